//! Conditions of the test: environment and time scale on the second page; specimens, ground motions, strikers, limits and parameters
//! in an annex. In: a run. Out: blocks. A value that the plan states without a measurement is marked.

mod frame;

use super::provenance;
use super::{Source, described, pairs, with_spaces};
use crate::procedures;
use crate::report::document::{Block, Text};
use crate::report::number;
use crate::report::run::Run;
use crate::report::status::particulars::{FRONT, stated};
use crate::report::wording::{common, conditions as wording, specimen as specimen_text};
use psd_physics::impact::energy::kinetic_energy;
use psd_plan::record::equipment::HeldLimit;
use psd_plan::schema::limits;
use psd_plan::schema::plan_block as schema;
use psd_plan::{Interval, Parameter, Settle, Specimen, Striker};
use psd_text::units::Dimension;

/// Fields of the `plan` block that another section prints, or that concern the language.
const PRINTED_ELSEWHERE: &[&str] = &[
    schema::EDITION.name,
    schema::REVISION.name,
    schema::DECISION_RULE.name,
    schema::DEVIATIONS.name,
    "check_run",
    schema::EQUIPMENT.name,
    schema::VALIDATION.name,
    schema::OPINIONS.name,
];

/// Fields of the `plan` block that are always printed here, with their labels.
const ENVIRONMENT: &[(&str, &str)] = &[
    (schema::TEMPERATURE.name, wording::TEMPERATURE),
    (schema::HUMIDITY.name, wording::HUMIDITY),
];

/// Fields that are printed here if they are given.
const WHERE_GIVEN: &[(&str, &str)] = &[
    (schema::SAMPLING.name, wording::SAMPLING),
    (schema::EXTERNAL.name, wording::EXTERNAL),
    (schema::NOTES.name, wording::NOTES),
];

/// The second page: environment, sampling, time scale, program.
pub(super) fn summary(source: &Source<'_>, body: &mut Vec<Block>) {
    let run = source.run;
    let mut rows = environment(run);
    if !run.record.rig.simulated {
        rows.extend(time_scales(run));
    }
    rows.push((wording::PROGRAM.into(), program(run).into()));
    body.push(Block::section(wording::TITLE));
    body.push(Block::Pairs { rows });
}

/// The version, and the outcome of its self-test.
fn program(run: &Run<'_>) -> String {
    wording::program(&run.provenance.psd_version, provenance::self_test())
}

/// The annex: specimens, ground motions, strikers, limits, parameters.
pub(super) fn section(source: &Source<'_>, body: &mut Vec<Block>) {
    let run = source.run;
    let as_stated = |name: String| Text::from(name).soft(wording::NOT_MEASURED);
    for specimen in &run.plan.specimens {
        body.push(Block::part(as_stated(wording::specimen(&specimen.name))));
        match &specimen.frame {
            Some(frame) => frame::structure(run.plan, frame, body),
            None => body.push(specimen_table(
                specimen,
                run.plan.rig.link.as_real().is_none(),
            )),
        }
    }
    for ground in &run.plan.grounds {
        body.push(Block::part(
            Text::from(wording::ground(&ground.name)).soft(wording::FROM_A_FILE),
        ));
        body.push(frame::ground(ground));
    }
    for striker in &run.plan.strikers {
        body.push(Block::part(as_stated(wording::striker(&striker.name))));
        body.push(striker_table(striker));
    }
    body.push(Block::part(if run.plan.specimens_at_scale().is_some() {
        wording::LIMITS_OF_THE_RIG
    } else {
        wording::LIMITS
    }));
    body.push(limits(run));
    if !run.plan.parameters.is_empty() {
        body.push(Block::part(wording::PARAMETERS));
        body.push(parameters(run));
    }
}

/// Temperature, humidity, and every other field of the plan that no other section prints. A simulation has no environment: what is
/// not given is not missing.
fn environment(run: &Run<'_>) -> Vec<(Text, Text)> {
    let simulated = run.record.rig.simulated;
    let mut rows: Vec<(Text, Text)> = ENVIRONMENT
        .iter()
        .map(|(field, name)| (name, stated(run, field)))
        .filter(|(_, text)| text.is_some() || !simulated)
        .map(|(name, text)| ((*name).into(), Text::given(text.as_deref())))
        .collect();
    rows.extend(
        WHERE_GIVEN
            .iter()
            .filter_map(|(field, name)| Some(((*name).into(), stated(run, field)?.into()))),
    );
    let is_printed = |field: &str| {
        PRINTED_ELSEWHERE.contains(&field)
            || FRONT.iter().any(|particular| particular.field == field)
            || ENVIRONMENT
                .iter()
                .chain(WHERE_GIVEN)
                .any(|(name, _)| *name == field)
    };
    let others = run
        .plan
        .particulars
        .iter()
        .filter(|(field, _)| !is_printed(field));
    rows.extend(others.map(|(field, text)| (with_spaces(field).into(), Text::given(Some(text)))));
    rows
}

/// Simulated time of each impact beside its laboratory time.
fn time_scales(run: &Run<'_>) -> Vec<(Text, Text)> {
    let rows = run.record.procedures.iter().filter_map(|procedure| {
        let (virtual_time, rig_time) = procedures::recorded(&procedure.history).time_spans?;
        let slower = if rig_time > 0.0 {
            wording::slower(rig_time / virtual_time)
        } else {
            String::new()
        };
        let [virtual_text, rig_text] =
            [virtual_time, rig_time].map(|time| number::text(time, Dimension::TIME));
        (virtual_time > 0.0).then(|| {
            (
                Text::from(wording::time_scale_of(&procedure.name)),
                Text::from(wording::time_scale(virtual_text, rig_text, slower)),
            )
        })
    });
    rows.collect()
}

/// The restoring-force model of a virtual specimen is printed only on a simulated rig.
fn specimen_table(specimen: &Specimen, is_virtual: bool) -> Block {
    let mass = Text::from(with_standard_uncertainty(
        specimen.mass,
        specimen.mass_uncertainty,
        Dimension::MASS,
    ));
    let mass = match &specimen.mass_from {
        Some(formula) => mass.soft(wording::FROM).code(formula),
        None => mass,
    };
    let mut rows: Vec<(&str, Text)> = vec![(wording::EQUIVALENT_MASS, mass)];
    if let Some(behaviour) = specimen.behaviour.as_ref().filter(|_| is_virtual) {
        rows.extend(
            specimen_text::rows(behaviour, &number::stated)
                .into_iter()
                .map(|(name, text)| (name, text.into())),
        );
    }
    if is_virtual && specimen.damping != 0.0 {
        rows.push((
            wording::DAMPING,
            number::stated(specimen.damping, Dimension::DAMPING).into(),
        ));
    }
    if is_virtual && specimen.coulomb != 0.0 {
        rows.push((
            wording::FRICTION,
            number::stated(specimen.coulomb, Dimension::FORCE).into(),
        ));
    }
    pairs(rows)
}

fn striker_table(striker: &Striker) -> Block {
    let energy = kinetic_energy(striker.mass, striker.velocity);
    let mut rows = vec![
        (
            wording::MASS,
            with_standard_uncertainty(striker.mass, striker.mass_uncertainty, Dimension::MASS),
        ),
        (
            wording::VELOCITY,
            with_standard_uncertainty(
                striker.velocity,
                striker.velocity_uncertainty,
                Dimension::VELOCITY,
            ),
        ),
        (wording::ENERGY, number::stated(energy, Dimension::ENERGY)),
        (wording::GAP, number::stated(striker.gap, Dimension::LENGTH)),
    ];
    if striker.gravity != 0.0 {
        rows.push((
            wording::ACCELERATION,
            number::stated(striker.gravity, Dimension::ACCELERATION),
        ));
    }
    described(rows)
}

/// A stated value, with its standard uncertainty if one is stated.
fn with_standard_uncertainty(value: f64, uncertainty: f64, dimension: Dimension) -> String {
    if uncertainty == 0.0 {
        return number::stated(value, dimension);
    }
    wording::u_in_brackets(number::with_uncertainty(
        value,
        Some(uncertainty),
        dimension,
    ))
}

/// The settling rule of a rig.
pub(super) fn settling(settle: Settle) -> String {
    if settle.band == 0.0 {
        return wording::NO_SETTLING.to_owned();
    }
    wording::settling(
        number::stated(settle.band, Dimension::LENGTH),
        number::stated(settle.force_rate, Dimension::FORCE_RATE),
        number::stated(settle.dwell, Dimension::TIME),
        number::stated(settle.timeout, Dimension::TIME),
    )
}

/// The limits of the guard, including default limits.
fn limits(run: &Run<'_>) -> Block {
    let equipment = run.equipment();
    let row = |limit: &HeldLimit| {
        let name = if limit.quantity == limits::NRMS_ERROR.name {
            common::NRMS_TRACKING_ERROR.to_owned()
        } else {
            with_spaces(&limit.quantity)
        };
        let axis = limit.axis.map_or_else(String::new, wording::comma_axis);
        (Text::from(name + &axis), Text::from(limit_range(limit)))
    };
    let rows: Vec<(Text, Text)> = equipment.limits.iter().map(row).collect();
    if rows.is_empty() {
        Block::paragraph(wording::NO_LIMIT)
    } else {
        Block::Pairs { rows }
    }
}

/// A limit of a tracking error is a fraction; it is printed in percent.
fn limit_range(limit: &HeldLimit) -> String {
    let interval = limit.interval();
    if limit.dimension() != Dimension::NUMBER {
        return range(interval, limit.dimension());
    }
    let percent = Interval {
        low: 100.0 * interval.low,
        high: 100.0 * interval.high,
    };
    range(percent, Dimension::NUMBER) + "\u{a0}%"
}

/// An interval in the unit of its larger end.
pub(super) fn range(interval: Interval, dimension: Dimension) -> String {
    let largest = [interval.low, interval.high]
        .into_iter()
        .filter(|end| end.is_finite())
        .fold(0.0, |a: f64, b| a.max(b.abs()));
    let text = |value: f64| number::stated_beside(value, largest, dimension);
    match (interval.low.is_finite(), interval.high.is_finite()) {
        (true, true) => wording::range(text(interval.low), text(interval.high)),
        (true, false) => format!("≥ {}", text(interval.low)),
        (false, _) => format!("≤ {}", text(interval.high)),
    }
}

fn parameters(run: &Run<'_>) -> Block {
    let value = |parameter: &Parameter| {
        let origin = if parameter.set {
            wording::SET_FOR_THIS_RUN
        } else {
            wording::AS_THE_PLAN_STATES
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
