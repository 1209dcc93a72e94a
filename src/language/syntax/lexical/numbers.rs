//! Errors of numbers, and their corrections. In: the text of one number, valid or not.

use crate::syntax::limits;

/// Why a number is invalid, and its corrections.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberError {
    pub why: &'static str,
    /// The corrections, the most probable first.
    pub write: Vec<String>,
}

/// A power of ten in handwriting.
const TIMES_TEN: &str = "x10^";

fn digits(text: &str) -> usize {
    text.len()
        - text
            .trim_start_matches(|next: char| next.is_ascii_digit())
            .len()
}

/// Length in bytes of the number at the start of `text`, with everything that was meant as part of it: `1_000`, `0x10`, `1,5`, `5.`,
/// `1.2.3`, `1 000`. A comma counts only outside brackets, a space only outside lists.
#[must_use]
pub fn extent(text: &str, comma: bool, blank: bool) -> usize {
    let hexadecimal = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"));
    if let Some(body) =
        hexadecimal.filter(|body| body.starts_with(|next: char| next.is_ascii_hexdigit()))
    {
        return 2 + body
            .find(|next: char| !(next.is_ascii_hexdigit() || next == '_'))
            .unwrap_or(body.len());
    }
    let digits_or_underscores = |text: &str| {
        text.find(|next: char| !(next.is_ascii_digit() || next == '_'))
            .unwrap_or(text.len())
    };
    let mut end = digits_or_underscores(text);
    while let Some(group) =
        grouped(&text[end..], blank).filter(|_| end <= 3 || text[..end].contains([' ', '\'', '’']))
    {
        end += group;
    }
    loop {
        let rest = &text[end..];
        let joined = rest.starts_with('.') || (comma && rest.starts_with(','));
        let fraction = if joined {
            digits_or_underscores(&rest[1..])
        } else {
            0
        };
        if fraction > 0 {
            end += 1 + fraction;
        } else if rest.starts_with('.') && !rest.starts_with("..") {
            end += 1;
            break;
        } else {
            break;
        }
    }
    let rest = &text[end..];
    if let Some(power) = rest.strip_prefix(TIMES_TEN) {
        let sign = usize::from(power.starts_with(['+', '-']));
        let power = digits(&power[sign..]);
        return if power > 0 {
            end + TIMES_TEN.len() + sign + power
        } else {
            end
        };
    }
    if let Some(power) = rest.strip_prefix(['d', 'D']) {
        let sign = usize::from(power.starts_with(['+', '-']));
        let power = digits(&power[sign..]);
        return if power > 0 {
            end + 1 + sign + power
        } else {
            end
        };
    }
    if rest.starts_with(['e', 'E']) {
        let sign = usize::from(rest[1..].starts_with(['+', '-']));
        let power = digits(&rest[1 + sign..]);
        let cut_short = !rest[1..].starts_with(|next: char| {
            next.is_ascii_alphanumeric() || matches!(next, '_' | '/' | '*' | '^')
        });
        if power > 0 || cut_short {
            end += 1 + sign + power;
        }
    }
    end
}

/// Length in bytes of a digit separator and the three digits after it: ` 000`, `'000`.
fn grouped(text: &str, blank: bool) -> Option<usize> {
    let mark = match text.chars().next()? {
        mark @ ('\'' | '’') => mark.len_utf8(),
        // A space of another sort was up to three bytes long.
        ' ' if blank => (text.len() - text.trim_start_matches(' ').len()).min(4),
        _ => return None,
    };
    let after = &text[mark..];
    let ends = after
        .get(3..)?
        .chars()
        .next()
        .is_none_or(|next| !next.is_ascii_alphanumeric() && next != '_');
    (mark < 4 && digits(after) == 3 && ends).then_some(mark + 3)
}

/// The error of a number with commas.
fn commas(written: &str) -> NumberError {
    let none = written.replace(',', "");
    let point = written.replace('.', "").replace(',', ".");
    let (whole, rest) = written.split_once(',').unwrap_or((written, ""));
    let thousands = (1..=3).contains(&whole.len())
        && whole != "0"
        && rest
            .split([',', '.'])
            .next()
            .is_some_and(|group| group.len() == 3);
    let many = rest.contains(',') || rest.contains('.');
    let (why, write) = match (thousands, many, whole.contains('.')) {
        (true, true, false) => ("digits in groups", vec![none]),
        (true, false, _) => ("comma in the number", vec![none, point]),
        _ => ("comma instead of a decimal point", vec![point]),
    };
    NumberError {
        why,
        write: write
            .into_iter()
            .filter(|text| error_of(text).is_none())
            .collect(),
    }
}

/// The error of the number `written`, if any.
#[must_use]
pub fn error_of(written: &str) -> Option<NumberError> {
    let error = |why, write: Option<String>| {
        Some(NumberError {
            why,
            write: write
                .filter(|text| error_of(text).is_none())
                .into_iter()
                .collect(),
        })
    };
    if written.len() > limits::NUMBER_CHARS {
        return error("more than 40 characters", None);
    }
    if let Some(body) = written
        .strip_prefix("0x")
        .or_else(|| written.strip_prefix("0X"))
    {
        let value = u64::from_str_radix(&body.replace('_', ""), 16).ok();
        return error("not a decimal number", value.map(|value| value.to_string()));
    }
    if let Some((mantissa, power)) = written.split_once(TIMES_TEN) {
        return error(
            "power of ten without `e`",
            Some(format!("{mantissa}e{power}")),
        );
    }
    if written.contains(['_', ' ', '\'', '’']) {
        return error(
            "digits in groups",
            Some(written.replace(['_', ' ', '\'', '’'], "")),
        );
    }
    if written.contains(',') {
        return Some(commas(written));
    }
    if written.contains(['d', 'D']) {
        return error(
            "power of ten without `e`",
            Some(written.replace(['d', 'D'], "e")),
        );
    }
    let (mantissa, power) = match written.split_once(['e', 'E']) {
        Some((mantissa, power)) => (mantissa, Some(power)),
        None => (written, None),
    };
    let scaled = |mantissa: &str| {
        power.map_or_else(
            || mantissa.to_owned(),
            |power| format!("{mantissa}e{power}"),
        )
    };
    if mantissa.starts_with('.') {
        return error(
            "no digit before the point",
            Some(scaled(&format!("0{mantissa}"))),
        );
    }
    if mantissa.ends_with('.') {
        return error(
            "no digit after the point",
            Some(scaled(mantissa.trim_end_matches('.'))),
        );
    }
    if mantissa.matches('.').count() > 1 {
        return error("more than one point", None);
    }
    if power.is_some_and(|power| digits(power.trim_start_matches(['+', '-'])) == 0) {
        return error("exponent without digits", Some(mantissa.to_owned()));
    }
    match written.parse::<f64>() {
        Ok(value) if !value.is_finite() => error("beyond the largest number, 1.8e308", None),
        Ok(value) if value == 0.0 && mantissa.contains(|digit| matches!(digit, '1'..='9')) => {
            error("too small to differ from zero", Some("0".to_owned()))
        }
        Ok(_) => None,
        Err(_) => error("not a number", None),
    }
}
