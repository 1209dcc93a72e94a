//! Whether a striker arrives at all: the time to cross its gap against the duration of the impact. In: striker and duration, SI. Out: an
//! error if the impact is over before the contact begins. It knows neither specimen nor contact.

use crate::codes::E638;
use psd_language::check::checker::Checker;
use psd_language::check::wording::{shown, time};
use psd_plan::Striker;
use psd_plan::schema::{Kind, methods, striker};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;
use psd_text::units::Dimension;

/// The time in which a striker crosses its gap, s: t of gap = v t + g t²/2.
fn time_to_arrive(striker: &Striker) -> f64 {
    let reached =
        (striker.velocity * striker.velocity + 2.0 * striker.gravity * striker.gap).sqrt();
    2.0 * striker.gap / (striker.velocity + reached)
}

/// `gap` and `velocity` as text, `arrives` and `duration` in \[s\].
#[derive(Violation)]
#[violation(
    E638,
    "`{striker}` never arrives: it takes {} for its gap of {gap}",
    time(arrives),
    gap = shown(gap, Dimension::LENGTH)
)]
#[help("reduce the `gap`, or increase the `duration`")]
struct NeverArrives<'a> {
    striker: &'a str,
    gap: f64,
    #[label("ends after {}", time(duration))]
    duration_at: Span,
    arrives: f64,
    duration: f64,
    #[label("{gap} before the specimen", gap = shown(gap, Dimension::LENGTH))]
    gap_at: Span,
}

/// Refuses a striker that does not cross its gap within the `duration` \[s\] of the impact `block`.
pub(crate) fn check(checker: &mut Checker, block: usize, striker: &Striker, duration: Option<f64>) {
    let arrives = time_to_arrive(striker);
    let Some(duration) = duration.filter(|duration| arrives >= *duration) else {
        return;
    };
    let Some((_, at)) = checker.field(block, methods::DURATION.name) else {
        return;
    };
    let declared = checker
        .scope
        .of_kind(Kind::Striker)
        .find(|(_, it)| it.name.is_some_and(|name| name.node == striker.name));
    let gap = declared.and_then(|(declared, _)| checker.field(declared, striker::GAP.name));
    let Some((_, gap)) = gap else { return };
    checker.report(NeverArrives {
        striker: &striker.name,
        gap: striker.gap,
        gap_at: gap.span,
        arrives,
        duration,
        duration_at: at.span,
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_to_arrive_is_that_of_uniform_acceleration() {
        let striker = |velocity, gap, gravity| Striker {
            name: String::new(),
            mass: 1.0,
            mass_uncertainty: 0.0,
            velocity,
            velocity_uncertainty: 0.0,
            gap,
            gravity,
        };
        assert_eq!(time_to_arrive(&striker(2.0, 3.0, 0.0)), 1.5);
        assert_eq!(time_to_arrive(&striker(2.0, 0.0, 9.81)), 0.0);
        // 1 m/s and 10 m/s²: after 1 s it has moved 1 m + 5 m.
        assert!((time_to_arrive(&striker(1.0, 6.0, 10.0)) - 1.0).abs() < 1e-12);
    }
}
