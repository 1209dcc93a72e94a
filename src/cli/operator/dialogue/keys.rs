//! Bytes of a terminal → keys for the dialogue. Ctrl-C and Ctrl-\ arrive as bytes here, because the terminal is in raw mode, and act as
//! their signals do. An incomplete escape sequence does not hide them. It reads nothing and does not wait.

/// A key with a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    Character(char),
    Enter,
    Escape,
    /// Deletes the last character.
    Erase,
    /// Deletes the whole line: Ctrl-U.
    EraseLine,
    /// Ctrl-C
    Interrupt,
    /// Ctrl-\
    Quit,
    /// The end of the input: Ctrl-D.
    End,
}

const ESCAPE: u8 = 0x1b;

/// The typed bytes, between one read and the next.
#[derive(Debug, Default)]
pub struct Keyboard {
    /// The beginning of a key that arrived in two parts.
    begun: Vec<u8>,
}

/// The meaning of the first bytes.
enum First {
    /// A key, or bytes without a meaning here; the number is their length.
    Whole(Option<Key>, usize),
    /// The beginning of a key.
    Part,
}

impl Keyboard {
    /// The keys of these bytes, together with the earlier ones.
    pub fn typed(&mut self, bytes: &[u8]) -> Vec<Key> {
        let mut all = std::mem::take(&mut self.begun);
        all.extend_from_slice(bytes);
        let (mut rest, mut keys) = (all.as_slice(), Vec::new());
        while !rest.is_empty() {
            let First::Whole(key, length) = first(rest) else {
                self.begun = rest.to_vec();
                break;
            };
            keys.extend(key);
            rest = &rest[length..];
        }
        keys
    }

    /// Nothing arrived for a while: an incomplete key is dropped, and the next byte begins a new key.
    pub fn quiet(&mut self) {
        self.begun.clear();
    }
}

fn first(bytes: &[u8]) -> First {
    match bytes {
        [ESCAPE, after @ ..] => sequence(after),
        [byte, ..] if byte.is_ascii_control() => First::Whole(control(*byte), 1),
        _ => match character(bytes) {
            Some((character, length)) => First::Whole(character.map(Key::Character), length),
            None => First::Part,
        },
    }
}

const fn control(byte: u8) -> Option<Key> {
    match byte {
        0x03 => Some(Key::Interrupt),
        0x04 => Some(Key::End),
        0x08 | 0x7f => Some(Key::Erase),
        b'\r' | b'\n' => Some(Key::Enter),
        0x15 => Some(Key::EraseLine),
        0x1c => Some(Key::Quit),
        _ => None,
    }
}

/// The meaning of an escape: the key itself if nothing follows, a letter with Alt, or an arrow or similar key. Only the first has a
/// function here.
fn sequence(after: &[u8]) -> First {
    let nothing = |length: usize| First::Whole(None, 1 + length);
    match after {
        [] => First::Whole(Some(Key::Escape), 1),
        // A control character keeps its meaning at any position.
        [byte, ..] if byte.is_ascii_control() => {
            First::Whole((*byte == ESCAPE).then_some(Key::Escape), 1)
        }
        [b'O'] => First::Part,
        [b'O', byte, ..] => nothing(1 + usize::from(!byte.is_ascii_control())),
        [b'[', more @ ..] => {
            // Function keys of the Linux console have a second bracket.
            let start = usize::from(more.first() == Some(&b'['));
            let inside = |byte: &&u8| matches!(byte, 0x20..=0x3f);
            let end = start + more[start..].iter().take_while(inside).count();
            match more.get(end) {
                None => First::Part,
                Some(byte) => nothing(1 + end + usize::from(!byte.is_ascii_control())),
            }
        }
        _ => match character(after) {
            Some((_, length)) => nothing(length),
            None => First::Part,
        },
    }
}

/// The first character and its length in bytes; an invalid byte is skipped. None if the rest is still missing.
fn character(bytes: &[u8]) -> Option<(Option<char>, usize)> {
    let longest = &bytes[..bytes.len().min(4)];
    let good = match std::str::from_utf8(longest) {
        Ok(text) => text,
        Err(fault) if fault.valid_up_to() > 0 => {
            std::str::from_utf8(&longest[..fault.valid_up_to()]).unwrap_or_default()
        }
        Err(fault) => return fault.error_len().map(|length| (None, length)),
    };
    good.chars().next().map(|character| {
        (
            Some(character).filter(|character| !character.is_control()),
            character.len_utf8(),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(bytes: &[u8]) -> Vec<Key> {
        Keyboard::default().typed(bytes)
    }

    #[test]
    fn letters_lines_and_controls_are_keys() {
        assert_eq!(
            typed("yYé€😀".as_bytes()),
            "yYé€😀".chars().map(Key::Character).collect::<Vec<_>>()
        );
        let all = [
            Key::Interrupt,
            Key::End,
            Key::Erase,
            Key::Enter,
            Key::Enter,
            Key::EraseLine,
            Key::Erase,
        ];
        assert_eq!(typed(b"\x03\x04\x08\r\n\x15\x7f"), all);
        assert_eq!(
            typed(b"\x00\x01\x11\xff\xc3h"),
            [Key::Character('h')],
            "what is no character hides none"
        );
        assert_eq!(typed("\u{85}".as_bytes()), []);
    }

    #[test]
    fn a_modified_letter_an_arrow_and_a_function_key_are_none() {
        for bytes in [
            &b"\x1by"[..],
            b"\x1b[A",
            b"\x1b[1;5C",
            b"\x1bOP",
            b"\x1b[15~",
            b"\x1b[[A",
            "\u{1b}é".as_bytes(),
        ] {
            assert_eq!(typed(bytes), [], "{bytes:?}");
            let twice = [bytes, b"q"].concat();
            assert_eq!(typed(&twice), [Key::Character('q')], "{bytes:?}");
        }
        assert_eq!(typed(b"\x1b"), [Key::Escape]);
        assert_eq!(typed(b"\x1b\x1b"), [Key::Escape, Key::Escape]);
    }

    #[test]
    fn a_key_that_comes_in_pieces_is_one_key() {
        let whole = "é\u{1b}[1;5C€q".as_bytes();
        // A part that ends with the escape byte is the Escape key.
        for cut in (1..whole.len()).filter(|cut| whole[cut - 1] != ESCAPE) {
            let mut keyboard = Keyboard::default();
            let keys = [keyboard.typed(&whole[..cut]), keyboard.typed(&whole[cut..])].concat();
            assert_eq!(
                keys,
                [
                    Key::Character('é'),
                    Key::Character('€'),
                    Key::Character('q')
                ],
                "cut at {cut}"
            );
        }
    }

    #[test]
    fn ctrl_c_is_heard_wherever_it_comes() {
        for before in [
            &b""[..],
            b"\x1b",
            b"\x1b[",
            b"\x1b[12",
            b"\x1bO",
            b"\x1b[[",
            b"\xc3",
            b"\xf0\x9f",
        ] {
            let mut keyboard = Keyboard::default();
            keyboard.typed(before);
            assert_eq!(
                keyboard.typed(b"\x03"),
                [Key::Interrupt],
                "after {before:?}, in pieces"
            );
            assert_eq!(
                typed(&[before, b"\x03"].concat()).last(),
                Some(&Key::Interrupt),
                "after {before:?}"
            );
            assert_eq!(
                typed(&[before, b"\x1c"].concat()).last(),
                Some(&Key::Quit),
                "after {before:?}"
            );
        }
    }

    #[test]
    fn what_was_begun_and_not_ended_takes_no_later_key_with_it() {
        let mut keyboard = Keyboard::default();
        assert_eq!(keyboard.typed(b"\x1b["), []);
        keyboard.quiet();
        assert_eq!(keyboard.typed(b"h"), [Key::Character('h')]);
    }
}
