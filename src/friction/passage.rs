//! Advection of a particle to a node through the cell upstream, and the time that it takes: see [`super::path`].

/// A step as the particles see it.
#[derive(Debug, Clone, Copy)]
pub struct PathStep {
    /// Step Δt, `s`; infinite or 0 for steady rolling.
    pub duration: f64,
    /// Distance Δ of the nodes, `m`.
    pub spacing: f64,
    /// Speed V, `m/s`; 0 counts as forward.
    pub speed: f64,
    /// Elastic displacement of a cell under a shear of the size of the largest pressure, `m`.
    pub displacement: f64,
    /// Scale of pressures, `Pa`.
    pub pressure: f64,
}

/// Advection of a particle to a node in a step: the weights of T and the residence t/d_c; or their change.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Passage {
    /// Weight of the value upstream at the end of the step.
    pub upstream: f64,
    /// Weights of the values upstream and at the node at its beginning.
    pub before: [f64; 2],
    /// Residence time over the memory distance, t/d_c, `s/m`; infinite where nothing is remembered.
    pub residence: f64,
}

impl Passage {
    /// Passage without memory: nothing is brought along.
    const NONE: Passage = Passage {
        upstream: 0.0,
        before: [0.0; 2],
        residence: f64::INFINITY,
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
                residence: spacing / (speed * distance),
            }
        } else if cells >= 1.0 {
            Passage {
                upstream: 1.0 - 1.0 / cells,
                before: [1.0 / cells, 0.0],
                residence: spacing / (speed * distance),
            }
        } else {
            Passage {
                upstream: 0.0,
                before: [cells, 1.0 - cells],
                residence: duration / distance,
            }
        }
    }

    /// Change of the passage with |V|, per `m/s`.
    pub fn tangent(&self, duration: f64, spacing: f64, speed: f64) -> Passage {
        let none = Passage::default();
        if self.residence.is_infinite() {
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
            residence: -self.residence / speed,
        }
    }

    /// Part of T of the values at the beginning of the step, upstream and at the node; that of the value upstream at its end comes
    /// besides.
    pub fn start(&self, upstream: f64, own: f64) -> f64 {
        self.before[0] * upstream + self.before[1] * own
    }
}
