//! What a particle of the rail brings to a node, and the time that it takes through the cell upstream: see [`super::path`].

/// A step as the particles see it.
#[derive(Debug, Clone, Copy)]
pub struct PathStep {
    /// Δt, `s`; infinite or 0 for steady rolling.
    pub duration: f64,
    /// Δ, `m`.
    pub spacing: f64,
    /// V, `m/s`; 0 counts as forward.
    pub speed: f64,
    /// Elastic displacement of a cell under a shear of the size of the largest pressure, `m`.
    pub displacement: f64,
    /// Scale of pressures, `Pa`.
    pub pressure: f64,
}

/// T, and t/d_c; or their change.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Passage {
    /// Weight of the value upstream at the end of the step.
    pub upstream: f64,
    /// Weights of the values upstream and at the node at its beginning.
    pub before: [f64; 2],
    /// t/d_c, `s/m`; infinite where nothing is remembered.
    pub exposure: f64,
}

impl Passage {
    /// Nothing is brought along.
    const NONE: Passage = Passage {
        upstream: 0.0,
        before: [0.0; 2],
        exposure: f64::INFINITY,
    };

    /// Passage through a cell `spacing` `m` long at |V| `speed` `m/s` in a step of `duration` `s`; one that is infinite
    /// or 0, a state without a step before it, is steady rolling.
    pub fn new(duration: f64, spacing: f64, speed: f64, distance: f64) -> Passage {
        let steady = !(duration > 0.0 && duration.is_finite());
        if distance == 0.0 || (steady && speed == 0.0) {
            return Passage::NONE;
        }
        let cells = speed * duration / spacing;
        if steady {
            Passage {
                upstream: 1.0,
                before: [0.0; 2],
                exposure: spacing / (speed * distance),
            }
        } else if cells >= 1.0 {
            Passage {
                upstream: 1.0 - 1.0 / cells,
                before: [1.0 / cells, 0.0],
                exposure: spacing / (speed * distance),
            }
        } else {
            Passage {
                upstream: 0.0,
                before: [cells, 1.0 - cells],
                exposure: duration / distance,
            }
        }
    }

    /// Change of the passage with |V|, per `m/s`.
    pub fn tangent(&self, duration: f64, spacing: f64, speed: f64) -> Passage {
        let none = Passage::default();
        if self.exposure.is_infinite() {
            return none;
        }
        if self.before[1] > 0.0 {
            let cells = duration / spacing;
            return Passage {
                before: [cells, -cells],
                ..none
            };
        }
        // 1/C over |V|; 0 in steady rolling.
        let share = self.before[0] / speed;
        Passage {
            upstream: share,
            before: [-share, 0.0],
            exposure: -self.exposure / speed,
        }
    }

    /// T of a value at the beginning of the step, (upstream, own); what the end of the step adds comes besides.
    pub fn start(&self, upstream: f64, own: f64) -> f64 {
        self.before[0] * upstream + self.before[1] * own
    }
}
