//! Forms of other languages that the grammar refuses, and the form of each in this one: `1:1:10 mm`, `5 % of span`, `1.07 kN m^-1`,
//! `hit-1`. In: the tokens of a statement and the one that was refused. Out: a diagnostic with what to write. It knows the form of a
//! unit and its names, and no block.

use std::ops::Range;

use psd_plan::schema::constant;
use psd_text::diagnostic::{Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::unit;

use super::control::NO_FUNCTIONS;
use super::grammar::Rule;
use super::lexical::tokens::{Kind, Token, Tokens};
use super::lexical::unit_tokens::unit_extent;
use super::limits;
use crate::codes::E101;

/// Functions of other languages that give numbers at equal distances.
const RANGES: [&str; 6] = ["linspace", "arange", "range", "seq", "linrange", "colon"];

/// Longest text that a message repeats.
const REPEATED: usize = 80;

#[derive(Violation)]
#[violation(E101, "`{written}` is not a name")]
#[help("write `{name}`: a name begins with a letter and contains a–z, 0–9 and _")]
struct NotAName<'a> {
    written: &'a str,
    name: &'a str,
    #[label("not a name")]
    span: Span,
}

#[derive(Violation)]
#[violation(E101, "{}", NO_FUNCTIONS.0)]
#[help("{}", NO_FUNCTIONS.1)]
struct FunctionDefined {
    #[label("a function")]
    span: Span,
}

#[derive(Violation)]
#[violation(E101, "a unit contains no spaces")]
#[help("write `{corrected}`")]
struct UnitInParts {
    corrected: String,
    #[label("one unit in two parts")]
    span: Span,
}

#[derive(Violation)]
#[violation(E101, "a unit follows a number or a list only")]
#[help("write `{corrected}`")]
struct UnitAfterValue {
    corrected: String,
    #[label("no number before the unit")]
    span: Span,
}

#[derive(Violation)]
#[violation(E101, "`of` is in `within … of` only")]
#[help("write `{corrected}`: a part of a value is a product")]
struct PartOfValue {
    corrected: String,
    #[label("a part of a value")]
    span: Span,
}

#[derive(Violation)]
#[violation(E101, "a range is written with `..` and `step`, not with `:`")]
#[help("write `{corrected}`: both ends are part of a range")]
struct RangeWithColons {
    corrected: String,
    #[label("a range")]
    span: Span,
}

#[derive(Violation)]
#[violation(E101, "a comma is missing between two values")]
#[help("write `{corrected}`")]
struct CommaMissing {
    corrected: String,
    #[label("two values without `,`")]
    span: Span,
}

#[derive(Violation)]
#[violation(E101, "the `:` after the name of an argument is missing")]
#[help("write `{corrected}`")]
struct ColonMissing {
    corrected: String,
    #[label("an argument and its value")]
    span: Span,
}

/// The diagnostic of a statement, the bytes `statement`, that is not read from byte `at` on; None if it is no known form.
pub fn form(
    tokens: &Tokens,
    statement: &Range<usize>,
    at: usize,
    rule: Rule,
) -> Option<Diagnostic> {
    let first = tokens
        .list
        .partition_point(|token| token.end <= statement.start);
    let inside = tokens.list[first..]
        .iter()
        .take_while(|token| token.start < statement.end);
    let list: Vec<Token> = inside
        .filter(|token| !matches!(token.kind, Kind::Comment | Kind::Newline))
        .copied()
        .collect();
    let at = list.partition_point(|token| token.end <= at);
    let refused = Refused {
        tokens,
        list: &list,
        at,
    };
    list.get(at)?;
    refused
        .function()
        .or_else(|| refused.name(rule))
        .or_else(|| refused.unit_in_parts())
        .or_else(|| refused.unit_after_value())
        .or_else(|| refused.part())
        .or_else(|| refused.range())
        .or_else(|| refused.colon())
        .or_else(|| refused.comma())
}

/// Whether other languages have a function of this name that gives numbers at equal distances.
#[must_use]
pub fn is_range(name: &str) -> bool {
    RANGES.contains(&name)
}

/// `1 .. 10 step 1 mm` for `linspace(1, 10, 10) mm`, `arange(1, 10, 1) mm` and the like. `unit`: the unit after the call.
#[must_use]
pub fn range_of_call(name: &str, arguments: &[&str], unit: &str) -> Option<String> {
    if !is_range(name) {
        return None;
    }
    let quantity = |text: &str| {
        let text = text.trim();
        let digits = text
            .find(|c: char| !(c.is_ascii_digit() || matches!(c, '-' | '.')))
            .unwrap_or(text.len());
        let (number, own) = text.split_at(digits);
        let own = own.trim();
        let own = if own.is_empty() { unit } else { own };
        Some((number.parse::<f64>().ok()?, own.to_owned()))
    };
    let [start, end, third] = arguments else {
        return None;
    };
    let ((start, of_start), (end, of_end), (third, of_third)) =
        (quantity(start)?, quantity(end)?, quantity(third)?);
    let step = if name.starts_with("lin") {
        (end - start) / (third - 1.0)
    } else {
        third
    };
    let same = of_start == of_end && (of_third == of_end || name.starts_with("lin"));
    let neat = |value: f64| value.is_finite() && value.to_string().len() <= 10;
    (same && neat(step) && step != 0.0).then(|| {
        format!("{start} .. {end} step {step} {of_end}")
            .trim_end()
            .to_owned()
    })
}

/// A statement and its refused token.
struct Refused<'a> {
    tokens: &'a Tokens<'a>,
    /// Without comments and line ends.
    list: &'a [Token],
    at: usize,
}

impl<'a> Refused<'a> {
    fn kind(&self, index: usize) -> Option<Kind> {
        self.list.get(index).map(|token| token.kind)
    }

    fn text(&self, index: usize) -> &'a str {
        self.list
            .get(index)
            .map_or("", |token| self.tokens.text_of(*token))
    }

    fn is_sign(&self, index: usize, sign: &str) -> bool {
        self.kind(index) == Some(Kind::Sign) && self.text(index) == sign
    }

    /// The text from one token to another, both included, if a message can repeat it.
    fn written(&self, first: usize, last: usize) -> Option<&'a str> {
        let written = &self.tokens.text[self.list[first].start..self.list[last].end];
        (written.len() <= REPEATED && !written.contains('\n')).then_some(written)
    }

    fn span(&self, first: usize, last: usize) -> Span {
        self.tokens
            .span(self.list[first].start, self.list[last].end)
    }

    /// Whether no space is between a token and the next one.
    fn touches(&self, index: usize) -> bool {
        let (Some(one), Some(next)) = (self.list.get(index), self.list.get(index + 1)) else {
            return false;
        };
        one.end == next.start
    }

    /// `def f(x) = 2 * x`, `f(x) = 2 * x`, `let f(x) = 2 * x`
    fn function(&self) -> Option<Diagnostic> {
        let before = self.at.checked_sub(1)?;
        let words = (0..self.at).all(|index| self.kind(index) == Some(Kind::Word));
        let called = self.is_sign(self.at, "(") && words && self.touches(before);
        called.then(|| {
            FunctionDefined {
                span: self.span(before, self.at),
            }
            .diagnostic()
        })
    }

    /// `impact hit-1 {`, `impact 1st_hit {`, `impact hit 1 {`
    fn name(&self, rule: Rule) -> Option<Diagnostic> {
        let of_key = match rule {
            Rule::head_alone => 0,
            Rule::entry_alone => 1,
            Rule::item_alone if matches!(self.text(0), "let" | "param") => 2,
            _ => return None,
        };
        if of_key > 0 && self.at > of_key {
            return None;
        }
        let (mut first, mut last) = (self.at, self.at);
        while first > 0 && self.touches(first - 1) {
            first -= 1;
        }
        while self.touches(last) {
            last += 1;
        }
        let apart = first == last && self.kind(first) == Some(Kind::Number) && first >= 2;
        if apart && rule == Rule::head_alone {
            first -= 1;
        }
        let written = self.written(first, last)?;
        let allowed = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | ' ');
        if first == last || !written.chars().all(allowed) {
            return None;
        }
        let joined = written.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
        let name = if joined.starts_with(|c: char| c.is_ascii_digit()) {
            let kind = self.text(first.checked_sub(1)?);
            format!("{kind}_{joined}")
        } else {
            joined
        };
        (name.len() <= limits::NAME_CHARS).then(|| {
            NotAName {
                written,
                name: &name,
                span: self.span(first, last),
            }
            .diagnostic()
        })
    }

    /// The unit at the refused word, and the byte after it.
    fn unit(&self) -> Option<(&'a str, usize)> {
        let start = self
            .list
            .get(self.at)
            .filter(|it| it.kind == Kind::Word)?
            .start;
        let rest = &self.tokens.text[start..];
        let found = &rest[..unit_extent(rest)];
        unit::parse(found).ok()?;
        Some((found, start + found.len()))
    }

    /// `10.4 kN m^-1`
    fn unit_in_parts(&self) -> Option<Diagnostic> {
        let before = self.at.checked_sub(1)?;
        let (more, end) = self.unit()?;
        let name = self.text(before);
        if constant(name).is_some() {
            // `2pi s` and `2 * pi s`
            let number = before
                .checked_sub(1)
                .filter(|_| self.kind(before) == Some(Kind::Unit));
            let first = number.unwrap_or(before);
            let times = number.map_or_else(String::new, |at| format!("{} * ", self.text(at)));
            return Some(
                UnitAfterValue {
                    corrected: format!("{times}{name} * 1 {more}"),
                    span: self.tokens.span(self.list[first].start, end),
                }
                .diagnostic(),
            );
        }
        if self.kind(before) != Some(Kind::Unit) || unit::parse(name).is_err() {
            return None;
        }
        let joined = match more.split_once("^-") {
            Some((name, "1")) => format!("/{name}"),
            Some((name, power)) if !more.contains(['*', '/']) => format!("/{name}^{power}"),
            _ => format!("*{more}"),
        };
        let number = before.checked_sub(1)?;
        let first = if self.kind(number) == Some(Kind::Number) {
            number
        } else {
            before
        };
        Some(
            UnitInParts {
                corrected: format!("{}{joined}", self.written(first, before)?),
                span: self.tokens.span(self.list[first].start, end),
            }
            .diagnostic(),
        )
    }

    /// `linspace(1, 10, 10) mm`, `(1 + 2) mm`
    fn unit_after_value(&self) -> Option<Diagnostic> {
        let close = self.at.checked_sub(1)?;
        let (unit, end) = self.unit()?;
        let open = self.innermost(close).filter(|_| self.is_sign(close, ")"))?;
        let called = open
            .checked_sub(1)
            .filter(|name| self.kind(*name) == Some(Kind::Word));
        let first = called.unwrap_or(open);
        let inside = &self.tokens.text[self.list[open].end..self.list[close].start];
        let arguments: Vec<&str> = inside.split(',').collect();
        let range = called.and_then(|name| range_of_call(self.text(name), &arguments, unit));
        let corrected = match range {
            Some(range) => range,
            None => format!("{} * 1 {unit}", self.written(first, close)?),
        };
        Some(
            UnitAfterValue {
                corrected,
                span: self.tokens.span(self.list[first].start, end),
            }
            .diagnostic(),
        )
    }

    /// Whether a token closes the bracket `open`.
    fn closes(&self, index: usize, open: usize) -> bool {
        let is_close = self.is_sign(index, ")") || self.is_sign(index, "]");
        is_close && self.innermost(index) == Some(open)
    }

    /// `5 % of span`
    fn part(&self) -> Option<Diagnostic> {
        let number = self.at.checked_sub(2)?;
        let is_part = self.text(self.at) == "of"
            && self.text(number + 1) == "%"
            && self.kind(number) == Some(Kind::Number);
        if !is_part || !matches!(self.kind(self.at + 1), Some(Kind::Word | Kind::Number)) {
            return None;
        }
        let mut last = self.at + 1;
        if self.kind(last + 1) == Some(Kind::Unit) {
            last += 1;
        }
        while self.is_sign(last + 1, ".") && self.kind(last + 2) == Some(Kind::Word) {
            last += 2;
        }
        Some(
            PartOfValue {
                corrected: format!(
                    "{} * {}",
                    self.written(number, number + 1)?,
                    self.written(self.at + 1, last)?
                ),
                span: self.span(number, last),
            }
            .diagnostic(),
        )
    }

    /// `1:1:10 mm`, `[1:1:10] mm`, `1 mm:10 mm`: a start, perhaps a step, and an end.
    fn range(&self) -> Option<Diagnostic> {
        if !self.is_sign(self.at, ":") {
            return None;
        }
        let mut first = self.at.checked_sub(1)?;
        if self.kind(first) == Some(Kind::Unit) {
            first = first.checked_sub(1)?;
        }
        let is_sign = |at: usize| self.is_sign(at, "-");
        if first > 0 && is_sign(first - 1) {
            first -= 1;
        }
        let mut parts: Vec<(String, &str)> = Vec::new();
        let mut next = first;
        loop {
            let minus = if is_sign(next) { "-" } else { "" };
            next += minus.len();
            if self.kind(next) != Some(Kind::Number) {
                return None;
            }
            let number = format!("{minus}{}", self.text(next));
            next += 1;
            let unit = if self.kind(next) == Some(Kind::Unit) {
                next += 1;
                self.text(next - 1)
            } else {
                ""
            };
            parts.push((number, unit));
            if !self.is_sign(next, ":") {
                break;
            }
            next += 1;
        }
        let mut last = next - 1;
        let listed = first > 0 && self.is_sign(first - 1, "[") && self.is_sign(next, "]");
        let mut unit = parts.last()?.1;
        if listed {
            first -= 1;
            last = next;
            if self.kind(next + 1) == Some(Kind::Unit) {
                last = next + 1;
                unit = self.text(last);
            }
        }
        let fits = parts.iter().all(|(_, own)| own.is_empty() || *own == unit);
        let (start, step, end) = match parts.as_slice() {
            [(start, _), (end, _)] => (start, "1", end),
            [(start, _), (step, _), (end, _)] => (start, step.as_str(), end),
            _ => return None,
        };
        let corrected = format!("{start} .. {end} step {step} {unit}");
        fits.then(|| {
            RangeWithColons {
                corrected: corrected.trim_end().to_owned(),
                span: self.span(first, last),
            }
            .diagnostic()
        })
    }

    /// Whether a value may end with this token.
    fn ends_value(&self, index: usize) -> bool {
        match self.kind(index) {
            Some(Kind::Word | Kind::Number | Kind::Unit | Kind::Text) => true,
            _ => self.is_sign(index, ")") || self.is_sign(index, "]"),
        }
    }

    /// Whether a value begins with this token.
    fn begins_value(&self, index: usize) -> bool {
        matches!(
            self.kind(index),
            Some(Kind::Word | Kind::Number | Kind::Text)
        )
    }

    /// `elastic(stiffness 300 kN/m)`
    fn colon(&self) -> Option<Diagnostic> {
        let name = self.at.checked_sub(1)?;
        let begins = self.is_sign(name.checked_sub(1)?, "(") || self.is_sign(name - 1, ",");
        let called = begins && self.kind(name) == Some(Kind::Word) && self.call().is_some();
        if !called || self.kind(self.at) != Some(Kind::Number) {
            return None;
        }
        let last = self.at + usize::from(self.kind(self.at + 1) == Some(Kind::Unit));
        Some(
            ColonMissing {
                corrected: format!("{}: {}", self.text(name), self.written(self.at, last)?),
                span: self.span(name, last),
            }
            .diagnostic(),
        )
    }

    /// The bracket that is open at a token: the one that it closes, if it closes one.
    fn innermost(&self, at: usize) -> Option<usize> {
        let mut depth = 0_usize;
        (0..at).rev().find(|index| {
            if self.is_sign(*index, ")") || self.is_sign(*index, "]") {
                depth += 1;
            } else if self.is_sign(*index, "(") || self.is_sign(*index, "[") {
                if depth == 0 {
                    return true;
                }
                depth -= 1;
            }
            false
        })
    }

    /// The parenthesis of the call around the refused token.
    fn call(&self) -> Option<usize> {
        let open = self
            .innermost(self.at)
            .filter(|open| self.is_sign(*open, "("))?;
        (self.kind(open.checked_sub(1)?) == Some(Kind::Word)).then_some(open)
    }

    /// `[displacement(hit) energy(hit)]`, `[1 2 3] mm`, `max(a b)`: all commas between the brackets.
    fn comma(&self) -> Option<Diagnostic> {
        let before = self.at.checked_sub(1)?;
        let missing = |index: usize| self.ends_value(index) && self.begins_value(index + 1);
        let list = self
            .innermost(self.at)
            .filter(|open| self.is_sign(*open, "["));
        let open = list.or_else(|| self.call())?;
        // `probability("stays in travel" fails)` has another form.
        if !missing(before) || matches!(self.text(self.at), "fails" | "holds") {
            return None;
        }
        let first = open + 1;
        let mut last = self.at;
        while last + 1 < self.list.len() && !self.closes(last + 1, open) {
            last += 1;
            self.written(first, last)?;
        }
        self.written(first, last)?;
        let mut corrected = String::new();
        for index in first..=last {
            corrected.push_str(self.text(index));
            if index == last {
                break;
            }
            if missing(index) {
                corrected.push(',');
            }
            let (end, next) = (self.list[index].end, self.list[index + 1].start);
            corrected.push_str(&self.tokens.text[end..next]);
        }
        Some(
            CommaMissing {
                corrected,
                span: self.span(first, last),
            }
            .diagnostic(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_at_equal_distances_are_a_range() {
        let of = |name, arguments: &[&str], unit| range_of_call(name, arguments, unit);
        let wanted = Some("1 .. 10 step 1 mm".to_owned());
        assert_eq!(of("linspace", &["1", "10", "10"], "mm"), wanted);
        assert_eq!(of("linspace", &["1 mm", "10 mm", "10"], ""), wanted);
        assert_eq!(of("range", &["1 mm", "10 mm", "1 mm"], ""), wanted);
        // The step of seven intervals between 1 and 10 has no end.
        assert_eq!(of("linspace", &["1", "10", "8"], "mm"), None);
        assert_eq!(of("linspace", &["1", "10", "1"], "mm"), None);
        assert_eq!(of("arange", &["1 m", "10 mm", "1 mm"], ""), None);
        assert_eq!(of("max", &["1", "10", "1"], "mm"), None);
    }
}
