//! A served rig that monitors its zeros. In: a client on a virtual rig whose cell has zero drift. Out: zeros before the first client and
//! after the last in the run log, and the same from the run log alone. There are none after the end if the operator ended the session.

use std::cell::Cell;

use crate::run::client_run::{Driver, Requests};
use crate::run::remote_control::Specimen;
use crate::run::replay;
use crate::run::replay::{Header, LoggedRun};
use crate::run::{Disconnect, Inspection, Observer};
use crate::tests::testing::elastic_plan;
use psd_plan::record::remote::DrivenStep;
use psd_plan::record::{Outcome, Record};
use psd_plan::{DriftCheck, Plan, VirtualLink, ZeroAfter};
use psd_rig::journal::{Durability, Journal};
use psd_rig::{RigFault, virtual_rig};
use psd_testing::journal::PowerLoss;
use psd_testing::journal::recover;

/// 0.1 N/s on a cell that may drift by this amount \[N\].
fn plan(force: f64, after: ZeroAfter) -> Plan {
    let mut plan = elastic_plan(1e5, Vec::new());
    plan.rig.link = psd_plan::Link::Virtual(VirtualLink {
        drift: 0.1,
        ..VirtualLink::default()
    });
    plan.rig.zero_drift = Some(DriftCheck {
        force,
        displacement: None,
        over: 2.0,
        after,
    });
    plan
}

/// Moves out by half a millimetre, stays, and disconnects.
fn client(specimen: &mut Specimen<'_, '_>) {
    let mut converse = || -> Result<(), RigFault> {
        specimen.come("127.0.0.1:1".to_owned())?;
        specimen.propose(&[5e-4])?;
        specimen.execute()?;
        specimen.commit();
        Ok(())
    };
    converse().unwrap();
    specimen.leave(Disconnect::Closed, "closed by the client".to_owned());
    specimen.close();
}

/// Whether it requests the end.
struct Person {
    wants: Cell<bool>,
}

impl Observer for Person {
    fn stop_requested(&self) -> bool {
        self.wants.replace(false)
    }
    fn inspect(&mut self, _: &str) -> Inspection {
        Inspection::go_on()
    }
}

fn header(plan: &Plan) -> Header {
    Header {
        served: Some("nees".to_owned()),
        ..crate::tests::testing::header(plan)
    }
}

/// The record of a served rig; the run log alone gives the same record.
fn served(plan: &Plan, wants: bool) -> Record {
    let (disk, record, steps) = recorded(plan, wants);
    let again = logged_run(plan, &disk);
    assert_eq!(format!("{:?}", again.record), format!("{record:?}"));
    assert_eq!(again.steps, Some(steps));
    record
}

/// The record of a served rig from its run log alone.
fn logged_run(plan: &Plan, disk: &PowerLoss) -> replay::Replayed {
    let again = replay::replay(
        plan,
        LoggedRun::of(&recover(&disk.written()).unwrap()).unwrap(),
    );
    assert_eq!(again.mismatch, None);
    again
}

fn recorded(plan: &Plan, wants: bool) -> (PowerLoss, Record, Vec<DrivenStep>) {
    let disk = PowerLoss::new();
    let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
    replay::begin(&mut journal, &header(plan), &["text".to_owned()]).unwrap();
    let (mut person, mut rig) = (
        Person {
            wants: Cell::new(wants),
        },
        virtual_rig(plan),
    );
    let wall = Box::new(|| None);
    let (recorded, steps) = replay::record_driven(
        plan,
        rig.as_mut(),
        &mut person,
        replay::OpenLog { journal, wall },
        Requests {
            driver: Driver::Client,
            clock: &|| 0.0,
            client: &mut |specimen| client(specimen),
        },
    );
    (disk, recorded.record, steps)
}

#[test]
fn the_zeros_are_read_before_the_first_client_and_after_the_last() {
    let record = served(&plan(5.0, ZeroAfter::Start), false);
    assert_eq!(record.outcome, Outcome::Completed);
    let drift = record.drift.unwrap();
    let axis = drift.axes[0];
    let (after, seconds) = (
        axis.after.unwrap(),
        axis.after.unwrap().time - axis.before.time,
    );
    assert!(
        (axis.before.force_slope - 0.1).abs() < 1e-9
            && (after.force - axis.before.force - 0.1 * seconds).abs() < 1e-9
    );
    assert_eq!(drift.beyond().next(), None);
    let strict = served(&plan(0.15, ZeroAfter::Start), false).drift.unwrap();
    assert!(
        strict
            .beyond()
            .next()
            .unwrap()
            .reason
            .starts_with("the zero of the force drifted by"),
        "{:?}",
        strict.beyond().next()
    );
}

#[test]
fn who_ends_the_serving_has_the_rig_held_where_it_is() {
    let record = served(&plan(5.0, ZeroAfter::Start), true);
    assert_eq!(record.outcome, Outcome::Completed);
    assert_eq!(record.drift.unwrap().axes[0].after, None);
    assert!(
        record
            .events
            .iter()
            .any(|event| event.text.contains("stopped on request")),
        "{:?}",
        record.events
    );
}

#[test]
fn a_rig_that_does_not_report_it_is_not_asked() {
    let mut plan = plan(5.0, ZeroAfter::Nowhere);
    assert!(served(&plan, false).drift.unwrap().axes[0].after.is_none());
    plan.rig.zero_drift = None;
    assert_eq!(served(&plan, false).drift, None);
}
