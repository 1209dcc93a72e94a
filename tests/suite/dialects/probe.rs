//! `psd rig probe` and `monitor` with every protocol driver. Further tests check their messages without a reply, or with replies of a
//! different device. In: the rigs of `rigs` and their emulators. Out: nothing moved; the log of every byte verifies this.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use super::rigs::{CASES, Case, by_name};
use super::{ANSWERS, Process, SILENT, ready, write_plan};

/// Exit code and all output.
struct Ended {
    code: Option<i32>,
    out: String,
    messages: String,
}

fn psd(folder: &Path, arguments: &[&str]) -> Ended {
    let mut command = Command::new(env!("CARGO_BIN_EXE_psd"));
    let ended = command
        .current_dir(folder)
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .expect("psd starts");
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    Ended {
        code: ended.status.code(),
        out: text(ended.stdout),
        messages: text(ended.stderr),
    }
}

/// The emulator of a case, which ends with this value.
fn stand_in(folder: &Path) -> Process {
    let simulate = [
        "rig",
        "simulate",
        "plan.psd",
        "--rig",
        "real",
        "--log",
        "bytes.txt",
    ];
    let simulator = super::psd(folder, "simulator.txt", &simulate);
    assert!(
        ready(folder),
        "{}",
        fs::read_to_string(folder.join("simulator.txt")).unwrap_or_default()
    );
    simulator
}

/// Targets that the emulator received.
fn moves(folder: &Path) -> usize {
    let bytes = fs::read_to_string(folder.join("bytes.txt")).expect("a log");
    assert!(bytes.contains("opened"), "nobody came");
    bytes
        .lines()
        .filter(|line| line.contains(" bench move "))
        .count()
}

/// Runs `what` for every case in parallel; all failures are reported.
fn each(cases: &[&Case], what: impl Fn(&Case) + Sync) {
    let failed: Vec<&str> = std::thread::scope(|scope| {
        let running: Vec<_> = cases
            .iter()
            .map(|case| (case.name, scope.spawn(|| what(case))))
            .collect();
        running
            .into_iter()
            .filter_map(|(name, thread)| thread.join().is_err().then_some(name))
            .collect()
    });
    assert!(failed.is_empty(), "{failed:?}");
}

#[test]
fn every_dialect_is_probed_and_watched_and_nothing_moves() {
    each(&CASES.iter().collect::<Vec<_>>(), |case| {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        write_plan(case, folder, ANSWERS);
        let _simulator = stand_in(folder);
        let probed = psd(folder, &["rig", "probe", "plan.psd", "--rig", "real"]);
        assert_eq!(probed.code, Some(0), "{}: {}", case.name, probed.messages);
        for expected in [
            "real",
            "  model ",
            "  displacement  0",
            "  force ",
            "-1 mm",
            "margin 1.000 mm",
            "margin 5.000 kN",
        ] {
            assert!(
                probed.out.contains(expected),
                "{}: {expected} in\n{}",
                case.name,
                probed.out
            );
        }
        let homed = probed
            .out
            .contains("at -1 mm in its own coordinate: a run would start there, at 0");
        assert_eq!(homed, case.name.starts_with("grbl"), "{}", probed.out);
        let open_loop = probed.out.contains("open loop");
        assert_eq!(open_loop, case.name.starts_with("grbl"), "{}", probed.out);

        let watched = psd(
            folder,
            &[
                "rig", "monitor", "plan.psd", "--rig", "real", "--count", "3", "--every", "20 ms",
            ],
        );
        assert_eq!(watched.code, Some(0), "{}: {}", case.name, watched.messages);
        let rows: Vec<Vec<f64>> = watched.out.lines().skip(1).map(numbers).collect();
        assert!(
            watched.out.starts_with("time_s,displacement_m,force_n\n") && rows.len() == 3,
            "{}",
            watched.out
        );
        assert!(
            rows.windows(2).all(|pair| pair[1][0] >= pair[0][0] + 0.02),
            "{}: {}",
            case.name,
            watched.out
        );
        assert!(
            rows.iter().all(|row| row[1] == 0.0 && row[2].abs() < 1.0),
            "{}: {}",
            case.name,
            watched.out
        );
        assert_eq!(moves(folder), 0, "{}", case.name);
    });
}

fn numbers(row: &str) -> Vec<f64> {
    row.split(',')
        .map(|word| word.parse().expect("a number"))
        .collect()
}

/// The message for a rig that does not understand the driver: the device and its location in the plan.
fn not_understood(ended: &Ended, plan_text: &str) {
    assert_eq!(
        (ended.code, ended.out.as_str()),
        (Some(3), ""),
        "{}",
        ended.messages
    );
    let lines: Vec<&str> = ended.messages.lines().collect();
    let error = lines
        .iter()
        .rposition(|line| line.starts_with("error: "))
        .unwrap_or_else(|| panic!("{}", ended.messages));
    let at = lines.get(error + 1).copied().unwrap_or_default();
    assert!(
        at.starts_with("  at: plan.psd:") && at.contains(plan_text),
        "{}",
        ended.messages
    );
    let silent = lines[error].contains("no usable answer");
    assert_eq!(
        lines
            .get(error + 2)
            .is_some_and(|line| line.starts_with(" help: the baud rate, the `dialect`")),
        silent,
        "{}",
        ended.messages
    );
}

/// A device with a different protocol at the plan's port: every driver gives up, reports this, and has moved nothing.
#[test]
fn a_rig_with_another_protocol_is_not_accepted() {
    // The rig of the emulator, and the rig in the changed plan.
    let pairs = [
        ("native", "grbl with scpi", "actuator = serial"),
        ("native", "instron", "link = serial"),
        ("native", "mark10", "link = serial"),
        ("native", "modbus", "link = serial"),
        ("mark10", "native", "link = serial"),
        ("modbus", "native", "link = serial"),
    ];
    std::thread::scope(|scope| {
        for (there, ours, plan_text) in pairs {
            scope.spawn(move || {
                let folder = tempfile::tempdir().expect("a folder");
                let folder = folder.path();
                write_plan(by_name(there), folder, SILENT);
                let _simulator = stand_in(folder);
                write_plan(by_name(ours), folder, SILENT);
                // A separate load cell has a silent line: the actuator is addressed first.
                let _nobody =
                    psd_rig::emulator::PseudoTerminal::linked(&folder.join("b")).expect("a line");
                let ended = psd(folder, &["rig", "probe", "plan.psd", "--rig", "real"]);
                not_understood(&ended, plan_text);
                assert_eq!(moves(folder), 0, "{there} for {ours}");
            });
        }
    });
}

/// No device at the port, or a silent device, as with a wrong baud rate.
#[test]
fn a_missing_port_and_a_silent_one_are_distinguished() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write_plan(by_name("native"), folder, SILENT);
    let dead = psd(folder, &["rig", "probe", "plan.psd", "--rig", "real"]);
    not_understood(&dead, "link = serial(port: \"");
    assert!(
        dead.messages.contains("there is no such port") && dead.messages.contains("psd rig list"),
        "{}",
        dead.messages
    );

    fs::write(folder.join("silence"), "at 0 s: drop replies for ever\n").expect("a script");
    let simulate = [
        "rig",
        "simulate",
        "plan.psd",
        "--rig",
        "real",
        "--log",
        "bytes.txt",
        "--script",
        "silence",
    ];
    let _simulator = super::psd(folder, "simulator.txt", &simulate);
    assert!(ready(folder));
    let silent = psd(folder, &["rig", "probe", "plan.psd", "--rig", "real"]);
    not_understood(&silent, "link = serial(port: \"");
    assert!(
        silent.messages.contains("no usable answer within"),
        "{}",
        silent.messages
    );

    // The message names the port of the separate load cell.
    write_plan(by_name("grbl with hx711"), folder, SILENT);
    let other = tempfile::tempdir().expect("a folder");
    let other = other.path();
    write_plan(by_name("grbl with hx711"), other, SILENT);
    let _simulator = stand_in(other);
    fs::remove_file(other.join("b")).expect("the port is a link");
    let missing = psd(other, &["rig", "probe", "plan.psd", "--rig", "real"]);
    not_understood(&missing, "load_cell = serial(port: \"");
}

/// No device at a TCP address.
#[test]
fn an_address_without_a_listener_is_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write_plan(by_name("nees"), folder, SILENT);
    let dead = psd(folder, &["rig", "probe", "plan.psd", "--rig", "real"]);
    not_understood(&dead, "link = tcp(address: \"127.0.0.1:");
    assert!(dead.messages.contains("refused"), "{}", dead.messages);
}
