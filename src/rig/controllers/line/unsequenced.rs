//! Lines whose answers have no sequence number, so that a late answer cannot be distinguished from a fresh one. In: a question as a
//! closure. Out: its answer, or none. It knows no protocol.

use crate::controllers::{Answer, DeviceFault, LineClient, Missed};
use crate::safety::failpoint::{Guarding, on};

/// Number of times a question is repeated after the first silence.
const AGAIN: u32 = 3;
/// Silence required on a text line before a question \[s\].
const LINE_GAP: f64 = 0.001;

/// Waits `quiet` \[s\] before a question. Unsolicited or remaining bytes are counted and discarded.
pub fn clear(client: &mut LineClient, quiet: f64) -> Result<(), DeviceFault> {
    if more(client, quiet)? {
        client.line_statistics_mut().ignored += 1;
        client.until_quiet(quiet)?;
    }
    Ok(())
}

/// Sends the question, and after silence sends it twice more. A late answer to the first question would arrive before or between the
/// other two answers, and would be one too many. So only the second of two single answers counts. Every silence is waited for in full.
/// After a question that was given up, the next one is asked so from the start: the late answer could be to another question.
pub fn fresh<T>(
    client: &mut LineClient,
    mut ask: impl FnMut(&mut LineClient) -> Result<T, DeviceFault>,
) -> Result<T, DeviceFault> {
    let began = client.now();
    if !(client.owes_an_answer && on(Guarding::Sequence)) {
        match ask(client) {
            Err(DeviceFault::Silent { .. }) if on(Guarding::Resend) => client.owes_an_answer = true,
            answer => return answer,
        }
    }
    for _ in 0..AGAIN {
        client.line_statistics_mut().resent += 1;
        let silence = client.reply_timeout();
        if on(Guarding::Sequence) {
            client.until_quiet(silence)?;
            match ask(client) {
                Err(DeviceFault::Silent { .. }) => continue,
                answer => answer?,
            };
            if more(client, silence)? {
                client.line_statistics_mut().ignored += 1;
                continue;
            }
        }
        match ask(client) {
            Err(DeviceFault::Silent { .. }) => {}
            answer => {
                client.owes_an_answer = false;
                return answer;
            }
        }
    }
    Err(DeviceFault::Silent {
        seconds: client.now() - began,
    })
}

/// Sends a command whose answer is the same after every repetition, and repeats it after silence.
pub fn order<T>(
    client: &mut LineClient,
    mut give: impl FnMut(&mut LineClient) -> Result<T, DeviceFault>,
) -> Result<T, DeviceFault> {
    let began = client.now();
    for _ in 0..if on(Guarding::Resend) { AGAIN } else { 0 } {
        match give(client) {
            Err(DeviceFault::Silent { .. }) => {
                client.line_statistics_mut().resent += 1;
                let silence = client.reply_timeout();
                client.until_quiet(silence)?;
            }
            answer => return answer,
        }
    }
    give(client).map_err(|fault| match fault {
        DeviceFault::Silent { .. } => DeviceFault::Silent {
            seconds: client.now() - began,
        },
        other => other,
    })
}

/// Requests one line and gives it without its ending, never the answer to an earlier question.
pub fn ask_line(
    client: &mut LineClient,
    question: &[u8],
    ending: &[u8],
) -> Result<Vec<u8>, DeviceFault> {
    fresh(client, |client| {
        clear(client, LINE_GAP)?;
        client.exchange_once(question, ending, |line| Answer::Take(line.to_vec()))
    })
}

/// Whether any byte is received within `seconds`.
fn more(client: &mut LineClient, seconds: f64) -> Result<bool, DeviceFault> {
    let until = client.now() + seconds;
    match client.exactly(1, until) {
        Ok(_) => Ok(true),
        Err(Missed::TimedOut) => Ok(false),
        Err(missed) => Err(fault(missed, client)),
    }
}

/// The device fault for a missing answer.
pub fn fault(missed: Missed, client: &LineClient) -> DeviceFault {
    match missed {
        Missed::TimedOut | Missed::TooLong => DeviceFault::Silent {
            seconds: client.reply_timeout(),
        },
        Missed::Lost(reason) => DeviceFault::Lost { reason },
        Missed::Interrupted => DeviceFault::Interrupted,
    }
}
