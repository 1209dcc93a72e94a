//! The check of the damping of a frame. In: a block. Out: damping ratios with their uncertainty, or errors. It knows no striker and no
//! ground.

use crate::codes::E639;
use psd_language::check::checker::{Checker, Shape};
use psd_language::check::violations::ListForNumber;
use psd_plan::ShakeDamping;
use psd_plan::formula::Formula;
use psd_plan::schema::frames;
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::display::significant;

/// One number is for Rayleigh damping; a list has one ratio for each mode.
pub fn damping(checker: &mut Checker, block: usize) -> Option<ShakeDamping> {
    let Some((entry, written)) = checker.field(block, frames::DAMPING_RATIO.name) else {
        return Some(ShakeDamping::Rayleigh(Formula::Constant(0.0)));
    };
    let typed = checker.entry(block, entry, written.value.span)?;
    Some(match typed.shape {
        Shape::Number => ShakeDamping::Rayleigh(typed.formula),
        Shape::List if matches!(typed.formula, Formula::List(_)) => {
            ShakeDamping::Modal(typed.parts())
        }
        Shape::List => {
            return checker.fail(ListForNumber {
                span: written.value.span,
            });
        }
    })
}

/// A damping ratio below 0 within its uncertainty.
struct DampingTooUncertain {
    uncertainty: f64,
    least: f64,
    span: Span,
}

impl Violation for DampingTooUncertain {
    const CODE: Code = E639;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            uncertainty,
            least,
            span,
        } = self;
        let percent = |number: f64| format!("{} %", significant(100.0 * number, 2));
        let of = format!(
            "damping ratio minus its uncertainty is below 0: {}",
            percent(least)
        );
        Diagnostic::new(Self::CODE, format!("minus its uncertainty, {of}"))
        .at(span, format!("standard uncertainty: {}", percent(uncertainty)))
        .help("write an uncertainty up to the damping ratio; for a rectangular distribution on 0 .. ζ it is ζ / (2 √3)")
    }
}

/// Standard uncertainty of each ratio: no ratio minus its uncertainty is below 0.
pub fn damping_uncertainty(
    checker: &mut Checker,
    block: usize,
    damping: Option<&ShakeDamping>,
) -> Option<f64> {
    const FIELD: &str = frames::DAMPING_UNCERTAINTY.name;
    let uncertainty = checker.constant(block, FIELD)?;
    let ratios = match damping? {
        ShakeDamping::Rayleigh(ratio) => std::slice::from_ref(ratio),
        ShakeDamping::Modal(ratios) => ratios,
    };
    let least = ratios.iter().filter_map(Formula::constant).reduce(f64::min);
    match (
        least.filter(|least| uncertainty > *least),
        checker.field(block, FIELD),
    ) {
        (Some(least), Some((_, entry))) => {
            let at = entry.value.span;
            checker.fail(DampingTooUncertain {
                uncertainty,
                least,
                span: at,
            })
        }
        _ => Some(uncertainty),
    }
}
