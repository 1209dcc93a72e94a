//! The first line of a run log cannot be changed in its data of rig, calibration and limits without detection. A run log of version 1,
//! which has no such data, still gives its results.

use serde_json::{Value, json};

use super::{faults, folder, run, with};
use crate::cli::commands::prediction::prediction;
use crate::cli::files::record_file;
use crate::evidence::check::examine;
use crate::evidence::folder::Folder;
use crate::evidence::names::MANIFEST;
use crate::evidence::rebuilt::{Rebuilt, ReplayedRun};
use crate::files::recorded_run::JOURNAL;
use crate::plan::formula::ResultValue;
use crate::report::manifest_with;
use crate::rig::journal::{EntryKind, OLDEST_FORMAT};
use crate::text::digest::sha256;
use crate::verdict::Verdict;
use psd_testing::journal::forged;
use psd_testing::journal::recover;

/// The folder of the run with a different first line. All check values and the manifest are consistent with it.
fn retold(mut alter: impl FnMut(&mut Value)) -> Folder {
    let journal = forged(&run()[JOURNAL], |kind, body| {
        if kind == EntryKind::Header {
            alter(body);
        }
    });
    let changed = with(&folder(run()), JOURNAL, Some(journal));
    let all: Vec<(String, String)> = changed
        .listed()
        .map(|(name, held)| (name.clone(), held.digest.clone()))
        .collect();
    with(&changed, MANIFEST, Some(manifest_with(&[], &all).bytes))
}

fn found(folder: &Folder) -> Vec<&'static str> {
    faults(&examine(folder, &Rebuilt::of(folder, &prediction), &[]))
}

#[test]
fn the_record_alone_states_device_channels_and_limits() {
    let recovered = recover(&run()[JOURNAL]).unwrap();
    let header = recovered.lines[0].body();
    assert_eq!(header["format"], 2);
    let equipment = &header["equipment"];
    assert_eq!(equipment["device"]["name"], "ideal");
    assert_eq!(equipment["device"]["resolution"], 0.0);
    let measures: Vec<&Value> = equipment["channels"]
        .as_array()
        .unwrap()
        .iter()
        .map(|channel| &channel["measures"])
        .collect();
    assert_eq!(measures, ["displacement", "force"]);
    assert_eq!(equipment["channels"][1]["factor"], 1.0);
    // A limit that no plan states and that the guard still applies.
    assert_eq!(
        equipment["limits"],
        json!([{"quantity": "tracking_energy_error", "low": 0.0, "high": 0.05}])
    );
    assert_eq!(found(&retold(|_| ())), [""; 0]);
}

#[test]
fn a_false_factor_certificate_limit_or_rig_is_found() {
    let others: [(&str, Value); 5] = [
        ("/channels/1/factor", json!(1.01)),
        ("/channels/1/certificate", json!("ACME 17")),
        ("/limits/0/high", json!(0.5)),
        ("/device/serial", json!("0147")),
        ("/device/resolution", json!(1e-6)),
    ];
    for (pointer, value) in others {
        let altered =
            retold(|header| *header["equipment"].pointer_mut(pointer).unwrap() = value.clone());
        assert_eq!(found(&altered), ["record"], "{pointer}");
    }
    for (pointer, value) in [
        ("/run_id", json!("0123456789abcdef")),
        ("/date", json!("2026-05-31")),
        ("/zzz", json!(5)),
    ] {
        let altered = retold(|header| header[&pointer[1..]] = value.clone());
        assert!(found(&altered).contains(&"record"), "{pointer}");
    }
    let silent = retold(|header| drop(header.as_object_mut().unwrap().remove("equipment")));
    assert_eq!(found(&silent), ["record"], "version 2 says it");
}

#[test]
fn a_record_of_version_1_gives_the_same_results() {
    let aged = |header: &mut Value| {
        header["format"] = json!(OLDEST_FORMAT);
        header.as_object_mut().unwrap().remove("equipment");
    };
    let old = retold(|header| {
        aged(header);
        header["build"] = json!("0".repeat(64));
    });
    let findings = examine(&old, &Rebuilt::of(&old, &prediction), &[]);
    assert!(
        findings[0].sound
            && findings[0].statement.contains("version 1")
            && findings[1].statement.contains("another build"),
        "{findings:?}"
    );
    assert_eq!(
        found(&retold(aged)),
        ["record"],
        "this program writes what was measured with"
    );
    let unknown = retold(|header| header["format"] = json!(3));
    assert!(unknown.run_log().is_some());
    assert_eq!(found(&unknown), ["record"]);
}

/// An older plan wrote `residual_…` for results without unloading. Its run log is still read, and the plan itself gets a correction.
#[test]
fn a_record_of_a_plan_with_an_older_name_is_read() {
    let require = "\nrequire \"stays\" hit.residual_displacement < 1 m\n";
    let text = |body: &Value| format!("{}{require}", body["text"].as_str().unwrap());
    let recovered = recover(&run()[JOURNAL]).unwrap();
    let plan = recovered
        .lines
        .iter()
        .find(|line| line.kind == EntryKind::Plan)
        .unwrap()
        .body();
    let digest = sha256(text(&plan).as_bytes());
    let older = forged(&run()[JOURNAL], |kind, body| match kind {
        EntryKind::Header => body["files"][0]["sha256"] = json!(digest),
        EntryKind::Plan => body["text"] = json!(text(body)),
        _ => {}
    });
    let read = record_file::of_text(JOURNAL.as_ref(), &older.into()).unwrap();
    let replayed = ReplayedRun::of(read, None, &prediction).unwrap();
    assert!(replayed.mismatch.is_none(), "{:?}", replayed.mismatch);
    let stays = &replayed.assessment.requirements[0];
    let ResultValue::Number { value: last, .. } = replayed.record.procedures[0]
        .result("final_displacement")
        .unwrap()
        .value
    else {
        panic!("one number")
    };
    assert_eq!(
        (stays.verdict, stays.conditions[0].value),
        (Verdict::Pass, last)
    );
}
