//! The paper's own mesh, 12 × 8 cells with 192 triangles and 13 surface nodes, runs end to end.

use wheelrail::error::Error;
use wheelrail::parameters::{Control, MeshKind, NormalSolver, Parameters};
use wheelrail::simulation::Simulation as Run;
use wheelrail::verification::paper_cases::{inputs, parameters, settled};

fn on_the_papers_mesh(hot: Option<f64>, creepage: f64, control: Control) -> Result<Run, Error> {
    let parameters = Parameters {
        mesh: MeshKind::Paper,
        normal_solver: NormalSolver::Pschenichnyj,
        control,
        ..parameters(hot)
    };
    settled(&parameters, creepage)
}

fn peak(run: &Run) -> f64 {
    run.state.outputs.peak_temperature - inputs(0.0).ambient_temperature
}

#[test]
fn the_papers_cases_run_on_its_mesh_by_its_method() {
    let constant = on_the_papers_mesh(None, 0.04, Control::Load).unwrap();
    // Of its 13 surface nodes nine lie in the contact window; the triangles are counted beside the mesh.
    assert_eq!(constant.contact_nodes().len(), 9);
    // Five nodes in contact: right within a tenth, and in the right order.
    assert!((peak(&constant) / 94.9 - 1.0).abs() < 0.1, "{}", peak(&constant));
    let mut before = peak(&constant);
    for hot in [150.0, 125.0, 100.0] {
        let run = on_the_papers_mesh(Some(hot), 0.04, Control::Load).unwrap();
        assert!(peak(&run) < before);
        before = peak(&run);
    }
    on_the_papers_mesh(Some(100.0), -1.0, Control::Load).unwrap();
}

/// Eight cells in depth make the strip far too stiff: 0.1 mm of penetration spread the contact beyond the window that
/// the load alone would size.
#[test]
fn the_papers_penetration_runs_on_its_mesh() {
    on_the_papers_mesh(None, 0.04, Control::Penetration).unwrap();
}
