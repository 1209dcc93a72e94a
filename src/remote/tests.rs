//! Whole sessions over loopback, with clients that are written here from the message layouts.

use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};

use super::*;
use crate::run::Unwatched;
use psd_plan::{Behaviour, Interval, Limits, Settle, Specimen as PlanSpecimen, VirtualLink};
use psd_rig::transport::{Clock as _, MonotonicClock};
use psd_rig::{Guard, Rig, VirtualRig};

const STIFFNESS: f64 = 3e5;

fn generic() -> Protocol {
    Protocol::GenericClient {
        stiffness: vec![STIFFNESS],
    }
}

pub(super) const LIMITS: Limits = Limits {
    displacement: Interval {
        low: -0.02,
        high: 0.02,
    },
    ..Limits::NONE
};

fn spring() -> VirtualRig {
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
    VirtualRig::new(VirtualLink::default(), settle, Some(&specimen), 1.0)
}

/// One control point with any name.
const NEES: Protocol = Protocol::Nees {
    control_points: Vec::new(),
};

/// Serves the spring once while `client` runs, and returns the results of both.
#[expect(clippy::needless_pass_by_value, reason = "each test makes its own")]
fn served<T: Send>(
    protocol: Protocol,
    limits: Limits,
    client: impl FnOnce(SocketAddr) -> T + Send,
) -> (T, Session) {
    served_on(&mut spring(), &protocol, limits, client)
}

pub(super) fn served_on<T: Send>(
    rig: &mut dyn Rig,
    protocol: &Protocol,
    limits: Limits,
    client: impl FnOnce(SocketAddr) -> T + Send,
) -> (T, Session) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    std::thread::scope(|scope| {
        let client = scope.spawn(move || client(address));
        let mut guard = Guard::new(rig, limits, Vec::new()).unwrap();
        let mut sessions = Vec::new();
        let mut on_event = |event: Event<'_>| {
            if let Event::Ended(session) = event {
                sessions.push(session.clone());
            }
        };
        let mut nobody = Unwatched;
        let clock = MonotonicClock::start();
        let now = || clock.now();
        let mut specimen = Specimen::new(&mut guard, &mut nobody, None, &now);
        serve(
            &listener,
            protocol,
            &mut specimen,
            true,
            &StopRequest::default(),
            &mut on_event,
        )
        .unwrap();
        let [session] = sessions.try_into().expect("one session");
        (client.join().unwrap(), session)
    })
}

/// A client of OpenSees' element, words of 64 bits.
pub(super) struct Element {
    stream: TcpStream,
    words: usize,
}

impl Element {
    pub(super) fn connect(address: SocketAddr, header: [i32; 11]) -> Self {
        let mut stream = TcpStream::connect(address).unwrap();
        let bytes: Vec<u8> = header
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        stream.write_all(&bytes).unwrap();
        Self {
            stream,
            words: usize::try_from(header[10]).unwrap(),
        }
    }

    pub(super) fn send(&mut self, words: &[f64]) {
        let padded = words
            .iter()
            .copied()
            .chain(std::iter::repeat(0.0))
            .take(self.words);
        let bytes: Vec<u8> = padded.flat_map(f64::to_le_bytes).collect();
        self.stream.write_all(&bytes).unwrap();
    }

    pub(super) fn ask(&mut self, action: f64) -> Vec<f64> {
        self.send(&[action]);
        let mut bytes = vec![0; 8 * self.words];
        self.stream.read_exact(&mut bytes).unwrap();
        bytes
            .chunks_exact(8)
            .map(|word| f64::from_le_bytes(word.try_into().unwrap()))
            .collect()
    }

    pub(super) fn is_closed(&mut self) -> bool {
        !matches!(self.stream.read(&mut [0; 8]), Ok(1..))
    }
}

const SMALLEST: [i32; 11] = [1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2];
const OPENSEES: [i32; 11] = [1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 256];

#[test]
fn the_smallest_session_gives_the_force() {
    let (force, session) = served(generic(), LIMITS, |address| {
        let mut element = Element::connect(address, SMALLEST);
        element.send(&[3.0, 0.001]);
        let force = element.ask(10.0);
        element.send(&[99.0, 0.0]);
        force
    });
    assert_eq!(force, [300.0, 0.0]);
    let driven = Driven {
        targets: 1,
        refused: 0,
        displacement: 0.001,
        force: 300.0,
    };
    assert_eq!(
        session,
        Session {
            ended: Ended::Closed,
            driven
        }
    );
}

/// Explicit Newmark as OpenSees drives it: 20 kg at 1 m/s on 300 kN/m, steps of 0.1 ms.
#[test]
fn an_explicit_newmark_of_the_client_finds_the_largest_displacement() {
    let (mass, step) = (20.0, 1e-4);
    let (largest, session) = served(generic(), LIMITS, |address| {
        let mut element = Element::connect(address, OPENSEES);
        let (mut d, mut v, mut a, mut largest) = (0.0_f64, 1.0, 0.0, 0.0_f64);
        for n in 1..=200_u32 {
            d += step * v + 0.5 * step * step * a;
            let time = step * f64::from(n);
            element.send(&[3.0, d, v, a, time]);
            assert_eq!(element.ask(14.0)[0], 0.0);
            element.send(&[3.0, d, v, a, time]);
            let next = -element.ask(10.0)[0] / mass;
            element.send(&[5.0]);
            v += 0.5 * step * (a + next);
            a = next;
            largest = largest.max(d);
        }
        element.send(&[99.0]);
        largest
    });
    assert!((largest * 1e3 - 8.16508).abs() < 1e-5, "{largest} m");
    assert_eq!(session.ended, Ended::Closed);
    assert_eq!(session.driven.targets, 200, "a repeat moves nothing");
    assert_eq!(session.driven.displacement, largest);
}

#[test]
fn every_question_of_the_protocol_has_an_answer() {
    // psd returns displacement, velocity, acceleration, force and time.
    let (answers, session) = served(generic(), LIMITS, |address| {
        let mut element = Element::connect(address, [1, 0, 0, 0, 0, 1, 1, 1, 1, 1, 8]);
        element.send(&[3.0, -0.002]);
        let answers = [6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0]
            .map(|action| element.ask(action));
        element.send(&[98.0]);
        answers
    });
    // 2 mm at the rig's own 1 mm/s.
    assert_eq!(answers[0], [-0.002, 0.0, 0.0, -600.0, 2.0, 0.0, 0.0, 0.0]);
    let firsts: Vec<f64> = answers[1..].iter().map(|answer| answer[0]).collect();
    assert_eq!(
        firsts,
        [
            -0.002, 0.0, 0.0, -600.0, 2.0, STIFFNESS, STIFFNESS, 0.0, 0.0
        ]
    );
    assert!(
        answers[1..]
            .iter()
            .all(|answer| answer[1..].iter().all(|word| *word == 0.0)),
        "nothing is left over"
    );
    assert_eq!(session.ended, Ended::Closed);
}

#[test]
fn a_target_beyond_a_limit_closes_and_nothing_moves() {
    for target in [0.021, f64::NAN, f64::INFINITY] {
        let (closed, session) = served(generic(), LIMITS, |address| {
            let mut element = Element::connect(address, SMALLEST);
            element.send(&[3.0, target]);
            let force = element.ask(10.0)[0];
            element.send(&[3.0, 0.001]);
            let still = element.ask(10.0)[0];
            element.send(&[99.0]);
            force.is_nan() && still.is_nan() && element.is_closed()
        });
        assert!(
            closed,
            "nothing is measured any more, and the session closes"
        );
        assert!(
            matches!(session.ended, Ended::Limit(RigFault::LimitBreached { .. })),
            "{session:?}"
        );
        assert_eq!(
            session.driven,
            Driven {
                refused: 1,
                ..Driven::default()
            }
        );
    }
    // The force at 10 mm would be 3 kN.
    let limits = Limits {
        force: Interval {
            low: -2e3,
            high: 2e3,
        },
        ..LIMITS
    };
    let (_, session) = served(generic(), limits, |address| {
        let mut element = Element::connect(address, SMALLEST);
        element.send(&[3.0, 0.01]);
        element.is_closed()
    });
    assert!(
        matches!(session.ended, Ended::Limit(_)) && session.driven.targets == 1,
        "{session:?}"
    );
}

#[test]
fn garbage_moves_nothing_and_a_client_may_hang_up_anywhere() {
    for bytes in [
        &b"GET / HTTP/1.1\r\nHost: psd\r\nAccept: */*\r\n\r\n  "[..],
        &[0xFF; 4096],
        b"open-session\tpsd\n",
    ] {
        let (closed, session) = served(generic(), LIMITS, |address| {
            let mut stream = TcpStream::connect(address).unwrap();
            stream.write_all(bytes).unwrap();
            // The server can have closed the connection by now.
            stream.shutdown(std::net::Shutdown::Write).ok();
            !matches!(stream.read(&mut [0; 8]), Ok(1..))
        });
        assert!(
            closed && matches!(session.ended, Ended::Misspoken(_) | Ended::HungUp),
            "{session:?}"
        );
        assert_eq!(session.driven, Driven::default());
    }
    let (closed, session) = served(generic(), LIMITS, |address| {
        let mut element = Element::connect(address, SMALLEST);
        element.send(&[1.5, 0.001]);
        element.is_closed()
    });
    assert!(closed && matches!(session.ended, Ended::Misspoken(_)));
    // In the middle of a trial: nothing moves.
    let ((), session) = served(generic(), LIMITS, |address| {
        let mut element = Element::connect(address, SMALLEST);
        element.send(&[3.0, 0.001]);
        element.ask(10.0);
        let half: Vec<u8> = [3.0_f64, 0.002]
            .iter()
            .flat_map(|word| word.to_le_bytes())
            .take(12)
            .collect();
        element.stream.write_all(&half).unwrap();
    });
    assert_eq!((session.ended, session.driven.targets), (Ended::HungUp, 1));
}

#[test]
fn a_second_client_is_turned_away_and_the_first_goes_on() {
    let ((turned_away, force), session) = served(generic(), LIMITS, |address| {
        let mut element = Element::connect(address, SMALLEST);
        element.ask(10.0);
        let mut second = TcpStream::connect(address).unwrap();
        let turned_away = !matches!(second.read(&mut [0; 8]), Ok(1..));
        element.send(&[3.0, 0.001]);
        let force = element.ask(10.0)[0];
        element.send(&[99.0]);
        (turned_away, force)
    });
    assert!(turned_away && force == 300.0);
    assert_eq!(session.ended, Ended::Closed);
}

/// Sends lines one after the other, each after the answer to the previous one.
fn coordinator(address: SocketAddr, lines: &[&str]) -> Vec<String> {
    use std::io::BufRead as _;
    let mut stream = TcpStream::connect(address).unwrap();
    let mut reader = std::io::BufReader::new(stream.try_clone().unwrap());
    let mut answer = |line: &&str| {
        stream.write_all(line.as_bytes()).unwrap();
        let mut answer = String::new();
        reader.read_line(&mut answer).unwrap();
        answer
    };
    lines.iter().map(&mut answer).collect()
}

#[test]
fn a_nees_session_refuses_a_proposal_beyond_a_limit_and_goes_on() {
    let (answers, session) = served(NEES, LIMITS, |address| {
        let lines = [
            "propose\tt0\tMDL-00-01\tx\tdisplacement\t1.0E-03\n",
            "open-session\tOpenFresco\n",
            "set-parameter\tdummy\tnstep\t10\n",
            "propose\tt1\tMDL-00-01\tx\tdisplacement\t1.0000000000E-03\n",
            "execute\tt1\n",
            "get-control-point\tt1\tMDL-00-01\n",
            "propose\tt2\tMDL-00-01\tx\tdisplacement\t2.1E-02\n",
            "execute\tt2\n",
            "propose\tt3[1 0 0]\tMDL-00-01:LBCB1\ty\tdisplacement\t-2.0E-03\r\n",
            "execute\tt3[1 0 0]\r\n",
            "get-control-point\tdummy\tMDL-00-01:LBCB1\r\n",
            "propose\tt4\tMDL-AUX\tdisplacement\tz\t3500\n",
            "execute\tt4\n",
            "propose\tt5\tMDL-00-01\tx\tdisplacement\t0\n",
            "cancel\tt5\n",
            "execute\tt5\n",
            "close-session\tOpenFresco\n",
        ];
        coordinator(address, &lines)
    });
    let by_hand = [
        "NOT OK\t3\t\tno session is open\n",
        "OK\t0\tsession opened\n",
        "OK\t0\tparameter set\n",
        "OK\t0\tt1\n",
        "OK\t0\tt1\n",
        "OK\t0\tt1\tMDL-00-01\tx\tdisplacement\t1.0000000000E-03\tx\tforce\t3.0000000000E+02\n",
        "NOT OK\t1\tt2\ttarget displacement 21 mm is outside its limit -20 mm .. 20 mm\n",
        "NOT OK\t3\tt2\tnot the last proposed transaction\n",
        "OK\t0\tt3[1 0 0]\r\n",
        "OK\t0\tt3[1 0 0]\r\n",
        "OK\t0\tdummy\tMDL-00-01:LBCB1\ty\tdisplacement\t-2.0000000000E-03\ty\tforce\t-6.0000000000E+02\r\n",
        "OK\t0\tt4\n",
        "OK\t0\tt4\n",
        "OK\t0\tt5\n",
        "OK\t0\tt5\n",
        "NOT OK\t3\tt5\tnot the last proposed transaction\n",
        "OK\t0\tsession closed\n",
    ];
    assert_eq!(answers, by_hand);
    let driven = Driven {
        targets: 2,
        refused: 1,
        displacement: 0.002,
        force: 600.0,
    };
    assert_eq!(
        session,
        Session {
            ended: Ended::Closed,
            driven
        }
    );
}

#[test]
fn a_nees_reading_beyond_a_limit_is_reported_and_ends_the_session() {
    let limits = Limits {
        force: Interval {
            low: -2e3,
            high: 2e3,
        },
        ..LIMITS
    };
    let (answers, session) = served(NEES, limits, |address| {
        coordinator(
            address,
            &[
                "open-session\tc\n",
                "propose\tt1\tMDL-00-01\tx\tdisplacement\t0.01\n",
                "execute\tt1\n",
            ],
        )
    });
    assert!(
        answers[2].starts_with("NOT OK\t1\tt1\tforce 3 kN is outside"),
        "{answers:?}"
    );
    assert!(matches!(session.ended, Ended::Limit(_)));
}

#[test]
fn a_line_without_end_is_not_gathered_for_ever_and_what_is_no_message_is_answered() {
    let (closed, session) = served(NEES, LIMITS, |address| {
        let mut stream = TcpStream::connect(address).unwrap();
        // The other side can close before all is written.
        let _ = stream.write_all(&vec![b'A'; 100_000]);
        !matches!(stream.read(&mut [0; 8]), Ok(1..))
    });
    assert!(
        closed && matches!(session.ended, Ended::Misspoken(_)),
        "{session:?}"
    );
    let (answers, session) = served(NEES, LIMITS, |address| {
        coordinator(address, &["\u{1b}[2Jhello\n", "\n"])
    });
    assert!(
        answers
            .iter()
            .all(|answer| answer.starts_with("NOT OK\t2\t")),
        "{answers:?}"
    );
    assert_eq!(
        session,
        Session {
            ended: Ended::HungUp,
            driven: Driven::default()
        }
    );
}

/// Returns how a session ends if its client sends these bytes and then nothing more.
fn ended_in_silence(protocol: &Protocol, sent: &[u8]) -> Ended {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let mut client = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
    client.write_all(sent).unwrap();
    let (mut rig, mut nobody, stop_request) = (spring(), Unwatched, StopRequest::default());
    let mut guard = Guard::new(&mut rig, LIMITS, Vec::new()).unwrap();
    let clock = MonotonicClock::start();
    let now = || clock.now();
    let mut specimen = Specimen::new(&mut guard, &mut nobody, None, &now);
    let mut connection =
        Connection::new(listener.accept().unwrap().0, LOOK, &stop_request).unwrap();
    connection.patience = Duration::from_millis(50);
    match protocol {
        Protocol::Nees { control_points } => {
            nees::session(&mut connection, &mut specimen, control_points)
        }
        Protocol::GenericClient { stiffness } => {
            generic_client::session(&mut connection, &mut specimen, stiffness)
        }
    }
}

#[test]
fn a_client_that_owes_a_word_and_is_silent_is_sent_away() {
    let header: Vec<u8> = SMALLEST
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    let asks: Vec<u8> = [header.as_slice(), &3.0_f64.to_le_bytes()[..5]].concat();
    for (protocol, sent) in [
        (generic(), &b""[..]),
        (generic(), &header[..20]),
        (generic(), asks.as_slice()),
        (NEES, b""),
        (NEES, b"open-session\ttest\npropose\tt1"),
        (NEES, b"hello\n"),
    ] {
        let ended = ended_in_silence(&protocol, sent);
        assert!(
            matches!(&ended, Ended::Misspoken(reason) if reason.contains("silent")),
            "{sent:?}: {ended:?}"
        );
    }
}
