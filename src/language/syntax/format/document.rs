//! The formatter of a Markdown document. In: a document without syntax errors. Out: the same document with its `psd` blocks in the
//! canonical layout; all other text is the same, byte for byte.

use super::format;
use crate::syntax::parse;
use psd_text::markdown::Document;
use psd_text::source::Sources;

/// The canonical form of a Markdown document. Formatting it again changes nothing.
#[must_use]
pub fn format_document(text: &str) -> String {
    let mut formatted = String::with_capacity(text.len());
    let mut at = 0;
    for block in Document::read(text).blocks {
        formatted.push_str(&text[at..block.body.start]);
        let indent = &text[block.indent.clone()];
        push_block(&mut formatted, &text[block.body.clone()], indent);
        at = block.body.end;
    }
    formatted.push_str(&text[at..]);
    formatted
}

/// Appends the plan text of one block, with the indentation of its fence and the line ends that it had.
fn push_block(formatted: &mut String, body: &str, indent: &str) {
    let end = if body.contains("\r\n") { "\r\n" } else { "\n" };
    let mut sources = Sources::default();
    let file = sources.add("block.psd", body);
    let (ast, _) = parse(&sources, file);
    for line in format(&ast, body).lines() {
        let indent = if line.is_empty() { "" } else { indent };
        formatted.extend([indent, line, end]);
    }
}

#[cfg(test)]
mod tests {
    use super::format_document;

    #[test]
    fn only_the_plan_is_formatted() {
        let document = "#  Title\n\n* a   b\n\n```psd\nlet a=1\n\n\n\nlet   b = 2\n```\n  c  \n```sh\nlet c=1\n```\n";
        let wanted = "#  Title\n\n* a   b\n\n```psd\nlet a = 1\n\nlet b = 2\n```\n  c  \n```sh\nlet c=1\n```\n";
        assert_eq!(format_document(document), wanted);
        assert_eq!(format_document(wanted), wanted);
    }

    #[test]
    fn a_block_keeps_its_indentation_and_its_line_ends() {
        let document =
            "1. Item\r\n   ```psd\r\nmove out { to = 1 mm\r\n speed=1 mm/s }\r\n   ```\r\n";
        let formatted = format_document(document);
        assert!(
            formatted.contains("   ```psd\r\n   move out {"),
            "{formatted}"
        );
        assert_eq!(
            formatted.matches('\n').count(),
            formatted.matches("\r\n").count()
        );
        assert_eq!(format_document(&formatted), formatted);
    }
}
