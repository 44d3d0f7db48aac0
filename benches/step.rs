//! One warm step of the braking manoeuvre, at default settings and with about 100 and 200 nodes in contact.

mod braking;
mod calls;

use braking::Braking;

fn main() {
    for (name, contact_nodes) in [("default", 61), ("100 in contact", 165), ("200 in contact", 331)] {
        let mut run = Braking::new(contact_nodes);
        calls::time(&format!("step, {name}"), || run.step());
    }
}
