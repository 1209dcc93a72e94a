//! The plan in a Markdown document: its fenced code blocks marked `psd`. In: the text of the document. Out: these blocks, the errors of
//! their fences, and the text with everything else blank. It does not know the language of a plan.

use std::ops::Range;

/// The word after `psd` that marks an example: a block that is not part of the plan.
pub const FRAGMENT: &str = "fragment";

/// Whether a file of this name is a Markdown document.
#[must_use]
pub fn is_document(name: &str) -> bool {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    ["md", "markdown"]
        .iter()
        .any(|known| ending.eq_ignore_ascii_case(known))
}

/// The `psd` blocks of a document, in order, and the errors of its fences.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Document {
    pub blocks: Vec<PlanBlock>,
    pub errors: Vec<FenceError>,
}

/// One `psd` block. All ranges are bytes of the document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanBlock {
    /// The spaces before the opening fence, as in a list.
    pub indent: Range<usize>,
    /// The lines between the two fences.
    pub body: Range<usize>,
}

/// An error of a fence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FenceError {
    /// The block that begins at `opening` has no end, or none before the `psd` block that begins at `next`.
    Unclosed {
        opening: Range<usize>,
        next: Option<Range<usize>>,
    },
    /// Words after `psd` that psd does not know, so that the block would not be read.
    UnknownWord { words: Range<usize> },
}

/// A code block that is open.
struct Open {
    character: char,
    length: usize,
    opening: Range<usize>,
    /// The block if it belongs to the plan; its end is not known yet.
    plan: Option<PlanBlock>,
}

/// A line that begins or ends a code block.
struct Fence<'a> {
    character: char,
    length: usize,
    indent: usize,
    info: &'a str,
}

impl Document {
    /// Reads the fences of a document.
    #[must_use]
    pub fn read(text: &str) -> Self {
        let mut document = Self::default();
        let mut open: Option<Open> = None;
        let mut in_comment = false;
        let mut start = 0;
        for whole in text.split_inclusive('\n') {
            let (begin, end) = (start, start + whole.len());
            start = end;
            let line = whole.trim_end();
            if open.is_none() && (in_comment || line.trim_start().starts_with("<!--")) {
                in_comment = !line.contains("-->");
                continue;
            }
            let Some(fence) = Fence::of(line) else {
                continue;
            };
            let here = begin + fence.indent..begin + line.len();
            if let Some(block) = open.take_if(|block| fence.closes(block)) {
                document.close(block, begin);
                continue;
            }
            if let Some(block) = &open {
                if fence.character != block.character
                    || fence.length < block.length
                    || !fence.is_psd()
                {
                    continue;
                }
                document.errors.push(FenceError::Unclosed {
                    opening: block.opening.clone(),
                    next: Some(here.clone()),
                });
            }
            if let Some(block) = open.take() {
                document.close(block, begin);
            }
            let is_plan = fence.is_psd() && document.is_read(&fence, &here);
            open = Some(Open {
                character: fence.character,
                length: fence.length,
                opening: here,
                plan: is_plan.then(|| PlanBlock {
                    indent: begin..begin + fence.indent,
                    body: end..end,
                }),
            });
        }
        if let Some(block) = open.filter(|block| block.plan.is_some()) {
            document.errors.push(FenceError::Unclosed {
                opening: block.opening.clone(),
                next: None,
            });
            document.close(block, text.len());
        }
        document
    }

    /// Whether a `psd` block is part of the plan. An unknown word is an error.
    fn is_read(&mut self, fence: &Fence<'_>, here: &Range<usize>) -> bool {
        let words = fence.info.split_once(char::is_whitespace);
        let words = words.map_or("", |(_, words)| words.trim());
        if !words.is_empty() && words != FRAGMENT {
            let words = here.end - words.len()..here.end;
            self.errors.push(FenceError::UnknownWord { words });
        }
        words.is_empty()
    }

    fn close(&mut self, block: Open, end: usize) {
        self.blocks.extend(block.plan.map(|block| PlanBlock {
            body: block.body.start..end,
            ..block
        }));
    }

    /// The text with spaces for everything outside the blocks. Every line and byte keeps its position.
    #[must_use]
    pub fn blanked(&self, text: &str) -> String {
        let mut blank = String::with_capacity(text.len());
        let mut at = 0;
        for block in &self.blocks {
            push_blank(&mut blank, &text[at..block.body.start]);
            blank.push_str(&text[block.body.clone()]);
            at = block.body.end;
        }
        push_blank(&mut blank, &text[at..]);
        blank
    }
}

/// Appends as many spaces as the text has bytes, with the same line ends.
fn push_blank(blank: &mut String, text: &str) {
    for line in text.split_inclusive('\n') {
        let body = line.trim_end_matches(['\r', '\n']);
        blank.extend(std::iter::repeat_n(' ', body.len()));
        // A lone carriage return is not a line end.
        let end = &line[body.len()..];
        blank.push_str(if end.contains('\n') { end } else { "" });
        let lone = if end.contains('\n') { 0 } else { end.len() };
        blank.extend(std::iter::repeat_n(' ', lone));
    }
}

impl<'a> Fence<'a> {
    /// The fence on a line, if the line is one (`CommonMark` 0.31, 4.5). A fence in a list may have any indentation.
    fn of(line: &'a str) -> Option<Self> {
        let trimmed = line.trim_start();
        let character = trimmed.chars().next().filter(|c| matches!(c, '`' | '~'))?;
        let rest = trimmed.trim_start_matches(character);
        let length = trimmed.len() - rest.len();
        let info = rest.trim();
        (length >= 3 && !(character == '`' && info.contains('`'))).then_some(Self {
            character,
            length,
            indent: line.len() - trimmed.len(),
            info,
        })
    }

    fn closes(&self, open: &Open) -> bool {
        self.info.is_empty() && self.character == open.character && self.length >= open.length
    }

    fn is_psd(&self) -> bool {
        let first = self.info.split_whitespace().next().unwrap_or_default();
        first.eq_ignore_ascii_case("psd")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bodies(text: &str) -> Vec<&str> {
        let blocks = Document::read(text).blocks;
        blocks.into_iter().map(|block| &text[block.body]).collect()
    }

    #[test]
    fn the_psd_blocks_are_the_plan() {
        let text = "# Title\n\n```psd\nlet a = 1\n```\n\n```sh\npsd run x\n```\n~~~ PSD\nlet b = 2\n~~~\n```psd fragment\nx\n```\n";
        assert_eq!(bodies(text), ["let a = 1\n", "let b = 2\n"]);
        assert_eq!(Document::read(text).errors, []);
    }

    /// A renderer does not show a commented block; in a longer fence it shows the fence itself.
    #[test]
    fn a_block_that_a_renderer_does_not_show_as_one_is_not_read() {
        for text in [
            "<!--\n```psd\nlet a = 1\n```\n-->\n",
            "````md\n```psd\nlet a = 1\n```\n````\n",
            "> ```psd\n> let a = 1\n> ```\n",
            "`````\n~~~psd\n`````\n",
            "text ```psd\n",
            "``psd\nlet a = 1\n``\n",
        ] {
            assert_eq!(bodies(text), [] as [&str; 0], "{text}");
            assert_eq!(Document::read(text).errors, [], "{text}");
        }
        assert_eq!(
            bodies("<!-- note -->\n```psd\nlet a = 1\n```\n"),
            ["let a = 1\n"]
        );
    }

    #[test]
    fn a_block_in_a_list_keeps_its_indentation() {
        let text = "1. Measure:\n\n   ```psd\n   let a = 1\n   ```\n";
        let block = &Document::read(text).blocks[0];
        assert_eq!(&text[block.indent.clone()], "   ");
        assert_eq!(&text[block.body.clone()], "   let a = 1\n");
    }

    #[test]
    fn a_fence_without_an_end_is_an_error_at_its_line() {
        let text = "a\n```psd\nlet a = 1\n";
        let found = Document::read(text);
        assert_eq!(
            found.errors,
            [FenceError::Unclosed {
                opening: 2..8,
                next: None
            }]
        );
        // The plan after a block of another kind that was not closed would be lost.
        let text = "```text\na\n```psd\nlet a = 1\n```\n";
        let found = Document::read(text);
        assert_eq!(
            found.errors,
            [FenceError::Unclosed {
                opening: 0..7,
                next: Some(10..16)
            }]
        );
        assert_eq!(bodies(text), ["let a = 1\n"]);
    }

    #[test]
    fn an_unknown_word_after_psd_is_an_error() {
        let text = "```psd  ignore me \nlet a = 1\n```\n";
        let found = Document::read(text);
        assert_eq!(found.blocks, []);
        let [FenceError::UnknownWord { words }] = found.errors.as_slice() else {
            panic!("{found:?}");
        };
        assert_eq!(&text[words.clone()], "ignore me");
    }

    #[test]
    fn what_is_outside_is_blank_and_every_byte_keeps_its_position() {
        let text = "# Träger ```\r\n\r\n```psd\r\nlet ä = 1\r\n```\r\nEnd\rend";
        let blank = Document::read(text).blanked(text);
        assert_eq!(blank.len(), text.len());
        let ends = |text: &str| {
            text.match_indices("\r\n")
                .map(|(at, _)| at)
                .collect::<Vec<_>>()
        };
        assert_eq!(ends(&blank), ends(text));
        assert_eq!(blank.trim(), "let ä = 1");
        assert_eq!(blank.find("let"), text.find("let"));
        assert!(!blank.trim_end().ends_with("end") && !blank.contains("End"));
    }

    #[test]
    fn the_ending_names_a_document() {
        assert!(
            ["a.md", "A.MD", "b.markdown"]
                .iter()
                .all(|name| is_document(name))
        );
        assert!(
            !["a.psd", "md", "a.md.psd"]
                .iter()
                .any(|name| is_document(name))
        );
    }
}
