//! The lines of a rig: the replies of every controller to its driver, and the requests to every emulated controller. The good inputs are
//! those of a short conversation of the two.

use std::io::{self, ErrorKind};
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use psd::check::{LoadError, Options, check};
use psd_plan::{DeviceLink, Plan};
use psd_rig::StopRequest;
use psd_rig::controllers::{self, Device, decoded, replies_to_reading};
use psd_rig::emulator::{Log, RigEmulator, Script, of_plan};
use psd_rig::protocols::{generic_header, nees_message};
use psd_rig::transport::{Clock, Emergency, Port};
use psd_testing::emulator::InProcess;
use psd_testing::rig::VirtualClock;

use super::attack;
use crate::dialects::rigs::CASES;

/// Between the pieces of a conversation.
const NEXT: &[u8] = b"<next>";
/// Longest settling time of a rig \[s\].
const SETTLING: f64 = 1.0;

/// The pieces of one side of a conversation.
type Side = Arc<Mutex<Vec<Vec<u8>>>>;

/// A port that writes down what goes through it.
struct Noted {
    port: Box<dyn Port>,
    sent: Side,
    received: Side,
}

impl Port for Noted {
    fn write(&mut self, bytes: &[u8], timeout: Duration) -> io::Result<()> {
        self.sent.lock().unwrap().push(bytes.to_vec());
        self.received.lock().unwrap().push(Vec::new());
        self.port.write(bytes, timeout)
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let count = self.port.read(buffer, timeout)?;
        let mut received = self.received.lock().unwrap();
        if received.is_empty() {
            received.push(Vec::new());
        }
        let last = received.last_mut().expect("a piece");
        last.extend(&buffer[..count]);
        Ok(count)
    }

    fn discard(&mut self) -> io::Result<()> {
        self.port.discard()
    }

    fn emergency(&self) -> io::Result<Box<dyn Emergency>> {
        self.port.emergency()
    }
}

#[derive(Default)]
struct Coming {
    /// The last piece first.
    later: Vec<Vec<u8>>,
    unread: Vec<u8>,
}

/// A port at which hostile bytes come: a piece after each request, and then nothing.
#[derive(Clone)]
struct Hostile {
    clock: VirtualClock,
    shared: Arc<Mutex<Coming>>,
}

impl Hostile {
    fn new(bytes: &[u8]) -> Self {
        let mut later = pieces(bytes);
        later.reverse();
        let unread = later.pop().unwrap_or_default();
        Self {
            clock: VirtualClock::default(),
            shared: Arc::new(Mutex::new(Coming { later, unread })),
        }
    }
}

impl Port for Hostile {
    fn write(&mut self, _: &[u8], _: Duration) -> io::Result<()> {
        let coming = &mut *self.shared.lock().unwrap();
        coming.unread.extend(coming.later.pop().unwrap_or_default());
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> io::Result<usize> {
        let unread = &mut self.shared.lock().unwrap().unread;
        let count = unread.len().min(buffer.len());
        if count == 0 {
            self.clock.advance(timeout.as_secs_f64());
            return Err(ErrorKind::TimedOut.into());
        }
        // Every byte takes time, as on a line.
        self.clock.advance(1e-4);
        buffer[..count].copy_from_slice(&unread[..count]);
        unread.drain(..count);
        Ok(count)
    }

    fn discard(&mut self) -> io::Result<()> {
        self.shared.lock().unwrap().unread.clear();
        Ok(())
    }

    fn emergency(&self) -> io::Result<Box<dyn Emergency>> {
        Ok(Box::new(self.clone()))
    }
}

impl Emergency for Hostile {
    fn send(&mut self, _: &[u8]) {}
}

fn pieces(bytes: &[u8]) -> Vec<Vec<u8>> {
    let (mut pieces, mut start) = (Vec::new(), 0);
    for at in 0..bytes.len() {
        if at >= start && bytes[at..].starts_with(NEXT) {
            pieces.push(bytes[start..at].to_vec());
            start = at + NEXT.len();
        }
    }
    pieces.push(bytes[start..].to_vec());
    pieces
}

/// Everything that a rig asks of a device. What fails, fails.
fn converse(device: &mut dyn Device) {
    let _ = device.identify();
    for target in [1e-4, -1e-4] {
        let targets = vec![target; device.axes()];
        if let Ok(going) = device.encode(&targets, 1e-3) {
            let _ = device.propose(&going).and_then(|()| device.begin(&going));
            let _ = device.start(&going);
            let _ = device.finish(&going);
        }
        for _ in 0..2 {
            if let Ok(sample) = device.sample() {
                assert!(!sample.channels.is_empty());
            }
        }
    }
    let _ = (device.last_move(), device.reported_range());
    let _ = device.hold();
}

/// A rig with its plan.
#[derive(Clone)]
struct Bench(Arc<Plan>);

impl Bench {
    fn all() -> Vec<Self> {
        let beam = include_str!("../../../plans/lib/gfrp_beam.psd");
        let load = |_: &str| -> Result<String, LoadError> { Ok(beam.to_owned()) };
        let options = Options {
            rig: Some("real".to_owned()),
            ..Options::default()
        };
        let plan = |text: &str| check("plan.psd", text, &load, &options).plan;
        let cases = CASES.iter().map(|case| {
            let text = case.plan(Path::new("/dev"), "127.0.0.1:9", 0.5);
            Self(Arc::new(plan(&text).expect("a right plan")))
        });
        cases.collect()
    }

    /// Its devices, each on a line of its own.
    fn links(&self) -> Vec<DeviceLink> {
        let link = self.0.rig.link.as_real().expect("a real rig");
        let both = [link.actuators(), link.load_cells()].concat();
        both.into_iter().map(|behind| behind.link.clone()).collect()
    }

    fn emulator(&self) -> RigEmulator {
        of_plan(&self.0, &Script::default(), Log::none(), 1, Some(7)).expect("an emulator")
    }

    /// What is sent and received on a line when nothing is wrong.
    fn conversation(&self, line: usize, link: &DeviceLink) -> [Vec<u8>; 2] {
        let emulator = InProcess::new(self.emulator());
        let (sent, received) = (Side::default(), Side::default());
        let port = Noted {
            port: Box::new(emulator.port(line)),
            sent: Arc::clone(&sent),
            received: Arc::clone(&received),
        };
        let clock: Box<dyn Clock> = Box::new(emulator.clock());
        let stop = StopRequest::default();
        converse(&mut *controllers::open(
            link,
            Box::new(port),
            clock,
            stop,
            SETTLING,
        ));
        [sent, received].map(|side| side.lock().unwrap().join(NEXT))
    }
}

/// A line of a rig.
struct Line {
    bench: Bench,
    index: usize,
    link: DeviceLink,
}

fn every_line() -> Vec<Line> {
    let mut lines = Vec::new();
    for bench in Bench::all() {
        for (index, link) in bench.links().into_iter().enumerate() {
            let bench = bench.clone();
            lines.push(Line { bench, index, link });
        }
    }
    lines
}

/// Attacks one side of every line. The first byte of an input is the number of its line.
fn attack_lines(name: &str, side: usize, target: impl Fn(&Line, &[u8])) {
    let lines = every_line();
    let seeds = (0_u8..).zip(&lines).map(|(number, line)| {
        let conversation = line.bench.conversation(line.index, &line.link);
        [&[number], conversation[side].as_slice()].concat()
    });
    attack(name, &seeds.collect::<Vec<_>>(), |bytes| {
        if let [number, bytes @ ..] = bytes {
            target(&lines[usize::from(*number) % lines.len()], bytes);
        }
    });
}

#[test]
fn replies_of_a_controller() {
    attack_lines("replies of a controller", 1, |line, bytes| {
        let port = Hostile::new(bytes);
        let clock: Box<dyn Clock> = Box::new(port.clock.clone());
        let stop = StopRequest::default();
        converse(&mut *controllers::open(
            &line.link,
            Box::new(port),
            clock,
            stop,
            SETTLING,
        ));
        if let Some(count) = replies_to_reading(&line.link.dialect) {
            for replies in pieces(bytes).chunks(count) {
                let _ = decoded(&line.link.dialect, 1, replies);
            }
        }
    });
}

#[test]
fn requests_to_an_emulated_controller() {
    attack_lines("requests to an emulated controller", 0, |line, bytes| {
        let mut emulator = line.bench.emulator();
        emulator.connect(line.index);
        for (count, piece) in (0..).zip(pieces(bytes)) {
            emulator.give(line.index, &piece);
            emulator.advance(0.1 * f64::from(count));
            let _ = emulator.take(line.index);
        }
    });
}

#[test]
fn messages_of_a_coordinator() {
    let seeds = [
        "open-session\tdummy\n",
        "propose\ttr-1\tMDL-00-01\tx\tdisplacement\t1.25e-3\n",
        "propose\ttr-2\tMDL-00-01\tx\tdisplacement\t1.0\ty\tforce\t-2\tMDL-00-02\tdisplacement\tz\t0\n",
        "execute\ttr-1\n",
        "get-control-point\ttr-1\tMDL-00-01\n",
        "cancel\ttr-1\n",
        "close-session\tdummy\n",
    ];
    let mut seeds = seeds.map(|seed| seed.as_bytes().to_vec()).to_vec();
    let header = [2_i32, 0, 0, 2, 0, 0, 0, 0, 2, 1, 6];
    seeds.push(header.iter().flat_map(|word| word.to_le_bytes()).collect());
    let names = ["MDL-00-01".to_owned(), "MDL-00-02".to_owned()];
    attack("messages of a coordinator", &seeds, |bytes| {
        if let Some(header) = bytes.first_chunk() {
            let _ = generic_header::parse(header, 2);
        }
        let line = String::from_utf8_lossy(bytes);
        match nees_message::parse(&line) {
            Ok(nees_message::Request::Propose { points, .. }) => {
                let index = |name: &str| nees_message::control_point_index(&names, name);
                let _ = nees_message::demands(&points, index);
            }
            Ok(_) => {}
            Err(refusal) => assert!(refusal.line().len() < 4096),
        }
    });
}
