//! The text of a document, with positions as an editor counts them: line and character, in UTF-8 bytes or UTF-16 units. In: a text. Out:
//! byte offsets and positions. A position outside of the text is the nearest one inside.

use std::ops::Range;
use std::sync::Arc;

use gen_lsp_types as lsp;

/// The unit in which an editor counts the characters of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Utf8,
    Utf16,
}

impl Encoding {
    /// The length of a text.
    pub fn length(self, text: &str) -> usize {
        match self {
            Self::Utf8 => text.len(),
            Self::Utf16 => text.chars().map(char::len_utf16).sum(),
        }
    }
}

/// A text and the starts of its lines.
#[derive(Clone, Debug)]
pub struct Text {
    content: Arc<str>,
    starts: Vec<usize>,
    encoding: Encoding,
}

impl Text {
    pub fn new(text: impl Into<Arc<str>>, encoding: Encoding) -> Self {
        let text = text.into();
        let bytes = text.as_bytes();
        let ends = (0..bytes.len()).filter(|at| match bytes[*at] {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        });
        let starts = std::iter::once(0).chain(ends.map(|end| end + 1)).collect();
        Self {
            content: text,
            starts,
            encoding,
        }
    }

    pub fn as_str(&self) -> &str {
        &self.content
    }

    /// The text, shared.
    pub fn shared(&self) -> Arc<str> {
        Arc::clone(&self.content)
    }

    /// The line, from 0, of a byte offset.
    pub fn line_of(&self, offset: usize) -> usize {
        self.starts
            .partition_point(|start| *start <= offset)
            .saturating_sub(1)
    }

    /// The bytes of a line without its end.
    pub fn line(&self, line: usize) -> Range<usize> {
        let Some(start) = self.starts.get(line).copied() else {
            return self.content.len()..self.content.len();
        };
        let end = self
            .starts
            .get(line + 1)
            .copied()
            .unwrap_or(self.content.len());
        let body = self.content[start..end].trim_end_matches(['\r', '\n']);
        start..start + body.len()
    }

    /// The byte offset of a position.
    pub fn offset(&self, position: lsp::Position) -> usize {
        let line = self.line(usize::try_from(position.line).unwrap_or(usize::MAX));
        let wanted = usize::try_from(position.character).unwrap_or(usize::MAX);
        let text = &self.content[line.clone()];
        let mut counted = 0;
        for (at, character) in text.char_indices() {
            let length = match self.encoding {
                Encoding::Utf8 => character.len_utf8(),
                Encoding::Utf16 => character.len_utf16(),
            };
            if counted + length > wanted {
                return line.start + at;
            }
            counted += length;
        }
        line.end
    }

    /// The position of a byte offset.
    pub fn position(&self, offset: usize) -> lsp::Position {
        let offset = self.content.floor_char_boundary(offset);
        let line = self.line_of(offset);
        let character = self
            .encoding
            .length(&self.content[self.starts[line]..offset]);
        lsp::Position::new(narrow(line), narrow(character))
    }

    pub fn range(&self, bytes: Range<usize>) -> lsp::Range {
        lsp::Range::new(self.position(bytes.start), self.position(bytes.end))
    }

    /// The bytes of a range of positions.
    pub fn bytes(&self, range: lsp::Range) -> Range<usize> {
        let (start, end) = (self.offset(range.start), self.offset(range.end));
        start.min(end)..end.max(start)
    }
}

/// A count as the protocol has it.
pub fn narrow(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A micro sign, a Greek letter, an ideograph, an emoji of two UTF-16 units, a combining accent.
    const LINES: &str = "# 3 µm Δt\r\n\"梁の試験\" x\n# 🔨e\u{301}z\rlast";

    #[test]
    fn every_offset_of_a_character_is_one_position_and_back() {
        for encoding in [Encoding::Utf8, Encoding::Utf16] {
            let text = Text::new(LINES, encoding);
            assert_eq!(text.starts.len(), 4);
            for (at, character) in LINES
                .char_indices()
                .filter(|(_, c)| !matches!(c, '\r' | '\n'))
            {
                let position = text.position(at);
                assert_eq!(text.offset(position), at, "{encoding:?} {at} {character}");
            }
        }
    }

    #[test]
    fn a_line_counts_bytes_or_units() {
        let at = LINES.find('z').unwrap();
        let of = |encoding| Text::new(LINES, encoding).position(at);
        assert_eq!(of(Encoding::Utf8), lsp::Position::new(2, 2 + 4 + 1 + 2));
        assert_eq!(of(Encoding::Utf16), lsp::Position::new(2, 2 + 2 + 1 + 1));
    }

    #[test]
    fn a_position_outside_is_the_nearest_one() {
        let text = Text::new(LINES, Encoding::Utf16);
        let end_of_first = LINES.find('\r').unwrap();
        assert_eq!(text.offset(lsp::Position::new(0, u32::MAX)), end_of_first);
        assert_eq!(text.offset(lsp::Position::new(9, 0)), LINES.len());
        // In the middle of the emoji.
        let emoji = LINES.find('🔨').unwrap();
        assert_eq!(text.offset(lsp::Position::new(2, 3)), emoji);
        assert_eq!(text.position(emoji + 2), lsp::Position::new(2, 2));
        assert_eq!(text.position(usize::MAX), lsp::Position::new(3, 4));
    }
}
