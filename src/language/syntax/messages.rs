//! Every syntax error as a diagnostic: the code, the message, the span and the suggestion. Other files find the errors; this file
//! contains their text.

use super::{
    lexical::{confusable::Confusable, letters, numbers},
    limits,
};
use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::Span;

/// The replacement for an `or`.
const EITHER: &str = "all that is required must hold, so there is no `or`: of two values of which one is enough, require the \
    smaller or the larger, as in `min(a, b) < 5 mm`";

const COMPARED: &str = "values are compared by `<=`, `>=`, `==` or `within 5 % of`";

/// `found` and `expected` are phrases, with their backquotes.
pub fn unexpected(span: Span, found: &str, expected: &str) -> Diagnostic {
    Diagnostic::new(Code::Syntax, format!("found {found}, expected {expected}"))
        .at(span, format!("expected {expected}"))
        .help(match found {
        "`}`" => "each `}` closes one `{`: take this one away, or open the block it should close".to_owned(),
        "`between`" if expected.contains("an operator") => {
            "a band is two comparisons joined with `and`, as in `x > 1 mm and x < 2 mm`, or `x within 5 % of 2 mm`".to_owned()
        }
        "`between`" if expected == "`=`" => "the value comes first: `param v = 0.8 m/s between 0.2 m/s .. 2 m/s`".to_owned(),
        "`,`" if expected.contains("`)`") && !expected.contains("`,`") => {
            "a list stands in `[ ]`, as in `[html, csv]`".to_owned()
        }
        "`use`" | "`param`" | "`let`" | "`require`" | "`and`" | "`within`" | "`of`" | "`step`" | "`between`" => {
            format!("{found} is a word of the language: names are other words")
        }
        "`or`" => EITHER.to_owned(),
        "`is`" | "`equals`" => COMPARED.to_owned(),
        "`to`" if expected.contains("an operator") => "a range is written with `..`, as in `-5 mm .. 5 mm`".to_owned(),
        "`in`" if expected.contains("`between`") => {
            "the range of a parameter follows `between`, as in `param v = 1 m/s between 0.5 m/s .. 2 m/s`".to_owned()
        }
        "`-`" if expected == "`=`" => "a name has `_` where others have `-`, as in `drop_height`".to_owned(),
        "`=`" | "`:`" if expected == "`{`" => "a block is its kind, its name and `{`, as in `striker hammer {`".to_owned(),
        "`=`" if expected.contains("`)`") => "an argument is given with `:`, as in `elastic(stiffness: 300 kN/m)`".to_owned(),
        "`=`" if expected.contains("an operator") => {
            format!("`=` gives a field its value; {COMPARED}")
        }
        "`,`" if expected.contains("the end of the line") => {
            "a field ends with its line: take the `,` away, or put several values into `[ ]`".to_owned()
        }
        "`+`" if expected == "a value" => "a number without a sign is positive: take the `+` away".to_owned(),
        "`/`" | "`~`" | "`\\`" if expected == "a value" => {
            "the name of a file or a port is a text: it stands in quotes".to_owned()
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
    Diagnostic::new(
        Code::Syntax,
        format!("found the field `{key}` outside a block, expected an item"),
    )
    .at(span, "belongs to no block")
    .help(format!(
        "move it into its block, or name a value with `let {key} = …`"
    ))
}

/// A line of words that does not open a block.
pub fn stray_words(span: Span, words: &str) -> Diagnostic {
    let mut short: String = words.chars().take(30).collect();
    if short.len() < words.len() {
        short.push('…');
    }
    Diagnostic::new(Code::Syntax, format!("`{short}` stands alone on its line and opens no block"))
        .at(span, "neither a block nor an item")
        .help("a block opens with `{` on this same line, as in `striker hammer { … }`; a remark stands behind `#`")
}

/// A line that begins with a keyword of another language.
pub fn word_of_another_language(span: Span, word: &str, help: &str) -> Diagnostic {
    Diagnostic::new(Code::Syntax, format!("`{word}` is no word of the language"))
        .at(span, "begins no item")
        .help(help)
}

/// A condition or a loop: `whole` is skipped.
pub fn no_control(message: &str, help: &str, begins: Span, whole: Span) -> Diagnostic {
    Diagnostic::new(Code::Syntax, message)
        .at(begins, "begins no item")
        .at(whole, "not read")
        .help(help)
}

pub fn arguments_in_braces(span: Span, call: &str) -> Diagnostic {
    Diagnostic::new(Code::Syntax, "arguments stand in `( )`")
        .at(span, "in braces")
        .help(format!("write `{call}`"))
}

/// `rest`: the text after `require`.
pub fn requirement_without_name(span: Span, rest: &str) -> Diagnostic {
    let short = rest.len() <= 60 && !rest.contains('\n');
    let rest = if short { rest } else { "…" };
    Diagnostic::new(Code::Syntax, "a requirement has a name, a text in quotes")
        .at(span, "expected a text in quotes")
        .help(format!(
            "name it, as in `require \"stays in travel\" {rest}`"
        ))
}

/// A line that continues an expression of the line before.
pub fn operator_begins_line(span: Span, operator: &str) -> Diagnostic {
    Diagnostic::new(Code::Syntax, format!("this line begins with `{operator}`"))
        .at(span, "belongs to the line before")
        .help("an expression goes on behind an operator: put it at the end of the line before, or join the lines")
}

pub fn brace_missing(span: Span) -> Diagnostic {
    Diagnostic::new(Code::Syntax, "this block lacks its `{`")
        .at(span, "fields and a `}` follow")
        .help("write the `{` at the end of this line, as in `striker hammer {`")
}

pub fn brace_on_next_line(span: Span) -> Diagnostic {
    Diagnostic::new(Code::Syntax, "this `{` stands apart from its block")
        .at(span, "a line too low")
        .help("put it on the line of the block's name, as in `striker hammer {`")
}

pub fn misplaced_block(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Syntax,
        "found a block or item inside a block, expected `key = value` or `}`",
    )
    .at(span, "expected a field")
    .help("blocks stand beside each other: close the block above first, or move this one out of it")
}

pub fn positional_after_named(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::Syntax,
        "found a value without a name after a named one, expected `name: value`",
    )
    .at(span, "expected a name")
    .help("values without a name come first: `elastic(300 kN/m)` or `elastic(stiffness: 300 kN/m)`")
}

pub fn unclosed(span: Span, open: &str, close: &str) -> Diagnostic {
    Diagnostic::new(
        Code::UnclosedBracket,
        format!("this `{open}` is never closed"),
    )
    .at(span, "opened here")
    .help(format!("write the `{close}` that belongs to it"))
}

pub fn bad_number(span: Span, written: &str, error: &numbers::NumberError) -> Diagnostic {
    let written = written.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut short: String = written.chars().take(20).collect();
    if short.len() < written.len() {
        short.push('…');
    }
    let help = match error.write.as_slice() {
        [] => "write a number such as `0.5` or `1.5e6`".to_owned(),
        [one] => format!("write `{one}`"),
        [one, others @ ..] => format!("write `{one}` or `{}`", others.join("` or `")),
    };
    Diagnostic::new(
        Code::BadNumber,
        format!("`{short}` is not a number psd reads"),
    )
    .at(span, error.why)
    .help(help)
}

/// `corrected`: number and unit without the parentheses.
pub fn unit_in_parentheses(span: Span, corrected: &str) -> Diagnostic {
    Diagnostic::new(Code::UnitWithoutBlank, "a unit has no parentheses")
        .at(span, "read as one unit")
        .help(format!(
            "write `{corrected}`: a unit is read from left to right, so that `N/m*s` is (N/m)·s"
        ))
}

pub fn unit_without_blank(span: Span, corrected: &str) -> Diagnostic {
    Diagnostic::new(Code::UnitWithoutBlank, "an operator is glued to a unit")
        .at(span, "read as part of the unit")
        .help(format!("put blanks around the operator: `{corrected}`"))
}

pub fn nested_too_deep(span: Span) -> Diagnostic {
    Diagnostic::new(Code::NestedTooDeep, "brackets are nested more than 64 deep")
        .at(span, "the 65th")
        .help("name a part of it with `let`")
}

pub fn bad_character(span: Span, shown: &str) -> Diagnostic {
    let help = match shown {
        "\\u{d}" => "end lines with LF or CR LF, never with CR alone",
        _ => "take it out: it does not show, and hides what the plan says",
    };
    Diagnostic::new(
        Code::BadText,
        format!("a plan cannot hold the character {shown}"),
    )
    .at(span, "this character")
    .help(help)
}

pub fn foreign_letter(span: Span, letters: &str, shown: &str) -> Diagnostic {
    let short: String = letters.chars().take(8).collect();
    Diagnostic::new(
        Code::BadText,
        format!("`{short}` ({shown}) cannot stand in a name"),
    )
    .at(span, "not a letter from a to z")
    .help("names are made of a–z, 0–9 and _; other letters stand in texts and comments")
}

pub fn stray(span: Span, found: &str) -> Diagnostic {
    let short: String = found.chars().take(8).collect();
    let diagnostic = Diagnostic::new(
        Code::Syntax,
        format!("found `{short}`, which has no meaning in a plan"),
    )
    .at(span, "no meaning here");
    diagnostic.help(match found {
        ";" => "a field ends with its line, and values of a list are parted by `,`",
        "'" | "“" | "”" | "‘" | "’" | "„" | "«" | "»" => "texts stand in straight double quotes: \"text\"",
        "&" | "&&" => "two conditions are joined by `and`",
        "|" | "||" => EITHER,
        "+/-" => "a tolerance is written `within 1 mm of 45 mm`; a range by both its ends, `44 mm .. 46 mm`",
        "±" => "write both ends, as in `-5 mm .. 5 mm`; in a requirement, `within 5 % of 8 mm`",
        "!" => "a condition is turned round by its sign: `!=`, `>` for `<=`",
        "°" | "º" => "a degree of arc is written `deg`",
        "½" => "write `0.5`",
        "¼" => "write `0.25`",
        "¾" => "write `0.75`",
        "√" => "write `sqrt(…)`",
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
    Diagnostic::new(
        Code::BadText,
        format!("`\\{shown}` means nothing in a text"),
    )
    .at(span, "unknown escape")
    .help("the escapes are `\\\"`, `\\\\`, `\\n` and `\\t`; a backslash itself is `\\\\`")
}

pub fn too_large(span: Span, what: &str, limit: usize, of: &str) -> Diagnostic {
    Diagnostic::new(
        Code::TooLarge,
        format!("{what} is longer than {limit} {of}"),
    )
    .at(span, format!("at most {limit} {of}"))
    .help("make it shorter, or split it")
}

pub fn too_many_operators(span: Span, limit: usize) -> Diagnostic {
    Diagnostic::new(
        Code::TooLarge,
        format!("this expression chains more than {limit} operators"),
    )
    .at(span, format!("at most {limit} operators"))
    .help("name parts of it with `let`, or write `sum([ … ])`")
}

/// A file in which every line ends with CR: other programs read it as one line.
pub fn carriage_returns(span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::BadText,
        "the lines of this file end with CR alone (U+000D)",
    )
    .at(span, "the first of them")
    .help("save the file with LF or CR LF line ends")
}

/// A confusable character or word, at the first of `count` positions.
pub fn confusable(found: Confusable, span: Span, count: usize, text: &str) -> Diagnostic {
    let often = match count {
        1 => String::new(),
        2 => ", here and in one more place".to_owned(),
        more => format!(", here and in {} more places", more - 1),
    };
    let error = |code, message: String, label: &str, help: String| {
        Diagnostic::new(code, format!("{message}{often}"))
            .at(span, label)
            .help(help)
    };
    let point = |c: char| format!("U+{:04X}", u32::from(c));
    match found {
        Confusable::ByteOrderMark => error(
            Code::BadText,
            "the file begins with a byte order mark (U+FEFF)".to_owned(),
            "before the first character",
            "save the file as UTF-8 without a byte order mark".to_owned(),
        ),
        Confusable::Space(blank) => {
            let name = match blank {
                '\u{a0}' | '\u{202f}' => "the no-break space ",
                '\u{2009}' => "the thin space ",
                '\u{3000}' => "the wide space ",
                _ => "",
            };
            error(
                Code::BadText,
                format!(
                    "a blank is {name}{}, not the space of the keyboard",
                    point(blank)
                ),
                "this blank",
                format!(
                    "replace it by a space; an editor finds it as {}",
                    point(blank)
                ),
            )
        }
        Confusable::Sign(written, meant) => {
            let code = written.chars().next().filter(|first| !first.is_ascii());
            let which = code.map_or_else(String::new, |first| format!(" ({})", point(first)));
            error(
                Code::Syntax,
                format!("`{written}`{which} is no sign of the language"),
                "this sign",
                format!("write `{meant}`"),
            )
        }
        Confusable::Superscript(written) => {
            let meant = "as in `mm^2` or `1/s`";
            let written: String = written.chars().take(12).collect();
            error(
                Code::Syntax,
                format!("`{written}` is no exponent of the language"),
                "a raised digit",
                format!("write the power with `^`, {meant}"),
            )
        }
        Confusable::Quotes(open) => {
            let inside = |c: char| {
                c == open
                    || matches!(
                        c,
                        '"' | '”' | '“' | '»' | '«' | '’' | '‘' | '`' | '\'' | '＂'
                    )
            };
            let written = text[span.range()].trim_matches(inside);
            let which = if open.is_ascii() {
                format!("`{open}`")
            } else {
                format!("`{open}` ({})", point(open))
            };
            error(
                Code::Syntax,
                format!("{which} is no quote of the language"),
                "meant as a text",
                format!("write \"{written}\" with the straight quote U+0022"),
            )
        }
        Confusable::Comment(opens) => error(
            Code::Syntax,
            format!("`{opens}` begins no comment"),
            "meant as a comment",
            "a comment begins with `#` and ends with its line".to_owned(),
        ),
        Confusable::Semicolon => error(
            Code::Syntax,
            "found `;`, which has no meaning in a plan".to_owned(),
            "no meaning here",
            "a field ends with its line: take the `;` away".to_owned(),
        ),
        Confusable::Word(word) => foreign_word(word, span, &often),
    }
}

/// A name with letters outside a–z; the span is that of the first.
fn foreign_word(word: &str, span: Span, often: &str) -> Diagnostic {
    let start = word.find(letters::is_foreign).unwrap_or(0);
    let letter = word[start..].chars().next().unwrap_or_default();
    let run: usize = word[start..]
        .chars()
        .take_while(|c| letters::is_foreign(*c))
        .map(char::len_utf8)
        .sum();
    let at = Span {
        start: span.start + u32::try_from(start).unwrap_or(0),
        ..span
    };
    let at = Span {
        end: at.start + u32::try_from(run).unwrap_or(0),
        ..at
    };
    let short: String = word.chars().take(30).collect();
    let point = format!("`{letter}` (U+{:04X})", u32::from(letter));
    let (message, label) = match letters::lookalike(letter) {
        Some(latin) => (
            format!("`{short}` holds {point}, which only looks like `{latin}`"),
            format!("not the `{latin}` of the keyboard"),
        ),
        None => (
            format!("`{short}` holds {point}, which no name or unit may hold"),
            "not a letter from a to z".to_owned(),
        ),
    };
    let help =
        match letters::written_plainly(word).filter(|plain| plain.len() <= limits::NAME_CHARS) {
            Some(plain) => format!("write `{plain}`: names are made of a–z, 0–9 and _"),
            None => "names are made of a–z, 0–9 and _; other letters stand in texts and comments"
                .to_owned(),
        };
    Diagnostic::new(Code::BadText, format!("{message}{often}"))
        .at(at, label)
        .help(help)
}
