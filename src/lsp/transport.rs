//! Messages as bytes. In: a stream of bytes. Out: messages on a connection; and back. Bytes that are no message get an error as answer,
//! and the next message is read: an editor, a proxy or a person may send anything.

use std::io::{self, BufRead, Read as _, Write};
use std::sync::Arc;
use std::sync::mpsc;

use lsp_server::{Connection, ErrorCode, Message};
use serde_json::{Value, json};

use crate::{Ended, Program, run};

/// Most bytes of one message. A plan has at most 1 MiB, and a change of it escapes every character at worst.
const MESSAGE_BYTES: usize = 16 << 20;
/// Most bytes of a line of a header.
const HEADER_BYTES: u64 = 4 << 10;

/// Serves one editor over two streams until it says `exit`, or until its stream ends.
///
/// # Errors
/// A stream that cannot be written.
pub fn serve(
    mut input: impl BufRead + Send + 'static,
    output: impl Write + Send + 'static,
    program: Arc<dyn Program>,
) -> io::Result<Ended> {
    let (own, editor) = Connection::memory();
    // None closes the output.
    let (to_writer, written) = mpsc::channel::<Option<Value>>();
    let (refused, closing) = (to_writer.clone(), to_writer.clone());
    let received = editor.sender;
    // It may wait for bytes that never come, and then ends with the program.
    std::thread::spawn(move || {
        while let Ok(Some(bytes)) = next(&mut input) {
            match bytes.and_then(|bytes| message(&bytes)) {
                Ok(Some(message)) => {
                    let exits =
                        matches!(&message, Message::Notification(last) if last.method == "exit");
                    if received.send(message).is_err() || exits {
                        break;
                    }
                }
                Ok(None) => {}
                Err(answer) => {
                    let _ = refused.send(Some(answer));
                }
            }
        }
    });
    let sent = editor.receiver;
    let forwarder = std::thread::spawn(move || {
        for message in sent {
            if let Ok(Value::Object(mut value)) = serde_json::to_value(&message) {
                value.insert("jsonrpc".to_owned(), json!("2.0"));
                let _ = to_writer.send(Some(Value::Object(value)));
            }
        }
    });
    let writer = std::thread::spawn(move || write_all(output, &written));
    let ended = run(own, program);
    let _ = forwarder.join();
    let _ = closing.send(None);
    writer.join().unwrap_or(Ok(()))?;
    Ok(ended)
}

fn write_all(mut output: impl Write, messages: &mpsc::Receiver<Option<Value>>) -> io::Result<()> {
    while let Ok(Some(message)) = messages.recv() {
        let text = message.to_string();
        write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
        output.flush()?;
    }
    Ok(())
}

/// The answer to bytes that are no request: it has no id.
fn refusal(code: ErrorCode, message: &str) -> Value {
    refusal_of(&Value::Null, code, message)
}

fn refusal_of(id: &Value, code: ErrorCode, message: &str) -> Value {
    json!({ "jsonrpc": "2.0", "id": id, "error": { "code": code as i32, "message": message } })
}

/// The bytes of the next message, or the answer to a header that announces none; nothing at the end of the stream.
fn next(input: &mut impl BufRead) -> io::Result<Option<Result<Vec<u8>, Value>>> {
    let mut length = None;
    let mut is_header = false;
    loop {
        let mut line = Vec::new();
        if input
            .by_ref()
            .take(HEADER_BYTES)
            .read_until(b'\n', &mut line)?
            == 0
        {
            return Ok(None);
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.trim();
        if line.is_empty() && is_header {
            break;
        }
        is_header |= !line.is_empty();
        if let Some((name, value)) = line.split_once(':')
            && name.trim().eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse::<u64>().ok();
        }
    }
    let Some(length) = length else {
        return Ok(Some(Err(refusal(
            ErrorCode::ParseError,
            "the header has no Content-Length",
        ))));
    };
    if length > MESSAGE_BYTES as u64 {
        io::copy(&mut input.by_ref().take(length), &mut io::sink())?;
        let message = format!("a message has at most {MESSAGE_BYTES} bytes");
        return Ok(Some(Err(refusal(ErrorCode::InvalidRequest, &message))));
    }
    let mut bytes = Vec::new();
    input.by_ref().take(length).read_to_end(&mut bytes)?;
    Ok(Some(Ok(bytes)))
}

/// The message in these bytes; nothing if it is an answer to no request of the server. An error is the answer to the sender.
fn message(bytes: &[u8]) -> Result<Option<Message>, Value> {
    let value: Value = serde_json::from_slice(bytes)
        .map_err(|error| refusal(ErrorCode::ParseError, &format!("no JSON: {error}")))?;
    let Value::Object(object) = &value else {
        return Err(refusal(
            ErrorCode::InvalidRequest,
            "a message is one JSON object",
        ));
    };
    let is_call = object.contains_key("method");
    let id = object.get("id");
    let is_id =
        |id: &Value| id.is_string() || id.as_i64().is_some_and(|id| i32::try_from(id).is_ok());
    match id {
        // An answer without a proper id answers nothing that was asked.
        Some(id) if !is_id(id) && !is_call => return Ok(None),
        Some(Value::Null) => {
            return Err(refusal(
                ErrorCode::InvalidRequest,
                "the id of a request is not null",
            ));
        }
        Some(id) if !is_id(id) => {
            return Err(refusal_of(
                id,
                ErrorCode::InvalidRequest,
                "the id of a request is a string or a whole number of 32 bits",
            ));
        }
        None if !is_call => {
            return Err(refusal(
                ErrorCode::InvalidRequest,
                "a message has a method or an id",
            ));
        }
        _ => {}
    }
    let id = id.cloned().unwrap_or(Value::Null);
    match serde_json::from_value::<Message>(value) {
        // A request that is read as something else would have no answer.
        Ok(Message::Notification(_)) if !id.is_null() => Err(refusal_of(
            &id,
            ErrorCode::InvalidRequest,
            "the method of a request is a string",
        )),
        Ok(message) => Ok(Some(message)),
        Err(_) if is_call => Err(refusal_of(
            &id,
            ErrorCode::InvalidRequest,
            "the method of a message is a string",
        )),
        Err(_) => Ok(None),
    }
}
