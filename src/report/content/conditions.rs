//! Conditions of the test: temperature and the like, time, the item, the striker, limits and parameters. In: a run. Out:
//! blocks. What was not given is said to be so, and what the plan states and nobody measured is marked.

use super::super::document::{Block, Text};
use super::super::{Run, number};
use super::{described, pairs, particulars, words};
use crate::plan::{Interval, Settle, Specimen, Striker};
use crate::procedures::{self, base_excitation};
use crate::record::equipment::HeldLimit;
use crate::report::specimen_text;
use crate::units::Dimension;

/// Everything about how the test was set up.
pub(super) fn all(run: &Run<'_>, body: &mut Vec<Block>) {
    body.push(Block::section("Conditions of the test"));
    body.push(Block::Pairs {
        rows: particulars::others(run),
    });
    time_scale(run, body);
    body.push(Block::note(
        "A pseudo-dynamic test loads the specimen slowly: effects of strain rate, and of the inertia of the specimen beyond the \
         equivalent mass, are not in the measured force.",
    ));
    let stated =
        |name: String| Text::from(name).soft(" · as the plan states, not measured in this run");
    for specimen in &run.plan.specimens {
        body.push(Block::part(stated(format!("Specimen {}", specimen.name))));
        match &specimen.frame {
            Some(frame) => base_excitation::report::structure(frame, body),
            None => body.push(specimen_table(
                specimen,
                run.plan.rig.link.as_real().is_none(),
            )),
        }
    }
    for ground in &run.plan.grounds {
        body.push(Block::part(
            Text::from(format!("Ground {}", ground.name)).soft(" · from a file of the plan"),
        ));
        body.push(base_excitation::report::ground(ground));
    }
    for striker in &run.plan.strikers {
        body.push(Block::part(stated(format!("Striker {}", striker.name))));
        body.push(striker_table(striker));
    }
    body.push(Block::part("Limits"));
    body.push(limits(run));
    if !run.plan.parameters.is_empty() {
        body.push(Block::part("Parameters"));
        body.push(parameters(run));
    }
}

/// Virtual time of each impact beside the time the rig took for it.
fn time_scale(run: &Run<'_>, body: &mut Vec<Block>) {
    let told = run.record.procedures.iter().filter_map(|procedure| {
        let (virtual_time, rig_time) = procedures::recorded(&procedure.history).time_spans?;
        let slower = || format!(", {:.0} times as long", rig_time / virtual_time);
        (virtual_time > 0.0).then(|| {
            (
                Text::from(format!("Time scale of {}", procedure.name)),
                Text::from(format!(
                    "{} of virtual time took {} on the rig{}",
                    number::text(virtual_time, Dimension::TIME),
                    number::text(rig_time, Dimension::TIME),
                    if rig_time > 0.0 {
                        slower()
                    } else {
                        String::new()
                    }
                )),
            )
        })
    });
    let rows: Vec<(Text, Text)> = told.collect();
    if !rows.is_empty() {
        body.push(Block::Pairs { rows });
    }
}

/// What a virtual specimen does is no property of a real one.
fn specimen_table(specimen: &Specimen, is_virtual: bool) -> Block {
    let mass = Text::from(doubtful(
        specimen.mass,
        specimen.mass_uncertainty,
        Dimension::MASS,
    ));
    let mass = match &specimen.mass_from {
        Some(formula) => mass.soft(" from ").code(formula),
        None => mass,
    };
    let mut rows: Vec<(&str, Text)> = vec![("equivalent mass", mass)];
    if let Some(behaviour) = specimen.behaviour.as_ref().filter(|_| is_virtual) {
        rows.extend(
            specimen_text::rows(behaviour, &number::stated)
                .into_iter()
                .map(|(name, text)| (name, text.into())),
        );
    }
    if is_virtual && specimen.damping != 0.0 {
        rows.push((
            "damping on the load cell",
            number::stated(specimen.damping, Dimension::DAMPING).into(),
        ));
    }
    if is_virtual && specimen.coulomb != 0.0 {
        rows.push((
            "friction on the load cell",
            number::stated(specimen.coulomb, Dimension::FORCE).into(),
        ));
    }
    pairs(rows)
}

fn striker_table(striker: &Striker) -> Block {
    let mut rows = vec![
        (
            "mass",
            doubtful(striker.mass, striker.mass_uncertainty, Dimension::MASS),
        ),
        (
            "velocity at the start",
            doubtful(
                striker.velocity,
                striker.velocity_uncertainty,
                Dimension::VELOCITY,
            ),
        ),
        (
            "energy",
            number::stated(
                0.5 * striker.mass * striker.velocity * striker.velocity,
                Dimension::ENERGY,
            ),
        ),
        (
            "gap at the start",
            number::stated(striker.gap, Dimension::LENGTH),
        ),
    ];
    if striker.gravity != 0.0 {
        rows.push((
            "acceleration along its way",
            number::stated(striker.gravity, Dimension::ACCELERATION),
        ));
    }
    described(rows)
}

/// A stated value with its standard uncertainty, where one is stated.
fn doubtful(value: f64, uncertainty: f64, dimension: Dimension) -> String {
    if uncertainty == 0.0 {
        return number::stated(value, dimension);
    }
    format!(
        "{}, u in brackets",
        number::with_uncertainty(value, Some(uncertainty), dimension)
    )
}

pub(super) fn settling(settle: Settle) -> String {
    if settle.band == 0.0 {
        return "a reading counts at once".to_owned();
    }
    format!(
        "within {} of the target and under {} for {}, at most {}",
        number::stated(settle.band, Dimension::LENGTH),
        number::stated(settle.force_rate, Dimension::FORCE_RATE),
        number::stated(settle.dwell, Dimension::TIME),
        number::stated(settle.timeout, Dimension::TIME)
    )
}

/// As the guard held them, also what holds by default.
fn limits(run: &Run<'_>) -> Block {
    let equipment = run.equipment();
    let row = |limit: &HeldLimit| {
        let name = if limit.quantity == "nrms_error" {
            "NRMS tracking error".to_owned()
        } else {
            words(&limit.quantity)
        };
        let axis = limit
            .axis
            .map_or_else(String::new, |axis| format!(", axis {axis}"));
        (
            Text::from(name + &axis),
            Text::from(range(limit.interval(), limit.dimension())),
        )
    };
    let rows: Vec<(Text, Text)> = equipment.limits.iter().map(row).collect();
    if rows.is_empty() {
        Block::paragraph("Nothing was limited.")
    } else {
        Block::Pairs { rows }
    }
}

pub(super) fn range(interval: Interval, dimension: Dimension) -> String {
    let largest = [interval.low, interval.high]
        .into_iter()
        .filter(|end| end.is_finite())
        .fold(0.0, |a: f64, b| a.max(b.abs()));
    let text = |value: f64| number::stated_beside(value, largest, dimension);
    match (interval.low.is_finite(), interval.high.is_finite()) {
        (true, true) => format!("{} to {}", text(interval.low), text(interval.high)),
        (true, false) => format!("≥ {}", text(interval.low)),
        (false, _) => format!("≤ {}", text(interval.high)),
    }
}

fn parameters(run: &Run<'_>) -> Block {
    let value = |parameter: &crate::plan::Parameter| {
        let origin = if parameter.set {
            " (set for this run)"
        } else {
            " (as the plan states)"
        };
        Text::from(number::stated(parameter.value, parameter.dimension)).soft(origin)
    };
    pairs(
        run.plan
            .parameters
            .iter()
            .map(|parameter| (parameter.name.as_str(), value(parameter)))
            .collect(),
    )
}
