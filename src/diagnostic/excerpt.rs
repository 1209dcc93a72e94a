//! The source text as it may be shown: control and direction characters escaped, very long lines cut around the
//! places, several files side by side. In: a diagnostic and its sources. Out: text the drawing tool can read, and
//! the places in it. Must not change what line and column a place is said to have.

use std::ops::Range;

use miette::{LabeledSpan, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use super::Diagnostic;
use crate::inert::steers;
pub use crate::inert::{escape, one_line};
use crate::source::{FileId, Position, SourceFile, Sources};

/// Characters of a line that are shown.
const WIDEST_LINE: usize = 120;
/// Characters shown before the first place of a line that is cut.
const LEAD: usize = 50;

/// All files a diagnostic points into, one after the other; the first place's file is the first.
#[derive(Debug)]
pub struct Excerpt {
    files: Vec<ShownFile>,
    /// Where each place really is, by its offset in the shown text.
    positions: Vec<(usize, Position)>,
}

#[derive(Debug)]
struct ShownFile {
    name: String,
    text: String,
    /// Offset of the text among all files.
    start: usize,
}

impl Excerpt {
    /// The excerpt and the diagnostic's places in it. `folder` is put before every file's name.
    pub fn new(diagnostic: &Diagnostic, sources: &Sources, folder: &str) -> (Self, Vec<LabeledSpan>) {
        let mut excerpt = Self { files: Vec::new(), positions: Vec::new() };
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
            let here: Vec<(usize, &super::Label)> =
                diagnostic.labels.iter().enumerate().filter(|(_, label)| label.span.file == id).collect();
            let places: Vec<Range<usize>> = here.iter().map(|(_, label)| clip(file, label.span.range())).collect();
            let (text, shown) = show(&file.text, &places);
            for ((index, label), place) in here.into_iter().zip(shown) {
                let span = SourceSpan::new((start + place.start).into(), place.len());
                let text = Some(escape(&label.text)).filter(|text| !text.is_empty());
                excerpt.positions.push((span.offset(), sources.position(label.span)));
                labels.push(if index == 0 {
                    LabeledSpan::new_primary_with_span(text, span)
                } else {
                    LabeledSpan::new_with_span(text, span)
                });
            }
            let length = text.len();
            excerpt.files.push(ShownFile { name: escape(&format!("{folder}{}", file.name)), text, start });
            // One byte between files keeps the end of one apart from the start of the next.
            start += length + 1;
        }
        (excerpt, labels)
    }
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        // A span over two files is refused: the drawing tool then draws two snippets.
        let end = span.offset() + span.len();
        let file = self
            .files
            .iter()
            .find(|file| file.start <= span.offset() && end <= file.start + file.text.len())
            .ok_or(MietteError::OutOfBounds)?;
        let local = SourceSpan::new((span.offset() - file.start).into(), span.len());
        let contents = file.text.as_str().read_span(&local, lines_before, lines_after)?;
        // Without context the tool asks for a place's line and column: the true ones, whatever was cut or escaped.
        let place = self.positions.iter().find(|(offset, _)| *offset == span.offset() && lines_before == 0 && lines_after == 0);
        let (line, column) =
            place.map_or((contents.line(), contents.column()), |(_, position)| (position.line - 1, position.column - 1));
        let moved = SourceSpan::new((contents.span().offset() + file.start).into(), contents.span().len());
        Ok(Box::new(MietteSpanContents::new_named(
            file.name.clone(),
            contents.data(),
            moved,
            line,
            column,
            contents.line_count(),
        )))
    }
}

/// A place that spans lines is shown on its first one; a place past the text, at the end of its last line.
fn clip(file: &SourceFile, range: Range<usize>) -> Range<usize> {
    let text = &file.text;
    let start = text.floor_char_boundary(range.start.min(text.trim_end_matches(['\n', '\r']).len()));
    let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
    let line_end = start + text[start..line_end].trim_end_matches('\r').len();
    start..text.ceil_char_boundary(range.end.clamp(start, line_end))
}

/// The text to show, and where each of `places` lies in it.
fn show(text: &str, places: &[Range<usize>]) -> (String, Vec<Range<usize>>) {
    let mut shown = String::with_capacity(text.len());
    let mut moved = vec![0..0; places.len()];
    let mut line_start = 0;
    for line in text.split_inclusive('\n') {
        let body = line.trim_end_matches(['\n', '\r']);
        let inside = |place: &Range<usize>| line_start <= place.start && place.start <= line_start + body.len();
        let first = places.iter().filter(|place| inside(place)).map(|place| place.start - line_start).min().unwrap_or(0);
        let window = window(body, first);
        if window.start > 0 {
            shown.push('…');
        }
        for (offset, character) in body[window.clone()].char_indices() {
            let offset = line_start + window.start + offset;
            mark(places, &mut moved, offset, shown.len());
            push_shown(&mut shown, character);
        }
        // Whatever lies past the window ends at its end.
        for (place, moved) in places.iter().zip(&mut moved).filter(|(place, _)| inside(place)) {
            let end = line_start + window.end;
            if place.start >= end {
                moved.start = shown.len();
            }
            if place.end >= end {
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

/// Notes that the byte `original` is shown at `now`.
fn mark(places: &[Range<usize>], moved: &mut [Range<usize>], original: usize, now: usize) {
    for (place, moved) in places.iter().zip(moved) {
        if place.start == original {
            moved.start = now;
        }
        if place.end == original {
            moved.end = now;
        }
    }
}

/// The part of a line to show: all of it, or [`WIDEST_LINE`] characters from a little before `first`.
fn window(body: &str, first: usize) -> Range<usize> {
    if body.len() <= WIDEST_LINE {
        return 0..body.len();
    }
    let nth = |from: usize, count: usize| body[from..].char_indices().nth(count).map_or(body.len(), |(offset, _)| from + offset);
    let start = body[..first].char_indices().rev().nth(LEAD - 1).map_or(0, |(offset, _)| offset);
    start..nth(start, WIDEST_LINE)
}

fn push_shown(text: &mut String, character: char) {
    if steers(character) && character != '\t' {
        text.extend(character.escape_unicode());
    } else {
        text.push(character);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_follow_the_escapes() {
        let (shown, moved) = show("a\u{1b}b c\r\nd", &[2..3, 4..5, 7..8]);
        assert_eq!(shown, "a\\u{1b}b c\nd\n");
        assert_eq!(moved.iter().map(|range| &shown[range.clone()]).collect::<Vec<_>>(), ["b", "c", "d"]);
    }

    #[test]
    fn a_cut_line_keeps_its_place_and_says_so() {
        let text = format!("{}here{}", "ä".repeat(300), "z".repeat(300));
        let (shown, moved) = show(&text, std::slice::from_ref(&(600..604)));
        assert_eq!(&shown[moved[0].clone()], "here");
        assert_eq!(shown.chars().count(), WIDEST_LINE + 3, "two marks and the newline");
    }
}
