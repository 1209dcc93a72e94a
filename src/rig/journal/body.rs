//! The JSON of an entry. In: any value that serde can walk. Out: one object of printable ASCII, appended to a buffer, or compared with that
//! of a line. It knows no other part of a line.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::Value;
use serde_json::ser::{Formatter, Serializer};

use super::{Line, Refusal, finite};

/// Appends the body as JSON.
///
/// # Errors
/// The body is not an object of finite numbers; the buffer may contain a part of it.
pub fn write(out: &mut Vec<u8>, body: &impl Serialize) -> Result<(), Refusal> {
    finite::check(body)?;
    let mut serializer = Serializer::with_formatter(out, Ascii);
    body.serialize(&mut serializer)
        .map_err(|error| Refusal::NotJson(error.to_string()))
}

/// Appends the body as JSON, after fields of the run log itself.
///
/// # Errors
/// As `write`; or the body already has such a field.
pub fn write_with(
    out: &mut Vec<u8>,
    own: &[(&'static str, Value)],
    body: &impl Serialize,
) -> Result<(), Refusal> {
    finite::check(body)?;
    let Ok(Value::Object(given)) = serde_json::to_value(body) else {
        return Err(Refusal::NotAnObject);
    };
    if let Some((name, _)) = own.iter().find(|(name, _)| given.contains_key(*name)) {
        return Err(Refusal::Reserved(name));
    }
    let own = own
        .iter()
        .map(|(name, value)| ((*name).to_owned(), value.clone()));
    write(out, &own.chain(given).collect::<serde_json::Map<_, _>>())
}

/// Whether the body of a line has the very bytes that are written for `body`, which has been read from it.
pub fn is_written_as(line: &Line, body: &impl Serialize) -> bool {
    line.with_json(|json| {
        let mut expected = Expected(json);
        let mut serializer = Serializer::with_formatter(&mut expected, Ascii);
        body.serialize(&mut serializer).is_ok() && expected.0.is_empty()
    })
}

/// The bytes that have to be written next. Another one is an error.
struct Expected<'a>(&'a [u8]);

impl Write for Expected<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 = self
            .0
            .strip_prefix(bytes)
            .ok_or(io::ErrorKind::InvalidData)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// JSON without spaces, in printable ASCII.
struct Ascii;

impl Formatter for Ascii {
    fn write_string_fragment<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        fragment: &str,
    ) -> io::Result<()> {
        // Control characters never occur here; DEL does.
        if fragment.bytes().all(|byte| byte < 0x7f) {
            return writer.write_all(fragment.as_bytes());
        }
        for character in fragment.chars() {
            if character < '\x7f' {
                writer.write_all(&[character as u8])?;
            } else {
                for unit in character.encode_utf16(&mut [0; 2]) {
                    write!(writer, "\\u{unit:04x}")?;
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::super::Refusal;
    use super::{write, write_with};

    fn written(body: &Value) -> String {
        let mut out = Vec::new();
        write(&mut out, body).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn it_is_printable_ascii_that_reads_back() {
        let body = json!({"é": "a\"\\\n\u{7f}\u{85}\u{202e}𝛿\0", "n": [0.1, -0.0, 1e300, 5e-324, u64::MAX, i64::MIN]});
        let text = written(&body);
        assert_eq!(
            text,
            r#"{"\u00e9":"a\"\\\n\u007f\u0085\u202e\ud835\udeff\u0000","n":[0.1,-0.0,1e+300,5e-324,18446744073709551615,-9223372036854775808]}"#
        );
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), body);
    }

    #[test]
    fn own_fields_come_first_and_are_not_given_twice() {
        let mut out = b"before ".to_vec();
        write_with(&mut out, &[("format", json!(1))], &json!({"plan": "ö"})).unwrap();
        assert_eq!(out, br#"before {"format":1,"plan":"\u00f6"}"#);
        let twice = write_with(
            &mut out,
            &[("count", json!(1)), ("head", json!(""))],
            &json!({"head": 2}),
        );
        assert_eq!(twice, Err(Refusal::Reserved("head")));
    }
}
