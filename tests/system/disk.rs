//! The disk fails during a run: one failed sync, no disk space, a limit on the file size. The rig is held and receives no more
//! commands. The failed sync is never repeated, and the run can be resumed when there is disk space.

use std::fs;
use std::process::Command;

use rustix::process::Signal;

use crate::needs;
use crate::stage::{Ended, PSD, Stage, finish, signal, start, strace, wait};

/// The last motion command is the hold.
fn held(stage: &Stage) {
    let requests = stage.requests();
    let last = |what: &str| requests.iter().rposition(|request| request.contains(what));
    let stop = last(">STOP").max(last("!"));
    assert!(
        stop.is_some() && stop > last(">MOVE"),
        "not held: {requests:#?}"
    );
}

#[test]
fn a_sync_that_fails_once_ends_the_run_and_is_not_tried_again() {
    if !needs::strace() {
        return;
    }
    let stage = Stage::new();
    let trace = stage.path("trace");
    let mut command = strace("fdatasync", "error=EIO:when=40");
    command
        .arg("-o")
        .arg(&trace)
        .arg("-P")
        .arg(stage.journal())
        .arg(PSD);
    stage.run_arguments(&mut command, &["--yes"]);
    let ran = wait(&mut command);
    assert_eq!(ran.code, Some(3), "{}", ran.output);
    assert!(
        ran.output.contains("the run log could not be written"),
        "{}",
        ran.output
    );
    held(&stage);
    let syncs = fs::read_to_string(&trace).unwrap();
    let syncs: Vec<&str> = syncs
        .lines()
        .filter(|line| line.contains("fdatasync("))
        .collect();
    assert!(
        syncs.len() == 40 && syncs[39].contains("EIO"),
        "after a failed sync no other says anything: {syncs:#?}"
    );
    stage.goes_on(&[]);
}

#[test]
fn a_limit_on_the_size_of_files_is_a_full_disk_and_no_signal_ends_the_program() {
    if !needs::prlimit() {
        return;
    }
    let whole = Stage::new();
    assert_eq!(wait(&mut whole.run_with(&["--yes"])).code, Some(0));
    let size = fs::metadata(whole.journal()).unwrap().len();
    let stage = Stage::new();
    let mut command = Command::new("prlimit");
    // The file size limit must be below the size of the reserve beside the run log, which is 1 MiB.
    assert!(size < 1 << 20);
    command.args([&format!("--fsize={}", size / 2), PSD]);
    stage.run_arguments(&mut command, &["--yes"]);
    let ran = wait(&mut command);
    assert_eq!(ran.code, Some(3), "{}", ran.output);
    assert!(ran.output.contains("error:"), "{}", ran.output);
    assert!(
        stage.moves().is_empty(),
        "nothing moves where the reserve cannot be laid"
    );
    assert!(
        !stage.path("run").exists(),
        "a run that did not begin leaves no folder"
    );
}

/// The run of a stage, with this fault in its writes to the run log.
fn with_fault_of_writes(stage: &Stage, fault: &str) -> Ended {
    let mut command = strace("write", fault);
    command
        .args(["-o", "/dev/null", "-P"])
        .arg(stage.journal())
        .arg(PSD);
    stage.run_arguments(&mut command, &["--yes"]);
    wait(&mut command)
}

#[test]
fn a_write_that_finds_no_room_holds_the_rig_and_the_run_goes_on_later() {
    if !needs::strace() {
        return;
    }
    for error in ["ENOSPC", "EFBIG", "EDQUOT", "EIO"] {
        let stage = Stage::new();
        let ran = with_fault_of_writes(&stage, &format!("error={error}:when=70"));
        assert_eq!(ran.code, Some(3), "{error}: {}", ran.output);
        assert!(
            ran.output.contains("the run log could not be written"),
            "{error}: {}",
            ran.output
        );
        held(&stage);
        stage.goes_on(&[]);
    }
}

#[test]
fn a_storm_of_interrupted_and_short_writes_loses_and_doubles_nothing() {
    if !needs::strace() {
        return;
    }
    let stage = Stage::new();
    let ran = with_fault_of_writes(&stage, "error=EINTR:when=2+2");
    assert_eq!(ran.code, Some(0), "{}", ran.output);
    assert_eq!(stage.verify().code, Some(0));
}

#[test]
fn a_disk_that_lies_about_what_it_took_is_found_out_before_a_report_is_made() {
    if !needs::strace() {
        return;
    }
    let stage = Stage::new();
    let ran = with_fault_of_writes(&stage, "retval=2:when=70");
    assert!(
        ran.code == Some(3) && ran.output.contains("the run log is damaged"),
        "{}",
        ran.output
    );
    assert!(!stage.path("run").join("report.html").exists());
    let verified = stage.verify();
    assert!(
        verified.code == Some(3) && verified.output.contains("WRONG"),
        "{}",
        verified.output
    );
}

#[test]
fn a_record_deleted_during_the_run_ends_it_and_verifies_nothing() {
    for removed in [true, false] {
        let stage = Stage::new();
        let run = start(&mut stage.run_with(&["--yes"]));
        stage.after_moves(8);
        signal(&run, Signal::STOP);
        let moves = stage.moves().len();
        if removed {
            fs::remove_dir_all(stage.path("run")).unwrap();
        } else {
            fs::rename(stage.journal(), stage.path("elsewhere")).unwrap();
        }
        signal(&run, Signal::CONT);
        let ran = finish(run);
        assert_eq!(ran.code, Some(3), "{}", ran.output);
        assert!(!stage.path("run").join("report.html").exists());
        held(&stage);
        let reason = if removed {
            "its file was deleted"
        } else {
            "its file was moved or replaced"
        };
        assert!(ran.output.contains(reason), "{}", ran.output);
        assert!(
            stage.moves().len() <= moves + 1,
            "nothing moves that nobody records"
        );
    }
}

#[test]
fn a_disk_that_fills_up_holds_the_rig_and_the_run_goes_on_when_there_is_room() {
    if !needs::own_mounts() {
        return;
    }
    // A step of the ramp takes 0.25 s: the disk is full before the run ends, also on a busy machine.
    let slow = |plan: &str| plan.replace("speed      = 20 mm/s", "speed      = 0.2 mm/s");
    let stage = Stage::of(slow, "");
    fs::create_dir(stage.path("run")).unwrap();
    fs::create_dir(stage.path("kept")).unwrap();
    // Enough free space to begin. A file beside the run log uses it once the run moves.
    let script = r#"set -e
mount -t tmpfs -o size=220m tmpfs "$1/run"
"$2" run "$1/plan.psd" --rig bench --operator "A. Tester" --yes --out "$1/run" & ran=$!
for wait in $(seq 2000); do
  if grep -q "bench move 5 " "$1/simulator-1.log"; then break; fi
  sleep 0.01
done
cat /dev/zero > "$1/run/journal.filler" 2>/dev/null || true
status=0; wait $ran || status=$?
rm "$1/run/journal.filler"
cp -a "$1/run/." "$1/kept/"
exit $status
"#;
    let ran = wait(
        Command::new("unshare")
            .args(["-rm", "bash", "-c", script, "bash"])
            .arg(stage.path(""))
            .arg(PSD),
    );
    assert_eq!(ran.code, Some(3), "{}", ran.output);
    assert!(
        ran.output.contains("the run log could not be written"),
        "{}",
        ran.output
    );
    held(&stage);
    fs::remove_dir_all(stage.path("run")).unwrap();
    fs::rename(stage.path("kept"), stage.path("run")).unwrap();
    let journal = fs::read_to_string(stage.journal()).unwrap();
    assert!(
        journal.contains(" FAULT "),
        "the reserve leaves room for the last words: {journal}"
    );
    stage.goes_on(&[]);
}

#[test]
fn a_disk_with_too_little_free_space_is_found_before_anything_moves() {
    if !needs::own_mounts() {
        return;
    }
    let stage = Stage::new();
    fs::create_dir(stage.path("small")).unwrap();
    // Enough for the reserve and the whole run log, but less than a run requires to begin.
    let script = r#"set -e
mount -t tmpfs -o size=2m tmpfs "$1/small"
status=0; "$2" run "$1/plan.psd" --rig bench --operator "A. Tester" --yes --out "$1/small/run" || status=$?
ls -A "$1/small"
exit $status
"#;
    let ran = wait(
        Command::new("unshare")
            .args(["-rm", "bash", "-c", script, "bash"])
            .arg(stage.path(""))
            .arg(PSD),
    );
    assert_eq!(ran.code, Some(3), "{}", ran.output);
    assert!(
        ran.output.contains("error[E629]")
            && ran.output.contains("1.0 MB of free space")
            && ran.output.contains("nothing has moved"),
        "{}",
        ran.output
    );
    assert!(
        ran.output.trim_end().ends_with("another disk with `--out`"),
        "no folder is left: {}",
        ran.output
    );
    assert!(stage.moves().is_empty(), "{:?}", stage.moves());
}
