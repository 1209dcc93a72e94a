//! Charts of an impact (paper, Figs. 9–11 and 16). In: the steps of one impact. Out: [`Chart`]s in SI.

use crate::procedures::stepping::energy::{EnergyCurve, nonzero_curves};
use crate::report::figures::chart::{
    Band, Chart, DASHED, DOTTED, Quantity, Reference, SOLID, Series, Style, palette,
};
use psd_physics::statistics::samples::peak;
use psd_plan::record::{ImpactHistory, ImpactStep, ImpactSteps, StepState};
use psd_text::units::Dimension;

/// Displacement of structure and striker, contact shaded, required bounds as lines.
pub(crate) fn displacement(history: &ImpactHistory, limits: &[Reference]) -> Chart {
    let mut chart = against_time(history, Quantity::of("Displacement", Dimension::LENGTH));
    let positions = || history.steps.iter().map(|step| step.computed);
    chart.series = vec![
        series(
            history,
            "structure X",
            |step| step.computed,
            Style::line(palette::BLUE, 2.0, SOLID),
        ),
        striker_near(
            history,
            positions(),
            Style::line(palette::VERMILION, 2.0, DASHED),
        ),
    ];
    chart.references = limits.to_vec();
    chart
}

/// The position of the striker, as long as it is near `positions`, those of the structure: a striker that moves away would reduce them
/// to a line.
pub(crate) fn striker_near(
    history: &ImpactHistory,
    positions: impl Iterator<Item = f64>,
    style: Style,
) -> Series {
    let (low, high) = positions.fold((0.0_f64, 0.0_f64), |(low, high), position| {
        (low.min(position), high.max(position))
    });
    let around = high - low;
    let near = |position: f64| position >= low - around && position <= high + around;
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
        .pairs()
        .flat_map(|(before, step)| {
            [
                (before.time, step.contact_force),
                (step.time, step.contact_force),
            ]
        })
        .collect();
    chart.series = vec![Series {
        label: "contact force F".to_owned(),
        points,
        style: Style::line(palette::BLUE, 1.5, SOLID),
    }];
    chart.references = limits.to_vec();
    chart
}

pub(crate) fn force_displacement(history: &ImpactHistory) -> Chart {
    let points = history
        .steps
        .iter()
        .map(|step| (step.command, step.restoring_force))
        .collect();
    Chart::of(
        Quantity::along("Displacement X", Dimension::LENGTH),
        Quantity::of("Restoring force R", Dimension::FORCE),
        vec![Series {
            label: "measured R".to_owned(),
            points,
            style: Style::line(palette::BLUE, 1.8, SOLID),
        }],
    )
}

/// The parts of the balance and their total; a part that is 0 throughout is not drawn.
pub(crate) fn energy(history: &ImpactHistory, contact: &'static str) -> Chart {
    let parts = [
        EnergyCurve::new(
            "striker",
            |step: &ImpactStep| step.energies.striker,
            Style::line(palette::VERMILION, 2.0, DASHED),
        ),
        EnergyCurve::new(
            "structure",
            |step: &ImpactStep| step.energies.structure,
            Style::line(palette::SKY, 1.6, SOLID),
        ),
        EnergyCurve::restoring(|step: &ImpactStep| step.energies.restoring),
        EnergyCurve::damping(|step: &ImpactStep| step.energies.damping),
        EnergyCurve::new(
            contact,
            |step: &ImpactStep| step.energies.contact_loss,
            Style::line(palette::GREEN, 2.2, DOTTED),
        ),
        EnergyCurve::weights(|step: &ImpactStep| step.energies.gravity),
    ];
    let total = |step: &ImpactStep| {
        let e = step.energies;
        e.striker + e.structure + e.restoring + e.damping + e.contact_loss
    };
    let mut chart = against_time(history, Quantity::of("Energy", Dimension::ENERGY));
    chart.series = nonzero_curves(&history.steps.iter(), |step| step.time, parts);
    chart.series.push(series(
        history,
        "total",
        total,
        Style::line(palette::BLACK, 1.2, SOLID),
    ));
    chart
}

/// The tracking error, and the tracking indicator as a length: divided by the largest command.
pub(crate) fn tracking(history: &ImpactHistory) -> Chart {
    let mut chart = against_time(history, Quantity::of("Tracking error", Dimension::LENGTH));
    let largest = peak(history.steps.iter().map(|step| step.command));
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

/// A chart over simulated time with the contact shaded, still without series.
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
fn periods(steps: &ImpactSteps, state: StepState) -> Vec<(f64, f64)> {
    let time = |index: usize| steps.get(index).map_or(f64::NAN, |step| step.time);
    let mut periods = Vec::new();
    let mut last = 0;
    for alike in steps
        .states()
        .get(1..)
        .unwrap_or_default()
        .chunk_by(StepState::eq)
    {
        let before = last;
        last += alike.len();
        if alike[0] == state {
            periods.push((time(before), time(last)));
        }
    }
    periods
}

pub(crate) fn series(
    history: &ImpactHistory,
    label: &str,
    read: impl Fn(&ImpactStep) -> f64,
    style: Style,
) -> Series {
    Series {
        label: label.to_owned(),
        points: history
            .steps
            .iter()
            .map(|step| (step.time, read(&step)))
            .collect(),
        style,
    }
}
