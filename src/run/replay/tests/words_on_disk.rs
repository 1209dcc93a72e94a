//! The words of the bodies on disk. Every body is here as a run log of this version has it, with all of its keys: a field that is
//! renamed in the code is then missing, and run logs of earlier releases could not be read.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use super::super::entry::{
    AmendBody, DigestBody, EndBody, FaultBody, Header, HeldBody, IntentBody, OperatorEntry,
    PlanBody, RecoverBody, ResumeBody, RigBody, SampleBody, StepBody, StrokeBody,
};
use psd_plan::record::Event;
use psd_rig::LineStatistics;
use psd_rig::journal::EntryKind;

/// Whether these bodies are read, and written with the same keys and values.
fn stable<Body: Serialize + DeserializeOwned>(bodies: &[Value]) {
    assert!(!bodies.is_empty());
    for on_disk in bodies {
        let read: Body = serde_json::from_value(on_disk.clone())
            .unwrap_or_else(|error| panic!("{error}: {on_disk}"));
        assert_eq!(&serde_json::to_value(&read).unwrap(), on_disk);
    }
}

fn header() -> Value {
    json!({
        "run_id": "1f", "psd": "0.2.0", "build": "2e", "rules": 1, "toolchain": "rustc",
        "files": [{"name": "plan.psd", "sha256": "3d"}], "settings": [["v", "1 m/s"]],
        "rig": "bench", "equipment": equipment(), "log": "compact", "check_run": true, "served": "nees",
        "date": "2026-05-31", "operator": "A. Person", "host": "lab",
        "began": "2026-05-31T08:00:00Z"
    })
}

fn equipment() -> Value {
    let identity = identity();
    json!({
        "device": {
            "name": identity["name"], "model": identity["model"], "serial": identity["serial"],
            "firmware": identity["firmware"], "boot": identity["boot"],
            "simulated": identity["simulated"], "resolution": 1e-6, "noise": 0.5
        },
        "channels": [
            {
                "axis": 1, "measures": "displacement", "given_in": "counts", "factor": 1e-6,
                "zero": 12.0, "declared_scatter": 1e-6, "uncertainty": 0.001, "certificate": "C-1",
                "due": "2027-01-01", "class": "0.5", "range": [-0.1, 0.1], "calibrated": [0.0, 0.1]
            },
            {
                "axis": 1, "measures": "force", "given_in": "units", "factor": 1.0, "zero": 0.0,
                "declared_scatter": 0.5, "uncertainty": 0.0, "certificate": null, "due": null
            }
        ],
        "limits": [{"quantity": "force", "axis": 1, "low": -5000.0, "high": 5000.0}]
    })
}

fn identity() -> Value {
    json!({
        "name": "bench", "model": "M", "serial": "S", "firmware": "1", "boot": "7f",
        "simulated": false
    })
}

fn faults() -> Vec<Value> {
    let mut faults = vec![
        json!({"not_settled": {"timeout": 5.0, "axis": 2}}),
        json!({"following": {"error": 1e-3, "band": 1e-5, "axis": 1}}),
        json!("interrupted"),
        json!({"device": "no answer"}),
    ];
    let quantities = [
        "target_displacement",
        "measured_displacement",
        "force",
        "speed",
        "increment",
        "tracking_error",
        "energy_error",
        "tracking_energy_error",
        "nrms_error",
    ];
    faults.extend(quantities.map(|quantity| {
        json!({"limit_breached": {
            "quantity": quantity, "value": 2.0, "low": -1.0, "high": 1.0, "axis": 1
        }})
    }));
    faults
}

fn fault_bodies() -> Vec<Value> {
    let with =
        |call: &str, fault: Value| json!({"t": 1.5, "call": call, "fault": fault, "wall": "08:00"});
    let calls = ["propose", "execute", "pause", "read", "traverse", "record"];
    let of_calls = calls.map(|call| with(call, json!("interrupted")));
    let of_faults = faults().into_iter().map(|fault| with("execute", fault));
    let during_a_motion = json!({
        "t": 1.5, "call": "execute", "fault": "interrupted",
        "reading": {"t": 1.4, "x": [1e-3], "r": [10.0], "raw": ["X 1"]}, "wall": "08:00"
    });
    of_calls
        .into_iter()
        .chain(of_faults)
        .chain([during_a_motion])
        .collect()
}

fn operator_bodies() -> Vec<Value> {
    let answers = [
        json!({"go_on": {"note": "fine", "by": "A. Person"}}),
        json!({"stop": {"reason": "crack", "by": null}}),
        json!("wait"),
    ];
    let mut bodies: Vec<Value> = answers
        .into_iter()
        .map(
            |answer| json!({"what": "answered", "note": "look", "answer": answer, "wall": "08:00"}),
        )
        .collect();
    bodies.extend([
        json!({"what": "noted", "text": "warm"}),
        json!({"what": "asked_to_stop"}),
        json!({"what": "asked_to_stop_inspecting"}),
        json!({"what": "answered_to_unload", "question": "unload?", "answer": "wait"}),
    ]);
    let mut requests = vec![
        json!({"asks": "come", "client": "127.0.0.1:1"}),
        json!({"asks": "propose", "target": 1e-3}),
        json!({"asks": "propose_all", "targets": [1e-3, 2e-3]}),
        json!({"asks": "propose_at", "targets": [1e-3], "speed": 1e-2}),
        json!({"asks": "propose_no_number", "said": "NaN"}),
        json!({"asks": "execute"}),
        json!({"asks": "commit"}),
        json!({"asks": "read"}),
        json!({"asks": "hold"}),
        json!({"asks": "remark", "text": "step 1"}),
        json!({"asks": "close"}),
    ];
    requests.extend(
        ["closed", "stopped", "failed"]
            .map(|end| json!({"asks": "leave", "disconnect": end, "reason": "end"})),
    );
    bodies.extend(
        requests
            .into_iter()
            .map(|request| json!({"what": "asked", "request": request})),
    );
    bodies
}

fn event_bodies() -> Vec<Value> {
    let kinds = [
        "note",
        "inspection",
        "limit_breach",
        "hold",
        "held",
        "not_held",
        "fault",
        "recovered",
        "remark",
        "resume",
        "amendment",
    ];
    let of_kind =
        |kind| json!({"time": 2.0, "procedure": "hit", "step": 3, "kind": kind, "text": "a"});
    kinds.map(of_kind).into()
}

fn resume_bodies() -> Vec<Value> {
    let targets = [
        json!({"target": "none"}),
        json!({"target": "executed"}),
        json!({"target": "not_executed"}),
        json!({"target": "held_during_motion"}),
        json!({"target": "remaining_motion", "from": [1e-3]}),
        json!({"target": "stroke", "back_to": 0.0, "others": [1e-3]}),
    ];
    let body = |target| {
        json!({
            "from": 12, "by": "A. Person", "reason": "power cut", "target_status": target,
            "assured": ["same_power_up", "re_referenced", "accepted_relaxation", "let_go"],
            "found": [[1e-3], [10.0]], "recorded": [[1e-3], [11.0]], "held": [[1e-3], [10.5]],
            "released": "RELEASE", "t": 4.0, "wall": "08:00"
        })
    };
    targets.map(body).into()
}

#[test]
fn every_body_has_its_words_on_disk() {
    for kind in EntryKind::ALL {
        match kind {
            EntryKind::Header => stable::<Header>(&[header()]),
            EntryKind::Plan => stable::<PlanBody>(&[json!({"file": 0, "text": "plan"})]),
            EntryKind::Rig => {
                stable::<RigBody>(&[json!(1e-3), json!([1e-3, 2e-3])].map(|target| {
                    json!({
                        "t": 0.0, "identity": identity(), "axes": 1,
                        "noise": {"force": 0.5, "resolution": 1e-6}, "own_speed": 1e-3,
                        "last_move": {"id": 4, "target": target}, "datum": [0.05], "replies": ["OK"]
                    })
                }));
            }
            EntryKind::Intent => stable::<IntentBody>(&[json!({
                "n": 1, "t": 0.5, "to": [1e-3], "speed": -1e-3, "encoded": [1e-3], "rate": 1e-3,
                "wire": "MOVE 1", "id": 5, "own": [0.051], "path": [{
                    "from": 0.0, "to": 1e-3, "start_velocity": 0.0, "end_velocity": 0.0,
                    "seconds": 1.0
                }],
                "samples": 9, "wall": "08:00"
            })]),
            EntryKind::Sample => stable::<SampleBody>(&[json!({
                "t": 1.0, "x": [1e-3], "r": [10.0], "raw": ["X 1"], "moved": [0.5, 0.9],
                "wall": "08:00"
            })]),
            EntryKind::Stroke => stable::<StrokeBody>(&[json!({"t": 1.0, "samples": 9})]),
            EntryKind::Step => stable::<StepBody>(&[json!({
                "step": 1, "time": 1e-3, "u": 1e-3, "x": 1e-3, "v": 0.5, "a": 2.0, "r": 10.0,
                "e": 1e-4, "axes": [{"u": 1e-3, "x": 1e-3, "v": 0.5, "a": 2.0, "r": 10.0}]
            })]),
            EntryKind::Digest => stable::<DigestBody>(&[json!({
                "entries": 3000, "steps": 1000, "targets": 1000, "t": 2.0, "sha256": "4e"
            })]),
            EntryKind::Operator => stable::<OperatorEntry>(&operator_bodies()),
            EntryKind::Event => stable::<Event>(&event_bodies()),
            EntryKind::Fault => stable::<FaultBody>(&fault_bodies()),
            EntryKind::Held => stable::<HeldBody>(&[json!({
                "t": 2.0, "unconfirmed": "no answer", "found": [[1e-3], [10.0]], "raw": ["X 1"],
                "wall": "08:00"
            })]),
            EntryKind::LineStatistics => {
                stable::<LineStatistics>(&[json!({"resent": 1, "ignored": 2, "reread": 3})]);
            }
            EntryKind::Recover => {
                stable::<RecoverBody>(&[json!({"t": 2.0, "put_aside": "journal.torn-1"})]);
            }
            EntryKind::Amend => stable::<AmendBody>(&[json!({
                "by": "A. Person", "reason": "typing error", "differences": ["plan.psd"],
                "header": header()
            })]),
            EntryKind::Resume => stable::<ResumeBody>(&resume_bodies()),
            EntryKind::End => stable::<EndBody>(&[json!({"outcome": "completed"})]),
        }
    }
}
