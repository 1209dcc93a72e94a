//! Source text and spans in it. In: the text of plan files. Out: [`Sources`], [`Span`] and [`Spanned`].
//! Knows nothing of the language and opens no file: the code that loads a file adds its text here.

/// The file of [`Sources`] in which a span lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileId(pub u32);

/// Half-open range of bytes, `start..end`, in one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    pub file: FileId,
    pub start: u32,
    pub end: u32,
}

impl Span {
    /// The bytes `start..end` of `file`. Offsets past 4 GiB cannot occur: a plan file is at most 1 MiB.
    #[must_use]
    pub fn new(file: FileId, start: usize, end: usize) -> Self {
        let narrow = |offset: usize| u32::try_from(offset).unwrap_or(u32::MAX);
        Self {
            file,
            start: narrow(start),
            end: narrow(end),
        }
    }

    /// The smallest span that covers both. They must be in one file.
    #[must_use]
    pub fn to(self, other: Span) -> Span {
        debug_assert_eq!(self.file, other.file);
        Span {
            file: self.file,
            start: self.start.min(other.start),
            end: self.end.max(other.end),
        }
    }

    #[must_use]
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// A value and the span at which it was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spanned<T> {
    pub node: T,
    pub span: Span,
}

impl<T> Spanned<T> {
    pub const fn new(node: T, span: Span) -> Self {
        Self { node, span }
    }
}

/// One file: its name as the plan wrote it (never an absolute path) and its text, already valid UTF-8.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    pub name: String,
    pub text: String,
}

/// Line and column, both from 1; the column counts characters, not bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    pub line: usize,
    pub column: usize,
}

/// All files of one plan, in the order they were loaded; the plan itself is the first.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<SourceFile>,
    /// The ends of the lines of each file, as byte offsets.
    ends: Vec<Vec<usize>>,
}

impl Sources {
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> FileId {
        let id = FileId(u32::try_from(self.files.len()).expect("at most 64 files are loaded"));
        let text: String = text.into();
        self.ends.push(
            text.bytes()
                .enumerate()
                .filter(|(_, byte)| *byte == b'\n')
                .map(|(at, _)| at)
                .collect(),
        );
        self.files.push(SourceFile {
            name: name.into(),
            text,
        });
        id
    }

    #[must_use]
    pub fn file(&self, id: FileId) -> &SourceFile {
        &self.files[id.0 as usize]
    }

    pub fn iter(&self) -> impl Iterator<Item = (FileId, &SourceFile)> {
        self.files
            .iter()
            .enumerate()
            .map(|(index, file)| (FileId(u32::try_from(index).unwrap_or(u32::MAX)), file))
    }

    /// The text under a span, in whole characters: a span may end within a letter of several bytes, where it is read as a punctuation mark.
    #[must_use]
    pub fn text(&self, span: Span) -> &str {
        &self.file(span.file).text[self.range(span)]
    }

    /// The whole characters of a span. A word with a foreign letter at its end has a span that ends inside it.
    #[must_use]
    pub fn range(&self, span: Span) -> std::ops::Range<usize> {
        let text = &self.file(span.file).text;
        let start = text.floor_char_boundary(span.start as usize);
        start..text.ceil_char_boundary((span.end as usize).max(start))
    }

    /// The byte range of some lines, counted from 0; lines that the file does not have are omitted.
    #[must_use]
    pub fn lines(&self, id: FileId, lines: std::ops::Range<usize>) -> std::ops::Range<usize> {
        let (ends, length) = (&self.ends[id.0 as usize], self.file(id).text.len());
        let start = |line: usize| {
            line.checked_sub(1)
                .map_or(0, |before| ends.get(before).map_or(length, |end| end + 1))
        };
        start(lines.start)..start(lines.end)
    }

    /// The position of the start of a span.
    #[must_use]
    pub fn position(&self, span: Span) -> Position {
        let text = &self.file(span.file).text;
        let at = text.floor_char_boundary(span.start as usize);
        let ends = &self.ends[span.file.0 as usize];
        let line = ends.partition_point(|end| *end < at);
        let line_start = line.checked_sub(1).map_or(0, |before| ends[before] + 1);
        Position {
            line: line + 1,
            column: text[line_start..at].chars().count() + 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn position_counts_characters_and_lines_from_one() {
        let mut sources = Sources::default();
        let file = sources.add("a.psd", "x\r\näb = 1\n");
        assert_eq!(
            sources.position(Span::new(file, 0, 1)),
            Position { line: 1, column: 1 }
        );
        assert_eq!(
            sources.position(Span::new(file, 5, 6)),
            Position { line: 2, column: 2 }
        );
        // In the middle of the ä, and after the end.
        let inside = Span::new(file, 4, 4);
        assert_eq!(
            (sources.position(inside), sources.text(inside)),
            (Position { line: 2, column: 1 }, "ä")
        );
        assert_eq!(sources.text(Span::new(file, 9, 99)), "1\n");
        assert_eq!(
            [0..1, 1..2, 0..9, 1..1, 7..9].map(|lines| sources.lines(file, lines)),
            [0..3, 3..11, 0..11, 3..3, 11..11]
        );
    }
}
