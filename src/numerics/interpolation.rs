//! Places between points.

/// The interval of the ascending `points` that holds `x`, and the share of it that lies before `x`. Beyond the ends it is the
/// first or last interval, with a share outside [0, 1].
pub fn between(points: &[f64], x: f64) -> (usize, f64) {
    let first = points.partition_point(|&p| p <= x).clamp(1, points.len() - 1) - 1;
    (first, (x - points[first]) / (points[first + 1] - points[first]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_holds_the_place() {
        let points = [0.0, 1.0, 3.0];
        for (x, expected) in [
            (0.0, (0, 0.0)),
            (0.25, (0, 0.25)),
            (1.0, (1, 0.0)),
            (2.0, (1, 0.5)),
            (3.0, (1, 1.0)),
            (-1.0, (0, -1.0)),
            (5.0, (1, 2.0)),
        ] {
            assert_eq!(between(&points, x), expected, "{x}");
        }
    }
}
