//! The first line of a run log cannot be changed in its data of rig, calibration and limits without detection. A run log of another
//! format or of other rules is refused.

use serde_json::{Value, json};

use super::{faults, folder, run, with};
use crate::commands::prediction::prediction;
use crate::evidence::check::examine;
use crate::evidence::folder::Folder;
use crate::evidence::names::MANIFEST;
use crate::evidence::rebuilt::Rebuilt;
use crate::files::recorded_run::JOURNAL;
use psd::report::manifest_with;
use psd::run::replay::RULES;
use psd_rig::journal::{EntryKind, FORMAT};
use psd_testing::journal::{forged, recover};

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
    assert_eq!(
        (&header["format"], &header["rules"]),
        (&json!(FORMAT), &json!(RULES))
    );
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
    assert_eq!(found(&silent), ["record"]);
}

#[test]
fn another_format_or_other_rules_are_refused() {
    let statement = |altered: &Folder| {
        let findings = Rebuilt::of(altered, &prediction).findings;
        assert!(!findings[0].is_sound(), "{findings:?}");
        findings[0].statement.clone()
    };
    for format in [FORMAT - 1, FORMAT + 1] {
        let altered = retold(|header| header["format"] = json!(format));
        assert!(altered.run_log().is_some());
        assert!(statement(&altered).contains(&format!("its format is version {format}")));
    }
    for rules in [RULES - 1, RULES + 1] {
        let altered = retold(|header| header["rules"] = json!(rules));
        assert!(statement(&altered).contains(&format!("its rules are {rules}")));
    }
    let none = retold(|header| drop(header.as_object_mut().unwrap().remove("rules")));
    assert!(statement(&none).contains("missing field `rules`"));
}
