//! A beam of 1 kg and 300 N/m is struck by 10 kg at 1 m/s. The loop is that of a pseudo-dynamic test: the solver predicts a
//! displacement, the specimen is moved there, and the solver ends the step with the force that is read. Here the specimen is a spring.
//!
//! ```text
//! cargo run -p psd-physics --example strike_a_beam
//! ```

use psd_physics::contact::Approaching;
use psd_physics::critical_time_step;
use psd_physics::impact::{ImpactError, ImpactInput, ImpactSolver};

fn main() -> Result<(), ImpactError> {
    let (mass, stiffness) = (1.0, 300.0);
    let time_step = critical_time_step(mass, stiffness) / 100.0;
    let input = ImpactInput::rigid(
        stiffness,
        Approaching {
            mass,
            striker_mass: 10.0,
            velocity: 1.0,
            time_step,
        },
    );
    let mut solver = ImpactSolver::new(&input, 0.0, 0.0)?;
    let (mut peak, mut time) = (0.0, 0.0);
    while !solver.finished() {
        let target = solver.predict();
        let force = stiffness * target;
        let state = solver.complete(target, force);
        if state.displacement > peak {
            (peak, time) = (state.displacement, state.time);
        }
    }
    println!("largest displacement {peak:.4} m, at {time:.3} s");
    Ok(())
}
