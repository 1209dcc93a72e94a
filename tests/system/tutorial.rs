//! The outputs on the tutorial page about the rig emulator: psd prints them, apart from noise. In: the page, and its commands
//! with a port of this test. `PSD_BLESS=1` writes the outputs into the page.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use crate::stage::{PSD, code, folder, signal, until};
use crate::terminal::Terminal;
use rustix::process::Signal;

/// The port of the emulator in `plans/lib/real_frame.psd`.
const PORT: &str = "/tmp/psd-bench";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn page() -> PathBuf {
    root().join("docs/tutorial/emulator.md")
}

/// A copy of the plans whose rig is at another port.
fn plans(folder: &Path) -> String {
    let port = folder.join("bench").to_string_lossy().into_owned();
    for part in ["plans", "plans/lib"] {
        fs::create_dir_all(folder.join(part)).unwrap();
        for entry in fs::read_dir(root().join(part)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "psd") {
                let text = fs::read_to_string(&path).unwrap().replace(PORT, &port);
                fs::write(folder.join(part).join(path.file_name().unwrap()), text).unwrap();
            }
        }
    }
    port
}

/// The commands of the page that have an output: the arguments of psd and the output.
fn commands(text: &str) -> Vec<(Vec<String>, String)> {
    let mut found = Vec::new();
    for part in text.split("```sh\npsd ").skip(1) {
        let (command, rest) = part.split_once("\n```\n").unwrap();
        let Some((between, output)) = rest.split_once("```text\n") else {
            continue;
        };
        // A block of another kind in between: the command has no output on the page.
        if !between.contains("```") && !command.contains('\n') {
            let (output, _) = output.split_once("```").unwrap();
            found.push((arguments(command), output.to_owned()));
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

/// Whether two outputs agree. Readings of a noisy rig may differ: on their lines a number equals any number, and a drift
/// may be below what the noise lets one see.
fn agree(shown: &str, printed: &str) -> bool {
    let number = |word: &str| word.replace('−', "-").parse::<f64>().is_ok();
    let lines = |text: &str| {
        text.trim_end()
            .lines()
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let (shown, printed) = (lines(shown), lines(printed));
    shown.len() == printed.len()
        && shown.iter().zip(&printed).all(|(one, other)| {
            let is_reading = ["noise", "position", "margin"]
                .iter()
                .any(|word| one.contains(word));
            let words = |line: &str| {
                line.split_whitespace()
                    .filter(|word| !(is_reading && *word == "below"))
                    .map(str::to_owned)
                    .collect::<Vec<_>>()
            };
            let (one, other) = (words(one), words(other));
            one.len() == other.len()
                && one
                    .iter()
                    .zip(&other)
                    .all(|(one, other)| one == other || is_reading && number(one) && number(other))
        })
}

struct Emulator(Child);

impl Drop for Emulator {
    fn drop(&mut self) {
        signal(&self.0, Signal::INT);
        code(&mut self.0);
    }
}

#[test]
fn the_page_on_the_emulator_shows_what_psd_prints() {
    let folder = folder();
    let port = plans(folder.path());
    let text = fs::read_to_string(page()).unwrap();
    let commands = commands(&text);
    let [simulate, probe, run] = commands.as_slice() else {
        panic!("{commands:?}");
    };
    let psd = |arguments: &[String]| {
        let mut command = Command::new(PSD);
        command
            .args(arguments)
            .current_dir(folder.path())
            .env("NO_COLOR", "1");
        command
    };
    let started = folder.path().join("started");
    let output = File::create(&started).unwrap();
    let child = psd(&simulate.0).stdin(Stdio::null()).stderr(output).spawn();
    let emulator = Emulator(child.unwrap());
    let printed = || fs::read_to_string(&started).unwrap();
    until("the emulator runs", || printed().contains("until Ctrl-C"));
    let started = printed();

    let probed = psd(&probe.0).stdin(Stdio::null()).output().unwrap();
    let probed = String::from_utf8(probed.stdout).unwrap();

    let mut operator = Terminal::start(&mut psd(&run.0));
    until("the question", || {
        operator.shown().contains("for the run log >")
    });
    let shown = operator.shown().replace('\r', "");
    operator.press("n\n");
    let (_, asked) = shown.split_once("  RELEASE: ").unwrap();
    let asked = format!("  RELEASE: {}", asked.trim_end());
    code(&mut operator.child);
    drop(emulator);

    let mut new = text.clone();
    for ((_, shown), printed) in commands.iter().zip([started, probed, asked]) {
        let printed = printed.replace(&port, PORT);
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
