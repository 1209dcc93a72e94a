//! The socket of OpenSees' `genericClient` element and of `expControl GenericTCP`: a header of sizes, then messages of
//! one length both ways, 64-bit floats in the machine's order. In: a client's connection. Out: motion through the guard,
//! forces to the client. The protocol has no word for an error: whatever stands in the way holds the rig and closes.
//!
//! A trial comes more than once: only a target that is not the last one moves the rig. Between moves the specimen is at
//! rest: velocity and acceleration are zero, so are damping and mass, which are the client's own; both stiffnesses are the one constant
//! that was given. A `GenericTCP` with an init file is not served.

use super::Ended;
use super::connection::Connection;
use super::generic_header::{self, HEADER, Layout};
use super::specimen::Specimen;

/// What a message asks for: its first word.
mod action {
    pub const SET_TRIAL: f64 = 3.0;
    pub const COMMIT: f64 = 5.0;
    pub const GET_MEASURED: f64 = 6.0;
    pub const GET_DISPLACEMENT: f64 = 7.0;
    pub const GET_VELOCITY: f64 = 8.0;
    pub const GET_ACCELERATION: f64 = 9.0;
    pub const GET_FORCE: f64 = 10.0;
    pub const GET_TIME: f64 = 11.0;
    pub const GET_INITIAL_STIFFNESS: f64 = 12.0;
    pub const GET_TANGENT_STIFFNESS: f64 = 13.0;
    pub const GET_DAMPING: f64 = 14.0;
    pub const GET_MASS: f64 = 15.0;
    pub const SHUT_DOWN: f64 = 98.0;
    pub const DIE: f64 = 99.0;
}

/// Serves a client until one of the two has enough.
pub fn session(connection: &mut Connection<'_>, specimen: &mut Specimen<'_, '_>, stiffness: f64) -> Ended {
    let ended = talk(connection, specimen, stiffness).unwrap_or_else(|ended| ended);
    specimen.hold();
    ended
}

fn talk(connection: &mut Connection<'_>, specimen: &mut Specimen<'_, '_>, stiffness: f64) -> Result<Ended, Ended> {
    let mut header = [0; HEADER];
    connection.read_all(&mut header)?;
    let layout = generic_header::parse(&header).map_err(Ended::Misspoken)?;
    let mut message = vec![0; 8 * layout.words];
    let mut answer = message.clone();
    loop {
        connection.read_all(&mut message)?;
        let asked = word(&message, 0);
        let single = |value: f64| [Some(value), None, None, None, None];
        let values = match asked {
            action::SET_TRIAL => {
                let target = word(&message, 1);
                if target != specimen.commanded() {
                    specimen.propose(target)?;
                    specimen.execute()?;
                }
                continue;
            }
            action::COMMIT => continue,
            action::GET_MEASURED => measured(layout, specimen),
            action::GET_DISPLACEMENT => single(specimen.felt().displacement),
            action::GET_VELOCITY | action::GET_ACCELERATION | action::GET_DAMPING | action::GET_MASS => single(0.0),
            action::GET_FORCE => single(specimen.felt().force),
            action::GET_TIME => single(specimen.time()),
            action::GET_INITIAL_STIFFNESS | action::GET_TANGENT_STIFFNESS => single(stiffness),
            action::SHUT_DOWN | action::DIE => return Ok(Ended::Closed),
            other => return Err(Ended::Misspoken(format!("no action is called {other}"))),
        };
        // What is not overwritten stays zero from the beginning.
        answer[..40.min(8 * layout.words)].fill(0);
        for (place, value) in answer.chunks_exact_mut(8).zip(values.into_iter().flatten()) {
            place.copy_from_slice(&value.to_le_bytes());
        }
        connection.write(&answer)?;
    }
}

/// What the header announced as measured, packed in its order.
fn measured(layout: Layout, specimen: &Specimen<'_, '_>) -> [Option<f64>; 5] {
    let felt = specimen.felt();
    let all = [felt.displacement, 0.0, 0.0, felt.force, specimen.time()];
    std::array::from_fn(|at| layout.measured[at].then_some(all[at]))
}

fn word(message: &[u8], at: usize) -> f64 {
    let mut bytes = [0; 8];
    bytes.copy_from_slice(&message[8 * at..8 * at + 8]);
    f64::from_le_bytes(bytes)
}
