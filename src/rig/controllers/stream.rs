//! Devices that send by themselves. In: a line that never stops. Out: a whole line that was begun after it was wanted.

use super::{Answer, DeviceFault, Talk};

/// A whole line, without its ending, of which no byte came before this call: the one under way is thrown away.
///
/// # Errors
/// None came within the time-out, or the line is gone.
pub(super) fn fresh_line(talk: &mut Talk) -> Result<Vec<u8>, DeviceFault> {
    talk.drain()?;
    let seconds = talk.reply_timeout();
    let deadline = talk.now() + seconds;
    let mut any = |line: &[u8]| Answer::Take(line.strip_suffix(b"\r").unwrap_or(line).to_vec());
    let silent = DeviceFault::Silent { seconds };
    talk.answer(b"\n", deadline, &mut any)?
        .ok_or_else(|| silent.clone())?;
    talk.answer(b"\n", deadline, &mut any)?.ok_or(silent)
}
