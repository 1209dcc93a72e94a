//! psd's own time per step of an impact on a real rig, without waiting for replies and without a disk. Also the time of the
//! uncertainty study after the last step. Also round trips of a reading over a pseudo-terminal and over TCP. Items are steps or
//! round trips. The time of the rig emulator in the first is measured separately and must be subtracted.

use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::TcpListener;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use divan::Bencher;
use divan::counter::ItemsCount;
use psd::check::{Options, check, no_files};
use psd::run::{Unwatched, replay};
use psd_plan::record::{History, Outcome, Record};
use psd_plan::{Plan, RealLink};
use psd_rig::StopRequest;
use psd_rig::controllers;
use psd_rig::controllers::Device;
use psd_rig::emulator::lines::real_time::Carrier as _;
use psd_rig::emulator::{Log, PseudoTerminal, RigEmulator, Script, of_plan};
use psd_rig::journal::{Durability, EntryKind, Journal, Storage};
use psd_rig::real::RealRig;
use psd_rig::transport::{Clock, Emergency, MonotonicClock, Port, SerialPort, TcpPort};

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

fn main() {
    divan::main();
}

/// All its inputs are exact, so that no study follows its steps.
fn plan() -> Plan {
    checked_plan(PLAN)
}

/// Its readings have a resolution of a micrometre, so that the run is studied.
fn resolved_plan() -> Plan {
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

fn emulator(plan: &Plan) -> RigEmulator {
    of_plan(plan, &Script::default(), Log::none(), 1, Some(1)).expect("an emulator")
}

fn link(plan: &Plan) -> &RealLink {
    plan.rig.link.as_real().expect("a real rig")
}

fn device(plan: &Plan, port: Box<dyn Port>, clock: Box<dyn Clock>) -> Box<dyn Device> {
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
struct AtOnce(Arc<Mutex<Shared>>);

struct Shared {
    emulator: RigEmulator,
    /// \[s\]
    now: f64,
    coming: Vec<u8>,
    /// The sent bytes and their times \[s\].
    sent: Vec<(f64, Vec<u8>)>,
}

impl AtOnce {
    fn new(mut emulator: RigEmulator) -> Self {
        emulator.connect(0);
        Self(Arc::new(Mutex::new(Shared {
            emulator,
            now: 0.0,
            coming: Vec::new(),
            sent: Vec::new(),
        })))
    }

    fn shared(&self) -> std::sync::MutexGuard<'_, Shared> {
        self.0.lock().expect("nobody panicked")
    }
}

/// Answer of the emulator to some bytes a millisecond after it received them: by then it has reached its target.
fn answer(emulator: &mut RigEmulator, now: f64, bytes: &[u8], answer: &mut Vec<u8>) {
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
fn run(plan: &Plan, line: &AtOnce) -> Record {
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

fn steps(record: &Record) -> usize {
    assert_eq!(record.outcome, Outcome::Completed, "{:?}", record.events);
    match &record.procedures[0].history {
        History::Impact(history) => history.steps.len() - 1,
        _ => unreachable!("the plan is an impact"),
    }
}

/// All parts of a step: prediction, guard, intent, move, settling, reading, sample, integration, record.
#[divan::bench]
fn step(bencher: Bencher) {
    whole_run(bencher, &plan());
}

/// The same with the uncertainty study: 64 runs along the recorded path with simulated reading errors, divided among threads.
/// The rig is at rest during the study.
#[divan::bench]
fn step_and_study(bencher: Bencher) {
    whole_run(bencher, &resolved_plan());
}

fn whole_run(bencher: Bencher, plan: &Plan) {
    let count = steps(&run(plan, &AtOnce::new(emulator(plan))));
    bencher
        .counter(ItemsCount::new(count))
        .with_inputs(|| AtOnce::new(emulator(plan)))
        .bench_local_values(|line| steps(&run(plan, &line)));
}

/// The part of `step` in the rig emulator: the same bytes at the same times.
#[divan::bench]
fn step_of_the_stand_in_alone(bencher: Bencher) {
    let plan = plan();
    let line = AtOnce::new(emulator(&plan));
    let count = steps(&run(&plan, &line));
    let sent = std::mem::take(&mut line.shared().sent);
    let connected = || {
        let mut emulator = emulator(&plan);
        emulator.connect(0);
        emulator
    };
    bencher
        .counter(ItemsCount::new(count))
        .with_inputs(connected)
        .bench_local_values(|mut emulator| {
            let mut reply = Vec::new();
            for (now, bytes) in &sent {
                reply.clear();
                answer(&mut emulator, *now, bytes, &mut reply);
            }
            reply
        });
}

fn round_trip(bencher: Bencher, mut device: Box<dyn Device>) {
    device.identify().expect("it answers");
    bencher
        .counter(ItemsCount::new(1_u8))
        .bench_local(|| device.sample().expect("a reading"));
}

/// One reading over a pseudo-terminal. The rig emulator does not sleep.
#[divan::bench]
fn reading_over_a_pseudo_terminal(bencher: Bencher) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("rig");
    let plan = plan();
    let mut line = PseudoTerminal::linked(&path).expect("a pseudo-terminal");
    let mut emulator = emulator(&plan);
    let over = Arc::new(AtomicBool::new(false));
    let served = Arc::clone(&over);
    let server = std::thread::spawn(move || {
        emulator.connect(0);
        let (began, mut buffer, mut reply) = (Instant::now(), [0; 512], Vec::new());
        while !served.load(Ordering::Relaxed) {
            let count = line.read(&mut buffer).unwrap_or(0);
            if count == 0 {
                std::thread::yield_now();
                continue;
            }
            answer(
                &mut emulator,
                began.elapsed().as_secs_f64(),
                &buffer[..count],
                &mut reply,
            );
            while !reply.is_empty() {
                let written = line.write(&reply).unwrap_or(0);
                reply.drain(..written);
            }
        }
    });
    let port = SerialPort::open(path.to_str().expect("a plain path"), 115_200).expect("it opens");
    round_trip(
        bencher,
        device(&plan, Box::new(port), Box::new(MonotonicClock::start())),
    );
    over.store(true, Ordering::Relaxed);
    server.join().expect("it ends well");
}

/// One reading over TCP on this machine.
#[divan::bench]
fn reading_over_tcp(bencher: Bencher) {
    let plan = plan();
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port is free");
    let address = listener.local_addr().expect("it is bound").to_string();
    let mut emulator = emulator(&plan);
    let server = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().expect("a client");
        stream.set_nodelay(true).expect("it can");
        emulator.connect(0);
        let (began, mut buffer, mut reply) = (Instant::now(), [0; 512], Vec::new());
        while let Ok(count @ 1..) = stream.read(&mut buffer) {
            reply.clear();
            answer(
                &mut emulator,
                began.elapsed().as_secs_f64(),
                &buffer[..count],
                &mut reply,
            );
            stream.write_all(&reply).expect("it is taken");
        }
    });
    let port = TcpPort::connect(&address, Duration::from_secs(5)).expect("it connects");
    round_trip(
        bencher,
        device(&plan, Box::new(port), Box::new(MonotonicClock::start())),
    );
    server.join().expect("it ends well");
}
