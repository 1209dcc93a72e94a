//! Lines whose answers carry no number, so that a late one looks like a fresh one. In: a question as a closure. Out: an
//! answer that is to that question, or none. It knows no dialect.

use super::{Answer, DeviceFault, Missed, Talk};
use crate::rig::safety::failpoint::{Guarding, on};

/// How often a question is asked anew after the first silence.
const AGAIN: u32 = 3;
/// How long a line of text is listened to before a question, s.
const LINE_GAP: f64 = 0.001;

/// Waits `quiet` s before a question. What comes unasked meanwhile, or was left over, is counted and thrown away.
pub(super) fn clear(talk: &mut Talk, quiet: f64) -> Result<(), DeviceFault> {
    if more(talk, quiet)? {
        talk.tally_mut().ignored += 1;
        talk.until_quiet(quiet)?;
    }
    Ok(())
}

/// Asks, and where there was silence asks twice more: a late answer to the first question would come before or between
/// the two and is seen as one too many, so that only the second of two lone answers counts. Each silence is waited out.
pub(super) fn fresh<T>(
    talk: &mut Talk,
    mut ask: impl FnMut(&mut Talk) -> Result<T, DeviceFault>,
) -> Result<T, DeviceFault> {
    let began = talk.now();
    match ask(talk) {
        Err(DeviceFault::Silent { .. }) if on(Guarding::Resend) => {}
        said => return said,
    }
    for _ in 0..AGAIN {
        talk.tally_mut().resent += 1;
        let silence = talk.reply_timeout();
        if on(Guarding::Sequence) {
            talk.until_quiet(silence)?;
            match ask(talk) {
                Err(DeviceFault::Silent { .. }) => continue,
                said => said?,
            };
            if more(talk, silence)? {
                talk.tally_mut().ignored += 1;
                continue;
            }
        }
        match ask(talk) {
            Err(DeviceFault::Silent { .. }) => {}
            said => return said,
        }
    }
    Err(DeviceFault::Silent {
        seconds: talk.now() - began,
    })
}

/// Gives an order whose answer is the same however often it is given, and gives it anew into silence.
pub(super) fn order<T>(
    talk: &mut Talk,
    mut give: impl FnMut(&mut Talk) -> Result<T, DeviceFault>,
) -> Result<T, DeviceFault> {
    let began = talk.now();
    for _ in 0..if on(Guarding::Resend) { AGAIN } else { 0 } {
        match give(talk) {
            Err(DeviceFault::Silent { .. }) => {
                talk.tally_mut().resent += 1;
                let silence = talk.reply_timeout();
                talk.until_quiet(silence)?;
            }
            said => return said,
        }
    }
    give(talk).map_err(|fault| match fault {
        DeviceFault::Silent { .. } => DeviceFault::Silent {
            seconds: talk.now() - began,
        },
        other => other,
    })
}

/// Asks for one line and gives it without its ending, never that of an earlier question.
pub(super) fn ask_line(
    talk: &mut Talk,
    question: &[u8],
    ending: &[u8],
) -> Result<Vec<u8>, DeviceFault> {
    fresh(talk, |talk| {
        clear(talk, LINE_GAP)?;
        talk.exchange_once(question, ending, |line| Answer::Take(line.to_vec()))
    })
}

/// Whether anything comes within `seconds`.
fn more(talk: &mut Talk, seconds: f64) -> Result<bool, DeviceFault> {
    let until = talk.now() + seconds;
    match talk.exactly(1, until) {
        Ok(_) => Ok(true),
        Err(Missed::TimedOut) => Ok(false),
        Err(missed) => Err(fault(missed, talk)),
    }
}

/// What a missing answer is to the caller of a device.
pub(super) fn fault(missed: Missed, talk: &Talk) -> DeviceFault {
    match missed {
        Missed::TimedOut | Missed::TooLong => DeviceFault::Silent {
            seconds: talk.reply_timeout(),
        },
        Missed::Gone(reason) => DeviceFault::Lost { reason },
        Missed::Interrupted => DeviceFault::Interrupted,
    }
}
