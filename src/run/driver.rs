//! The run of a plan: the pre-test check, the procedures in order, the zeros before and after. In: a plan, a rig, an
//! observer. Out: the record. It knows no particular procedure.

use super::session::Session;
use super::{Keep, Observer, Performed, pretest_check, zero_drift};
use crate::procedures;
use crate::run::inputs::Inputs;
use psd_plan::formula::ProcedureId;
use psd_plan::record::{EventKind, Outcome, ProcedureRecord, Record};
use psd_plan::{DriftCheck, Plan, ZeroAfter};
use psd_rig::Rig;

/// Runs every procedure of the plan in order on the rig. Never fails: a fault is the outcome of the record.
#[must_use]
pub fn run(plan: &Plan, rig: &mut dyn Rig, observer: &mut dyn Observer) -> Record {
    run_with(plan, rig, observer, Keep::default())
}

/// The same, with a record of this part of the run.
#[must_use]
pub fn run_with(plan: &Plan, rig: &mut dyn Rig, observer: &mut dyn Observer, keep: Keep) -> Record {
    let identity = rig.identity();
    let mut record = Record {
        rig: identity,
        procedures: Vec::new(),
        events: Vec::new(),
        outcome: Outcome::Completed,
        drift: None,
    };
    let mut session = match Session::begin(plan, rig, observer) {
        Ok(session) => session,
        Err(ended) => {
            let (event, stop) = *ended;
            return Record {
                events: vec![event],
                outcome: stop.outcome(),
                ..record
            };
        }
    };
    session.keep = keep;
    if let Some(link) = plan.rig.link.as_real()
        && let Err(stop) = pretest_check::pass(plan, link, afterwards(plan), &mut session)
    {
        session.end(&stop);
        return Record {
            events: session.finish(),
            outcome: stop.outcome(),
            ..record
        };
    }
    let home = session.guard.commanded().to_vec();
    match plan
        .rig
        .zero_drift
        .map(|check| zero_drift::before(check, &mut session))
        .transpose()
    {
        Ok(drift) => record.drift = drift,
        Err(stop) => {
            session.end(&stop);
            return Record {
                events: session.finish(),
                outcome: stop.outcome(),
                ..record
            };
        }
    }
    for procedure in &plan.procedures {
        if let Err(stop) = session.stop_if_requested() {
            record.outcome = session.end_as_declared(&stop, plan);
            break;
        }
        session.enter(procedure, procedures::most_steps(&procedure.kind, plan));
        let mut inputs = Inputs::new(&record, ProcedureId(record.procedures.len()));
        let Performed {
            history,
            mut results,
            stop,
        } = procedures::run(&procedure.kind, plan, &mut inputs, &mut session);
        inputs
            .take_observations()
            .into_iter()
            .for_each(|text| session.event(EventKind::Remark, text));
        procedures::attribute(
            &procedure.kind,
            &history,
            plan,
            &inputs,
            session.guard.declared_noise(),
            &mut results,
        );
        for text in procedures::withhold_outside_calibration(plan, &history, &mut results) {
            session.event(EventKind::Remark, text);
        }
        let inputs = inputs.into_recorded();
        let axial = session.guard.take_axial_readings();
        record.procedures.push(ProcedureRecord {
            name: procedure.name.clone(),
            kind: procedure.kind.keyword(),
            complete: stop.is_none(),
            inputs,
            results,
            history,
            axial: if keep == Keep::Results {
                Vec::new()
            } else {
                axial
            },
        });
        if let Some(stop) = stop {
            record.outcome = session.end_as_declared(&stop, plan);
            break;
        }
        session.leave();
    }
    if let Some(drift) = &mut record.drift {
        drift.held = session.guard.take_held();
        if record.outcome == Outcome::Completed
            && let Err(stop) = session
                .stop_if_requested()
                .and_then(|()| zero_drift::after(drift, &home, &mut session))
        {
            session.end(&stop);
            record.outcome = stop.outcome();
        }
    }
    session.report_axial_loads();
    record.events = session.finish();
    record
}

/// The motion of a real rig after the pre-test check.
fn afterwards(plan: &Plan) -> &'static str {
    match plan.rig.zero_drift {
        Some(DriftCheck {
            after: ZeroAfter::Start,
            ..
        }) => "MOVES as the plan specifies, and at its end back to its start position",
        _ => "MOVES as the plan specifies",
    }
}
