//! psd's own time per step of an impact on a real rig, without waiting for replies and without a disk ([`stand_in`]). Also the time of the
//! uncertainty study after the last step. Also round trips of a reading over a pseudo-terminal and over TCP. Items are steps or
//! round trips. The time of the rig emulator in the first is measured separately and must be subtracted.

mod stand_in;

use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use divan::Bencher;
use divan::counter::ItemsCount;
use psd_plan::Plan;
use psd_rig::controllers::Device;
use psd_rig::emulator::PseudoTerminal;
use psd_rig::emulator::lines::real_time::Carrier as _;
use psd_rig::transport::{MonotonicClock, SerialPort, TcpPort};
use stand_in::{AtOnce, answer, device, emulator, plan, replies, resolved_plan, run, steps};

fn main() {
    divan::main();
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
    let sent = line.take_sent();
    bencher
        .counter(ItemsCount::new(count))
        .with_inputs(|| emulator(&plan))
        .bench_local_values(|emulator| replies(emulator, &sent));
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
