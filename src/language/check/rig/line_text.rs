//! A string that is sent over a line: ASCII, printable, not empty.

use crate::check::checker::Checker;
use crate::check::expressions::choice::Chosen;
use crate::check::violations::BadLineText;

/// A string that is sent on a line of a protocol: `Some(None)` if it is omitted.
pub fn line_text<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    name: &str,
) -> Option<Option<String>> {
    let Some((text, span)) = checker.text_argument(chosen, name)? else {
        return Some(None);
    };
    if text.trim().is_empty() || text.chars().any(|c| c.is_control() || !c.is_ascii()) {
        return checker.fail(BadLineText { field: name, span });
    }
    Some(Some(text))
}
