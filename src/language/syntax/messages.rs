//! Every syntax error as a diagnostic: the code, the message, the span and the suggestion. Other files find the errors; this file
//! contains their text.

use std::ops::Range;

use crate::codes::{E101, E102, E103, E104, E105, E106, E107, E108};
use psd_text::diagnostic::Diagnostic;
use psd_text::markdown::{FRAGMENT, FenceError};
use psd_text::source::{FileId, Span};

use super::{
    lexical::{confusable::Confusable, letters, numbers},
    limits,
};

/// The replacement for an `or`.
const EITHER: &str = "all requirements must be met, so there is no `or`; if one of two values is sufficient, require \
 the smaller or the larger, as in `min(a, b) < 5 mm`";

const COMPARED: &str = "write a comparison with `<=`, `>=`, `==` or `within 5 % of`";

/// `found` and `expected` are phrases, with their backquotes.
pub fn unexpected(span: Span, found: &str, expected: &str) -> Diagnostic {
    Diagnostic::new(E101, format!("found {found}, expected {expected}"))
        .at(span, format!("expected {expected}"))
        .help(match found {
        "`}`" => "remove this `}`, or open the block that it closes".to_owned(),
        "`between`" if expected.contains("an operator") => {
            "write two comparisons joined with `and`, as in `x > 1 mm and x < 2 mm`, or `x within 5 % of 2 mm`".to_owned()
        }
        "`between`" if expected == "`=`" => "write the value first: `param v = 0.8 m/s between 0.2 m/s .. 2 m/s`".to_owned(),
        "`,`" if expected.contains("`)`") && !expected.contains("`,`") => {
            "write a list in `[ ]`, as in `[html, csv]`".to_owned()
        }
        "`use`" | "`param`" | "`let`" | "`require`" | "`and`" | "`within`" | "`of`" | "`step`" | "`between`" => {
            format!("choose another name: {found} is a keyword")
        }
        "`or`" => EITHER.to_owned(),
        "`is`" | "`equals`" => COMPARED.to_owned(),
        "`:`" if expected.contains("an operator") => "write a range with `..`, as in `1 mm .. 10 mm step …`".to_owned(),
        "`to`" if expected.contains("an operator") => "write a range with `..`, as in `-5 mm .. 5 mm`".to_owned(),
        "`in`" if expected.contains("`between`") => {
            "write the range of a parameter after `between`, as in `param v = 1 m/s between 0.5 m/s .. 2 m/s`".to_owned()
        }
        "`=`" | "`:`" if expected == "`{`" => "write the kind, the name and `{`, as in `striker hammer {`".to_owned(),
        "`=`" if expected.contains("`)`") => "write `:` before the value of an argument, as in `elastic(stiffness: 300 kN/m)`".to_owned(),
        "`=`" if expected.contains("`]`") => "write `~` before the distribution of an input, as in `beam.mass ~ normal(cv: 2 %)`".to_owned(),
        "`fails`" | "`holds`" if expected.contains("`)`") => {
            "write the event before the requirement, as in `scatter.probability(fails: \"stays in travel\")`".to_owned()
        }
        "`from`" if expected.contains("an operator") => {
            "write `in` before the values of an intensity, as in `impact_speed in 0.4 .. 1.6 step 0.1 m/s`".to_owned()
        }
        "`=`" if expected.contains("an operator") => {
            format!("`=` gives a field its value; {COMPARED}")
        }
        "`,`" if expected.contains("the end of the line") => {
            "remove the `,` at the end of a field, or write several values in `[ ]`".to_owned()
        }
        "`+`" if expected == "a value" => "remove the `+`: a number without a sign is positive".to_owned(),
        "`/`" | "`~`" | "`\\`" if expected == "a value" => {
            "write the name of a file or a port in quotes".to_owned()
        }
        _ if expected == "a field" => "write `key = value`".to_owned(),
        _ if expected == "a value" => "write a number with its unit, a string, a name, a list or a range".to_owned(),
        "`<`" | "`<=`" | "`>`" | "`>=`" | "`==`" | "`!=`" if expected.contains("the end of the line") => {
            "write two comparisons joined with `and`: `1 mm < x and x < 2 mm`".to_owned()
        }
        _ if expected == "an item" => {
            "write a block, such as `striker hammer { … }`, or a line that starts with `use`, `param`, `let` or `require`"
                .to_owned()
        }
        _ if expected.contains("the end of the line") => "write one field or item per line".to_owned(),
        _ => format!("write {expected} here"),
    })
}

pub fn field_outside(span: Span, key: &str) -> Diagnostic {
    Diagnostic::new(
        E101,
        format!("field `{key}` outside a block, expected an item"),
    )
    .at(span, "not in a block")
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
    Diagnostic::new(
        E101,
        format!("`{short}` is neither a block nor an item"),
    )
    .at(span, "neither a block nor an item")
    .help(
        "write `{` on this line for a block, as in `striker hammer {`; write `#` before a comment",
    )
}

/// A line that begins with a keyword of another language.
pub fn word_of_another_language(span: Span, word: &str, help: &str) -> Diagnostic {
    Diagnostic::new(E101, format!("unknown word `{word}`"))
        .at(span, "not an item")
        .help(help)
}

/// A condition or a loop: `whole` is skipped.
pub fn no_control(message: &str, help: &str, begins: Span, whole: Span) -> Diagnostic {
    Diagnostic::new(E101, message)
        .at(begins, "not an item")
        .at(whole, "not read")
        .help(help)
}

/// Blocks without braces: `colon` is the first one after the words `head`.
pub fn blocks_by_indentation(colon: Span, whole: Span, head: &str) -> Diagnostic {
    let named = if head.contains(' ') {
        head.to_owned()
    } else {
        format!("{head} NAME")
    };
    Diagnostic::new(E101, "found `:`, expected `{`")
        .at(colon, "expected `{`")
        .at(whole, "not read")
        .help(format!(
            "write each block in braces and each field with `=`: `{named} {{`, lines such as `mass = 1 kg`, and `}}`"
        ))
}

pub fn arguments_in_braces(span: Span, call: &str) -> Diagnostic {
    Diagnostic::new(E101, "arguments must be in `( )`")
        .at(span, "in braces")
        .help(format!("write `{call}`"))
}

/// `rest`: the text after `require`.
pub fn requirement_without_name(span: Span, rest: &str) -> Diagnostic {
    let short = rest.len() <= 60 && !rest.contains('\n');
    let rest = if short { rest } else { "…" };
    Diagnostic::new(E101, "a requirement must have a name, a string in quotes")
        .at(span, "expected a string in quotes")
        .help(format!(
            "add a name, as in `require \"stays in travel\" {rest}`"
        ))
}

/// A line that continues an expression of the line before.
pub fn operator_begins_line(span: Span, operator: &str) -> Diagnostic {
    Diagnostic::new(E101, format!("this line begins with `{operator}`"))
        .at(span, "continues the line before")
        .help("move the operator to the end of the line before, or join the lines")
}

pub fn brace_missing(span: Span) -> Diagnostic {
    Diagnostic::new(E101, "this block has no `{`")
        .at(span, "block contents without `{`")
        .help("write the `{` at the end of this line, as in `striker hammer {`")
}

pub fn brace_on_next_line(span: Span) -> Diagnostic {
    Diagnostic::new(E101, "`{` is not on the line of its block")
        .at(span, "on a separate line")
        .help("move it to the line of the block's name, as in `striker hammer {`")
}

pub fn misplaced_block(span: Span) -> Diagnostic {
    Diagnostic::new(
        E101,
        "found a block or item inside a block, expected `key = value` or `}`",
    )
    .at(span, "expected a field")
    .help("close the block above first, or move this one out of it")
}

pub fn positional_after_named(span: Span) -> Diagnostic {
    Diagnostic::new(
        E101,
        "value without a name after a named one, expected `name: value`",
    )
    .at(span, "expected a name")
    .help(
        "write values without a name first: `elastic(300 kN/m)` or `elastic(stiffness: 300 kN/m)`",
    )
}

pub fn unclosed(span: Span, open: &str, close: &str) -> Diagnostic {
    Diagnostic::new(E102, format!("`{open}` is never closed"))
        .at(span, "opened here")
        .help(format!("write the matching `{close}`"))
}

/// A Markdown document without a `psd` block.
pub fn no_plan_block(span: Span) -> Diagnostic {
    Diagnostic::new(
        E108,
        "no `psd` block in this Markdown document: it has no plan",
    )
    .at(span, "no block from here to the end")
    .help(
        "write the plan in a code block: the line \"```psd\", then the plan, then the line \"```\"",
    )
}

/// An error of a fence of a Markdown document.
pub fn fence(file: FileId, error: &FenceError) -> Diagnostic {
    let at = |range: &Range<usize>| Span::new(file, range.start, range.end);
    match error {
        FenceError::Unclosed { opening, next } => {
            let unclosed = Diagnostic::new(E108, "this code block is never closed")
                .at(at(opening), "opened here");
            let unclosed = next.iter().fold(unclosed, |unclosed, next| {
                unclosed.at(at(next), "next block of the plan")
            });
            unclosed.help("write the closing fence, \"```\" or \"~~~\", on a separate line")
        }
        FenceError::UnknownWord { words } => Diagnostic::new(
            E108,
            "unknown word after `psd`: psd does not know whether this block is part of the plan",
        )
        .at(at(words), "unknown word")
        .help(format!(
            "write `psd` alone for a block of the plan, or `psd {FRAGMENT}` for an example"
        )),
    }
}

/// A block of the plan that begins in one code block and ends in another.
pub fn item_over_fences(head: Span) -> Diagnostic {
    Diagnostic::new(E108, "this continues after the end of its code block")
        .at(head, "begins here")
        .help("end it before the closing fence, or join the two code blocks")
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
    Diagnostic::new(E103, format!("`{short}` is not a number that psd reads"))
        .at(span, error.why)
        .help(help)
}

/// `corrected`: number and unit without the parentheses or brackets.
pub fn unit_in_parentheses(span: Span, corrected: &str, brackets: bool) -> Diagnostic {
    let which = if brackets { "brackets" } else { "parentheses" };
    Diagnostic::new(E104, format!("a unit must not contain {which}"))
        .at(span, "read as one unit")
        .help(format!(
            "write `{corrected}`: a unit is read from left to right, so `N/m*s` is (N/m)·s"
        ))
}

pub fn unit_without_blank(span: Span, corrected: &str) -> Diagnostic {
    Diagnostic::new(E104, "operator touches a unit")
        .at(span, "read as part of the unit")
        .help(format!("write spaces around the operator: `{corrected}`"))
}

pub fn nested_too_deep(span: Span) -> Diagnostic {
    Diagnostic::new(
        E105,
        "parentheses and brackets are nested more than 64 deep",
    )
    .at(span, "level 65")
    .help("name a part of it with `let`")
}

pub fn bad_character(span: Span, shown: &str) -> Diagnostic {
    let help = match shown {
        "\\u{d}" => "end lines with LF or CR LF, not with CR alone",
        _ => "remove it: it is invisible and hides the meaning of the plan",
    };
    Diagnostic::new(E106, format!("a plan cannot contain the character {shown}"))
        .at(span, "this character")
        .help(help)
}

pub fn foreign_letter(span: Span, letters: &str, shown: &str) -> Diagnostic {
    let short: String = letters.chars().take(8).collect();
    Diagnostic::new(
        E106,
        format!("invalid character `{short}` ({shown}) in a name"),
    )
    .at(span, "not a letter from a to z")
    .help("write names with a–z, 0–9 and _; other letters are allowed in strings and comments")
}

pub fn stray(span: Span, found: &str) -> Diagnostic {
    let short: String = found.chars().take(8).collect();
    let diagnostic = Diagnostic::new(
        E101,
        format!("unexpected `{short}`: it has no meaning in a plan"),
    )
    .at(span, "no meaning here");
    diagnostic.help(match found {
        ";" => "remove it at the end of a field; write `,` between the values of a list",
        "'" | "“" | "”" | "‘" | "’" | "„" | "«" | "»" => "write strings in straight double quotes: \"text\"",
        "&" | "&&" => "join two conditions with `and`",
        "|" | "||" => EITHER,
        "+/-" => "write a tolerance as `within 1 mm of 45 mm`, or a range with both ends, `44 mm .. 46 mm`",
        "±" => "write both ends, as in `-5 mm .. 5 mm`; in a requirement, `within 5 % of 8 mm`",
        "!" => "negate a condition by its operator: `!=`, `>` for `<=`",
        "%" | "%%" => "write `#` before a comment; as a unit, `%` follows its number",
        "°C" => "write `degC` for a degree Celsius, as in `23 degC`",
        "°" | "º" => "write `deg` for a degree of arc",
        "½" => "write `0.5`",
        "¼" => "write `0.25`",
        "¾" => "write `0.75`",
        "√" => "write `sqrt(…)`",
        _ => "remove it, or move it into a string or a comment",
    })
}

pub fn unclosed_text(span: Span) -> Diagnostic {
    Diagnostic::new(E106, "this string is never closed")
        .at(span, "opened here")
        .help("write the closing `\"` on the same line; a line end in a string is `\\n`")
}

pub fn bad_escape(span: Span, character: char) -> Diagnostic {
    let shown: String = character.escape_default().collect();
    Diagnostic::new(E106, format!("unknown escape `\\{shown}` in a string"))
        .at(span, "unknown escape")
        .help("write `\\\"`, `\\\\`, `\\n` or `\\t`; a backslash itself is `\\\\`")
}

pub fn too_large(span: Span, what: &str, limit: usize, of: &str) -> Diagnostic {
    Diagnostic::new(E107, format!("{what} is longer than {limit} {of}"))
        .at(span, format!("at most {limit} {of}"))
        .help("shorten it, or split it")
}

pub fn too_many_operators(span: Span, limit: usize) -> Diagnostic {
    Diagnostic::new(E107, format!("expression with more than {limit} operators"))
        .at(span, format!("at most {limit} operators"))
        .help("name parts of it with `let`, or write `sum([ … ])`")
}

/// A file in which every line ends with CR: other programs read it as one line.
pub fn carriage_returns(span: Span) -> Diagnostic {
    Diagnostic::new(E106, "lines of this file end with CR alone (U+000D)")
        .at(span, "first such line end")
        .help("save the file with LF or CR LF line ends")
}

/// A confusable character or word, at the first of `count` positions.
pub fn confusable(found: Confusable, span: Span, count: usize, text: &str) -> Diagnostic {
    let often = match count {
        1 => String::new(),
        2 => ", here and in one other line".to_owned(),
        more => format!(", here and in {} other lines", more - 1),
    };
    let error = |code, message: String, label: &str, help: String| {
        Diagnostic::new(code, format!("{message}{often}"))
            .at(span, label)
            .help(help)
    };
    let point = |c: char| format!("U+{:04X}", u32::from(c));
    match found {
        Confusable::ByteOrderMark => error(
            E106,
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
                E106,
                format!("found {name}{}, expected an ordinary space", point(blank)),
                "this character",
                format!(
                    "replace it with a space; an editor finds it as {}",
                    point(blank)
                ),
            )
        }
        Confusable::Sign(written, meant) => {
            let code = written.chars().next().filter(|first| !first.is_ascii());
            let which = code.map_or_else(String::new, |first| format!(" ({})", point(first)));
            error(
                E101,
                format!("`{written}`{which} is not a character of the language"),
                "this character",
                format!("write `{meant}`"),
            )
        }
        Confusable::Superscript(written) => {
            let meant = "as in `mm^2` or `1/s`";
            let written: String = written.chars().take(12).collect();
            error(
                E101,
                format!("`{written}` is not an exponent"),
                "superscript digit",
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
                E101,
                format!("{which} is not a quotation mark of the language"),
                "intended string",
                format!("write \"{written}\" with the straight quote U+0022"),
            )
        }
        Confusable::Comment(opens) => error(
            E101,
            format!("`{opens}` does not begin a comment"),
            "intended comment",
            "write `#` before a comment; it ends with its line".to_owned(),
        ),
        Confusable::Semicolon => error(
            E101,
            "unexpected `;`: it has no meaning in a plan".to_owned(),
            "no meaning here",
            "remove the `;`: a field ends with its line".to_owned(),
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
            format!("`{short}` contains {point}, which only looks like `{latin}`"),
            format!("not the ASCII `{latin}`"),
        ),
        None => (
            format!("`{short}` contains {point}, which is not allowed in a name or unit"),
            "not a letter from a to z".to_owned(),
        ),
    };
    let help =
        match letters::written_plainly(word).filter(|plain| plain.len() <= limits::NAME_CHARS) {
            Some(plain) => format!("write `{plain}`: names contain a–z, 0–9 and _"),
            None => {
                "write names with a–z, 0–9 and _; other letters are allowed in strings and comments"
                    .to_owned()
            }
        };
    Diagnostic::new(E106, format!("{message}{often}"))
        .at(at, label)
        .help(help)
}
