//! A real rig without waiting and without a disk: an emulator that answers immediately, and a run log that is stored nowhere.

use std::io::{self, ErrorKind};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use psd::check::{Options, check, no_files};
use psd::run::{Unwatched, replay};
use psd_plan::record::{History, Outcome, Record};
use psd_plan::{Plan, RealLink};
use psd_rig::StopRequest;
use psd_rig::controllers;
use psd_rig::controllers::Device;
use psd_rig::emulator::{Log, RigEmulator, Script, of_plan};
use psd_rig::journal::{Durability, EntryKind, Journal, Storage};
use psd_rig::real::RealRig;
use psd_rig::transport::{Clock, Emergency, Port};

const PLAN: &str = r#"
specimen beam {
  mass      = 0.73 kg
  behaviour = elastic(stiffness: 300 kN/m)
  damping   = 6 N*s/m
}

limits {
  displacement = -1 mm .. 12 mm
  force        = 5 kN
  speed        = 400 mm/s
}

rig real {
  link        = serial(port: "/dev/none", dialect: native)
  settle      = within(0.002 mm, 50 kN/s, timeout: 5 s)
  safe_state  = hold
  pretest_check        = probe(0.1 mm, stiffness: 250 kN/m .. 350 kN/m, zero: 2 N)
  rate        = 200 Hz
  samples     = 1
  calibration = "none"
}

striker pendulum {
  mass     = 20 kg
  velocity = 1 m/s
}

impact hit {
  striker   = pendulum
  stiffness = 300 kN/m
  contact   = rigid
  time_step = 0.01 ms
  duration  = 12 ms
}
"#;

/// All its inputs are exact, so that no study follows its steps.
pub fn plan() -> Plan {
    checked_plan(PLAN)
}

/// Its readings have a resolution of a micrometre, so that the run is studied.
pub fn resolved_plan() -> Plan {
    checked_plan(&PLAN.replace("rate        =", "resolution  = 1 um\n  rate        ="))
}

fn checked_plan(text: &str) -> Plan {
    let options = Options {
        rig: Some("real".to_owned()),
        ..Options::default()
    };
    let checked = check("plan.psd", text, &no_files, &options);
    checked
        .plan
        .unwrap_or_else(|| panic!("{:?}", checked.diagnostics))
}

pub fn emulator(plan: &Plan) -> RigEmulator {
    of_plan(plan, &Script::default(), Log::none(), 1, Some(1)).expect("an emulator")
}

fn link(plan: &Plan) -> &RealLink {
    plan.rig.link.as_real().expect("a real rig")
}

pub fn device(plan: &Plan, port: Box<dyn Port>, clock: Box<dyn Clock>) -> Box<dyn Device> {
    controllers::open(
        &link(plan).actuator,
        port,
        clock,
        StopRequest::default(),
        plan.rig.settle.timeout,
    )
}

/// An emulator that answers immediately. Its time passes while the host waits.
#[derive(Clone)]
pub struct AtOnce(Arc<Mutex<Shared>>);

struct Shared {
    emulator: RigEmulator,
    /// \[s\]
    now: f64,
    coming: Vec<u8>,
    /// The sent bytes and their times \[s\].
    sent: Vec<(f64, Vec<u8>)>,
}

impl AtOnce {
    pub fn new(mut emulator: RigEmulator) -> Self {
        emulator.connect(0);
        Self(Arc::new(Mutex::new(Shared {
            emulator,
            now: 0.0,
            coming: Vec::new(),
            sent: Vec::new(),
        })))
    }

    /// The sent bytes and their times \[s\].
    pub fn take_sent(&self) -> Vec<(f64, Vec<u8>)> {
        std::mem::take(&mut self.shared().sent)
    }

    fn shared(&self) -> std::sync::MutexGuard<'_, Shared> {
        self.0.lock().expect("nobody panicked")
    }
}

/// Answer of the emulator to some bytes a millisecond after it received them: by then it has reached its target.
pub fn answer(emulator: &mut RigEmulator, now: f64, bytes: &[u8], answer: &mut Vec<u8>) {
    emulator.advance(now);
    emulator.give(0, bytes);
    while let Some(piece) = emulator.take(0) {
        answer.extend(piece);
    }
}

impl Port for AtOnce {
    fn write(&mut self, bytes: &[u8], _: Duration) -> io::Result<()> {
        let shared = &mut *self.shared();
        shared.now += 0.001;
        shared.sent.push((shared.now, bytes.to_vec()));
        answer(&mut shared.emulator, shared.now, bytes, &mut shared.coming);
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let mut shared = self.shared();
        if shared.coming.is_empty() {
            shared.now += timeout.as_secs_f64();
            return Err(ErrorKind::TimedOut.into());
        }
        let count = shared.coming.len().min(buffer.len());
        buffer[..count].copy_from_slice(&shared.coming[..count]);
        shared.coming.drain(..count);
        Ok(count)
    }

    fn discard(&mut self) -> io::Result<()> {
        self.shared().coming.clear();
        Ok(())
    }

    fn emergency(&self) -> io::Result<Box<dyn Emergency>> {
        Ok(Box::new(self.clone()))
    }
}

impl Emergency for AtOnce {
    fn send(&mut self, bytes: &[u8]) {
        let _ = self.write(bytes, Duration::ZERO);
    }
}

impl Clock for AtOnce {
    fn now(&self) -> f64 {
        self.shared().now
    }

    fn sleep(&mut self, seconds: f64) {
        self.shared().now += seconds;
    }

    fn wall(&self) -> Option<String> {
        None
    }
}

/// Accepts all bytes and stores none.
struct Nowhere;

impl Storage for Nowhere {
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        divan::black_box(bytes);
        Ok(())
    }

    fn sync(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn cut(&mut self, _: u64) -> io::Result<()> {
        Ok(())
    }
}

/// Runs the plan on a rig that answers immediately, recorded to memory.
pub fn run(plan: &Plan, line: &AtOnce) -> Record {
    let actuator = device(plan, Box::new(line.clone()), Box::new(line.clone()));
    let mut rig = RealRig::open(
        &plan.rig,
        &plan.limits,
        actuator,
        None,
        Box::new(line.clone()),
        StopRequest::default(),
    )
    .expect("it opens");
    let mut journal = Journal::create(Box::new(Nowhere), Durability::EverySyncPoint);
    journal
        .append(EntryKind::Header, &serde_json::json!({}))
        .expect("the header is taken");
    let wall = Box::new(|| None);
    replay::record(plan, &mut rig, &mut Unwatched, journal, wall).record
}

pub fn steps(record: &Record) -> usize {
    assert_eq!(record.outcome, Outcome::Completed, "{:?}", record.events);
    match &record.procedures[0].history {
        History::Impact(history) => history.steps.len() - 1,
        _ => unreachable!("the plan is an impact"),
    }
}

/// The replies of the emulator to these bytes at these times \[s\], without a rig.
pub fn replies(mut emulator: RigEmulator, sent: &[(f64, Vec<u8>)]) -> Vec<u8> {
    emulator.connect(0);
    let mut reply = Vec::new();
    for (now, bytes) in sent {
        reply.clear();
        answer(&mut emulator, *now, bytes, &mut reply);
    }
    reply
}
