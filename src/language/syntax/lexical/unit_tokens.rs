//! The extent of a unit in the text of a plan. In: the text from the unit on. Out: its length in bytes. It knows the form of a unit; the
//! name of a unit is checked only in parentheses.

/// A unit in parentheses at the start of `text`, after `*` or `/` unless it is `alone`: its length in bytes, the operator included, and
/// the same without parentheses. Anything that is not a unit is an expression.
pub fn unit_in_parentheses(text: &str, alone: bool) -> Option<(usize, String)> {
    let sign = if alone {
        ""
    } else {
        text.get(..1).filter(|sign| matches!(*sign, "*" | "/"))?
    };
    let inside = text[sign.len()..].strip_prefix('(')?;
    let unit = inside
        .split([')', '\n'])
        .next()
        .filter(|unit| inside[unit.len()..].starts_with(')'))?;
    let trimmed = unit.trim();
    if unit_extent(trimmed) != trimmed.len() || psd_text::units::unit::parse(trimmed).is_err() {
        return None;
    }
    let turned = |c: char| match c {
        '*' if sign == "/" => '/',
        '/' if sign == "/" => '*',
        same => same,
    };
    let flat = sign.chars().chain(trimmed.chars().map(turned)).collect();
    Some((sign.len() + 1 + unit.len() + 1, flat))
}

/// A unit in brackets at the start of `text`, `[kg]`: its length in bytes, and the same without brackets.
pub fn unit_in_brackets(text: &str) -> Option<(usize, String)> {
    let inside = text.strip_prefix('[')?;
    let unit = &inside[..inside.find([']', '\n'])?];
    let closed = inside[unit.len()..].starts_with(']');
    let trimmed = unit.trim();
    let known =
        unit_extent(trimmed) == trimmed.len() && psd_text::units::unit::parse(trimmed).is_ok();
    (closed && known && !trimmed.is_empty()).then(|| (unit.len() + 2, trimmed.to_owned()))
}

/// Length in bytes of the unit token at the start of `text`: `name[^power]` joined by `*` or `/`; 0 without a unit.
pub fn unit_extent(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut end = if bytes.starts_with(b"1/") {
        1
    } else {
        unit_factor(text)
    };
    while end > 0 && matches!(bytes.get(end), Some(b'*' | b'/')) {
        let factor = unit_factor(&text[end + 1..]);
        if factor == 0 {
            break;
        }
        end += 1 + factor;
    }
    end
}

fn unit_factor(text: &str) -> usize {
    let letter = |next: char| next.is_ascii_alphabetic() || matches!(next, 'µ' | 'μ');
    let name = if text.starts_with('%') {
        1
    } else if text.starts_with(letter) {
        text.find(|next: char| !(letter(next) || next.is_ascii_digit() || next == '_'))
            .unwrap_or(text.len())
    } else {
        return 0;
    };
    let Some(power) = text[name..].strip_prefix('^') else {
        return name;
    };
    let digits = |text: &str| {
        text.len()
            - text
                .trim_start_matches(|next: char| next.is_ascii_digit())
                .len()
    };
    let sign = usize::from(power.starts_with('-'));
    let whole = digits(&power[sign..]);
    if whole == 0 {
        return name;
    }
    let mut end = sign + whole;
    if power[end..].starts_with('.') {
        let fraction = digits(&power[end + 1..]);
        end += if fraction == 0 { 0 } else { 1 + fraction };
    }
    name + 1 + end
}
