//! Cells of the tables of `check --explain`. In: SI values. Out: strings.

use psd_plan::Interval;
use psd_plan::schema::limits;
use psd_text::units::Dimension;
use psd_text::units::display::{digits, join, readable, unit};

/// A row of fixed strings.
pub(super) fn row<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

/// `0 .. 1.000 mm`: both ends in the unit of the larger one.
pub(super) fn span(interval: Interval, dimension: Dimension) -> String {
    let finite = |end: f64| if end.is_finite() { end.abs() } else { 0.0 };
    let (unit, factor) = unit(finite(interval.low).max(finite(interval.high)), dimension);
    let shown = |end: f64| digits(end, factor, dimension);
    let text = match (interval.low.is_finite(), interval.high.is_finite()) {
        (true, true) => format!("{} .. {}", shown(interval.low), shown(interval.high)),
        (false, true) => format!("up to {}", shown(interval.high)),
        (true, false) => format!("from {}", shown(interval.low)),
        (false, false) => return "any".to_owned(),
    };
    join(&text, &unit)
}

/// The distance to the end that the run approaches.
pub(super) fn margin(
    name: &str,
    allowed: Interval,
    reached: Interval,
    dimension: Dimension,
) -> String {
    let rests = |allowed: f64, reached: f64| allowed == 0.0 && reached == 0.0;
    if name == limits::SPEED.name && allowed.high == reached.high {
        // Without a lower command the rig moves at its maximum speed.
        "none: at the speed limit".to_owned()
    } else if rests(allowed.low, reached.low) && rests(allowed.high, reached.high) {
        "none: at rest at the limit".to_owned()
    } else {
        readable(distance(name, allowed, reached), dimension)
    }
}

/// The distance to the end that the run approaches as a number, negative beyond it: to an end on the other side of zero from all
/// that was reached there is no motion. An absolute value has an upper end only.
pub(super) fn distance(name: &str, allowed: Interval, reached: Interval) -> f64 {
    let (above, below) = (allowed.high - reached.high, reached.low - allowed.low);
    let is_size = ![limits::DISPLACEMENT.name, limits::FORCE.name].contains(&name);
    match (reached.low < 0.0, reached.high > 0.0) {
        _ if is_size => above,
        (false, true) if below >= 0.0 => above,
        (true, false) if above >= 0.0 => below,
        _ => above.min(below),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_has_one_unit() {
        assert_eq!(
            span(
                Interval {
                    low: -2e-3,
                    high: 25e-3
                },
                Dimension::LENGTH
            ),
            "−2.000 .. 25.00 mm"
        );
        assert_eq!(
            span(
                Interval {
                    low: f64::NEG_INFINITY,
                    high: 12e3
                },
                Dimension::FORCE
            ),
            "up to 12.00 kN"
        );
        assert_eq!(
            span(
                Interval {
                    low: 0.0,
                    high: 0.01
                },
                Dimension::NUMBER
            ),
            "0 .. 0.01000"
        );
    }

    #[test]
    fn the_margin_is_that_of_the_end_that_is_approached() {
        let margin_of = |name, allowed: (f64, f64), reached: (f64, f64)| {
            let interval = |(low, high)| Interval { low, high };
            margin(
                name,
                interval(allowed),
                interval(reached),
                Dimension::LENGTH,
            )
        };
        assert_eq!(
            margin_of("displacement", (-1e-3, 0.1), (0.0, 0.04)),
            "60.00 mm"
        );
        assert_eq!(
            margin_of("displacement", (0.0, 0.1), (0.0, 0.04)),
            "60.00 mm"
        );
        assert_eq!(
            margin_of("displacement", (-0.1, 0.0), (-0.04, 0.0)),
            "60.00 mm"
        );
        assert_eq!(
            margin_of("displacement", (-0.05, 0.1), (-0.02, 0.04)),
            "30.00 mm"
        );
        assert_eq!(margin_of("increment", (0.0, 5e-3), (0.0, 4e-3)), "1.000 mm");
        assert_eq!(
            margin_of("speed", (0.0, 0.02), (0.0, 0.02)),
            "none: at the speed limit"
        );
    }
}
