//! Splits received bytes into whole lines. It knows no protocol, only the line end and the maximum length.

/// Longest line kept \[bytes\]. More bytes without a line end are noise and are dropped.
const LONGEST: usize = 512;

/// The received part of a line that has not ended.
#[derive(Debug, Default)]
pub struct LineBuffer {
    begun: Vec<u8>,
    /// The current line is too long: all of it is dropped.
    overflowed: bool,
}

impl LineBuffer {
    /// Receives bytes and returns the lines that have ended, without their ends. A line ends with CR, LF or both. Empty lines
    /// and lines that are not ASCII are dropped.
    pub fn take(&mut self, bytes: &[u8]) -> Vec<String> {
        let mut lines = Vec::new();
        for byte in bytes {
            if matches!(byte, b'\r' | b'\n') {
                let line = std::mem::take(&mut self.begun);
                let whole =
                    !std::mem::take(&mut self.overflowed) && !line.is_empty() && line.is_ascii();
                lines.extend(whole.then(|| {
                    line.iter()
                        .map(|byte| char::from(*byte))
                        .collect::<String>()
                }));
            } else if self.begun.len() < LONGEST {
                self.begun.push(*byte);
            } else {
                self.overflowed = true;
            }
        }
        lines
    }

    /// Clears the received part.
    pub fn clear(&mut self) {
        self.begun.clear();
        self.overflowed = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_whole_however_its_bytes_come() {
        let mut buffer = LineBuffer::default();
        assert_eq!(buffer.take(b"Q1\r\nQ1"), ["Q1"]);
        assert!(buffer.take(b"34,").is_empty());
        assert_eq!(buffer.take(b"1,0\rQ22\n\n"), ["Q134,1,0", "Q22"]);
    }

    #[test]
    fn a_line_too_long_or_of_other_bytes_is_none_and_the_next_is_heard() {
        let mut buffer = LineBuffer::default();
        assert!(buffer.take(&[b'7'; LONGEST]).is_empty());
        assert_eq!(buffer.take(b"\n")[0].len(), LONGEST);
        assert!(buffer.take(&[b'7'; LONGEST + 1]).is_empty());
        assert_eq!(buffer.take(b"\n\xff\nQ1\n"), ["Q1"]);
    }
}
