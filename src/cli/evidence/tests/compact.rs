//! A run folder with a compact run log: verification simulates the run again. Every changed byte is found, a changed table too, and the
//! simulation of another build that this one does not repeat is not called wrong.

use serde_json::{Value, json};

use super::{Bytes, compact_run, folder, forged, offsets, psd, run, with};
use crate::Exit;
use crate::commands::prediction::prediction;
use crate::evidence::check::examine;
use crate::evidence::finding::{Finding, Judgement};
use crate::evidence::folder::Folder;
use crate::evidence::names::MANIFEST;
use crate::evidence::rebuilt::Rebuilt;
use crate::files::failure::NOT_VERIFIABLE;
use crate::files::recorded_run::JOURNAL;
use psd_rig::journal::EntryKind;
use psd_testing::journal;

const TABLE: &str = "tables/hit.csv";

fn found(folder: &Folder) -> Vec<Finding> {
    examine(folder, &Rebuilt::of(folder, &prediction), &[])
}

fn judgements(findings: &[Finding], judgement: Judgement) -> Vec<&'static str> {
    let of = findings
        .iter()
        .filter(|finding| finding.judgement == judgement);
    of.map(|finding| finding.part).collect()
}

/// The folder with a run log that somebody wrote who computes chain, checksums and manifest again.
fn retold(alter: impl FnMut(EntryKind, &mut Value)) -> Folder {
    let altered = journal::forged(&compact_run()[JOURNAL], alter);
    forged(&with(&folder(compact_run()), JOURNAL, Some(altered)))
}

fn of_another_build(kind: EntryKind, body: &mut Value) {
    if kind == EntryKind::Header {
        body["build"] = json!("0".repeat(64));
    }
}

/// As another program, whose steps differ in the last bit, would have logged them.
fn of_other_steps(kind: EntryKind, body: &mut Value) {
    if kind == EntryKind::Digest {
        body["sha256"] = json!("1".repeat(64));
    }
}

#[test]
fn tables_and_figures_are_those_of_a_full_run_log() {
    let is_of_the_run =
        |name: &&String| name.starts_with("tables/") || name.starts_with("figures/");
    let of = |files: &'static Bytes| {
        let files = files.iter().filter(|(name, _)| is_of_the_run(name));
        files.collect::<Vec<_>>()
    };
    assert!(of(run()).len() > 3);
    assert_eq!(of(run()), of(compact_run()));
    let findings = found(&folder(compact_run()));
    assert!(findings.iter().all(Finding::is_sound), "{findings:#?}");
    let targets = findings.iter().find(|finding| finding.part == "targets");
    assert_eq!(
        targets.unwrap().statement,
        "all 3 simulated again, bit-identical, and 3 steps"
    );
}

#[test]
fn a_flipped_byte_of_the_run_log_is_found() {
    let sound = folder(compact_run());
    let own = &compact_run()[JOURNAL];
    for at in offsets(own.len()) {
        let mut changed = own.clone();
        changed[at] ^= if at % 2 == 0 { 0x01 } else { 0x80 };
        let found = found(&with(&sound, JOURNAL, Some(changed)));
        assert!(!found.iter().all(Finding::is_sound), "{at}");
    }
}

#[test]
fn a_changed_table_and_changed_steps_are_found_behind_a_new_manifest() {
    let sound = folder(compact_run());
    let mut table = compact_run()[TABLE].clone();
    let last = table.len() - 2;
    table[last] ^= 1;
    let found_of_table = found(&forged(&with(&sound, TABLE, Some(table))));
    let wrong = judgements(&found_of_table, Judgement::Wrong);
    assert_eq!(wrong, ["results", "manifest"]);
    let findings = found(&retold(of_other_steps));
    assert_eq!(judgements(&findings, Judgement::Wrong), ["targets"]);
    let targets = findings.iter().find(|finding| finding.part == "targets");
    let statement = &targets.unwrap().statement;
    assert!(
        statement.starts_with("entry 4: the run requires 3 steps to ")
            && statement.contains(&format!("with the digest {}", "1".repeat(64))),
        "{statement}"
    );
}

#[test]
fn another_build_verifies_what_it_repeats_and_calls_nothing_else_wrong() {
    // Its report names the other program: this build makes it again.
    let repeated = found(&retold(of_another_build));
    let targets = repeated.iter().find(|finding| finding.part == "targets");
    assert_eq!(
        targets.unwrap().statement,
        "all 3 simulated again, bit-identical, and 3 steps by another build of psd"
    );
    let other = retold(|kind, body| {
        of_another_build(kind, body);
        of_other_steps(kind, body);
    });
    let findings = found(&other);
    assert_eq!(
        judgements(&findings, Judgement::Wrong),
        [""; 0],
        "{findings:#?}"
    );
    assert_eq!(judgements(&findings, Judgement::NotVerifiable), ["targets"]);
    let targets = findings.iter().find(|finding| finding.part == "targets");
    let made_by = format!("; the run was made by psd 0.2.0 build {}", "0".repeat(64));
    assert!(targets.unwrap().statement.ends_with(&made_by));
    // A changed file differs from its manifest, whoever made the run; behind a new manifest it is not verifiable.
    let mut table = compact_run()[TABLE].clone();
    table[100] ^= 1;
    let changed = with(&retold(of_another_build), TABLE, Some(table));
    assert_eq!(judgements(&found(&changed), Judgement::Wrong), ["manifest"]);
    let hidden = found(&forged(&changed));
    assert_eq!(
        judgements(&hidden, Judgement::Wrong),
        [""; 0],
        "{hidden:#?}"
    );
    assert!(judgements(&hidden, Judgement::NotVerifiable).contains(&"results"));
}

#[test]
fn a_plan_that_another_build_checked_otherwise_is_not_verifiable() {
    let other_limits = |kind: EntryKind, body: &mut Value| {
        if kind == EntryKind::Header {
            body["equipment"]["device"]["noise"] = json!(1.0);
        }
    };
    let findings = found(&retold(other_limits));
    assert_eq!(judgements(&findings, Judgement::Wrong), ["record"]);
    let findings = found(&retold(|kind, body| {
        of_another_build(kind, body);
        other_limits(kind, body);
    }));
    assert_eq!(judgements(&findings, Judgement::Wrong), [""; 0]);
    assert_eq!(judgements(&findings, Judgement::NotVerifiable), ["record"]);
}

#[test]
fn the_commands_refuse_what_they_cannot_repeat() {
    let root = tempfile::tempdir().unwrap();
    let other = journal::forged(&compact_run()[JOURNAL], |kind, body| {
        of_another_build(kind, body);
        of_other_steps(kind, body);
    });
    let (run, out) = (root.path().join("run"), root.path().join("out"));
    std::fs::create_dir(&run).unwrap();
    std::fs::write(run.join(JOURNAL), other).unwrap();
    let (run, out_path) = (run.to_str().unwrap(), out.to_str().unwrap());
    for command in [
        &["verify", run][..],
        &["report", run, "--out", out_path],
        &["compare", run, run],
    ] {
        assert_eq!(psd(command), Exit::Fault, "{command:?}");
    }
    assert!(!out.join(MANIFEST).exists());
    let read = crate::files::recorded_run::read(run.as_ref()).unwrap();
    let replayed = crate::evidence::ReplayedRun::of(read, None, &prediction).unwrap();
    let refused = replayed
        .refuse_another_simulation(run.as_ref())
        .unwrap_err();
    assert!(refused.to_string().contains(NOT_VERIFIABLE), "{refused}");
}

/// A killed simulation leaves a run log without an end. It is started again: nothing can be resumed.
#[test]
fn a_killed_simulation_is_reported_as_incomplete_and_started_again() {
    let root = tempfile::tempdir().unwrap();
    let entries = journal::records(&compact_run()[JOURNAL]);
    for kept in 1..entries.len() {
        let cut = journal::written(entries[..kept].iter().cloned());
        let run = root.path().join(format!("run-{kept}"));
        std::fs::create_dir(&run).unwrap();
        std::fs::write(run.join(JOURNAL), cut).unwrap();
        let run = run.to_str().unwrap();
        let (operator, reason) = ("A. Person", "power cut");
        let resumed = psd(&["resume", run, "--operator", operator, "--reason", reason]);
        assert_ne!(resumed, Exit::Met, "{kept}");
        if kept < 3 {
            continue;
        }
        let findings = found(&Folder::read(run.as_ref()).unwrap());
        let targets = findings.iter().find(|finding| finding.part == "targets");
        let statement = &targets.unwrap().statement;
        // After the last digest only the end is missing.
        let is_whole = entries[..kept]
            .iter()
            .any(|(kind, _)| *kind == EntryKind::Digest);
        let expected = if is_whole { "no end" } else { "INCOMPLETE" };
        assert!(statement.contains(expected), "{kept}: {statement}");
    }
}
