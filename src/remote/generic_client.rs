//! The socket of OpenSees' `genericClient` element and of `expControl GenericTCP`: a header of sizes, then messages of one
//! length in both directions. They contain 64-bit floats in the machine's byte order. In: a client's connection. Out: motion
//! through the guard, forces to the client.
//!
//! The protocol has no error message. OpenSees (tested with 3.7.1) does not notice that its server has disconnected. After a
//! `close`, a `shutdown` or a reset it waits in its read for ever, at full processor load. It does notice a force that is not
//! finite: an iteration does not converge, and `analyze` fails at that step. An explicit or linear analysis continues to the
//! end of its steps with NaN and sends its 99. NaN cannot be mistaken for a result. Therefore any fault holds the rig. Every
//! later request is answered with NaN, until the client disconnects, is silent or has sent all its messages.
//!
//! A trial is sent more than once: only a target that differs from the last one moves the rig. Between moves the specimen
//! is at rest: velocity and acceleration are zero, and so are damping and mass, which belong to the client; both
//! stiffnesses are the given constant. A rig of n axes is driven by vectors of n words, and a stiffness, damping or mass
//! has n·n words. One message moves all axes; if a limit refuses one, none moves. The messages of a `GenericTCP` with an
//! init file are accepted, noted and otherwise ignored.

use std::time::Duration;

use super::Ended;
use super::connection::{Broken, Connection};
use crate::run::remote_control::Specimen;
use psd_rig::protocols::generic_header::{self, HEADER, Layout};

/// The first word of a message: the requested action.
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

/// First byte of a message of GenericTCP's `-initFile`, and bytes of the whole.
const SETTING: u8 = 2;
const SETTING_MESSAGE: usize = 16_385;

/// Maximum time during which a refused client is still answered, and maximum time that it can be silent meanwhile.
const FAREWELL: Duration = Duration::from_secs(30);
const SILENCE: Duration = Duration::from_secs(1);

/// Serves a client until one of the two ends the session.
pub fn session(
    connection: &mut Connection<'_>,
    specimen: &mut Specimen<'_, '_>,
    stiffness: &[f64],
) -> Ended {
    let (mut words, mut begun) = (0, Vec::new());
    let ended = converse(connection, specimen, stiffness, &mut words, &mut begun)
        .unwrap_or_else(|ended| ended);
    if words > 0 && matches!(ended, Ended::Limit(_) | Ended::Rig(_) | Ended::Stopped) {
        specimen.hold();
        // A further failure adds nothing to the reason why the session ended.
        let _ = bid_farewell(connection, specimen, words, &begun);
    }
    ended
}

/// Answers every question with NaN until the client disconnects. Nothing moves. `begun` has been received of the first of
/// them.
fn bid_farewell(
    connection: &mut Connection<'_>,
    specimen: &mut Specimen<'_, '_>,
    words: usize,
    begun: &[u8],
) -> Result<(), Broken> {
    let answer: Vec<u8> = std::iter::repeat_n(f64::NAN, words)
        .flat_map(f64::to_le_bytes)
        .collect();
    let mut message = vec![0; 8 * words];
    message[..begun.len()].copy_from_slice(begun);
    let mut filled = begun.len();
    let over = specimen.now() + FAREWELL.as_secs_f64();
    while specimen.now() < over {
        connection.read_soon(&mut message[filled..], specimen, SILENCE)?;
        filled = 0;
        match word(&message, 0) {
            action::SET_TRIAL | action::COMMIT => {}
            action::SHUT_DOWN | action::DIE => return Ok(()),
            _ => connection.write(&answer, specimen)?,
        }
    }
    Ok(())
}

fn converse(
    connection: &mut Connection<'_>,
    specimen: &mut Specimen<'_, '_>,
    stiffness: &[f64],
    words: &mut usize,
    begun: &mut Vec<u8>,
) -> Result<Ended, Ended> {
    let mut header = [0; HEADER];
    connection.read_all(&mut header, specimen)?;
    let axes = specimen.degrees_of_freedom();
    let layout = generic_header::parse(&header, axes).map_err(Ended::Misspoken)?;
    *words = layout.words;
    let mut message = vec![0; 8 * layout.words];
    let mut answer = message.clone();
    let (mut settings, mut longest) = (0_u64, 0);
    loop {
        begun.clear();
        let first = connection.read(&mut message[..1], specimen, None)?;
        if message[0] == SETTING {
            // The rest of it is skipped; the action of any other message begins with a zero.
            let mut rest = [0; SETTING_MESSAGE - 1];
            connection.read_all(&mut rest, specimen)?;
            if settings == 0 {
                specimen.remark(format!(
                    "settings of the client's init file are not for this rig: {}",
                    line_of(&rest)
                ));
            }
            settings += 1;
            continue;
        }
        // Kept as received: if it is interrupted here, its end is still received later.
        begun.extend_from_slice(&message[..first]);
        let since = Some(specimen.now());
        while begun.len() < message.len() {
            let came = connection.read(&mut message[begun.len()..], specimen, since)?;
            begun.extend_from_slice(&message[begun.len()..begun.len() + came]);
        }
        begun.clear();
        let asked = word(&message, 0);
        let still = || vec![0.0; axes];
        let values = match asked {
            action::SET_TRIAL => {
                let targets: Vec<f64> = (1..=axes).map(|at| word(&message, at)).collect();
                if targets != specimen.commanded() {
                    specimen.propose(&targets)?;
                    let words = layout.words;
                    connection.execute(specimen, move |ahead| takes_leave(ahead, words))?;
                }
                continue;
            }
            action::COMMIT => {
                specimen.commit();
                continue;
            }
            action::GET_MEASURED => measured(layout, specimen),
            action::GET_DISPLACEMENT => specimen.feedback().displacement.clone(),
            action::GET_VELOCITY | action::GET_ACCELERATION => still(),
            action::GET_DAMPING | action::GET_MASS => vec![0.0; axes * axes],
            action::GET_FORCE => specimen.feedback().force.clone(),
            action::GET_TIME => vec![specimen.time()],
            action::GET_INITIAL_STIFFNESS | action::GET_TANGENT_STIFFNESS => stiffness.to_vec(),
            action::SHUT_DOWN | action::DIE => return Ok(Ended::Closed),
            other => return Err(Ended::Misspoken(format!("unknown action {other}"))),
        };
        if values.len() > layout.words {
            let needed = values.len();
            return Err(Ended::Misspoken(format!(
                "messages of {} words are too short for an answer of {needed}",
                layout.words
            )));
        }
        // Bytes that neither this answer nor an earlier one overwrites stay zero.
        answer[..8 * longest].fill(0);
        longest = longest.max(values.len());
        for (bytes, value) in answer.chunks_exact_mut(8).zip(values) {
            bytes.copy_from_slice(&value.to_le_bytes());
        }
        connection.write(&answer, specimen)?;
    }
}

/// Whether one of the messages that were sent ahead, of this length in words, is the last.
fn takes_leave(mut ahead: &[u8], words: usize) -> bool {
    loop {
        let length = if ahead.first() == Some(&SETTING) {
            SETTING_MESSAGE
        } else {
            8 * words
        };
        let Some((message, more)) = ahead.split_at_checked(length) else {
            return false;
        };
        if message[0] != SETTING && matches!(word(message, 0), action::SHUT_DOWN | action::DIE) {
            return true;
        }
        ahead = more;
    }
}

/// The measured values announced in the header, packed in its order.
fn measured(layout: Layout, specimen: &Specimen<'_, '_>) -> Vec<f64> {
    let feedback = specimen.feedback();
    let still = vec![0.0; feedback.force.len()];
    let all = [
        &feedback.displacement,
        &still,
        &still,
        &feedback.force,
        &vec![specimen.time()],
    ];
    all.into_iter()
        .zip(layout.measured)
        .filter(|(_, wanted)| *wanted)
        .flat_map(|(values, _)| values)
        .copied()
        .collect()
}

/// The text of a setting, up to its end.
fn line_of(message: &[u8]) -> String {
    let end = message
        .iter()
        .position(|byte| matches!(byte, 0 | b'\n' | b'\r'))
        .unwrap_or(message.len());
    String::from_utf8_lossy(&message[..end.min(200)]).into_owned()
}

fn word(message: &[u8], at: usize) -> f64 {
    let mut bytes = [0; 8];
    bytes.copy_from_slice(&message[8 * at..8 * at + 8]);
    f64::from_le_bytes(bytes)
}
