//! Makes texts from outside (labels, notes, replies of a rig) harmless, with one function for each sink. In: any text. Out: a text that
//! the sink shows and never interprets. It contains no terminal control, no change of reading direction, no invisible character, no
//! formula, and no file name that a file system treats as a device.

use std::fmt::Write as _;

/// Whether a character has an effect beyond its glyph: control characters, direction marks, invisible characters,
/// tags, and code points that are not characters.
#[must_use]
pub fn is_control_like(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{ad}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
                | '\u{2060}'..='\u{206f}' | '\u{3164}' | '\u{feff}' | '\u{ffa0}' | '\u{fdd0}'..='\u{fdef}'
                | '\u{e0000}'..='\u{e007f}'
        )
        || u32::from(c) & 0xfffe == 0xfffe
}

/// Control-like characters become their escapes, `\u{1b}`. Newlines stay.
#[must_use]
pub fn escape(text: &str) -> String {
    escaped(text, |c| c == '\n')
}

/// [`escape`] for a text that must stay on its line: newlines become `\u{a}`.
#[must_use]
pub fn one_line(text: &str) -> String {
    escaped(text, |_| false)
}

/// A text that may contain the program's own colours: only `ESC [ digits m`, newlines and tabs pass. The last filter before a terminal.
#[must_use]
pub fn terminal(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let length = colour(rest).unwrap_or(c.len_utf8());
        let (own, after) = rest.split_at(length);
        if length > 1 && c == '\u{1b}' {
            shown.push_str(own);
        } else {
            push(&mut shown, c, |c| matches!(c, '\n' | '\t'));
        }
        rest = after;
    }
    shown
}

/// The length of the colour sequence at the start of a text.
fn colour(text: &str) -> Option<usize> {
    let digits = text.strip_prefix("\u{1b}[")?;
    let end = digits.find(|c: char| !c.is_ascii_digit() && c != ';')?;
    digits[end..].starts_with('m').then_some(2 + end + 1)
}

/// Control-like characters become the replacement character: for pages, where an escape would be read as text.
#[must_use]
pub fn printed(text: &str) -> String {
    text.chars()
        .map(|c| {
            if is_control_like(c) {
                char::REPLACEMENT_CHARACTER
            } else {
                c
            }
        })
        .collect()
}

/// A page of markup whose texts are escaped already: control-like characters are replaced, whatever their origin.
#[must_use]
pub fn page(markup: &str) -> String {
    markup
        .chars()
        .map(|c| {
            if is_control_like(c) && c != '\n' {
                char::REPLACEMENT_CHARACTER
            } else {
                c
            }
        })
        .collect()
}

/// A cell of text that no spreadsheet treats as a formula: a leading `'` is put before text that begins like a formula.
#[must_use]
pub fn cell(text: &str) -> String {
    let shown = one_line(text);
    let begins = [
        '=', '+', '-', '@', '\u{ff1d}', '\u{ff0b}', '\u{ff0d}', '\u{ff20}',
    ];
    let first = text.trim_start().chars().next();
    if first.is_some_and(|first| begins.contains(&first)) {
        format!("'{shown}")
    } else {
        shown
    }
}

/// A JSON document whose texts contain control-like characters only as `\u` escapes: the same values, and safe to print.
#[must_use]
pub fn json(document: &str) -> String {
    let mut safe = String::with_capacity(document.len());
    for c in document.chars() {
        if is_control_like(c) && c != '\n' {
            for unit in c.encode_utf16(&mut [0; 2]) {
                let _ = write!(safe, "\\u{unit:04x}");
            }
        } else {
            safe.push(c);
        }
    }
    safe
}

/// A file of psd in JSON: indented, made safe as by [`json`], with a newline at its end. Floats are the shortest that read back the same.
#[must_use]
pub fn json_file(value: &impl serde::Serialize) -> String {
    let text = serde_json::to_string_pretty(value).expect("plain numbers and texts");
    json(&text) + "\n"
}

/// Most characters of a part of a path: with an extension and a number every file system accepts it.
const PART_CHARS: usize = 120;
/// Most bytes of a part of a path.
const PART_BYTES: usize = 200;

/// One part of a path that is a plain name on every system: no separator, no `..`, no device name of Windows, no space or dot at
/// its end. A name that is plain already is unchanged.
#[must_use]
pub fn file_part(name: &str) -> String {
    let is_plain = |c: char| {
        !is_control_like(c) && !matches!(c, '/' | '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|')
    };
    let mut part: String = name
        .chars()
        .take(PART_CHARS)
        .map(|c| if is_plain(c) { c } else { '_' })
        .collect();
    part.truncate(part.floor_char_boundary(PART_BYTES));
    let ends = part.trim_end_matches(['.', ' ']).len();
    part.truncate(ends);
    let begins = part.len() - part.trim_start_matches(' ').len();
    part.drain(..begins);
    if part.is_empty() {
        return "_".to_owned();
    }
    let stem = part
        .split('.')
        .next()
        .unwrap_or_default()
        .trim_end_matches(' ');
    if is_device(stem) {
        format!("{stem}-{}", &part[stem.len()..])
    } else {
        part
    }
}

/// Names that Windows treats as devices, whatever follows the first dot.
fn is_device(stem: &str) -> bool {
    let stem = stem.to_ascii_uppercase();
    let port = stem
        .strip_prefix("COM")
        .or_else(|| stem.strip_prefix("LPT"));
    matches!(
        stem.as_str(),
        "CON" | "PRN" | "AUX" | "NUL" | "CONIN$" | "CONOUT$"
    ) || port.is_some_and(|number| {
        matches!(
            number,
            "0" | "1" | "2" | "3" | "4" | "5" | "6" | "7" | "8" | "9" | "¹" | "²" | "³"
        )
    })
}

fn escaped(text: &str, stays: impl Fn(char) -> bool) -> String {
    let mut shown = String::with_capacity(text.len());
    text.chars().for_each(|c| push(&mut shown, c, &stays));
    shown
}

fn push(text: &mut String, c: char, stays: impl Fn(char) -> bool) {
    if is_control_like(c) && !stays(c) {
        text.extend(c.escape_unicode());
    } else {
        text.push(c);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_is_shown_and_what_is_written_stays() {
        assert_eq!(
            escape("a\u{1b}]0;x\u{7}\n\u{202e}b"),
            "a\\u{1b}]0;x\\u{7}\n\\u{202e}b"
        );
        assert_eq!(one_line("a\n\tb"), "a\\u{a}\\u{9}b");
        assert_eq!(
            printed("a\u{9b}31m\u{ffff}\u{e0041}b"),
            "a\u{fffd}31m\u{fffd}\u{fffd}b"
        );
        let written = "Prüfung Ẋ ≤ 8.5\u{a0}mm, 質量, «x», 👷";
        assert_eq!(
            (escape(written), printed(written), json(written)),
            (written.into(), written.into(), written.into())
        );
    }

    #[test]
    fn only_colours_pass_the_last_gate() {
        let ours = "\u{1b}[1;31merror:\u{1b}[0m a\tb\n";
        assert_eq!(terminal(ours), ours);
        for (hostile, shown) in [
            ("\u{1b}[2J", "\\u{1b}[2J"),
            ("\u{1b}]8;;http://x\u{7}y", "\\u{1b}]8;;http://x\\u{7}y"),
            ("\u{1b}[1;31", "\\u{1b}[1;31"),
            ("\u{1b}[6n\u{1b}c\r", "\\u{1b}[6n\\u{1b}c\\u{d}"),
            ("\u{9b}31m\u{0}", "\\u{9b}31m\\u{0}"),
        ] {
            assert_eq!(terminal(hostile), shown);
        }
    }

    #[test]
    fn a_cell_that_begins_like_a_formula_becomes_text() {
        for hostile in [
            "=1+1",
            "+1",
            "-1",
            "@sum",
            " =1",
            "\t=x",
            "\r\n+x",
            "\u{ff1d}1",
        ] {
            assert!(cell(hostile).starts_with('\''), "{hostile:?}");
        }
        assert_eq!(
            (
                cell("contact").as_str(),
                cell("a=b").as_str(),
                cell("\tx").as_str()
            ),
            ("contact", "a=b", "\\u{9}x")
        );
    }

    #[test]
    fn json_keeps_its_values() {
        let value = serde_json::json!({ "a": "\u{202e}\u{7f}\u{e0041}\u{85}\u{0}\"\\ é" });
        let safe = json(&serde_json::to_string_pretty(&value).unwrap());
        assert!(
            !safe.chars().any(|c| is_control_like(c) && c != '\n'),
            "{safe}"
        );
        assert_eq!(
            serde_json::from_str::<serde_json::Value>(&safe).unwrap(),
            value
        );
    }

    #[test]
    fn a_part_of_a_path_is_a_plain_name_on_every_system() {
        for (name, part) in [
            ("frame.psd", "frame.psd"),
            ("CON", "CON-"),
            ("con.psd", "con-.psd"),
            ("nul .txt", "nul- .txt"),
            ("com¹", "com¹-"),
            ("console", "console"),
            ("a\nb:c", "a_b_c"),
            (" a. .", "a"),
            ("..", "_"),
            ("\u{202e}dsp.exe", "_dsp.exe"),
            ("", "_"),
        ] {
            assert_eq!(file_part(name), part, "{name:?}");
            assert_eq!(file_part(part), part, "it stays so");
        }
        assert!(file_part(&"é".repeat(1000)).len() <= PART_BYTES);
    }
}
