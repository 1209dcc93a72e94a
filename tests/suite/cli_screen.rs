//! The live screen on a pseudo-terminal: keys in, screen contents out, and their entries in the run log.

use std::fs::File;
use std::io::{Read as _, Write as _};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{LocalModes, Winsize, tcgetattr, tcsetwinsize};
use serde_json::Value;

/// Longest wait for any output, far longer than required: only a program that does not respond reaches it.
const PATIENCE: Duration = Duration::from_mins(1);

/// An inspection comes first, so that the screen appears before the steps on a machine of any speed.
const PLAN: &str = r#"plan "A test with a look" {
  edition = 1
}

specimen beam {
  mass      = 1 kg
  behaviour = elastic(stiffness: 327.65 N/m)
}

striker hammer {
  mass     = 10 kg
  velocity = 1 m/s
}

limits {
  displacement = -0.1 m .. 0.2 m
}

inspect joints {
  note = "Look at the joints"
}

move there {
  to = 1 mm
}

inspect again {
  note = "Look again"
}

report {
  figures = []
  formats = [html, csv]
}
"#;

/// The program on a terminal of 100 × 30.
struct Terminal {
    folder: tempfile::TempDir,
    master: File,
    /// Kept open, so that the terminal modes can be read after the end of the program.
    slave: File,
    child: Child,
    seen: String,
    columns: u16,
}

impl Terminal {
    fn run(arguments: &[&str]) -> Self {
        Self::psd(&[&["run", "plan.psd", "--out", "out"], arguments].concat())
    }

    fn psd(arguments: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("plan.psd"), PLAN).unwrap();
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&master).unwrap();
        unlockpt(&master).unwrap();
        let size = Winsize {
            ws_row: 30,
            ws_col: 100,
            ws_xpixel: 0,
            ws_ypixel: 0,
        };
        tcsetwinsize(&master, size).unwrap();
        let name = ptsname(&master, Vec::new()).unwrap().into_string().unwrap();
        let slave = File::options().read(true).write(true).open(name).unwrap();
        let stream = || Stdio::from(slave.try_clone().unwrap());
        let child = Command::new(env!("CARGO_BIN_EXE_psd"))
            .args(arguments)
            .current_dir(folder.path())
            .env("TERM", "xterm-256color")
            .env("LC_ALL", "C.UTF-8")
            .stdin(stream())
            .stdout(stream())
            .stderr(stream())
            .spawn()
            .unwrap();
        Self {
            folder,
            master: File::from(master),
            slave,
            child,
            seen: String::new(),
            columns: 100,
        }
    }

    /// Reads until this text has been drawn after the last key.
    fn wait_for(&mut self, text: &str) {
        let (mut buffer, since) = ([0; 4096], Instant::now());
        while !self.seen.contains(text) {
            if since.elapsed() > PATIENCE {
                self.child.kill().unwrap();
                panic!("in vain for {text:?}:\n{}", self.seen);
            }
            let count = self.master.read(&mut buffer).unwrap();
            assert!(
                count > 0,
                "the terminal closed before {text:?}:\n{}",
                self.seen
            );
            self.seen
                .push_str(&String::from_utf8_lossy(&buffer[..count]));
        }
    }

    fn press(&mut self, keys: &str) {
        self.seen.clear();
        self.master.write_all(keys.as_bytes()).unwrap();
    }

    /// Sets a different window size, like a window manager; waits until the screen is drawn for it.
    fn resize(&mut self, columns: u16) {
        self.set_size(columns);
        self.wait_for("hold now");
    }

    fn set_size(&mut self, columns: u16) {
        self.columns = columns;
        self.seen.clear();
        tcsetwinsize(
            &self.master,
            Winsize {
                ws_row: 30,
                ws_col: columns,
                ws_xpixel: 0,
                ws_ypixel: 0,
            },
        )
        .unwrap();
        kill_process(Pid::from_child(&self.child), Signal::WINCH).unwrap();
    }

    /// Waits until this text is on the screen. The whole screen is drawn only after a change of the window size.
    fn drawn(&mut self, text: &str) {
        let since = Instant::now();
        while !self.seen.contains(text) {
            assert!(
                since.elapsed() < PATIENCE,
                "in vain for {text:?}:\n{}",
                self.seen
            );
            let columns = if self.columns == 100 { 110 } else { 100 };
            self.set_size(columns);
            // Cleared, drawn, and the cursor hidden again.
            self.wait_for("\u{1b}[2J");
            let cleared = self.seen.find("\u{1b}[2J").unwrap_or_default();
            self.seen.drain(..cleared);
            self.wait_for("\u{1b}[?25l");
        }
    }

    /// The exit code and the summary.
    fn ended(mut self) -> (Option<i32>, Value) {
        self.wait_for("run ");
        let code = self.child.wait().unwrap().code();
        let modes = tcgetattr(&self.slave).unwrap().local_modes;
        assert!(
            modes.contains(LocalModes::ICANON | LocalModes::ECHO | LocalModes::ISIG),
            "the terminal is as it was"
        );
        let summary = std::fs::read_to_string(self.folder.path().join("out/summary.json")).unwrap();
        (code, serde_json::from_str(&summary).unwrap())
    }
}

fn events(summary: &Value) -> Vec<&str> {
    summary["events"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|event| event["text"].as_str())
        .collect()
}

#[test]
fn an_inspection_is_asked_on_the_screen_and_answered_by_name() {
    let mut terminal = Terminal::run(&[]);
    terminal.wait_for("INSPECTION");
    terminal.drawn("type yes");
    // An invalid answer is ignored. A comment has a separate key, and a name follows a yes.
    terminal.press("xyz\rino crack\ryes\r");
    terminal.wait_for("name");
    terminal.press("A. Engineer\r");
    terminal.drawn("type yes");
    terminal.press("yes\r");
    let (code, summary) = terminal.ended();
    assert_eq!(code, Some(0), "{summary:#}");
    assert_eq!(
        events(&summary),
        [
            "Look at the joints: no crack (A. Engineer)",
            "Look again (A. Engineer)"
        ]
    );
}

#[test]
fn ctrl_c_and_no_and_the_end_of_the_input_stop_and_none_is_a_yes() {
    for (keys, reason) in [
        ("\u{3}", "stopped on request"),
        ("q", "stopped on request"),
        ("\u{4}", "no answer at an inspection"),
        (
            "icrack\rn\r",
            "stopped by the operator at an inspection: crack",
        ),
    ] {
        let mut terminal = Terminal::run(&["--operator", "B"]);
        terminal.wait_for("INSPECTION");
        terminal.drawn("type yes");
        terminal.press(keys);
        let (code, summary) = terminal.ended();
        assert_eq!(code, Some(4), "{keys:?}: {summary:#}");
        assert!(
            events(&summary).iter().any(|text| text.contains(reason)),
            "{keys:?}: {summary:#}"
        );
    }
}

#[test]
fn the_first_key_after_the_window_got_another_size_is_heard() {
    for (key, reason) in [
        ("h", "on request"),
        ("q", "stopped on request"),
        ("\u{3}", "stopped on request"),
    ] {
        let mut terminal = Terminal::run(&["--operator", "B"]);
        terminal.wait_for("INSPECTION");
        terminal.drawn("type yes");
        terminal.resize(120);
        terminal.resize(90);
        terminal.press(key);
        let (code, summary) = terminal.ended();
        assert_eq!(code, Some(4), "{key:?}: {summary:#}");
        assert!(
            events(&summary).iter().any(|text| text.contains(reason)),
            "{key:?}: {summary:#}"
        );
    }
}

#[test]
fn a_short_run_draws_no_screen() {
    let terminal = Terminal::run(&["--yes", "--operator", "B"]);
    let mut seen = String::new();
    let (code, summary) = {
        let mut terminal = terminal;
        terminal.wait_for("run ");
        seen.push_str(&terminal.seen);
        terminal.ended()
    };
    assert_eq!(code, Some(0));
    assert!(!seen.contains("\u{1b}[?1049h"), "{seen:?}");
    assert_eq!(
        events(&summary)[0],
        "Look at the joints: answered by --yes (B)"
    );
}

/// What the command line does not say is asked before the run log is read.
#[test]
fn resume_asks_for_what_is_missing() {
    let mut terminal = Terminal::psd(&["resume", "out"]);
    terminal.wait_for("is not a run folder: it has no run log");
    terminal.child.wait().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().to_str().unwrap();
    std::fs::write(folder.path().join("journal.psdj"), "no run log\n").unwrap();
    let mut terminal = Terminal::psd(&["resume", run, "--reason", "checked"]);
    terminal.wait_for("name of the operator?");
    terminal.press("\n");
    terminal.wait_for("a name must be one line");
    terminal.press("A. Tester\n");
    terminal.wait_for("error:");
    assert_eq!(terminal.child.wait().unwrap().code(), Some(3));
    let mut terminal = Terminal::psd(&["resume", run, "--operator", "A. Tester"]);
    terminal.wait_for("why did it stop");
    terminal.press("checked\n");
    terminal.wait_for("error:");
    assert_eq!(terminal.child.wait().unwrap().code(), Some(3));
}
