//! Every fault of the text, as a diagnostic: the code, the sentence, the place and the way out. Found elsewhere, worded
//! here.

use super::numbers;
use crate::{
    diagnostic::{Code, Diagnostic},
    source::Span,
};

/// `found` and `expected` are in human words, marks included.
pub fn unexpected(span: Span, found: &str, expected: &str) -> Diagnostic {
    Diagnostic::new(Code::Syntax, format!("found {found}, expected {expected}"))
        .at(span, format!("expected {expected}"))
        .help(match found {
        "`}`" => "each `}` closes one `{`: take this one away, or open the block it should close".to_owned(),
        "`use`" | "`param`" | "`let`" | "`require`" | "`and`" | "`within`" | "`of`" | "`step`" | "`between`" => {
            format!("{found} is a word of the language: names are other words")
        }
        _ if expected == "a field" => "write `key = value`".to_owned(),
        _ if expected == "a value" => "a value is a number with its unit, a text, a name, a list or a range".to_owned(),
        "`<`" | "`<=`" | "`>`" | "`>=`" | "`==`" | "`!=`" if expected.contains("the end of the line") => {
            "one comparison holds two values; join two with `and`: `1 mm < x and x < 2 mm`".to_owned()
        }
        _ if expected == "an item" => {
            "an item is a block, such as `striker hammer { … }`, or a line that starts with `use`, `param`, `let` or `require`"
                .to_owned()
        }
        _ if expected.contains("the end of the line") => "one field or item stands on one line".to_owned(),
        _ => format!("write {expected} here"),
    })
}

pub fn field_outside(span: Span, key: &str) -> Diagnostic {
    Diagnostic::new(Code::Syntax, format!("found the field `{key}` outside a block, expected an item"))
        .at(span, "belongs to no block")
        .help(format!("move it into its block, or name a value with `let {key} = …`"))
}

/// A line of words that opens no block.
pub fn stray_words(span: Span, words: &str) -> Diagnostic {
    let mut short: String = words.chars().take(30).collect();
    if short.len() < words.len() {
        short.push('…');
    }
    Diagnostic::new(Code::Syntax, format!("`{short}` stands alone on its line and opens no block"))
        .at(span, "neither a block nor an item")
        .help("a block opens with `{` on this same line, as in `striker hammer { … }`; a remark stands behind `#`")
}

pub fn misplaced_block(span: Span) -> Diagnostic {
    Diagnostic::new(Code::Syntax, "found a block or item inside a block, expected `key = value` or `}`")
        .at(span, "expected a field")
        .help("blocks stand beside each other: close the block above first, or move this one out of it")
}

pub fn positional_after_named(span: Span) -> Diagnostic {
    Diagnostic::new(Code::Syntax, "found a value without a name after a named one, expected `name: value`")
        .at(span, "expected a name")
        .help("values without a name come first: `elastic(300 kN/m)` or `elastic(stiffness: 300 kN/m)`")
}

pub fn unclosed(span: Span, open: &str, close: &str) -> Diagnostic {
    Diagnostic::new(Code::UnclosedBracket, format!("this `{open}` is never closed"))
        .at(span, "opened here")
        .help(format!("write the `{close}` that belongs to it"))
}

pub fn bad_number(span: Span, written: &str, fault: numbers::Fault) -> Diagnostic {
    let mut short: String = written.chars().take(20).collect();
    if short.len() < written.len() {
        short.push('…');
    }
    let help = fault.write.map_or_else(|| "write a number such as `0.5` or `1.5e6`".to_owned(), |text| format!("write `{text}`"));
    Diagnostic::new(Code::BadNumber, format!("`{short}` is not a number psd reads")).at(span, fault.why).help(help)
}

pub fn unit_without_blank(span: Span, mended: &str) -> Diagnostic {
    Diagnostic::new(Code::UnitWithoutBlank, "an operator is glued to a unit")
        .at(span, "read as part of the unit")
        .help(format!("put blanks around the operator: `{mended}`"))
}

pub fn nested_too_deep(span: Span) -> Diagnostic {
    Diagnostic::new(Code::NestedTooDeep, "brackets are nested more than 64 deep")
        .at(span, "the 65th")
        .help("name a part of it with `let`")
}

pub fn bad_character(span: Span, shown: &str) -> Diagnostic {
    let help = match shown {
        "\\u{feff}" => "save the file as UTF-8 without a byte order mark",
        "\\u{d}" => "end lines with LF or CR LF, never with CR alone",
        _ => "take it out: it does not show, and hides what the plan says",
    };
    Diagnostic::new(Code::BadText, format!("a plan cannot hold the character {shown}")).at(span, "this character").help(help)
}

pub fn foreign_letter(span: Span, letters: &str, shown: &str) -> Diagnostic {
    let short: String = letters.chars().take(8).collect();
    Diagnostic::new(Code::BadText, format!("`{short}` ({shown}) cannot stand in a name"))
        .at(span, "not a letter from a to z")
        .help("names are made of a–z, 0–9 and _; other letters stand in texts and comments")
}

pub fn stray(span: Span, found: &str) -> Diagnostic {
    let short: String = found.chars().take(8).collect();
    let diagnostic =
        Diagnostic::new(Code::Syntax, format!("found `{short}`, which has no meaning in a plan")).at(span, "no meaning here");
    diagnostic.help(match found {
        ";" => "a field ends with its line: take the `;` away",
        "'" | "“" | "”" | "‘" | "’" => "texts stand in straight double quotes: \"text\"",
        "−" | "–" | "—" => "write the minus sign of the keyboard: `-`",
        "×" | "·" => "write `*`",
        "÷" => "write `/`",
        _ => "take it out, or put it into a text or a comment",
    })
}

pub fn unclosed_text(span: Span) -> Diagnostic {
    Diagnostic::new(Code::BadText, "this text is never closed")
        .at(span, "opened here")
        .help("write the closing `\"` on the same line; a line end in a text is `\\n`")
}

pub fn bad_escape(span: Span, character: char) -> Diagnostic {
    let shown: String = character.escape_default().collect();
    Diagnostic::new(Code::BadText, format!("`\\{shown}` means nothing in a text"))
        .at(span, "unknown escape")
        .help("the escapes are `\\\"`, `\\\\`, `\\n` and `\\t`; a backslash itself is `\\\\`")
}

pub fn too_large(span: Span, what: &str, limit: usize, of: &str) -> Diagnostic {
    Diagnostic::new(Code::TooLarge, format!("{what} is longer than {limit} {of}"))
        .at(span, format!("at most {limit} {of}"))
        .help("make it shorter, or split it")
}

pub fn too_many_operators(span: Span, limit: usize) -> Diagnostic {
    Diagnostic::new(Code::TooLarge, format!("this expression chains more than {limit} operators"))
        .at(span, format!("at most {limit} operators"))
        .help("name parts of it with `let`, or write `sum([ … ])`")
}
