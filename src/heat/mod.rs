//! Temperature of the rail (19), (23), and the displacement that it causes.
//!
//! [`basis`] takes the depth apart into modes, [`march`] carries them through the columns, by [`step`] and [`factors`], under the condition of
//! [`surface`], [`incoming`] is the rail that the wheel ahead has left, [`thermal_map`] the displacement of the contact
//! nodes, compressed by [`compression`], and [`isotherm`] how deep the rail is hotter than a given temperature. [`Heat`] holds what of this is computed once.

pub mod basis;
pub mod compression;
pub mod factors;
pub mod incoming;
pub mod isotherm;
pub mod march;
pub mod step;
// The patch engine uses it.
#[allow(dead_code)]
pub mod strips;
pub mod surface;
pub mod thermal_map;

use crate::body::compliance::ThermalDisplacement;
use crate::body::mesh::Mesh;
use crate::error::Result;
use crate::parameters::Parameters;
use basis::DepthBasis;
use incoming::Incoming;
use march::Heated;
use thermal_map::ThermalMap;

/// Heat of a rail: all that a step needs and that does not change after initialisation.
pub struct Heat {
    /// Eigenbasis of the depth operator.
    pub basis: DepthBasis,
    /// Profile of the temperature that enters.
    pub incoming: Incoming,
    /// Displacement of the contact nodes.
    pub displacement: ThermalMap,
}

impl Heat {
    /// Heat on a mesh, with the exact map from temperature to displacement on it.
    ///
    /// # Errors
    /// [`crate::error::Error::DepthBasis`].
    pub fn new(mesh: &Mesh, exact: &ThermalDisplacement, parameters: &Parameters) -> Result<Heat> {
        let basis = DepthBasis::new(&mesh.depth)?;
        let displacement = ThermalMap::new(
            mesh,
            &basis,
            exact,
            parameters.thermal_diffusivity,
            thermal_map::TOLERANCE,
        );
        let incoming = Incoming::new(&mesh.depth, &basis, parameters.skin_depth);
        Ok(Heat {
            basis,
            incoming,
            displacement,
        })
    }

    /// Fills the inflow column of a field with rail that enters at `rise` `K` over the ambient.
    pub fn enter(&self, rise: f64, inflow: usize, field: &mut Heated) {
        let m = self.basis.len();
        self.incoming.enter(
            rise,
            &mut field.amplitudes[inflow * m..(inflow + 1) * m],
            &mut field.surface[inflow],
        );
    }

    /// Temperature rise over the skin depth that holds the heat of a column given by its modal amplitudes, `K`.
    pub fn equivalent_rise(&self, amplitudes: &[f64]) -> f64 {
        self.incoming.equivalent_rise(&self.basis, amplitudes)
    }
}

/// Fronts on the default mesh.
#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::FrictionState;
    use crate::friction::coulomb::Sliding;
    use crate::heat::factors::CellFactors;
    use crate::heat::march::HeatMarch;
    use crate::heat::surface::{SurfaceCondition, SurfaceExchange};
    use crate::settings::HeatSettings;
    use crate::transport::Upwind;

    /// Hot rail comes in and ends, and the wheel slips and stops: no surface falls below the ambient, and none that is not
    /// heated rises above what came in.
    #[test]
    fn fronts_leave_no_surface_colder_than_the_ambient() {
        let parameters = Parameters::default();
        let mesh = Mesh::new(&parameters);
        let basis = DepthBasis::new(&mesh.depth).unwrap();
        let incoming = Incoming::new(&mesh.depth, &basis, parameters.skin_depth);
        let m = basis.len();
        let exchange = |heats: bool| -> Vec<SurfaceExchange> {
            (0..mesh.contact_nodes)
                .map(|node| match heats && node.abs_diff(30) < 18 {
                    true => SurfaceExchange::new(&parameters, 5e8, Sliding::new(2.0, 1.0), 0.0),
                    false => SurfaceExchange::default(),
                })
                .collect()
        };
        let mut cells = CellFactors::new(&basis, &mesh.x);
        let mut heated_most = 0.0_f64;
        for speed in [0.0, 1e-3, 0.1, 1.0, 10.0, 80.0, -10.0] {
            for duration in [1e-6, 1e-5, 1e-4, 1e-3, 3e-2] {
                for heats in [false, true] {
                    let march = HeatMarch {
                        basis: &basis,
                        transport: Upwind::new(&mesh.x, speed),
                        first_contact: mesh.first_contact,
                        duration,
                        surface: SurfaceCondition {
                            friction: FrictionState {
                                parameters: &parameters,
                                ambient: 293.15,
                                scale: 1.0,
                            },
                            settings: HeatSettings::default(),
                        },
                    };
                    let mut before = vec![0.0; mesh.columns() * m];
                    for step in 0..40 {
                        let (mut after, mut surface) = (vec![0.0; before.len()], vec![0.0; mesh.columns()]);
                        let inflow = march.transport.inflow();
                        let rise = if step % 20 < 10 { 100.0 } else { 0.0 };
                        incoming.enter(rise, &mut after[inflow * m..][..m], &mut surface[inflow]);
                        let mut field = Heated {
                            amplitudes: &mut after,
                            surface: &mut surface,
                            flux: &mut vec![0.0; mesh.contact_nodes],
                        };
                        let exchange = exchange(heats && step % 6 < 3);
                        march.advance(&before, &exchange, &mut field, &mut cells).unwrap();
                        let (least, most) = surface.iter().fold((0.0_f64, 0.0_f64), |(least, most), &rise| {
                            (least.min(rise), most.max(rise))
                        });
                        // Round-off of the sums over the modes.
                        assert!(least > -1e-9, "{speed} {duration} {heats} {step}: {least}");
                        assert!(heats || most < 101.5, "{speed} {duration} {step}: {most}");
                        heated_most = heated_most.max(most);
                        before = after;
                    }
                }
            }
        }
        assert!(heated_most > 200.0, "{heated_most}");
    }
}
