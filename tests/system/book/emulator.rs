//! The tutorial page about the rig emulator, from the start of the emulator to a signed report. In: the page, and its commands with
//! a port of this test. psd prints the outputs on the page, apart from readings and digests. `cargo xtask generate emulator` writes the
//! outputs into the page.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use crate::stage::{PSD, code, folder, signal, until};
use crate::terminal::Terminal;
use rustix::process::Signal;

/// The port of the emulator in `plans/lib/real_frame.psd`.
const PORT: &str = "/tmp/psd-bench";

/// The rig of the page, and the same rig with more time for an answer: a busy machine may stop its emulator for a second.
const STAND_IN: &str = "serial_number: \"STAND-IN-1\")\n";
const PATIENT: &str =
    "serial_number: \"STAND-IN-1\", reply_timeout: 2 s)\n  watchdog        = 30 s\n";

/// Typed text in the first second after the question does not count; a busy machine asks late.
const DEAF: Duration = Duration::from_secs(5);

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn page() -> PathBuf {
    root().join("docs/tutorial/emulator.md")
}

/// A copy of the plans whose rig is at another port, and has more time for an answer.
fn plans(folder: &Path) -> String {
    let port = folder.join("bench").to_string_lossy().into_owned();
    for part in ["plans", "plans/lib"] {
        fs::create_dir_all(folder.join(part)).unwrap();
        for entry in fs::read_dir(root().join(part)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "psd") {
                let text = fs::read_to_string(&path).unwrap().replace(PORT, &port);
                let text = text.replace(STAND_IN, PATIENT);
                fs::write(folder.join(part).join(path.file_name().unwrap()), text).unwrap();
            }
        }
    }
    port
}

/// The commands of the page, in order: the arguments of psd, and the output if the page shows it.
fn commands(text: &str) -> Vec<(Vec<String>, Option<String>)> {
    let mut found = Vec::new();
    for part in text.split("```sh\n").skip(1) {
        let (block, rest) = part.split_once("\n```\n").unwrap();
        let lines = block.lines().filter_map(|line| line.strip_prefix("psd "));
        found.extend(lines.map(|line| (arguments(line), None)));
        // A block of another kind in between: the command has no output on the page.
        let output = rest
            .split_once("```text\n")
            .filter(|(between, _)| !between.contains("```"))
            .and_then(|(_, output)| output.split_once("```"));
        if let (Some((output, _)), Some(last)) = (output, found.last_mut()) {
            last.1 = Some(output.to_owned());
        }
    }
    found
}

/// The words of a command, with quoted words kept together.
fn arguments(command: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (index, part) in command.split('"').enumerate() {
        if index % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

/// A word whose readings and digests are replaced: they differ from run to run.
fn free(word: &str) -> &str {
    let bare = word.trim_end_matches([',', '.']);
    let number = bare.replace('−', "-").parse::<f64>().is_ok();
    let digest = bare.len() >= 16 && bare.chars().all(|c| c.is_ascii_hexdigit());
    if number || digest { "#" } else { word }
}

/// Whether two outputs agree. On lines of readings and counts a number equals any number, and a drift may be below what
/// the noise shows.
fn agree(shown: &str, printed: &str) -> bool {
    let lines = |text: &str| -> Vec<String> {
        let line = |line: &str| {
            let varies = ["noise", "position", "margin", " ok "];
            if varies.iter().any(|word| line.contains(word)) {
                let words = line.split_whitespace().filter(|word| *word != "below");
                let words: Vec<&str> = words.map(free).collect();
                words.join(" ")
            } else {
                line.split_whitespace().collect::<Vec<_>>().join(" ")
            }
        };
        text.trim_end().lines().map(line).collect()
    };
    lines(shown) == lines(printed)
}

/// A folder with the plans, and commands of psd in it.
struct Bench {
    folder: tempfile::TempDir,
    port: String,
}

impl Bench {
    fn new() -> Self {
        let folder = folder();
        let port = plans(folder.path());
        Self { folder, port }
    }

    fn psd(&self, arguments: &[String]) -> Command {
        let mut command = Command::new(PSD);
        command
            .args(arguments)
            .current_dir(self.folder.path())
            .env("NO_COLOR", "1")
            .stdin(Stdio::null());
        command
    }

    /// Starts the emulator; its output.
    fn emulator(&self, arguments: &[String]) -> (Emulator, String) {
        let started = self.folder.path().join("started");
        let output = File::create(&started).unwrap();
        let child = self.psd(arguments).stderr(output).spawn();
        let emulator = Emulator(child.unwrap());
        let printed = || fs::read_to_string(&started).unwrap();
        until("the emulator runs", || printed().contains("until Ctrl-C"));
        (emulator, printed())
    }

    /// The output of a command that succeeds.
    fn printed(&self, arguments: &[String]) -> String {
        let output = self.psd(arguments).output().unwrap();
        assert!(output.status.success(), "{arguments:?}: {output:?}");
        String::from_utf8(output.stdout).unwrap() + &String::from_utf8(output.stderr).unwrap()
    }
}

struct Emulator(Child);

impl Drop for Emulator {
    fn drop(&mut self) {
        signal(&self.0, Signal::INT);
        code(&mut self.0);
    }
}

#[test]
fn the_page_on_the_emulator_leads_to_a_signed_report() {
    let bench = Bench::new();
    let text = fs::read_to_string(page()).unwrap();
    let commands = commands(&text);
    let [simulate, probe, run, after @ .., _script] = commands.as_slice() else {
        panic!("{commands:?}");
    };
    let (emulator, started) = bench.emulator(&simulate.0);
    let mut outputs = vec![started, bench.printed(&probe.0)];

    let mut operator = Terminal::start(&mut bench.psd(&run.0));
    until("the question", || {
        operator.shown().contains("for the run log >")
    });
    let shown = operator.shown().replace('\r', "");
    std::thread::sleep(DEAF);
    operator.press("RELEASE\n");
    let ended = operator.code();
    assert!(matches!(ended, Some(0 | 1)), "{}", operator.shown());
    let (_, asked) = shown.split_once("  RELEASE: ").unwrap();
    outputs.push(format!("  RELEASE: {}", asked.trim_end()));
    drop(emulator);

    outputs.extend(after.iter().map(|(arguments, _)| bench.printed(arguments)));
    let mut new = text.clone();
    let shown = commands.iter().map(|(_, shown)| shown);
    for (shown, printed) in shown.zip(outputs) {
        let Some(shown) = shown else { continue };
        let printed = printed.replace(&bench.port, PORT);
        if std::env::var_os("PSD_BLESS").is_some() {
            new = new.replace(shown.as_str(), &format!("{}\n", printed.trim_end()));
        } else {
            assert!(
                agree(shown, &printed),
                "the page shows\n{shown}\npsd prints\n{printed}"
            );
        }
    }
    if new != text {
        fs::write(page(), new).unwrap();
    }
}

#[test]
fn the_faults_of_the_page_end_the_run_as_it_says() {
    let bench = Bench::new();
    let text = fs::read_to_string(page()).unwrap();
    let (_, script) = text.split_once("`faults.txt`:\n\n```text\n").unwrap();
    let (script, _) = script.split_once("```").unwrap();
    fs::write(bench.folder.path().join("faults.txt"), script).unwrap();
    let commands = commands(&text);
    let (simulate, _) = commands.last().unwrap();
    let (emulator, _) = bench.emulator(simulate);
    let run = arguments("run plans/beam.psd --rig bench --operator A --yes");
    let output = bench.psd(&run).output().unwrap();
    drop(emulator);
    let printed = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3), "{printed}");
    for part in [
        "Communication recovered",
        "the force sensor is frozen",
        "HELD",
    ] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
}
