//! Numbers of a study's report. In: probabilities, intervals and values. Out: text: probabilities in percent, values in a readable unit.

use super::figures::percent;
use crate::report::document::Text;
use crate::report::wording::study as wording;
use crate::study::answers::{Ends, Probability};
use psd_plan::schema::{printed_unit, readable_result};
use psd_text::units::{Dimension, display};

/// The estimate, or both bounds; without failures an upper bound.
pub fn probability(found: Option<&Probability>) -> Text {
    found.map_or_else(|| "–".into(), |found| estimate(found).into())
}

/// The same in words.
pub fn estimate(found: &Probability) -> String {
    let Probability {
        bounds: [low, high],
        interval,
        ..
    } = found;
    if *high == 0.0 {
        wording::below(short_percent(interval[1]))
    } else if *low >= 1.0 {
        wording::above(short_percent(interval[0]))
    } else if low == high {
        short_percent(*low)
    } else {
        wording::between(short_percent(*low), short_percent(*high))
    }
}

/// The interval of a probability.
pub fn range(found: Option<&Probability>) -> Text {
    found.map_or_else(|| "–".into(), |it| percents(it.interval).into())
}

/// `0.24 % to 7.04 %`
pub fn percents([low, high]: [f64; 2]) -> String {
    wording::between(short_percent(low), short_percent(high))
}

/// Three significant digits.
pub fn short_percent(fraction: f64) -> String {
    if fraction == 0.0 || fraction == 1.0 {
        return percent(fraction);
    }
    display::join(
        &display::minus(&display::significant(100.0 * fraction, 3)),
        "%",
    )
}

/// A value and, below it, its interval in the same unit.
pub fn with_interval(
    result: &str,
    value: Option<f64>,
    interval: Ends,
    dimension: Dimension,
) -> Text {
    let Some(value) = value else {
        return "–".into();
    };
    let text = Text::from(readable_result(result, value, dimension));
    if interval == [None; 2] {
        return text;
    }
    let (_, factor) = printed_unit(result, value, dimension);
    let end = |end: Option<f64>, unbounded: &str| {
        end.map_or_else(
            || unbounded.to_owned(),
            |end| display::digits(end, factor, dimension),
        )
    };
    let low = end(interval[0], &format!("−{}", wording::UNBOUNDED));
    let high = end(interval[1], wording::UNBOUNDED);
    text.line().soft(format!("[{low}, {high}]"))
}

/// `0.61 [0.55, 0.67]`: two numbers without a unit.
pub fn index([low, high]: [f64; 2]) -> String {
    wording::between(decimals(low), decimals(high))
}

/// Three decimals.
pub fn decimals(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = if text == "-0.000" { "0.000" } else { &text };
    display::minus(text)
}
