//! A stage for one run: a separate folder, a short plan, and `psd rig simulate` behind a pseudo-terminal. In: the faults. Out:
//! ended programs, and the commands to the rig in the emulator's log.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use tempfile::TempDir;

pub const PSD: &str = env!("CARGO_BIN_EXE_psd");

/// Longest wait for any event, far longer than needed: only a program that hangs reaches it.
pub const PATIENCE: Duration = Duration::from_mins(3);

/// About forty steps without noise, so that two runs measure the same.
const PLAN: &str = r#"plan "A short run on a real rig" {
  edition     = 1
  specimen_id = "SYS-1"
}

limits {
  displacement = -5 mm .. 10 mm
  force        = -5 kN .. 5 kN
  speed        = 200 mm/s
}

rig bench {
  link       = serial(port: "PORT", dialect: native, reply_timeout: 2 s)
  settle     = within(0.01 mm, 1000 N/s, for: 0.01 s, timeout: 20 s)
  safe_state = hold
  watchdog   = 30 s
  rate       = 500 Hz
  samples    = 1
  speed      = 20 mm/s
  pretest_check       = probe(0.1 mm, stiffness: 90 kN/m .. 110 kN/m, zero: 20 N)
}

specimen bar {
  mass      = 20 kg
  behaviour = elastic(stiffness: 100 kN/m)
}

striker hammer {
  mass     = 5 kg
  velocity = 0.1 m/s
}

stiffness ramp k0 {
  displacements = 0.1 mm .. 0.8 mm step 0.1 mm
  pause         = 0 s
  return        = true
}

inspect look {
  note = "look at the specimen"
}

impact hit {
  striker   = hammer
  stiffness = k0.stiffness
  damping   = 0 N*s/m
  contact   = rigid
  time_step = 1 ms
  duration  = 24 ms
  pause     = 0 s
}

require "stiffness recovered" k0.stiffness within 1 % of 100 kN/m

report {
  figures = []
  formats = [html, csv]
}
"#;

/// The plan of a rig that holds automatically after 8 s without communication.
pub fn watched(plan: &str) -> String {
    swapped(
        &swapped(plan, "watchdog   = 30 s", "watchdog   = 8 s"),
        "reply_timeout: 2 s",
        "reply_timeout: 1 s",
    )
}

/// Sends nothing to a rig that is [`watched`] until its watchdog has tripped.
pub fn let_it_trip() {
    std::thread::sleep(Duration::from_secs(9));
}

fn swapped(plan: &str, words: &str, others: &str) -> String {
    assert!(plan.contains(words), "no `{words}` in the plan");
    plan.replace(words, others)
}

/// The output of an ended program.
#[derive(Debug)]
pub struct Ended {
    pub code: Option<i32>,
    /// Standard error and standard output.
    pub output: String,
}

pub struct Stage {
    folder: TempDir,
    simulator: Option<Child>,
    logs: usize,
}

impl Stage {
    /// A stage whose rig emulator is running.
    pub fn new() -> Self {
        Self::of(str::to_owned, "")
    }

    /// A stage with a separate plan and a script of faults.
    pub fn of(plan: impl Fn(&str) -> String, script: &str) -> Self {
        Self::laid_out(plan, script, |_| {})
    }

    /// [`Self::of`] with more files in its folder.
    pub fn laid_out(
        plan: impl Fn(&str) -> String,
        script: &str,
        files: impl FnOnce(&Path),
    ) -> Self {
        let folder = folder();
        files(folder.path());
        let port = folder.path().join("rig");
        fs::write(
            folder.path().join("plan.psd"),
            plan(&PLAN.replace("PORT", port.to_str().unwrap())),
        )
        .unwrap();
        let mut stage = Self {
            folder,
            simulator: None,
            logs: 0,
        };
        stage.power_up(script);
        stage
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn journal(&self) -> PathBuf {
        self.path("run").join("journal.psdj")
    }

    /// Restarts the rig emulator with new faults: it has lost its previous state.
    pub fn power_up(&mut self, script: &str) {
        self.power_down();
        self.logs += 1;
        fs::write(self.path("script"), script).unwrap();
        let mut command = Command::new(PSD);
        command
            .args(["rig", "simulate"])
            .arg(self.path("plan.psd"))
            .args(["--rig", "bench", "--log"])
            .arg(self.log_path());
        command.arg("--script").arg(self.path("script"));
        let log_file = File::create(self.path("simulator.told")).unwrap();
        let mut simulator = command
            .stdin(Stdio::null())
            .stderr(log_file)
            .spawn()
            .unwrap();
        let log_path = self.path("simulator.told");
        until("the emulator runs", || {
            let log = fs::read_to_string(&log_path).unwrap();
            assert!(simulator.try_wait().unwrap().is_none(), "{log}");
            log.contains("emulates the rig")
        });
        self.simulator = Some(simulator);
    }

    fn log_path(&self) -> PathBuf {
        self.path(&format!("simulator-{}.log", self.logs))
    }

    /// Ends the rig emulator; no target was outside the limits.
    pub fn power_down(&mut self) {
        if let Some(mut simulator) = self.simulator.take() {
            signal(&simulator, Signal::INT);
            let status = ended(&mut simulator);
            assert_eq!(
                status.code(),
                Some(0),
                "the simulator: {}",
                fs::read_to_string(self.path("simulator.told")).unwrap()
            );
        }
    }

    /// The log of the rig emulator since its last power-up.
    pub fn log(&self) -> String {
        fs::read_to_string(self.log_path()).unwrap()
    }

    /// Number and target of every move since the last power-up, in order.
    pub fn moves(&self) -> Vec<String> {
        let log = self.log();
        let moves = log
            .lines()
            .filter_map(|line| line.split_once(" bench move "));
        moves
            .map(|(_, what)| what.split(" m at ").next().unwrap().to_owned())
            .collect()
    }

    /// The requests of the host since the last power-up, one per line.
    pub fn requests(&self) -> Vec<String> {
        let log = self.log();
        log.lines()
            .filter_map(|line| line.split_once(" actuator > "))
            .map(|(_, what)| what.to_owned())
            .collect()
    }

    /// The number of first messages of a connection.
    pub fn greetings(&self) -> usize {
        self.requests()
            .iter()
            .filter(|request| request.contains(">HELLO"))
            .count()
    }

    /// Waits until the emulator has closed the connection of every host that ended, and prepared for the next.
    pub fn after_hosts(&self) {
        let count = |what: &str| {
            self.log()
                .lines()
                .filter(|line| line.ends_with(what))
                .count()
        };
        until("the last host has left", || {
            count("(opened)") == count("(host left)")
        });
    }

    /// Waits until this number of moves is done.
    pub fn after_moves(&self, count: usize) {
        until("the run moves", || self.moves().len() >= count);
    }

    /// `psd run` of the stage's plan into `run`, with additional arguments.
    pub fn run_with(&self, more: &[&str]) -> Command {
        let mut command = Command::new(PSD);
        self.run_arguments(&mut command, more);
        command
    }

    /// The same for a program that another program starts.
    pub fn run_arguments(&self, command: &mut Command, more: &[&str]) {
        command.arg("run").arg(self.path("plan.psd")).args([
            "--rig",
            "bench",
            "--operator",
            "A. Tester",
            "--out",
        ]);
        command.arg(self.path("run")).args(more);
    }

    pub fn resume_with(&self, more: &[&str]) -> Command {
        let mut command = Command::new(PSD);
        command.arg("resume").arg(self.path("run")).args([
            "--operator",
            "B. Tester",
            "--reason",
            "it was interrupted",
            "--yes",
        ]);
        command.args(more);
        command
    }

    /// `psd rig TOOL` of the stage's plan and rig, with additional arguments.
    pub fn tool(&self, tool: &str, more: &[&str]) -> Command {
        let mut command = Command::new(PSD);
        command
            .args(["rig", tool])
            .arg(self.path("plan.psd"))
            .args(["--rig", "bench"])
            .args(more);
        command
    }

    /// [`Self::tool`] with a name and a run folder.
    pub fn recorded_tool(&self, tool: &str, more: &[&str]) -> Command {
        let mut command = self.tool(tool, &["--operator", "A. Tester", "--out"]);
        command.arg(self.path("run")).args(more);
        command
    }

    pub fn verify(&self) -> Ended {
        wait(Command::new(PSD).arg("verify").arg(self.path("run")))
    }

    /// Checks that the run log is valid, and that all files of the folder come from it.
    pub fn proven(&self) -> String {
        let verified = self.verify();
        assert_eq!(verified.code, Some(0), "{}", verified.output);
        verified.output
    }

    /// Whether the last motion command is the hold.
    pub fn is_held(&self) -> bool {
        let requests = self.requests();
        let last = |what: &str| requests.iter().rposition(|request| request.contains(what));
        last(">STOP").max(last("!")) > last(">MOVE").max(last(">GLIDE"))
    }

    /// The operator stopped the run: the rig is at its hold position, and the run log is valid.
    pub fn held_and_sound(&self, ran: &Ended) {
        assert_eq!(ran.code, Some(4), "{}", ran.output);
        assert!(self.is_held(), "not held: {:#?}", self.requests());
        let verified = self.verify();
        assert!(
            verified.code == Some(0) && verified.output.contains("INCOMPLETE"),
            "{}",
            verified.output
        );
    }

    /// Resumes the run to its end and verifies its run log.
    pub fn goes_on(&self, more: &[&str]) -> Ended {
        let resumed = wait(&mut self.resume_with(more));
        assert_eq!(resumed.code, Some(0), "{}", resumed.output);
        let verified = self.verify();
        assert!(
            verified.code == Some(0) && !verified.output.contains("INCOMPLETE"),
            "{}",
            verified.output
        );
        resumed
    }

    /// All measured and calculated results of the run, without their times.
    pub fn results(&self) -> String {
        let run = self.path("run");
        let mut text: String = ["k0", "hit"]
            .map(|name| without_times(&run.join("tables").join(format!("{name}.csv"))))
            .concat();
        let summary: serde_json::Value =
            serde_json::from_slice(&fs::read(run.join("summary.json")).unwrap()).unwrap();
        for part in ["verdict", "requirements", "procedures"] {
            assert!(!summary[part].is_null(), "{part}");
        }
        text += &summary["verdict"].to_string();
        text += &summary["requirements"].to_string();
        text += &summary["procedures"].to_string();
        text
    }
}

/// A separate folder, in memory if there is space: on a busy disk a sync of the run log or a line of the log takes seconds.
/// Program and rig emulator cannot communicate during this time.
pub fn folder() -> TempDir {
    const IN_MEMORY: &str = "/dev/shm";
    const ROOM: u64 = 1 << 30;
    let has_room = rustix::fs::statvfs(IN_MEMORY)
        .is_ok_and(|found| found.f_bavail.saturating_mul(found.f_frsize) >= ROOM);
    has_room
        .then(|| tempfile::tempdir_in(IN_MEMORY).ok())
        .flatten()
        .unwrap_or_else(|| tempfile::tempdir().unwrap())
}

impl Drop for Stage {
    fn drop(&mut self) {
        if let Some(mut simulator) = self.simulator.take() {
            let _ = simulator.kill();
            let _ = simulator.wait();
        }
    }
}

/// A table without its columns of clock times.
fn without_times(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    assert!(header.contains(&"wall_time_s"));
    let kept = |line: &str| -> String {
        let fields = line
            .split(',')
            .zip(&header)
            .filter(|(_, name)| **name != "wall_time_s");
        fields.map(|(field, _)| field).collect::<Vec<_>>().join(",") + "\n"
    };
    text.lines().map(kept).collect()
}

/// strace of a program and all that it starts: it looks at one kind of call and injects `fault` into it, if one is stated. A filter of the
/// kernel then stops the program at no other call. With that filter strace sends no signal, so that a signal needs all calls.
pub fn strace(call: &str, fault: &str) -> Command {
    let mut command = Command::new("strace");
    command.args(["-f", "-e", &format!("trace={call}")]);
    if !fault.contains("signal=") {
        command.arg("--seccomp-bpf");
    }
    if !fault.is_empty() {
        command.args(["-e", &format!("inject={call}:{fault}")]);
    }
    command
}

/// Starts a program whose output is kept until [`finish`].
pub fn start(command: &mut Command) -> Child {
    command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Waits for the end of a program from [`start`].
pub fn finish(mut child: Child) -> Ended {
    let status = ended(&mut child);
    let output = child.wait_with_output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    Ended {
        code: status.code(),
        output: text(output.stderr) + &text(output.stdout),
    }
}

/// Runs a program to its end.
pub fn wait(command: &mut Command) -> Ended {
    finish(start(command))
}

/// Waits for the end of a program whose output goes elsewhere.
pub fn code(child: &mut Child) -> Option<i32> {
    ended(child).code()
}

fn ended(child: &mut Child) -> ExitStatus {
    let since = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return status;
        }
        if since.elapsed() > PATIENCE {
            child.kill().unwrap();
            panic!("a program did not come to its end");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

pub fn signal(child: &Child, signal: Signal) {
    kill_process(Pid::from_child(child), signal).unwrap();
}

/// Waits for an event.
pub fn until(what: &str, mut happened: impl FnMut() -> bool) {
    let since = Instant::now();
    while !happened() {
        assert!(since.elapsed() < PATIENCE, "in vain: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}
