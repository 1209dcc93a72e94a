//! Devices that send automatically. In: a line that never stops. Out: a whole line that was begun after the request for it.

use crate::controllers::{Answer, DeviceFault, LineClient};

/// A whole line, without its ending, of which no byte was received before this call. The line in progress is discarded.
///
/// # Errors
/// None was received within the time-out, or the line is lost.
pub fn fresh_line(client: &mut LineClient) -> Result<Vec<u8>, DeviceFault> {
    client.drain()?;
    let seconds = client.reply_timeout();
    let deadline = client.now() + seconds;
    let mut any = |line: &[u8]| Answer::Take(line.strip_suffix(b"\r").unwrap_or(line).to_vec());
    let silent = DeviceFault::Silent { seconds };
    client
        .answer(b"\n", deadline, &mut any)?
        .ok_or_else(|| silent.clone())?;
    client.answer(b"\n", deadline, &mut any)?.ok_or(silent)
}
