//! Cost of one step of OpenSees over loopback: messages of 256 words, four of them answered. Nagle's delay stays on as in
//! OpenSees, and the specimen moves at every step. Items are steps.

use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::thread::JoinHandle;
use std::time::Instant;

use divan::Bencher;
use divan::counter::ItemsCount;
use psd::remote::{Protocol, serve};
use psd::run::Unwatched;
use psd::run::remote_control::Specimen;
use psd_plan::{Behaviour, Interval, Limits, Settle, Specimen as PlanSpecimen, VirtualLink};
use psd_rig::{Guard, StopRequest, VirtualRig};

const STIFFNESS: f64 = 3e5;
const WORDS: usize = 256;

fn main() {
    divan::main();
}

/// A server on its own thread, and its client.
fn connected() -> (TcpStream, JoinHandle<()>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port is free");
    let address = listener.local_addr().expect("it is bound");
    let server = std::thread::spawn(move || {
        let behaviour = Some(Behaviour::Elastic {
            stiffness: STIFFNESS,
        });
        let specimen = PlanSpecimen::new("spring", 20.0, behaviour);
        let settle = Settle {
            band: 0.0,
            force_rate: 0.0,
            dwell: 0.0,
            timeout: 60.0,
        };
        let mut rig = VirtualRig::new(VirtualLink::default(), settle, Some(&specimen), 1.0);
        let limits = Limits {
            displacement: Interval {
                low: -0.02,
                high: 0.02,
            },
            ..Limits::NONE
        };
        let mut guard =
            Guard::new(&mut rig, limits, Vec::new()).expect("it stands inside its limits");
        let protocol = Protocol::GenericClient {
            stiffness: vec![STIFFNESS],
        };
        let mut nobody = Unwatched;
        let start = Instant::now();
        let now = || start.elapsed().as_secs_f64();
        let mut specimen = Specimen::new(&mut guard, &mut nobody, None, &now);
        serve(
            &listener,
            &protocol,
            &mut specimen,
            true,
            &StopRequest::default(),
            &mut |_| (),
        )
        .expect("it listens");
    });
    let mut client = TcpStream::connect(address).expect("it listens");
    let header = [1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 256_i32].map(i32::to_le_bytes);
    client
        .write_all(header.as_flattened())
        .expect("it is taken");
    (client, server)
}

/// Sends one message.
fn send(client: &mut TcpStream, message: &mut [u8; 8 * WORDS], words: &[f64]) {
    message.fill(0);
    for (bytes, word) in message.chunks_exact_mut(8).zip(words) {
        bytes.copy_from_slice(&word.to_le_bytes());
    }
    client.write_all(message).expect("it is taken");
}

#[divan::bench]
fn opensees_step(bencher: Bencher) {
    let (mut client, server) = connected();
    let mut message = [0; 8 * WORDS];
    let mut answer = [0; 8 * WORDS];
    let mut step = 0_u32;
    bencher.counter(ItemsCount::new(1_u64)).bench_local(|| {
        step += 1;
        let displacement = f64::from(step % 100) * 1e-4;
        let trial = [3.0, displacement, 0.0, 0.0, f64::from(step)];
        for action in [14.0, 14.0, 13.0, 10.0] {
            if action == 14.0 {
                send(&mut client, &mut message, &trial);
            }
            send(&mut client, &mut message, &[action]);
            client.read_exact(&mut answer).expect("it answers");
        }
        send(&mut client, &mut message, &[5.0]);
        answer[0]
    });
    send(&mut client, &mut message, &[99.0]);
    server.join().expect("it ends well");
}
