//! How an impact was integrated and followed: the integrator, what was corrected, the mode, and what tracking did to the
//! energy. In: a run's procedure. Out: one paragraph. These are items of the method, not deviations from it.

use super::super::document::Block;
use super::super::{Run, number};
use crate::mechanics::monitor::Tracking;
use crate::plan::{Impact, Integrator, Mode, ProcedureKind};
use crate::quantity::Dimension;
use crate::record::ImpactHistory;

/// Errors below this, m, are rounding.
pub(super) const NOTHING: f64 = 1e-12;

pub(super) fn note(run: &Run<'_>, index: usize, history: &ImpactHistory, body: &mut Vec<Block>) {
    let Some(ProcedureKind::Impact(impact)) = run.plan.procedures.get(index).map(|planned| &planned.kind) else { return };
    let mut sentences = vec![integrator(impact)];
    sentences.extend(driven(impact.stepping.i_modification, impact.stepping.mode));
    sentences.extend(tracking(history));
    body.push(Block::paragraph(sentences.join(" ")));
}

/// How the actuators went, and what was made of the readings.
pub(super) fn driven(i_modification: bool, mode: Mode) -> Vec<String> {
    let mut sentences = Vec::new();
    if i_modification {
        sentences.push(
            "The force was corrected to where the specimen was to be, r* = r − K(d measured − d commanded), with the initial \
             stiffness (I-modification)."
                .to_owned(),
        );
    }
    if let Mode::Continuous { time_scale } = mode {
        sentences.push(format!(
            "The actuator did not stop at the steps: it moved at {} times the virtual time, and what a damper of the specimen does \
             at that speed is in the restoring force.",
            number::text(time_scale, Dimension::NUMBER)
        ));
    }
    sentences
}

fn integrator(impact: &Impact) -> String {
    let unstable = if impact.stepping.allow_unstable { " The plan allows a time step beyond its stability limit." } else { "" };
    let named = match impact.stepping.integrator {
        Integrator::Tangent => {
            "constant average acceleration with the measured tangent stiffness (Melo et al. 2006, eqs. 2 to 6)"
        }
        Integrator::Explicit => "explicit Newmark, stable up to the period over π",
        Integrator::AlphaOs { alpha } => {
            let alpha = number::stated(alpha, Dimension::NUMBER);
            return format!(
                "Integrator: α-operator splitting, α = {alpha}, with the initial stiffness at the high end of its interval.{unstable}"
            );
        }
    };
    format!("Integrator: {named}.{unstable}")
}

fn tracking(history: &ImpactHistory) -> Option<String> {
    let (first, last) = (history.steps.first()?, history.steps.last()?);
    Some(followed(last.tracking, last.tracking.share_of(first.energies.striker), "The actuator"))
}

/// What following wrongly did, where it did anything that can be told from rounding; `share` is that of the input energy, signed.
pub(super) fn followed(found: Tracking, share: Option<f64>, who: &str) -> String {
    if found.peak_error < NOTHING {
        return format!("{who} stood at every target.");
    }
    let energy = share.map_or_else(String::new, |share| {
        let does = if share < 0.0 { "put into the test" } else { "taken out of it" };
        format!(
            ", energy {does} by following wrongly {}\u{a0}% of the input",
            number::text(100.0 * share.abs(), Dimension::NUMBER)
        )
    });
    format!(
        "Tracking: largest error {}, NRMS error {}\u{a0}%{energy}.",
        number::text(found.peak_error, Dimension::LENGTH),
        number::text(100.0 * found.nrms_error, Dimension::NUMBER)
    )
}
