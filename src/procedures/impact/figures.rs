//! Charts of an impact (paper, Figs. 9–11 and 16). In: the steps of one impact. Out: [`Chart`]s in SI.

use crate::plan::formula::{Formula, Function, Part, ProcedureId};
use crate::plan::{Contact, ProcedureKind};
use crate::record::{ImpactHistory, ImpactStep, StepState};
use crate::report::Run;
use crate::report::figures::chart::{
    Band, Chart, DASH_DOT, DASHED, DOTTED, LONG, Quantity, Reference, SOLID, Series, Style, palette,
};
use crate::report::number;
use crate::units::Dimension;
use crate::verdict::Bound;

/// Displacement of structure and striker, contact shaded, required bounds as lines.
pub(crate) fn displacement(history: &ImpactHistory, limits: &[Reference]) -> Chart {
    let mut chart = against_time(history, Quantity::of("Displacement", Dimension::LENGTH));
    let places = || history.steps.iter().map(|step| step.computed);
    chart.series = vec![
        series(
            history,
            "structure X",
            |step| step.computed,
            Style::line(palette::BLUE, 2.0, SOLID),
        ),
        striker_near(
            history,
            places(),
            Style::line(palette::VERMILION, 2.0, DASHED),
        ),
    ];
    chart.references = limits
        .iter()
        .map(|limit| Reference {
            label: limit.label.clone(),
            y: limit.y,
        })
        .collect();
    chart
}

/// Where the striker is, as long as it is near `places`, those of the structure: one that flies away would leave no room
/// to see them.
pub(crate) fn striker_near(
    history: &ImpactHistory,
    places: impl Iterator<Item = f64>,
    style: Style,
) -> Series {
    let (low, high) = places.fold((0.0_f64, 0.0_f64), |(low, high), place| {
        (low.min(place), high.max(place))
    });
    let around = high - low;
    let near = |place: f64| place >= low - around && place <= high + around;
    let steps = &history.steps;
    let shown = steps
        .iter()
        .rposition(|step| near(step.striker_displacement))
        .map_or(steps.len(), |last| last + 1);
    let points = steps
        .iter()
        .take(shown)
        .map(|step| (step.time, step.striker_displacement))
        .collect();
    Series {
        label: "striker Xs".to_owned(),
        points,
        style,
    }
}

pub(crate) fn velocity(history: &ImpactHistory) -> Chart {
    let mut chart = against_time(history, Quantity::of("Velocity", Dimension::VELOCITY));
    chart.series = vec![
        series(
            history,
            "structure",
            |step| step.velocity,
            Style::line(palette::BLUE, 1.6, SOLID),
        ),
        series(
            history,
            "striker",
            |step| step.striker_velocity,
            Style::line(palette::VERMILION, 2.0, DASHED),
        ),
    ];
    chart
}

pub(crate) fn striker_velocity(history: &ImpactHistory) -> Chart {
    let mut chart = against_time(
        history,
        Quantity::of("Striker velocity", Dimension::VELOCITY),
    );
    chart.series = vec![series(
        history,
        "striker",
        |step| step.striker_velocity,
        Style::line(palette::VERMILION, 2.0, SOLID),
    )];
    chart
}

/// The contact force is a mean over its step, so that it is drawn as steps.
pub(crate) fn contact_force(history: &ImpactHistory, limits: &[Reference]) -> Chart {
    let mut chart = against_time(history, Quantity::of("Contact force", Dimension::FORCE));
    let points = history
        .steps
        .windows(2)
        .flat_map(|pair| {
            [
                (pair[0].time, pair[1].contact_force),
                (pair[1].time, pair[1].contact_force),
            ]
        })
        .collect();
    chart.series = vec![Series {
        label: "contact force F".to_owned(),
        points,
        style: Style::line(palette::BLUE, 1.5, SOLID),
    }];
    chart.references = limits
        .iter()
        .map(|limit| Reference {
            label: limit.label.clone(),
            y: limit.y,
        })
        .collect();
    chart
}

pub(crate) fn force_displacement(history: &ImpactHistory) -> Chart {
    let points = history
        .steps
        .iter()
        .map(|step| (step.command, step.restoring_force))
        .collect();
    Chart {
        x: Quantity::along("Displacement X", Dimension::LENGTH),
        y: Quantity::of("Restoring force R", Dimension::FORCE),
        bands: Vec::new(),
        series: vec![Series {
            label: "measured R".to_owned(),
            points,
            style: Style::line(palette::BLUE, 1.8, SOLID),
        }],
        references: Vec::new(),
    }
}

/// Name, reading and style of one energy.
type EnergyPart = (&'static str, fn(&ImpactStep) -> f64, Style);

/// What became of the energy that the contact took: a spring gives back what it stored, every other law loses it.
pub(crate) fn taken_by_contact(run: &Run<'_>, procedure: ProcedureId) -> &'static str {
    let contact = match run
        .plan
        .procedures
        .get(procedure.0)
        .map(|procedure| &procedure.kind)
    {
        Some(ProcedureKind::Impact(impact)) => &impact.contact,
        Some(ProcedureKind::StoreyImpact(impact)) => &impact.contact,
        _ => return "taken by the contact",
    };
    match contact {
        Contact::Hertz {
            loss,
            force_limit: None,
            ..
        } if loss.constant() == Some(0.0) => "stored in the contact",
        Contact::Hertz { .. } => "stored and lost in the contact",
        Contact::Rigid | Contact::Limit { .. } | Contact::Restitution { .. } => {
            "lost in the contact"
        }
    }
}

/// The parts of the balance and their total; damping and what the contact took only where there is any.
pub(crate) fn energy(history: &ImpactHistory, contact: &'static str) -> Chart {
    let mut chart = against_time(history, Quantity::of("Energy", Dimension::ENERGY));
    let parts: [EnergyPart; 5] = [
        (
            "striker",
            |step| step.energies.striker,
            Style::line(palette::VERMILION, 2.0, DASHED),
        ),
        (
            "structure",
            |step| step.energies.structure,
            Style::line(palette::SKY, 1.6, SOLID),
        ),
        (
            "restoring",
            |step| step.energies.restoring,
            Style::line(palette::BLUE, 2.0, LONG),
        ),
        (
            "damping",
            |step| step.energies.damping,
            Style::line(palette::PURPLE, 2.0, DASH_DOT),
        ),
        (
            contact,
            |step| step.energies.contact_loss,
            Style::line(palette::GREEN, 2.2, DOTTED),
        ),
    ];
    let drawn = parts
        .into_iter()
        .filter(|(_, read, _)| history.steps.iter().any(|step| read(step) != 0.0));
    chart.series = drawn
        .map(|(label, read, style)| series(history, label, read, style))
        .collect();
    let total = |step: &ImpactStep| {
        let e = step.energies;
        e.striker + e.structure + e.restoring + e.damping + e.contact_loss
    };
    chart.series.push(series(
        history,
        "total",
        total,
        Style::line(palette::BLACK, 1.2, SOLID),
    ));
    chart
}

/// What the actuator missed, and the tracking indicator as a length: over the largest command.
pub(crate) fn tracking(history: &ImpactHistory) -> Chart {
    let mut chart = against_time(history, Quantity::of("Tracking error", Dimension::LENGTH));
    let largest = history
        .steps
        .iter()
        .map(|step| step.command.abs())
        .fold(0.0, f64::max);
    let missed = |step: &ImpactStep| step.displacement - step.command;
    chart.series = vec![series(
        history,
        "measured − commanded",
        missed,
        Style::line(palette::BLUE, 1.5, SOLID),
    )];
    if largest > 0.0 {
        let points = history
            .steps
            .iter()
            .map(|step| (step.time, step.tracking.indicator / largest))
            .collect();
        let style = Style::line(palette::VERMILION, 2.0, DASHED);
        chart.series.push(Series {
            label: "tracking indicator / largest command".to_owned(),
            points,
            style,
        });
    }
    chart
}

/// Bounds that a requirement sets on a result of one procedure, for that result's figure.
pub(crate) fn limits_on(run: &Run<'_>, procedure: ProcedureId, result: &str) -> Vec<Reference> {
    let mut lines = Vec::new();
    for (requirement, outcome) in run
        .plan
        .requirements
        .iter()
        .zip(&run.assessment.requirements)
    {
        for (condition, held) in requirement.conditions.iter().zip(&outcome.conditions) {
            if !reads(&condition.value, procedure, result) {
                continue;
            }
            // A band is two lines with one text, so that two texts never stand on each other.
            let entry =
                entry(&condition.value).map_or_else(String::new, |entry| format!(" ({entry})"));
            let label = format!(
                "{}{entry}: {}",
                short(&requirement.label),
                number::bound(held)
            );
            match held.bound {
                Some(Bound::Compare { limit, .. }) => lines.push(Reference { label, y: limit }),
                Some(Bound::Within { target, tolerance }) => {
                    lines.push(Reference {
                        label,
                        y: target - tolerance,
                    });
                    lines.push(Reference {
                        label: String::new(),
                        y: target + tolerance,
                    });
                }
                None => {}
            }
        }
    }
    lines.retain(|line| line.y.is_finite());
    lines
}

/// Which entry of a list a condition is on, from 1; none where it is on all of them.
fn entry(value: &Formula) -> Option<usize> {
    if let Formula::Index(_, index) = value {
        Some(index + 1)
    } else {
        None
    }
}

/// Whether a condition is on the value of this result, or on the largest entry of it where it is a list. A bound on its
/// uncertainty is none on what is drawn.
fn reads(value: &Formula, procedure: ProcedureId, result: &str) -> bool {
    let is = |formula: &Formula| {
        formula
            .as_result()
            .is_some_and(|r| r.procedure == procedure && r.name == result && r.part == Part::Value)
    };
    match value {
        Formula::Call(Function::Max, arguments) => arguments.iter().all(is),
        Formula::Index(list, _) => is(list),
        other => is(other),
    }
}

/// A label that fits into a picture, on one line.
fn short(label: &str) -> String {
    const LONGEST: usize = 40;
    // As it is drawn, so that its room is that of what is drawn.
    let label = crate::text::glyphs::shown(label);
    let mut text: String = label
        .chars()
        .take(LONGEST)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if label.chars().count() > LONGEST {
        text.push('…');
    }
    text
}

/// A chart over virtual time with the contact shaded, still without series.
pub(crate) fn against_time(history: &ImpactHistory, y: Quantity) -> Chart {
    let band = |label, state, colour| Band {
        label,
        intervals: periods(&history.steps, state),
        colour,
    };
    Chart {
        x: Quantity::time(),
        y,
        bands: vec![
            band("contact", StepState::Contact, palette::CONTACT),
            band("limit force", StepState::Limit, palette::LIMIT),
        ],
        series: Vec::new(),
        references: Vec::new(),
    }
}

/// The intervals of time spent in `state`: a step's state holds from the step before to it.
fn periods(steps: &[ImpactStep], state: StepState) -> Vec<(f64, f64)> {
    let mut periods: Vec<(f64, f64)> = Vec::new();
    for pair in steps.windows(2).filter(|pair| pair[1].state == state) {
        match periods.last_mut() {
            Some(last) if last.1 == pair[0].time => last.1 = pair[1].time,
            _ => periods.push((pair[0].time, pair[1].time)),
        }
    }
    periods
}

pub(crate) fn series(
    history: &ImpactHistory,
    label: &str,
    read: fn(&ImpactStep) -> f64,
    style: Style,
) -> Series {
    Series {
        label: label.to_owned(),
        points: history
            .steps
            .iter()
            .map(|step| (step.time, read(step)))
            .collect(),
        style,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::formula::ResultReference;

    #[test]
    fn a_bound_on_an_uncertainty_is_no_line_among_the_values() {
        let (procedure, name) = (ProcedureId(0), "max_drift");
        let result = |part| {
            Formula::Result(ResultReference {
                procedure,
                name,
                part,
            })
        };
        assert!(reads(&result(Part::Value), procedure, name));
        assert!(!reads(&result(Part::Uncertainty), procedure, name));
        assert!(
            !reads(&result(Part::Value), ProcedureId(1), name)
                && !reads(&result(Part::Value), procedure, "periods")
        );
        let second = Formula::Index(Box::new(result(Part::Value)), 1);
        assert!(
            reads(&second, procedure, name)
                && entry(&second) == Some(2)
                && entry(&result(Part::Value)).is_none()
        );
        assert!(!reads(
            &Formula::Index(Box::new(result(Part::Uncertainty)), 1),
            procedure,
            name
        ));
    }
}
