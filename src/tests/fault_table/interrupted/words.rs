//! psd is killed at every command that it sends to a rig, before it and after it. The run is then resumed. In: a plan, an emulator, the
//! number of a command. Out: the same end, and no target is sent twice. `run::tape` tests the writes of the run log.

use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use super::cut_off::{Resumed, resumed};
use crate::run::{Unwatched, replay};
use crate::tests::fault_table::stage::{emulator, header, open_through, plan_of, run};
use crate::tests::testing::ramp;
use psd_plan::{Plan, ProcedureKind, StiffnessRamp};
use psd_rig::emulator::Log;
use psd_rig::journal::{Durability, Journal};
use psd_rig::transport::{Emergency, Port};
use psd_testing::emulator::{InProcess, SimulatedPort};
use psd_testing::journal::PowerLoss;

/// A line on which psd is killed at one command.
struct Dying {
    line: SimulatedPort,
    count: Arc<AtomicUsize>,
    word: usize,
    after: bool,
}

impl Port for Dying {
    fn write(&mut self, bytes: &[u8], timeout: Duration) -> io::Result<()> {
        let now = self.count.fetch_add(1, Ordering::SeqCst) == self.word;
        assert!(!now || self.after, "killed before it");
        let written = self.line.write(bytes, timeout);
        assert!(!now, "killed after it");
        written
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> io::Result<usize> {
        self.line.read(buffer, timeout)
    }

    fn discard(&mut self) -> io::Result<()> {
        self.line.discard()
    }

    fn emergency(&self) -> io::Result<Box<dyn Emergency>> {
        self.line.emergency()
    }
}

/// Whether psd was killed there.
fn killed(plan: &Plan, emulator: &InProcess, disk: &PowerLoss, word: usize, after: bool) -> bool {
    let count = Arc::new(AtomicUsize::new(0));
    let through = |line| -> Box<dyn Port> {
        Box::new(Dying {
            line,
            count: Arc::clone(&count),
            word,
            after,
        })
    };
    let ended = catch_unwind(AssertUnwindSafe(|| {
        let mut rig = open_through(plan, emulator, &through).unwrap();
        let mut journal = Journal::create(Box::new(disk.clone()), Durability::EverySyncPoint);
        replay::begin(&mut journal, &header(plan), &["text".to_owned()]).unwrap();
        replay::record(plan, &mut rig, &mut Unwatched, journal, Box::new(|| None))
    }));
    ended.is_err()
}

/// Three steps out and back.
fn plan() -> Plan {
    let ramp = ramp(1e-4);
    let displacements = ramp.displacements[..3].to_vec();
    plan_of(vec![ProcedureKind::StiffnessRamp(StiffnessRamp {
        displacements,
        return_path: true,
        ..ramp
    })])
}

#[test]
fn killed_at_every_word_it_goes_on_to_the_same_end_and_no_target_is_carried_out_twice() {
    let plan = plan();
    let whole = run(&plan, "");
    let targets = |emulator: &InProcess| {
        emulator
            .lock()
            .rig()
            .moves()
            .iter()
            .map(|sent| sent.targets.clone())
            .collect::<Vec<_>>()
    };
    let moves = targets(&whole.emulator);
    for after in [false, true] {
        let mut kills = 0;
        loop {
            let (emulator, disk) = (emulator(&plan, "", Log::none(), 1), PowerLoss::new());
            if !killed(&plan, &emulator, &disk, kills, after) {
                break;
            }
            kills += 1;
            // The run log has no entry of a rig before the first contact.
            if disk.written().is_empty() {
                continue;
            }
            match resumed(&plan, &emulator, &disk, kills) {
                Resumed::ToItsEnd(record) => {
                    assert_eq!(
                        targets(&emulator),
                        moves,
                        "word {kills}, {after}: each target once, in order"
                    );
                    let results = |record: &psd_plan::record::Record| {
                        format!("{:?}", record.procedures[0].results)
                    };
                    assert_eq!(
                        results(&record),
                        results(&whole.record),
                        "word {kills}, {after}"
                    );
                }
                Resumed::Ended | Resumed::NeverBegun => {}
            }
        }
        assert!(kills > 60, "{kills} words");
    }
}
