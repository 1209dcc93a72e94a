//! The build of psd that made a run, in its run log and its report.

use super::{folder, run, with};
use crate::commands::prediction::prediction;
use crate::evidence::rebuilt::{Rebuilt, ReplayedRun};
use crate::files::provenance::{BUILD, TOOLCHAIN};
use crate::files::recorded_run;
use crate::files::recorded_run::JOURNAL;
use psd::report::OutputFile;
use psd_rig::journal::{Durability, EntryKind, FileStorage, Journal};
use psd_testing::journal::recover;

/// The run log as a different program would have begun it.
fn of_another_build(journal: &[u8]) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(JOURNAL);
    let mut rewritten = Journal::create(
        Box::new(FileStorage::create(&path).unwrap()),
        Durability::Buffered,
    );
    for line in recover(journal).unwrap().lines {
        let mut body = line.body();
        // The journal writes these fields itself.
        for own in ["format", "count", "head"] {
            body.as_object_mut().unwrap().shift_remove(own);
        }
        if line.kind == EntryKind::Header {
            (body["build"], body["toolchain"]) =
                ("0".repeat(64).into(), "riscv64, another compiler".into());
        }
        match line.kind {
            EntryKind::End => rewritten.end(&body).unwrap(),
            kind => rewritten.append(kind, &body).unwrap(),
        }
    }
    drop(rewritten);
    std::fs::read(path).unwrap()
}

#[test]
fn a_report_names_the_build_that_made_the_run_and_not_the_one_that_made_the_report() {
    let own = folder(run());
    let journal = of_another_build(&run()[JOURNAL]);
    let read = recorded_run::of_text(JOURNAL.as_ref(), &journal.clone().into()).unwrap();
    let mut files: Vec<OutputFile> = Vec::new();
    ReplayedRun::of(read, None, &prediction)
        .unwrap()
        .results(&mut files)
        .unwrap();
    let page = files
        .iter()
        .find(|file| file.path == "report.html")
        .unwrap();
    let page = String::from_utf8(page.bytes.clone()).unwrap();
    assert!(page.contains(&"0".repeat(64)) && page.contains("riscv64, another compiler"));
    assert!(!page.contains(BUILD) && !page.contains(TOOLCHAIN));
    // No other part of the results depends on it.
    let others = files
        .iter()
        .filter(|file| !file.path.starts_with("report."));
    let moved: Vec<&str> = others
        .filter(|file| run()[&file.path] != file.bytes)
        .map(|file| file.path.as_str())
        .collect();
    assert_eq!(moved, [""; 0]);
    let statement = Rebuilt::of(&with(&own, JOURNAL, Some(journal)), &prediction)
        .report
        .unwrap()
        .other_build
        .unwrap();
    assert!(statement.contains("build 0000"), "{statement}");
    let page = String::from_utf8(run()["report.html"].clone()).unwrap();
    assert!(
        page.contains(BUILD) && page.contains(TOOLCHAIN),
        "a run names the program that makes it"
    );
}
