//! A real rig driven by clients: `psd rig serve` between small clients of its two protocols and a rig emulator behind a
//! pseudo-terminal. Whatever client, rig or operator do, the rig is HELD afterwards, and the run log verifies.

use std::io::{BufRead as _, BufReader, ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Child, ChildStdout, Stdio};
use std::time::Duration;

use rustix::process::Signal;

use crate::stage::{Stage, code, let_it_trip, signal, until, watched};

/// `psd rig serve` on a stage's rig, ready for clients.
pub struct Served {
    pub stage: Stage,
    program: Child,
    stdout: BufReader<ChildStdout>,
    pub address: String,
}

impl Served {
    fn nees(script: &str) -> Self {
        Self::start(script, "nees", &[])
    }

    fn generic(script: &str) -> Self {
        Self::start(script, "generic-client", &[])
    }

    pub fn start(script: &str, protocol: &str, more: &[&str]) -> Self {
        Self::start_on(Stage::of(str::to_owned, script), protocol, more)
    }

    /// Starts on the rig of a separate stage.
    pub fn start_on(stage: Stage, protocol: &str, more: &[&str]) -> Self {
        let mut command = stage.recorded_tool(
            "serve",
            &["--protocol", protocol, "--listen", "127.0.0.1:0", "--yes"],
        );
        let log_file = std::fs::File::create(stage.path("serve.told")).unwrap();
        let mut program = command
            .args(more)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(log_file)
            .spawn()
            .unwrap();
        let mut stdout = BufReader::new(program.stdout.take().unwrap());
        let mut ready = String::new();
        stdout.read_line(&mut ready).unwrap();
        let address = ready
            .trim_end()
            .strip_prefix(&format!("ready: {protocol} on "))
            .unwrap_or_else(|| {
                panic!(
                    "not ready: {}",
                    std::fs::read_to_string(stage.path("serve.told")).unwrap()
                );
            });
        let address = address.to_owned();
        Self {
            stage,
            program,
            stdout,
            address,
        }
    }

    pub fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(&self.address).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_mins(3)))
            .unwrap();
        stream
    }

    /// Waits until the program has printed this on standard error.
    fn prints(&self, words: &str) {
        until(words, || {
            std::fs::read_to_string(self.stage.path("serve.told"))
                .unwrap()
                .contains(words)
        });
    }

    /// The end of the program: its exit code and output. The rig is held, and the run log verified.
    pub fn ended(&mut self) -> (Option<i32>, String) {
        let code = code(&mut self.program);
        let mut printed = String::new();
        self.stdout.read_to_string(&mut printed).unwrap();
        self.stage.proven();
        (code, printed)
    }

    pub fn held(&self) {
        let requests = self.stage.requests();
        let last = |what: &str| requests.iter().rposition(|request| request.contains(what));
        assert!(
            last(">STOP").max(last("!")) > last(">MOVE"),
            "not held: {requests:#?}"
        );
    }

    /// The operator ends it.
    pub fn stop(&mut self, sent: Signal) -> (Option<i32>, String) {
        signal(&self.program, sent);
        self.ended()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

/// A coordinator of the NEES protocol.
pub struct Coordinator {
    lines: BufReader<TcpStream>,
    transactions: u32,
}

impl Coordinator {
    /// A client that comes while the session before it still ends is turned away, and comes again.
    pub fn come(served: &Served) -> Self {
        let mut come = None;
        until("a session is opened", || {
            come = Self::opened(served);
            come.is_some()
        });
        come.unwrap()
    }

    fn opened(served: &Served) -> Option<Self> {
        let mut lines = BufReader::new(served.connect());
        lines.get_mut().write_all(b"open-session\ttest\n").ok()?;
        let mut answer = String::new();
        lines.read_line(&mut answer).ok()?;
        (answer.trim_end() == "OK\t0\tsession opened").then_some(Self {
            lines,
            transactions: 0,
        })
    }

    fn send(&mut self, line: &str) {
        self.lines
            .get_mut()
            .write_all(format!("{line}\n").as_bytes())
            .unwrap();
    }

    pub fn ask(&mut self, line: &str) -> String {
        self.send(line);
        let mut answer = String::new();
        self.lines.read_line(&mut answer).unwrap();
        answer.trim_end().to_owned()
    }

    /// Proposes a position \[m\] and executes it if it is accepted. Returns the answers.
    fn go(&mut self, position: f64) -> Vec<String> {
        self.transactions += 1;
        let id = format!("trans{}", self.transactions);
        let proposed = self.ask(&format!(
            "propose\t{id}\tMDL-00-01\tx\tdisplacement\t{position:.10E}"
        ));
        let accepted = proposed.starts_with("OK");
        let mut answers = vec![proposed];
        if accepted {
            answers.push(self.ask(&format!("execute\t{id}")));
        }
        answers
    }

    /// Displacement and force \[m, N\].
    fn position_and_force(&mut self) -> (f64, f64) {
        let answer = self.ask("get-control-point\tdummy\tMDL-00-01");
        let words: Vec<&str> = answer.split('\t').collect();
        assert_eq!(
            (words[0], words[2], words[3]),
            ("OK", "dummy", "MDL-00-01"),
            "{answer}"
        );
        (words[6].parse().unwrap(), words[9].parse().unwrap())
    }

    pub fn close(mut self) {
        assert_eq!(self.ask("close-session\ttest"), "OK\t0\tsession closed");
    }
}

/// A finite-element program's element of one degree of freedom.
struct Element(TcpStream);

impl Element {
    fn come(served: &Served) -> Self {
        let mut stream = served.connect();
        let header = [1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2_i32].map(i32::to_le_bytes);
        stream.write_all(header.as_flattened()).unwrap();
        Self(stream)
    }

    fn send(&mut self, words: [f64; 2]) {
        self.0
            .write_all(words.map(f64::to_le_bytes).as_flattened())
            .unwrap();
    }

    /// The force at a position \[N\].
    fn force_at(&mut self, position: f64) -> f64 {
        self.send([3.0, position]);
        self.force()
    }

    fn force(&mut self) -> f64 {
        self.send([10.0, 0.0]);
        let mut answer = [0; 16];
        self.0.read_exact(&mut answer).unwrap();
        f64::from_le_bytes(answer[..8].try_into().unwrap())
    }
}

/// Whether the other side has closed the connection, with or without bytes before.
fn is_closed(stream: &mut TcpStream) -> bool {
    let mut buffer = [0; 1024];
    loop {
        match stream.read(&mut buffer) {
            Ok(0) => return true,
            Ok(_) => {}
            Err(error) => return error.kind() == ErrorKind::ConnectionReset,
        }
    }
}

#[test]
fn a_coordinator_drives_it_and_is_refused_beyond_a_limit() {
    let mut served = Served::start("", "nees", &["--once"]);
    let probed = served.stage.moves().len();
    let mut client = Coordinator::come(&served);
    assert_eq!(client.go(1e-3), ["OK\t0\ttrans1", "OK\t0\ttrans1"]);
    assert_eq!(client.position_and_force(), (1e-3, 100.0));
    let refused = client.go(10.001e-3);
    assert!(
        refused[0].starts_with("NOT OK\t1\ttrans2\t") && refused[0].contains("outside its limit"),
        "{refused:?}"
    );
    assert_eq!(
        client.ask("execute\ttrans2").split('\t').next(),
        Some("NOT OK"),
        "what was refused cannot be executed"
    );
    assert_eq!(
        client.position_and_force(),
        (1e-3, 100.0),
        "nothing has moved"
    );
    assert_eq!(client.go(-1e-3), ["OK\t0\ttrans3", "OK\t0\ttrans3"]);
    client.close();
    let (code, printed) = served.ended();
    assert_eq!(code, Some(4));
    assert!(
        printed.starts_with("session: closed by the client\ntargets: 2, 1 refused by a limit\n"),
        "{printed}"
    );
    assert_eq!(served.stage.moves().len(), probed + 2);
    served.held();
}

#[test]
fn an_element_beyond_a_limit_gets_no_number_until_it_leaves() {
    let mut served = Served::generic("");
    let mut element = Element::come(&served);
    assert_eq!(element.force_at(-2e-3), -200.0);
    let moves = served.stage.moves().len();
    assert!(element.force_at(-5.001e-3).is_nan());
    assert!(
        element.force().is_nan() && element.force_at(1e-3).is_nan(),
        "nor does it move any more"
    );
    element.send([99.0, 0.0]);
    let (code, printed) = served.ended();
    assert_eq!(code, Some(4), "{printed}");
    assert_eq!(served.stage.moves().len(), moves);
    served.held();
}

#[test]
fn each_signal_in_a_session_holds_the_rig_and_keeps_the_record() {
    for sent in [Signal::INT, Signal::TERM, Signal::HUP, Signal::QUIT] {
        let mut served = Served::nees("");
        let mut client = Coordinator::come(&served);
        client.go(1e-3);
        let (code, printed) = served.stop(sent);
        assert_eq!(code, Some(4), "{printed}");
        assert!(
            printed.starts_with("session: stopped by the operator\ntargets: 1\n"),
            "{printed}"
        );
        assert!(is_closed(client.lines.get_mut()));
        served.held();

        let mut served = Served::generic("");
        let mut element = Element::come(&served);
        element.force_at(1e-3);
        signal(&served.program, sent);
        until("it says so to the element too", || element.force().is_nan());
        element.send([99.0, 0.0]);
        assert_eq!(served.ended().0, Some(4));
        served.held();
    }
}

#[test]
fn a_rig_that_falls_silent_ends_the_session_and_the_client_is_informed() {
    // The pre-test check makes two moves.
    let silent = || Stage::of(watched, "after 3 moves: drop replies for ever");
    let mut served = Served::start_on(silent(), "nees", &[]);
    let mut client = Coordinator::come(&served);
    let answers = client.go(1e-3);
    let failed = answers.last().unwrap();
    assert!(
        failed.starts_with("NOT OK\t4\ttrans1\t") && failed.contains("no usable answer within"),
        "{answers:?}"
    );
    assert!(is_closed(client.lines.get_mut()));
    let (code, printed) = served.ended();
    assert!(
        code == Some(3) && printed.contains("no usable answer within"),
        "{printed}"
    );
    served.held();

    let mut served = Served::start_on(silent(), "generic-client", &[]);
    let mut element = Element::come(&served);
    assert!(element.force_at(1e-3).is_nan());
    element.send([99.0, 0.0]);
    assert_eq!(served.ended().0, Some(3));
    served.held();
}

/// Also while it waits for a client, and while a client is silent: a lost rig is noticed.
#[test]
fn a_rig_that_goes_away_while_nobody_asks_is_noticed() {
    // It is polled eight times within its watchdog time.
    let hanging_up = || {
        Served::start_on(
            Stage::of(watched, "after 40 readings: hang up"),
            "nees",
            &[],
        )
    };
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let mut served = hanging_up();
            let mut client = served.connect();
            assert!(is_closed(&mut client));
            assert_eq!(served.ended().0, Some(3));
        });
        let (code, printed) = hanging_up().ended();
        assert!(
            code == Some(3) && printed.contains("connection lost"),
            "{printed}"
        );
    });
}

#[test]
fn a_client_that_goes_away_leaves_it_held_and_the_next_one_goes_on() {
    let mut served = Served::nees("");
    let mut first = Coordinator::come(&served);
    first.go(1e-3);
    first.send("propose\tlast\tMDL-00-01\tx\tdisplacement\t2.0E-3");
    drop(first);
    served.prints("session ended: the client left without closing");
    served.held();
    let mut second = Coordinator::come(&served);
    assert_eq!(
        second.position_and_force(),
        (1e-3, 100.0),
        "where the first one left it"
    );
    assert!(
        second.ask("execute\tlast").starts_with("NOT OK"),
        "what the first one proposed is gone with it"
    );
    second.go(0.0);
    second.close();
    served.prints("session ended: closed by the client");
    let (code, printed) = served.stop(Signal::INT);
    assert_eq!(code, Some(3), "the worst session counts: {printed}");
    assert_eq!(printed.matches("session: ").count(), 2, "{printed}");
    served.held();
}

/// The stage whose rig needs 400 s to its client's target, and 2 s for the probe of the pre-test check.
fn endless() -> Stage {
    let slower = |plan: &str| {
        plan.replace(
            "speed      = 20 mm/s",
            "speed      = 0.01 mm/s\n  resolution = 1 um",
        )
    };
    Stage::of(
        |plan| slower(plan).replace("probe(0.1 mm", "probe(0.02 mm"),
        "",
    )
}

#[test]
fn a_client_that_goes_away_in_the_middle_of_a_move_has_the_rig_held_at_once() {
    let mut served = Served::start_on(endless(), "generic-client", &[]);
    let mut element = Element::come(&served);
    // Its next request is sent already, as an element sends it.
    element.send([3.0, 4e-3]);
    element.send([10.0, 0.0]);
    served.stage.after_moves(3);
    drop(element);
    served.prints("session ended: the client left without closing");
    served.held();
    // The next client finds it at its hold position, and is served.
    let mut next = Element::come(&served);
    next.send([99.0, 0.0]);
    served.prints("session ended: closed by the client");
    assert_eq!(served.stop(Signal::TERM).0, Some(3));

    let mut served = Served::start_on(endless(), "nees", &["--once"]);
    let mut client = Coordinator::come(&served);
    client.ask("propose\tt1\tMDL-00-01\tx\tdisplacement\t4.0E-3");
    client.send("execute\tt1");
    served.stage.after_moves(3);
    drop(client);
    assert_eq!(served.ended().0, Some(3));
    served.held();
}

#[test]
fn a_signal_in_the_middle_of_a_clients_move_holds_at_once() {
    let mut served = Served::start_on(endless(), "generic-client", &[]);
    let mut element = Element::come(&served);
    element.send([3.0, 4e-3]);
    served.stage.after_moves(3);
    assert_eq!(served.stop(Signal::TERM).0, Some(4));
    served.held();
}

#[test]
fn a_client_that_took_its_leave_before_it_went_away_has_its_last_move() {
    let mut served = Served::start("", "generic-client", &["--once"]);
    let mut element = Element::come(&served);
    element.send([3.0, 1e-3]);
    element.send([5.0, 0.0]);
    element.send([99.0, 0.0]);
    drop(element);
    let (code, printed) = served.ended();
    assert!(
        code == Some(0) && printed.contains("session: closed by the client\ntargets: 1\n"),
        "{printed}"
    );

    let mut served = Served::start("", "nees", &["--once"]);
    let mut client = Coordinator::come(&served);
    client.ask("propose\tt1\tMDL-00-01\tx\tdisplacement\t1.0E-3");
    client.send("execute\tt1\nclose-session\ttest");
    // It sends nothing more, and reads the answers.
    client
        .lines
        .get_mut()
        .shutdown(std::net::Shutdown::Write)
        .unwrap();
    assert!(is_closed(client.lines.get_mut()));
    assert_eq!(served.ended().0, Some(0));
}

#[test]
fn an_element_that_goes_away_in_the_middle_of_a_message_moves_nothing() {
    let mut served = Served::start("", "generic-client", &["--once"]);
    let mut element = Element::come(&served);
    assert_eq!(element.force_at(1e-3), 100.0);
    let moves = served.stage.moves().len();
    // The action and three bytes of its target.
    element.0.write_all(&3.0_f64.to_le_bytes()).unwrap();
    element.0.write_all(&[0, 0, 0]).unwrap();
    drop(element);
    assert_eq!(served.ended().0, Some(3));
    assert_eq!(served.stage.moves().len(), moves);
    served.held();
}

#[test]
fn garbage_is_answered_or_sent_away_and_moves_nothing() {
    let mut served = Served::nees("");
    let moves = served.stage.moves().len();
    let mut client = Coordinator::come(&served);
    for line in [
        "",
        "GET / HTTP/1.1",
        "propose",
        "propose\tt1",
        "propose\tt1\tMDL-00-01\tx\tdisplacement",
        "propose\tt1\tMDL-00-01\tx\tdisplacement\tnan",
        "propose\tt1\tMDL-00-01\tx\tdisplacement\t1e400",
        "propose\tt1\tMDL-00-01\tx\tdisplacement\t1,5",
        "propose\tt1\tMDL-00-01\tx\tforce\t100",
        "propose\tt1\tMDL-00-01\tx\tdisplacement\t0.001\tMDL-00-02\tx\tdisplacement\t0.001",
        "execute\tt1",
        "\u{0}\u{1b}[2J\u{7}",
    ] {
        let answer = client.ask(line);
        assert!(answer.starts_with("NOT OK\t"), "{line:?}: {answer:?}");
    }
    // A line that does not end.
    client.lines.get_mut().write_all(&[b'x'; 5000]).unwrap();
    assert!(is_closed(client.lines.get_mut()));
    served.prints("the client cannot be served: a line of more than 4096 bytes");
    let mut half = served.connect();
    half.write_all(b"open-session\ttest\npropose\tt1\tMDL-00-01\tx\tdisp")
        .unwrap();
    half.shutdown(std::net::Shutdown::Write).unwrap();
    assert!(is_closed(&mut half));
    assert_eq!(served.stop(Signal::INT).0, Some(3));
    assert_eq!(served.stage.moves().len(), moves);

    let mut served = Served::generic("");
    for words in [
        b"GET / HTTP/1.1\r\nHost: 127.0.0.1:8090\r\nUser-Agent: x\r\n\r\n".as_slice(),
        &[0xff; 44],
        &[0; 44],
    ] {
        let mut stranger = served.connect();
        stranger.write_all(words).unwrap();
        assert!(is_closed(&mut stranger), "{words:?}");
    }
    served.prints("the client cannot be served");
    assert_eq!(served.stop(Signal::INT).0, Some(3));
    assert_eq!(served.stage.moves().len(), moves);
}

#[test]
fn a_second_client_at_the_same_time_is_turned_away_and_disturbs_nothing() {
    let mut served = Served::start("", "nees", &["--once"]);
    let mut first = Coordinator::come(&served);
    first.go(1e-3);
    for _ in 0..3 {
        let mut second = served.connect();
        // A refused client can fail to send any more bytes.
        let _ = second.write_all(
            b"open-session\tother\npropose\tt\tMDL-00-01\tx\tdisplacement\t0.002\nexecute\tt\n",
        );
        assert!(is_closed(&mut second));
    }
    assert_eq!(first.position_and_force(), (1e-3, 100.0));
    first.go(2e-3);
    first.close();
    let (code, printed) = served.ended();
    assert!(
        code == Some(0) && printed.contains("targets: 2\n"),
        "{printed}"
    );
}

#[test]
fn a_program_that_is_killed_leaves_a_record_and_a_rig_that_holds_itself() {
    let mut served = Served::start_on(Stage::of(watched, ""), "nees", &[]);
    let mut client = Coordinator::come(&served);
    client.go(1e-3);
    served.program.kill().unwrap();
    served.program.wait().unwrap();
    let verified = served.stage.verify();
    assert!(
        verified.output.contains("INCOMPLETE"),
        "{}",
        verified.output
    );
    assert!(
        verified.output.contains("3 recomputed"),
        "two of the pre-test check, and the client's: {}",
        verified.output
    );
    let_it_trip();
    let probed = crate::stage::wait(&mut served.stage.tool("probe", &[]));
    let log = served.stage.log();
    // Bit 7 of the flags: its watchdog tripped.
    assert!(log.contains(" HELD 0x0080*"), "{}\n{log}", probed.output);
    assert_eq!(served.stage.moves().len(), 3);
}
