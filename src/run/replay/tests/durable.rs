//! No target is sent and no reading is used before it is durable, and a disk that fails holds the rig.

use super::*;
use psd_testing::forwarded;

/// A rig that checks at every call which entries of the run log would survive a loss of power.
struct Suspicious {
    rig: RestingRig,
    disk: PowerLoss,
    proposed: f64,
    read: bool,
    /// The entries that were missing.
    missing: Vec<&'static str>,
}

impl Suspicious {
    /// Kind of the last durable entry, and its target.
    fn durable(&self) -> (EntryKind, Option<f64>) {
        let recovered = recover(&self.disk.synced()).unwrap();
        let last = recovered.lines.last().unwrap();
        (last.kind, last.body()["to"][0].as_f64())
    }

    fn last_reading_is_durable(&mut self) {
        let recovered = recover(&self.disk.synced()).unwrap();
        let intent = recovered
            .lines
            .iter()
            .rposition(|line| line.kind == EntryKind::Intent);
        let sample = recovered
            .lines
            .iter()
            .rposition(|line| line.kind == EntryKind::Sample);
        if self.read && sample <= intent {
            self.missing.push("sample");
        }
        self.read = false;
    }
}

impl Rig for Suspicious {
    forwarded!(rig: identity, time, pause, hold, declared_noise);

    fn degrees_of_freedom(&self) -> usize {
        1
    }
    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault> {
        self.last_reading_is_durable();
        self.proposed = targets[0];
        self.rig.propose(targets, speed)
    }
    fn execute(&mut self) -> Result<(), RigFault> {
        if self.durable() != (EntryKind::Intent, Some(self.proposed)) {
            self.missing.push("intent");
        }
        self.rig.execute()
    }
    fn read(&mut self) -> Result<Reading, RigFault> {
        self.last_reading_is_durable();
        self.read = true;
        self.rig.read()
    }
    fn traverse(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        if self.durable() != (EntryKind::Intent, Some(targets[0])) {
            self.missing.push("intent");
        }
        self.rig.traverse(targets, velocity, samples, each)
    }
}

/// The entries of a run that a loss of power at the worst moment would lose.
fn lost_to_power() -> Vec<&'static str> {
    let (plan, disk) = (plan(), PowerLoss::new());
    let mut rig = Suspicious {
        rig: RestingRig::new(&plan),
        disk: disk.clone(),
        proposed: 0.0,
        read: false,
        missing: Vec::new(),
    };
    let mut journal = journal(disk);
    begin(&mut journal, &header(&plan), &[]).unwrap();
    let recorded = record(&plan, &mut rig, &mut Witness, journal, no_wall());
    assert_eq!(recorded.record.outcome, Outcome::Completed);
    rig.missing
}

#[test]
fn no_target_leaves_and_no_reading_is_used_before_it_is_durable() {
    assert_eq!(lost_to_power(), [] as [&str; 0]);
    assert!(without(Guarding::IntentDurable, lost_to_power).contains(&"intent"));
    assert!(without(Guarding::SampleDurable, lost_to_power).contains(&"sample"));
}

#[test]
fn a_disk_that_fails_holds_the_rig_and_nothing_more_is_sent() {
    let plan = plan();
    let healthy = recorded(&plan).0.0.borrow().carried_out.len();
    let mut stopped = 0;
    for failed_sync in 6..60 {
        let disk = SickDisk::new(Sickness {
            failed_sync: Some(failed_sync),
            ..Sickness::default()
        });
        let mut rig = RestingRig::new(&plan);
        let mut journal = journal(disk.clone());
        begin(&mut journal, &header(&plan), &[]).unwrap();
        let recorded = record(&plan, &mut rig, &mut Witness, journal, no_wall());
        assert!(
            matches!(&recorded.record.outcome, Outcome::Faulted { reason } if reason.contains("cannot be written"))
        );
        assert!(recorded.fault.is_some());
        let carried_out = rig.0.borrow().carried_out.len();
        let known = recover(&disk.written())
            .unwrap()
            .lines
            .iter()
            .filter(|line| line.kind == EntryKind::Intent)
            .count();
        assert!(
            carried_out <= known && carried_out < healthy,
            "{carried_out} of {known}"
        );
        assert_eq!(
            replay(&plan, logged(&disk.written()).1).mismatch,
            None,
            "sync {failed_sync}: its last words end it again"
        );
        stopped += 1;
    }
    assert_eq!(stopped, 54);
}
