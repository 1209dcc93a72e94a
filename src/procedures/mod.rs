//! The procedures, one folder each: check, run, tables, figures and report. In: a block of the plan, then a rig behind the guard. Out:
//! histories and results. Only this file lists the procedures: one function per stage, each with one exhaustive match.

pub(crate) mod common;
pub mod cycle;
pub mod damping_sweep;
pub mod escalate;
pub(crate) mod facts;
pub(crate) mod frame;
pub mod impact;
pub mod inspect;
pub mod move_to;
pub mod preload;
pub mod shake;
pub mod stepping;
pub mod stiffness_ramp;
pub mod unload;

use std::iter::once;

use crate::report::Run;
use crate::report::document::Block;
use crate::report::figures::chart::{Chart, SharedCurve};
use crate::report::tables::{Table, each_once, numeric};
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use common::calibrated_range;
use common::fit_uncertainty::Fits;
use common::predicted::Predicted;
use facts::{Delay, Facts, Leaves, Left, Listed, Recorded, Tests};
use psd_language::check::checker::Checker;
use psd_language::check::declarations::limits::CheckedLimits;
use psd_language::check::declared::Declared;
use psd_physics::self_test::SelfTestPart;
use psd_physics::structure::assemblies::Assemblies;
use psd_plan::formula::Formula;
use psd_plan::procedures::preload::block::AXIAL_FORCE;
use psd_plan::record::{
    CycleStep, History, MoveStep, NamedResult, ProcedureRecord, RampStep, SweepStep,
};
use psd_plan::schema::{Column, Kind};
use psd_plan::uncertainty::{InstrumentUncertainty, Source};
use psd_plan::{
    DeclaredNoise, Figure, FigureKind, Impact, Plan, Procedure, ProcedureBlock, ProcedureKind,
};

/// Check: the procedure that a block specifies; None after an error, and for a block that does not declare a procedure.
pub(crate) fn check(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    let Kind::Procedure(procedure) = checker.scope.blocks[block].kind.kind else {
        return None;
    };
    match procedure {
        ProcedureBlock::StiffnessRamp => stiffness_ramp::check::stiffness_ramp(checker, block),
        ProcedureBlock::DampingSweep => damping_sweep::check::damping_sweep(checker, block),
        ProcedureBlock::Impact => impact::check::impact(checker, block),
        ProcedureBlock::Shake => shake::check::shake(checker, block),
        ProcedureBlock::Cycle => cycle::check::cycle(checker, block),
        ProcedureBlock::Escalate => escalate::check::escalate(checker, block),
        ProcedureBlock::Unload => unload::check::unload(checker, block),
        ProcedureBlock::Move => move_to::check::move_block(checker, block),
        ProcedureBlock::Preload => preload::check::preload(checker, block),
        ProcedureBlock::Inspect => inspect::check::inspect(checker, block),
    }
}

/// Check: compares a procedure with the other declarations of the plan.
pub(crate) fn check_declared(
    checker: &mut Checker,
    block: usize,
    kind: &ProcedureKind,
    declared: &Declared<'_>,
) {
    match kind {
        ProcedureKind::Impact(impact) => {
            impact::check::declared::with_its_striker(checker, block, impact, declared);
        }
        ProcedureKind::Escalate(escalate) => {
            escalate::declared::check_declared(checker, block, escalate, declared);
        }
        ProcedureKind::Shake(shake) => {
            shake::check::check_declared(checker, block, shake, declared);
        }
        ProcedureKind::StiffnessRamp(_)
        | ProcedureKind::DampingSweep(_)
        | ProcedureKind::Cycle(_)
        | ProcedureKind::Unload(_)
        | ProcedureKind::Move(_)
        | ProcedureKind::Preload(_)
        | ProcedureKind::Inspect { .. } => {}
    }
}

/// Check: the results that the plan reads from procedures; called only if there is no error.
pub(crate) fn check_reads(checker: &mut Checker, procedures: &[(usize, Option<Procedure>)]) {
    stiffness_ramp::read_results::check(checker, procedures);
    cycle::declared_cycles::check_entries(checker, procedures);
}

/// Check: compares the targets that are known before the run with the limits.
pub(crate) fn check_limits(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    limits: &CheckedLimits,
) {
    cycle::declared_cycles::check_cycles(checker, procedures, limits);
}

/// Check: whether a procedure certainly moves the specimen to no negative displacement.
pub(crate) fn stays_positive(kind: &ProcedureKind) -> bool {
    let positive = |target: &Formula| target.constant().is_some_and(|target| target >= 0.0);
    match kind {
        ProcedureKind::StiffnessRamp(ramp) => ramp.displacements.iter().all(positive),
        ProcedureKind::Move(to) => positive(&to.to),
        ProcedureKind::Preload(_) | ProcedureKind::Inspect { .. } => true,
        ProcedureKind::Impact(_)
        | ProcedureKind::Escalate(_)
        | ProcedureKind::Shake(_)
        | ProcedureKind::DampingSweep(_)
        | ProcedureKind::Cycle(_)
        | ProcedureKind::Unload(_) => false,
    }
}

/// Check: the state in which a procedure leaves the specimen.
pub(crate) fn leaves(kind: &ProcedureKind, left: Left<'_>) -> Leaves<'static> {
    match kind {
        ProcedureKind::Impact(impact) => Leaves::Moving(impact::facts::motion(impact)),
        ProcedureKind::Shake(shake) => Leaves::Moving(shake::left::left(shake, left.grounds)),
        ProcedureKind::Unload(unload) => unload::facts::leaves(unload, left.specimens),
        ProcedureKind::Escalate(series) => Leaves::Moving(escalate::declared::motion(series)),
        ProcedureKind::Preload(_) | ProcedureKind::Inspect { .. } => Leaves::AsFound,
        ProcedureKind::StiffnessRamp(_)
        | ProcedureKind::DampingSweep(_)
        | ProcedureKind::Cycle(_)
        | ProcedureKind::Move(_) => Leaves::AtRest,
    }
}

/// Check: the specimen whose mass and its uncertainty a procedure uses, if it does. Collects the sources that its own mass states.
pub(crate) fn uses_mass(kind: &ProcedureKind, stated: &mut Vec<Source>) -> Option<usize> {
    let mut of_impact = |impact: &Impact| {
        let point = impact.point()?;
        point.mass.collect_stated(stated);
        (point.mass_uncertainty > 0.0).then_some(impact.specimen)
    };
    match kind {
        ProcedureKind::DampingSweep(sweep) => Some(sweep.specimen),
        ProcedureKind::Impact(impact) => of_impact(impact),
        ProcedureKind::Escalate(series) => of_impact(&series.impact),
        ProcedureKind::StiffnessRamp(_)
        | ProcedureKind::Shake(_)
        | ProcedureKind::Cycle(_)
        | ProcedureKind::Unload(_)
        | ProcedureKind::Move(_)
        | ProcedureKind::Preload(_)
        | ProcedureKind::Inspect { .. } => None,
    }
}

/// Check and report: the facts about a procedure of the plan.
pub(crate) fn facts_of(kind: &ProcedureKind) -> Facts<'_> {
    match kind {
        ProcedureKind::StiffnessRamp(_) => stiffness_ramp::facts::facts(),
        ProcedureKind::DampingSweep(_) => damping_sweep::facts::facts(),
        ProcedureKind::Impact(impact) => impact::facts::facts(impact),
        ProcedureKind::Shake(shake) => shake::facts::facts(shake),
        ProcedureKind::Cycle(_) => cycle::facts::facts(),
        ProcedureKind::Unload(unload) => unload::facts::facts(unload),
        ProcedureKind::Escalate(series) => escalate::facts::facts(series),
        ProcedureKind::Move(_) => Facts::default(),
        ProcedureKind::Preload(_) | ProcedureKind::Inspect { .. } => Facts {
            tests: Tests::Nothing,
            ..Facts::default()
        },
    }
}

/// Report: the results of a procedure of the plan, as a report lists them.
pub(crate) fn listed(kind: &ProcedureKind) -> Listed {
    match kind {
        ProcedureKind::StiffnessRamp(_) => stiffness_ramp::facts::listed(),
        ProcedureKind::DampingSweep(_) => damping_sweep::facts::listed(),
        ProcedureKind::Impact(impact) => impact::facts::listed(impact),
        ProcedureKind::Shake(_) => shake::facts::listed(),
        ProcedureKind::Cycle(_) => cycle::facts::listed(),
        ProcedureKind::Unload(unload) => unload::facts::listed(unload),
        ProcedureKind::Escalate(_) => escalate::facts::listed(),
        ProcedureKind::Preload(_) => Listed {
            headline: vec![AXIAL_FORCE.name],
            ..Listed::default()
        },
        ProcedureKind::Move(_) | ProcedureKind::Inspect { .. } => Listed::default(),
    }
}

/// Run: an impact on one degree of freedom, which a study may run in a batch.
pub(crate) fn point_impact(kind: &ProcedureKind) -> Option<&Impact> {
    match kind {
        ProcedureKind::Impact(impact) => impact.point().map(|_| impact),
        ProcedureKind::StiffnessRamp(_)
        | ProcedureKind::DampingSweep(_)
        | ProcedureKind::Shake(_)
        | ProcedureKind::Cycle(_)
        | ProcedureKind::Escalate(_)
        | ProcedureKind::Unload(_)
        | ProcedureKind::Move(_)
        | ProcedureKind::Preload(_)
        | ProcedureKind::Inspect { .. } => None,
    }
}

/// Report: the observations on the record of a procedure.
pub(crate) fn recorded(history: &History) -> Recorded {
    match history {
        History::StiffnessRamp(history) => stiffness_ramp::facts::recorded(history),
        History::DampingSweep(history) => damping_sweep::facts::recorded(history),
        History::Impact(history) => impact::facts::recorded(history),
        History::Shake(history) => shake::facts::recorded(history),
        History::Cycle(_) => cycle::facts::recorded(),
        History::Escalate(_) => escalate::facts::recorded(),
        History::Unload(history) => unload::facts::recorded(history.of),
        History::Move(_) | History::Preload | History::Inspect => Recorded::default(),
    }
}

/// Run: carries a procedure out.
pub(crate) fn run(
    kind: &ProcedureKind,
    plan: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    match kind {
        ProcedureKind::StiffnessRamp(ramp) => {
            stiffness_ramp::run::perform(ramp, plan, inputs, session)
        }
        ProcedureKind::DampingSweep(sweep) => {
            damping_sweep::run::perform(sweep, plan, inputs, session)
        }
        ProcedureKind::Impact(impact) => impact::run::perform(impact, plan, inputs, session),
        ProcedureKind::Shake(shake) => shake::run::perform(shake, plan, inputs, session),
        ProcedureKind::Cycle(cycles) => cycle::run::perform(cycles, plan, inputs, session),
        ProcedureKind::Escalate(series) => escalate::run::perform(series, plan, inputs, session),
        ProcedureKind::Unload(unload) => unload::run::perform(unload, plan, inputs, session),
        ProcedureKind::Move(target) => move_to::run::perform(target, inputs, session),
        ProcedureKind::Preload(load) => preload::run::perform(load, plan, inputs, session),
        ProcedureKind::Inspect { note } => inspect::run::perform(note, session),
    }
}

/// Run: gives the fitted results of a procedure their contributions, except those of its own uncertainty.
pub(crate) fn attribute(
    kind: &ProcedureKind,
    history: &History,
    plan: &Plan,
    inputs: &Inputs<'_>,
    declared: DeclaredNoise,
    results: &mut [NamedResult],
) {
    let procedure = inputs.procedure();
    let instruments = InstrumentUncertainty::of(plan, declared, 1);
    let attribute = &mut |fits: &Fits<'_>| {
        common::fit_uncertainty::attribute(fits, plan, procedure, &instruments, results);
    };
    match (kind, history) {
        (ProcedureKind::StiffnessRamp(ramp), History::StiffnessRamp(found)) => {
            stiffness_ramp::fits::with_fits(found, ramp, &instruments, attribute);
        }
        (ProcedureKind::DampingSweep(sweep), History::DampingSweep(found)) => {
            damping_sweep::uncertainty::propagate(sweep, found, plan, inputs, declared, results);
        }
        (ProcedureKind::Cycle(cycle), History::Cycle(found)) => {
            cycle::uncertainty::with_fits(found, cycle, &instruments, attribute);
        }
        (
            _,
            History::StiffnessRamp(_)
            | History::DampingSweep(_)
            | History::Cycle(_)
            | History::Impact(_)
            | History::Shake(_)
            | History::Escalate(_)
            | History::Move(_)
            | History::Unload(_)
            | History::Preload
            | History::Inspect,
        ) => return,
    }
    common::fit_uncertainty::combine(results);
}

/// Run: withholds the uncertainty of results from readings outside of a calibrated range; returns the observations on them.
pub(crate) fn withhold_outside_calibration(
    plan: &Plan,
    history: &History,
    results: &mut [NamedResult],
) -> Vec<String> {
    let given: calibrated_range::Readings<'_> = &|give| readings(plan, history, give);
    calibrated_range::withhold(&plan.rig, plan.degrees_of_freedom(), given, results)
}

/// Run: an upper bound of a procedure's steps, if the plan alone gives one.
pub fn most_steps(kind: &ProcedureKind, plan: &Plan) -> Option<u64> {
    match kind {
        ProcedureKind::StiffnessRamp(ramp) => Some(ramp.targets()),
        ProcedureKind::Impact(_) | ProcedureKind::Shake(_) => known_steps(kind, plan),
        ProcedureKind::Cycle(cycle) => cycle.rate.is_none().then(|| cycle.targets() + 1),
        ProcedureKind::Escalate(series) => escalate::run::most_steps(series, plan),
        ProcedureKind::Move(_) => Some(1),
        ProcedureKind::Preload(_) => Some(u64::from(preload::run::STEPS)),
        ProcedureKind::Inspect { .. } => Some(0),
        ProcedureKind::DampingSweep(_) | ProcedureKind::Unload(_) => None,
    }
}

/// Check and run: the number of steps of a procedure that integrates, if the plan alone determines it; None for any other.
pub(crate) fn known_steps(kind: &ProcedureKind, plan: &Plan) -> Option<u64> {
    match kind {
        ProcedureKind::Impact(impact) => {
            impact.known_steps(plan, plan.strikers.get(impact.striker)?)
        }
        ProcedureKind::Shake(shake) => shake.known_steps(plan),
        ProcedureKind::Escalate(series) => {
            let steps = series.known_steps_of_an_impact(plan)?;
            Some(steps.saturating_mul(series.velocities.len() as u64))
        }
        ProcedureKind::StiffnessRamp(_)
        | ProcedureKind::DampingSweep(_)
        | ProcedureKind::Cycle(_)
        | ProcedureKind::Unload(_)
        | ProcedureKind::Move(_)
        | ProcedureKind::Preload(_)
        | ProcedureKind::Inspect { .. } => None,
    }
}

/// Check: the delay of the actuators of a simulated rig; None if too little is known before the run, or nothing is integrated.
pub(crate) fn delay(kind: &ProcedureKind, plan: &Plan) -> Option<Delay> {
    match kind {
        ProcedureKind::Impact(impact) => impact::facts::delay(plan, impact),
        ProcedureKind::Escalate(series) => impact::facts::delay_in_series(plan, series),
        ProcedureKind::Shake(shake) => shake::facts::delay(plan, shake),
        ProcedureKind::StiffnessRamp(_)
        | ProcedureKind::DampingSweep(_)
        | ProcedureKind::Cycle(_)
        | ProcedureKind::Unload(_)
        | ProcedureKind::Move(_)
        | ProcedureKind::Preload(_)
        | ProcedureKind::Inspect { .. } => None,
    }
}

/// Command line: what `psd check --explain` prints of a procedure from a dry run, besides its motion. `by_tracking`: rows for the energy
/// that tracking errors add to it or remove.
pub fn predicted(
    plan: &Plan,
    kind: &ProcedureKind,
    procedure: &ProcedureRecord,
    by_tracking: &[Vec<String>],
) -> Vec<Predicted> {
    match (kind, &procedure.history) {
        (ProcedureKind::Impact(impact), History::Impact(history)) => {
            impact::predicted::predicted(plan, impact, procedure, history, by_tracking)
        }
        (ProcedureKind::Shake(shake), History::Shake(history)) => {
            shake::predicted::predicted(plan, shake, &procedure.name, history, by_tracking)
        }
        (_, History::Escalate(_)) => vec![Predicted::new(
            format!("{}, worst impact", procedure.name),
            by_tracking.to_vec(),
        )],
        (
            _,
            History::Impact(_)
            | History::Shake(_)
            | History::StiffnessRamp(_)
            | History::DampingSweep(_)
            | History::Cycle(_)
            | History::Move(_)
            | History::Unload(_)
            | History::Preload
            | History::Inspect,
        ) => Vec::new(),
    }
}

/// Report: a figure and its caption; None if nothing is recorded for it.
pub(crate) fn chart(
    run: &Run<'_>,
    procedure: &ProcedureRecord,
    figure: &Figure,
) -> Option<(Chart, String)> {
    let planned = &run.plan.procedures.get(figure.procedure.0)?.kind;
    let (name, kind) = (&procedure.name, figure.kind);
    match (planned, &procedure.history) {
        (_, History::StiffnessRamp(history)) => stiffness_ramp::figures::chart(name, history, kind),
        (_, History::DampingSweep(history)) => damping_sweep::figures::chart(name, history, kind),
        (ProcedureKind::Impact(impact), History::Impact(history)) => {
            impact::figures::chart(run, impact, name, history, figure)
        }
        (_, History::Shake(history)) => shake::figures::chart(run, name, history, figure),
        (_, History::Cycle(history)) => cycle::figures::chart(name, history, kind),
        (_, History::Escalate(history)) => escalate::figures::chart(run, name, history, figure),
        (_, History::Unload(history)) => unload::figures::chart(run, name, history, kind),
        (_, History::Impact(_) | History::Move(_) | History::Preload | History::Inspect) => None,
    }
}

/// Report: the curve of a procedure on a chart of several.
pub(crate) fn shared_curve(kind: FigureKind, history: &History) -> Option<SharedCurve> {
    match history {
        History::Impact(history) => impact::figures::shared(kind, history),
        History::Shake(history) => shake::figures::shared(kind, history),
        History::StiffnessRamp(_)
        | History::DampingSweep(_)
        | History::Cycle(_)
        | History::Escalate(_)
        | History::Move(_)
        | History::Unload(_)
        | History::Preload
        | History::Inspect => None,
    }
}

/// Report: the table of a procedure's steps, with its further tables; none if it records no steps.
pub(crate) fn tables<'a>(plan: &Plan, procedure: &'a ProcedureRecord) -> Vec<Table<'a>> {
    let name = procedure.name.clone();
    let assemblies = plan.frame_on_the_rig().and_then(Assemblies::of);
    let scaled = assemblies.clone().filter(Assemblies::is_scaled);
    let mut tables = match &procedure.history {
        History::StiffnessRamp(history) => stiffness_ramp::tables::tables(name, history),
        History::DampingSweep(history) => vec![damping_sweep::tables::table(name, history)],
        History::Impact(history) => {
            let of_elements = impact::tables::of_elements(&name, history, assemblies);
            once(impact::tables::table(name, history, scaled))
                .chain(of_elements)
                .collect()
        }
        History::Shake(history) => {
            let number = |step: usize| history.steps[step].step;
            let of_elements = frame::tables::of_elements(&name, &history.steps, number, assemblies);
            once(shake::tables::table(name, history, scaled))
                .chain(of_elements)
                .collect()
        }
        History::Cycle(history) => cycle::tables::tables(name, history),
        History::Escalate(history) => escalate::tables::tables(name, history, scaled.as_ref()),
        History::Move(steps) => vec![move_to::tables::table(name, steps)],
        History::Unload(history) => vec![unload::tables::table(name, history, scaled)],
        History::Preload | History::Inspect => Vec::new(),
    };
    tables.extend(preload::tables::table(&procedure.name, &procedure.axial));
    tables
}

/// Check and accepted results: the numeric columns of the tables of a block, each once; none without tables.
pub fn columns(kind: Kind) -> impl Iterator<Item = Column> {
    let Kind::Procedure(procedure) = kind else {
        return Vec::new().into_iter();
    };
    let all = match procedure {
        ProcedureBlock::StiffnessRamp => stiffness_ramp::tables::columns(),
        ProcedureBlock::Move => move_to::tables::columns(),
        ProcedureBlock::Unload => unload::tables::columns(),
        ProcedureBlock::DampingSweep => numeric(damping_sweep::tables::STEPS),
        ProcedureBlock::Impact => impact::tables::columns(),
        ProcedureBlock::Cycle => cycle::tables::columns(),
        ProcedureBlock::Shake => {
            let of_floors = frame::tables::columns(shake::tables::shake());
            [of_floors, numeric(&frame::tables::elements())].concat()
        }
        ProcedureBlock::Escalate => escalate::tables::columns(),
        ProcedureBlock::Preload => preload::tables::columns(),
        ProcedureBlock::Inspect => Vec::new(),
    };
    each_once(all).into_iter()
}

/// Report: the blocks below the results of a procedure.
pub(crate) fn report(
    run: &Run<'_>,
    index: usize,
    procedure: &ProcedureRecord,
    body: &mut Vec<Block>,
) {
    let Some(planned) = run.plan.procedures.get(index) else {
        return;
    };
    match (&planned.kind, &procedure.history) {
        (_, History::StiffnessRamp(history)) => stiffness_ramp::report::report(history, body),
        (_, History::DampingSweep(history)) => damping_sweep::report::report(history, body),
        (ProcedureKind::Impact(impact), History::Impact(history)) => {
            impact::report::report(run, impact, procedure, history, body);
        }
        (_, History::Cycle(history)) => cycle::report::table(history, body),
        (ProcedureKind::Shake(shake), History::Shake(history)) => {
            shake::report::report(run, shake, procedure, history, body);
        }
        (ProcedureKind::Escalate(series), History::Escalate(history)) => {
            escalate::report::table(run, &series.impact, procedure, history, body);
        }
        (ProcedureKind::Unload(unload), History::Unload(history)) => {
            unload::report::report(run, unload, procedure, history, body);
        }
        (
            _,
            History::Impact(_)
            | History::Shake(_)
            | History::Escalate(_)
            | History::Unload(_)
            | History::Move(_)
            | History::Preload
            | History::Inspect,
        ) => {}
    }
}

/// Report: the parts of the self-test that a procedure uses, each with the parts in combination with it.
pub(crate) fn self_tested(kind: &ProcedureKind) -> Vec<Vec<SelfTestPart>> {
    match kind {
        ProcedureKind::StiffnessRamp(ramp) => vec![vec![stiffness_ramp::facts::self_tested(ramp)]],
        ProcedureKind::DampingSweep(_) => vec![vec![SelfTestPart::DampingFit]],
        ProcedureKind::Impact(impact) => impact::facts::self_tested(impact),
        ProcedureKind::Escalate(series) => impact::facts::self_tested(&series.impact),
        ProcedureKind::Shake(shake) => stepping::self_tested::stepped(&shake.stepping, true, None),
        ProcedureKind::Cycle(_) => vec![vec![SelfTestPart::Loops]],
        ProcedureKind::Unload(_) => vec![vec![SelfTestPart::Unloading]],
        ProcedureKind::Move(_) | ProcedureKind::Preload(_) | ProcedureKind::Inspect { .. } => {
            Vec::new()
        }
    }
}

/// Report: gives displacement \[m\] and force \[N\] of every axis, row by row of a procedure's table.
pub(crate) fn readings(plan: &Plan, history: &History, give: &mut dyn FnMut(&[f64], &[f64])) {
    let give = &mut common::reached::of_axes(plan, give);
    match history {
        History::StiffnessRamp(ramp) => {
            let read = |step: &RampStep| (step.displacement, step.restoring_force);
            common::reached::of_axis(&ramp.steps, read, give);
        }
        History::Move(steps) => {
            let read = |step: &MoveStep| (step.displacement, step.restoring_force);
            common::reached::of_axis(steps, read, give);
        }
        History::DampingSweep(sweep) => {
            let read = |step: &SweepStep| (step.displacement, step.restoring_force);
            common::reached::of_axis(&sweep.steps, read, give);
        }
        History::Cycle(cycle) => {
            let read = |step: &CycleStep| (step.displacement, step.restoring_force);
            common::reached::of_axis(&cycle.steps, read, give);
        }
        History::Impact(history) => common::reached::of_impact(history, give),
        History::Escalate(series) => {
            for impact in &series.impacts {
                common::reached::of_impact(&impact.history, give);
            }
        }
        History::Shake(shake) => {
            common::reached::of_floors(shake.steps.iter().map(|step| &step.floors), give);
        }
        History::Unload(history) => common::reached::of_unloading(history, give),
        History::Preload | History::Inspect => {}
    }
}
