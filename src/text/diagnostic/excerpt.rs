//! The source text as it is shown: control and direction characters escaped, very long lines cut around the marked
//! spans, several files one after the other. In: a diagnostic and its sources. Out: text for the drawing library, and
//! the spans in it. Every span keeps its true line and column.

use std::ops::Range;

use crate::sanitize::is_control_like;
use miette::{LabeledSpan, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use super::{Diagnostic, Label};
pub use crate::sanitize::{escape, one_line};
use crate::source::{FileId, Position, SourceFile, Sources, Span};

/// Characters of a line that are shown, at most.
const WIDEST_LINE: usize = 120;
/// Characters shown before the first span of a line that is cut.
const LEAD: usize = 50;
/// Lines kept before and after a span: the drawing library shows one, and joins the lines of two spans that are near.
const AROUND: usize = 2;

/// The lines around the spans of a diagnostic, one segment after the other; the file of the first span is the first.
#[derive(Debug)]
pub struct Excerpt {
    segments: Vec<Segment>,
    /// The true position of each span, by its offset in the shown text.
    positions: Vec<(usize, Position)>,
}

/// Some lines of one file.
#[derive(Debug)]
struct Segment {
    /// Line numbers in the file.
    name: String,
    text: String,
    /// Offset of the text among all segments.
    start: usize,
    /// Lines of the file before this segment.
    before: usize,
}

impl Excerpt {
    /// The excerpt and the spans of the diagnostic in it. `folder` is put before the name of every file.
    pub fn new(
        diagnostic: &Diagnostic,
        sources: &Sources,
        folder: &str,
    ) -> (Self, Vec<LabeledSpan>) {
        let mut excerpt = Self {
            segments: Vec::new(),
            positions: Vec::new(),
        };
        let mut labels = Vec::new();
        let mut seen: Vec<FileId> = Vec::new();
        let mut start = 0;
        for first in &diagnostic.labels {
            let id = first.span.file;
            if seen.contains(&id) {
                continue;
            }
            seen.push(id);
            let file = sources.file(id);
            let here = diagnostic
                .labels
                .iter()
                .enumerate()
                .filter(|(_, label)| label.span.file == id);
            let mut marked: Vec<Marked<'_>> = here
                .map(|(index, label)| Marked::new(label, index == 0, sources))
                .collect();
            marked.sort_by_key(|mark| mark.line);
            for near in marked.chunk_by(|one, next| next.line - one.line <= 2 * AROUND) {
                let before = near[0].line.saturating_sub(AROUND);
                let lines = sources.lines(id, before..near[near.len() - 1].line + AROUND + 1);
                let inside =
                    |range: &Range<usize>| range.start - lines.start..range.end - lines.start;
                let ranges: Vec<Range<usize>> =
                    near.iter().map(|mark| inside(&mark.range)).collect();
                let (text, shown) = show(&file.text[lines.clone()], &ranges);
                for (mark, shown) in near.iter().zip(shown) {
                    let span = SourceSpan::new((start + shown.start).into(), shown.len());
                    let text = Some(escape(&mark.label.text)).filter(|text| !text.is_empty());
                    excerpt
                        .positions
                        .push((span.offset(), sources.position(mark.label.span)));
                    labels.push(if mark.primary {
                        LabeledSpan::new_primary_with_span(text, span)
                    } else {
                        LabeledSpan::new_with_span(text, span)
                    });
                }
                let length = text.len();
                excerpt.segments.push(Segment {
                    name: escape(&format!("{folder}{}", file.name)),
                    text,
                    start,
                    before,
                });
                // One byte between segments separates the end of one from the start of the next.
                start += length + 1;
            }
        }
        (excerpt, labels)
    }
}

/// A label, and its span in the shown text.
struct Marked<'a> {
    label: &'a Label,
    primary: bool,
    /// Bytes of the file.
    range: Range<usize>,
    /// From 0.
    line: usize,
}

impl<'a> Marked<'a> {
    fn new(label: &'a Label, primary: bool, sources: &Sources) -> Self {
        let range = clip(sources.file(label.span.file), label.span.range());
        let line = sources
            .position(Span::new(label.span.file, range.start, range.start))
            .line
            - 1;
        Self {
            label,
            primary,
            range,
            line,
        }
    }
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        // A span over two segments is rejected: the drawing library then draws two snippets.
        let end = span.offset() + span.len();
        let segment = self
            .segments
            .iter()
            .find(|segment| {
                segment.start <= span.offset() && end <= segment.start + segment.text.len()
            })
            .ok_or(MietteError::OutOfBounds)?;
        let local = SourceSpan::new((span.offset() - segment.start).into(), span.len());
        let contents = segment
            .text
            .as_str()
            .read_span(&local, lines_before, lines_after)?;
        // Without context the library asks for line and column of a span: the true ones, whatever was cut or escaped.
        let mark = self
            .positions
            .iter()
            .find(|(offset, _)| *offset == span.offset() && lines_before == 0 && lines_after == 0);
        let (line, column) = mark.map_or(
            (segment.before + contents.line(), contents.column()),
            |(_, at)| (at.line - 1, at.column - 1),
        );
        let moved = SourceSpan::new(
            (contents.span().offset() + segment.start).into(),
            contents.span().len(),
        );
        Ok(Box::new(MietteSpanContents::new_named(
            segment.name.clone(),
            contents.data(),
            moved,
            line,
            column,
            contents.line_count(),
        )))
    }
}

/// A span of several lines is shown on its first line; a span after the end of the text, at the end of its last line.
fn clip(file: &SourceFile, range: Range<usize>) -> Range<usize> {
    let text = &file.text;
    let start =
        text.floor_char_boundary(range.start.min(text.trim_end_matches(['\n', '\r']).len()));
    let line_end = text[start..]
        .find('\n')
        .map_or(text.len(), |newline| start + newline);
    let line_end = start + text[start..line_end].trim_end_matches('\r').len();
    start..text.ceil_char_boundary(range.end.clamp(start, line_end))
}

/// The text to show, and each of the `marked` ranges in it.
fn show(text: &str, marked: &[Range<usize>]) -> (String, Vec<Range<usize>>) {
    let mut shown = String::with_capacity(text.len());
    let mut moved = vec![0..0; marked.len()];
    let mut line_start = 0;
    for line in text.split_inclusive('\n') {
        let body = line.trim_end_matches(['\n', '\r']);
        let inside =
            |mark: &Range<usize>| line_start <= mark.start && mark.start <= line_start + body.len();
        let first = marked
            .iter()
            .filter(|mark| inside(mark))
            .map(|mark| mark.start - line_start)
            .min()
            .unwrap_or(0);
        let window = window(body, first);
        if window.start > 0 {
            shown.push('…');
        }
        for (offset, character) in body[window.clone()].char_indices() {
            let offset = line_start + window.start + offset;
            move_bounds(marked, &mut moved, offset, shown.len());
            push_shown(&mut shown, character);
        }
        // A span after the window ends at its end.
        for (mark, moved) in marked
            .iter()
            .zip(&mut moved)
            .filter(|(mark, _)| inside(mark))
        {
            let end = line_start + window.end;
            if mark.start >= end {
                moved.start = shown.len();
            }
            if mark.end >= end {
                moved.end = shown.len();
            }
        }
        if window.end < body.len() {
            shown.push('…');
        }
        shown.push('\n');
        line_start += line.len();
    }
    (shown, moved)
}

/// Records that the byte `original` is shown at `now`.
fn move_bounds(marked: &[Range<usize>], moved: &mut [Range<usize>], original: usize, now: usize) {
    for (mark, moved) in marked.iter().zip(moved) {
        if mark.start == original {
            moved.start = now;
        }
        if mark.end == original {
            moved.end = now;
        }
    }
}

/// The part of a line to show: all of it, or [`WIDEST_LINE`] characters from a little before `first`.
fn window(body: &str, first: usize) -> Range<usize> {
    if body.len() <= WIDEST_LINE {
        return 0..body.len();
    }
    let nth = |from: usize, count: usize| {
        body[from..]
            .char_indices()
            .nth(count)
            .map_or(body.len(), |(offset, _)| from + offset)
    };
    let start = body[..first]
        .char_indices()
        .rev()
        .nth(LEAD - 1)
        .map_or(0, |(offset, _)| offset);
    start..nth(start, WIDEST_LINE)
}

fn push_shown(text: &mut String, character: char) {
    if is_control_like(character) && character != '\t' {
        text.extend(character.escape_unicode());
    } else {
        text.push(character);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Code;

    /// An error in the middle of a large file and another at its end: no excerpt joins them.
    #[test]
    fn an_excerpt_of_a_large_file_has_only_the_lines_around_its_spans() {
        let mut sources = Sources::default();
        let text = "let a = 1 mm\n".repeat(80_000);
        let file = sources.add("large.psd", text.as_str());
        let at = |line: usize| Span::new(file, 13 * line + 4, 13 * line + 5);
        let mut diagnostic = Diagnostic::new(Code::new("E101"), "twice");
        diagnostic.labels = [70_000, 3, 70_002, 79_999]
            .map(|line| Label {
                span: at(line),
                text: line.to_string(),
            })
            .to_vec();
        let (excerpt, labels) = Excerpt::new(&diagnostic, &sources, "");
        let shown: Vec<(usize, usize)> = excerpt
            .segments
            .iter()
            .map(|segment| (segment.before, segment.text.lines().count()))
            .collect();
        assert_eq!(shown, [(1, 5), (69_998, 7), (79_997, 3)]);
        for label in labels {
            let line: usize = label.label().unwrap().parse().unwrap();
            let contents = excerpt.read_span(label.inner(), 1, 1).unwrap();
            assert_eq!(contents.line(), line - 1, "one line before it is shown too");
            assert_eq!(label.primary(), line == 70_000);
        }
    }

    #[test]
    fn spans_follow_the_escapes() {
        let (shown, moved) = show("a\u{1b}b c\r\nd", &[2..3, 4..5, 7..8]);
        assert_eq!(shown, "a\\u{1b}b c\nd\n");
        assert_eq!(
            moved
                .iter()
                .map(|range| &shown[range.clone()])
                .collect::<Vec<_>>(),
            ["b", "c", "d"]
        );
    }

    #[test]
    fn a_truncated_line_keeps_its_span_and_is_marked() {
        let text = format!("{}here{}", "ä".repeat(300), "z".repeat(300));
        let (shown, moved) = show(&text, std::slice::from_ref(&(600..604)));
        assert_eq!(&shown[moved[0].clone()], "here");
        assert_eq!(
            shown.chars().count(),
            WIDEST_LINE + 3,
            "two marks and the newline"
        );
    }
}
