//! The characters that a plan may contain, and how an invalid one is shown. Pure functions of text.

use std::{fmt::Write as _, ops::Range};

/// Control characters are invalid everywhere; characters that hide or reorder text are invalid outside comments.
#[must_use]
pub fn is_bad(character: char, in_comment: bool) -> bool {
    let control = character.is_control() && !matches!(character, '\t' | '\n');
    let hidden = matches!(character,
        '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}'
        | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}');
    control || (hidden && !in_comment)
}

/// The runs of invalid characters in one line, each as it is to be shown.
#[must_use]
pub fn bad_runs(line: &str, in_comment: bool) -> Vec<(Range<usize>, String)> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (offset, character) in line
        .char_indices()
        .filter(|(_, character)| is_bad(*character, in_comment))
    {
        let end = offset + character.len_utf8();
        match runs.last_mut() {
            Some(run) if run.end == offset => run.end = end,
            _ => runs.push(offset..end),
        }
    }
    runs.into_iter()
        .map(|run| (run.clone(), shown(&line[run])))
        .collect()
}

/// Length in bytes of the run of equal characters at the start of `text` that are invalid outside strings
/// and comments.
#[must_use]
pub fn stray_run(text: &str) -> usize {
    let sort = |character: char| {
        (
            is_bad(character, false),
            character.is_alphabetic(),
            character.is_ascii(),
        )
    };
    let Some(first) = text.chars().next() else {
        return 0;
    };
    if first.is_ascii() && !first.is_ascii_control() {
        // `&&`
        return text.find(|next| next != first).unwrap_or(text.len()).min(2);
    }
    text.find(|next: char| sort(next) != sort(first))
        .unwrap_or(text.len())
}

/// Code points, at most eight: `\u{202e}`.
#[must_use]
pub fn shown(run: &str) -> String {
    let mut shown = String::new();
    for character in run.chars().take(8) {
        let _ = write!(shown, "\\u{{{:x}}}", u32::from(character));
    }
    if run.chars().count() > 8 {
        shown.push('…');
    }
    shown
}
