//! A finding as text: name, old and new value, difference, first position, count, and tolerance. In: a finding, SI. Out: text in readable
//! units.

use crate::golden::finding::{Change, Count, Finding, Moved, RowRef};
use psd_text::units::Dimension;
use psd_text::units::display::{join, minus, readable, significant, trimmed, unit};

/// A finding, ready to be arranged in columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Words {
    pub part: &'static str,
    pub name: String,
    /// For example `7.880 mm → 7.912 mm`.
    pub change: String,
    /// For example `+32.0 µm  +0.406 %`; empty if there is no number.
    pub by: String,
    /// Position, count and tolerance; may be empty.
    pub detail: String,
}

impl Words {
    #[must_use]
    pub fn of(finding: &Finding) -> Self {
        let (change, by, detail) = match &finding.change {
            Change::Moved(moved) => (pair(moved), by(moved), detail(moved)),
            Change::Text { was, is, first } => {
                let detail = first.as_ref().map_or_else(String::new, |(at, count)| {
                    format!("first at {}; {}", row_text(*at), counted(*count, "rows"))
                });
                (texts(was, is), String::new(), detail)
            }
            Change::Missing => (
                "accepted, but missing now".to_owned(),
                String::new(),
                String::new(),
            ),
            Change::New => (
                "new: not in the accepted results".to_owned(),
                String::new(),
                String::new(),
            ),
            Change::Length { of, was, is } => {
                #[expect(clippy::cast_possible_wrap, reason = "far fewer than 2^63")]
                let more = *is as i64 - *was as i64;
                (
                    format!("{was} → {is} {of}"),
                    minus(&format!("{more:+}")),
                    String::new(),
                )
            }
        };
        Self {
            part: finding.part.name(),
            name: finding.name.clone(),
            change,
            by,
            detail,
        }
    }

    /// The whole text in one line.
    #[must_use]
    pub fn line(&self) -> String {
        let parts = [self.name.as_str(), &self.change, &self.by]
            .into_iter()
            .filter(|part| !part.is_empty());
        let line = parts.collect::<Vec<_>>().join("  ");
        if self.detail.is_empty() {
            line
        } else {
            format!("{line}  ({})", self.detail)
        }
    }
}

/// Old and new value, with enough digits to distinguish them.
fn pair(moved: &Moved) -> String {
    const FEWEST: f64 = 4.0;
    const MOST: f64 = 17.0;
    let size = moved
        .was
        .unwrap_or(0.0)
        .abs()
        .max(moved.is.unwrap_or(0.0).abs());
    let (unit, factor) = unit(size, moved.dimension);
    let apart = moved.by().map_or(1.0, |by| by.abs() / size);
    let wanted = if apart > 0.0 {
        (2.0 - apart.log10().floor()).clamp(FEWEST, MOST)
    } else {
        FEWEST
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to a few digits"
    )]
    let digits = wanted as usize;
    let number = |value: Option<f64>| {
        value.map_or_else(
            || "no value".to_owned(),
            |value| {
                let is_count = moved.dimension == Dimension::NUMBER
                    && value.fract() == 0.0
                    && value.abs() < 1e9;
                let text = if is_count {
                    format!("{value}")
                } else {
                    significant(value / factor, digits)
                };
                join(&minus(&text), &unit)
            },
        )
    };
    format!("{} → {}", number(moved.was), number(moved.is))
}

/// Above it, as from a probability of nearly 0 to 1, a percentage says nothing.
const LARGEST_FRACTION: f64 = 100.0;

fn by(moved: &Moved) -> String {
    let Some(by) = moved.by() else {
        return String::new();
    };
    let (unit, factor) = unit(by, moved.dimension);
    let signed = |value: f64, digits: usize| {
        let text = significant(value, digits);
        minus(&if value > 0.0 {
            format!("+{text}")
        } else {
            text
        })
    };
    let absolute = join(&signed(by / factor, 3), &unit);
    match moved.by_fraction() {
        Some(fraction) if fraction.abs() <= LARGEST_FRACTION => {
            format!("{absolute}  {} %", signed(100.0 * fraction, 3))
        }
        _ => absolute,
    }
}

fn detail(moved: &Moved) -> String {
    let mut parts = Vec::new();
    if let (Some(largest), Some(first)) = (moved.largest, moved.first) {
        if largest.row == first.row {
            parts.push(format!("first at {}", row_text(first)));
        } else {
            parts.push(format!(
                "largest at {}, first at {}",
                row_text(largest),
                row_text(first)
            ));
        }
    }
    parts.extend(moved.count.map(|count| {
        counted(
            count,
            if moved.first.is_some_and(|at| at.step.is_some()) {
                "rows"
            } else {
                "points"
            },
        )
    }));
    parts.push(format!("tolerance {}", tolerance(moved)));
    parts.join("; ")
}

/// The tolerance: the wider of the two bounds.
fn tolerance(moved: &Moved) -> String {
    let relative = moved.rule.relative * moved.scale;
    if moved.rule.absolute > relative {
        return readable(moved.rule.absolute, moved.dimension);
    }
    let share = moved.rule.relative;
    let share = if share >= 1e-5 {
        format!("{} %", trimmed(&significant(100.0 * share, 3)))
    } else {
        minus(&trimmed(&format!("{share:.2e}")))
    };
    if moved.count.is_some() {
        format!(
            "{share} of the largest, {}",
            readable(moved.scale, moved.dimension)
        )
    } else {
        format!("{share} of {}", readable(moved.scale, moved.dimension))
    }
}

fn counted(count: Count, what: &str) -> String {
    format!("{} of {} {what}", count.moved, count.of)
}

fn row_text(at: RowRef) -> String {
    let step = at.step.map_or_else(
        || format!("point {}", at.row + 1),
        |step| format!("step {step}"),
    );
    match at.time {
        Some(time) => format!("{step}, {}", readable(time, Dimension::TIME)),
        None => step,
    }
}

/// Two texts on one line: short ones in full, long ones from their first difference.
fn texts(was: &str, is: &str) -> String {
    const LONGEST: usize = 60;
    let parting = was
        .chars()
        .zip(is.chars())
        .take_while(|(was, is)| was == is)
        .count();
    let from = if was.chars().count().max(is.chars().count()) <= LONGEST {
        0
    } else {
        parting.saturating_sub(LONGEST / 4)
    };
    let piece = |text: &str| {
        let piece: String = text
            .chars()
            .skip(from)
            .take(LONGEST)
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let more = text.chars().count() > from + LONGEST;
        format!(
            "\"{}{piece}{}\"",
            if from > 0 { "…" } else { "" },
            if more { "…" } else { "" }
        )
    };
    format!("{} → {}", piece(was), piece(is))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::finding::FindingPart;
    use crate::golden::tolerance::Rule;

    fn moved(was: Option<f64>, is: Option<f64>, dimension: Dimension) -> Moved {
        let rule = Rule {
            relative: 1e-9,
            absolute: 1e-12,
        };
        Moved {
            dimension,
            was,
            is,
            rule,
            scale: 0.007_912,
            largest: None,
            first: None,
            count: None,
        }
    }

    fn words(change: Change) -> Words {
        Words::of(&Finding::new(
            FindingPart::Result,
            "hit.max_displacement",
            change,
        ))
    }

    #[test]
    fn a_number_reads_in_the_units_of_the_lab_and_with_the_digits_that_differ() {
        let worded = words(Change::Moved(moved(
            Some(0.007_88),
            Some(0.007_912),
            Dimension::LENGTH,
        )));
        assert_eq!(
            (worded.change.as_str(), worded.by.as_str()),
            ("7.8800 mm → 7.9120 mm", "+32.0 µm  +0.406 %")
        );
        assert_eq!(worded.detail, "tolerance 1 × 10⁻⁹ of 7.912 mm");
        let near = words(Change::Moved(moved(
            Some(1000.0),
            Some(1000.0 + 1e-4),
            Dimension::FORCE,
        )));
        assert_eq!(
            (near.change.as_str(), near.by.as_str()),
            (
                "1.000000000 kN → 1.000000100 kN",
                "+0.0001000 N  +1.00 × 10⁻⁵ %"
            )
        );
        let gone = words(Change::Moved(moved(Some(3.0), None, Dimension::NUMBER)));
        assert_eq!(
            (gone.change.as_str(), gone.by.as_str()),
            ("3 → no value", "")
        );
    }

    #[test]
    fn a_column_states_positions_and_number_of_differences() {
        let at = |row, step, time| {
            Some(RowRef {
                row,
                step: Some(step),
                time: Some(time),
            })
        };
        let column = Moved {
            largest: at(12, 12, 0.006),
            first: at(3, 3, 0.0015),
            count: Some(Count { moved: 15, of: 27 }),
            ..moved(Some(-0.002), Some(-0.003), Dimension::LENGTH)
        };
        let worded = words(Change::Moved(column));
        assert_eq!(
            (worded.change.as_str(), worded.by.as_str()),
            ("−2.000 mm → −3.000 mm", "−1.00 mm  −50.0 %")
        );
        assert_eq!(
            worded.detail,
            "largest at step 12, 6.000 ms, first at step 3, 1.500 ms; 15 of 27 rows; tolerance 1 × 10⁻⁹ of the largest, 7.912 mm"
        );
    }

    #[test]
    fn long_texts_are_shown_where_they_part() {
        assert_eq!(texts("pass", "fail"), "\"pass\" → \"fail\"");
        let long = "x".repeat(100);
        assert!(texts(&format!("{long}a"), &format!("{long}b")).ends_with("xb\""));
        assert_eq!(
            words(Change::Length {
                of: "rows",
                was: 27,
                is: 26
            })
            .line(),
            "hit.max_displacement  27 → 26 rows  −1"
        );
    }
}
