//! Two summaries: what is compared, with which unit and name, and what is not.

use serde_json::json;

use super::*;

fn summary() -> Value {
    let condition = json!({ "condition": "hit.x < 1 m", "verdict": "pass", "value": 0.5, "limit": 1.0, "tolerance": null,
        "margin": 0.5, "unit": "m", "u": null, "guard_band": 0.1, "conforms": 0.9,
        "in_finer_steps": [0.4, 0.6], "reason": null });
    json!({
        "schema": "psd.summary/1", "run_id": "a", "psd": "0.1.0", "plan": { "title": "T", "sha256": "b" },
        "verdict": "pass",
        "procedures": { "hit": { "kind": "impact", "complete": true,
            "inputs": { "mass": { "value": 2.0, "unit": "kg", "u": null } },
            "results": {
                "x": { "value": 0.5, "unit": "m", "u": 1e-3, "degrees_of_freedom": 8.0, "k": 2.4 },
                "drift": { "value": [1e-3, 2e-3], "unit": "m", "u": null },
                "stop_time": { "value": null, "unit": "s", "u": null } },
            "uncertainty_budgets": {
                "x": { "unit": "m", "u": 1e-3, "degrees_of_freedom": 8.0, "contributions": [
                    { "input": "mass", "method": "linearised", "value": 2.0, "input_unit": "kg", "input_u": 0.1, "sensitivity": 0.01,
                        "contribution": 1e-3, "smooth": true },
                    { "input": "noise", "method": "sampled", "value": null, "input_unit": "N", "input_u": null, "sensitivity": null,
                        "contribution": 1e-5, "smooth": true }] },
                "drift[1]": { "unit": "m", "u": 1e-4, "contributions": [] } } },
            "again": { "kind": "impact", "complete": true, "inputs": { "mass": { "value": 2.0, "unit": "kg", "u": null } },
                "results": {} } },
        "requirements": [{ "name": "stays", "verdict": "pass", "value": 0.5, "limit": 1.0, "margin": 0.5, "unit": "m",
            "u": null, "guard_band": 0.1, "condition": "hit.x < 1 m", "conditions": [condition] }],
        "events": [{ "wall_time_s": 1.0, "text": "seen" }],
    })
}

fn findings(change: impl FnOnce(&mut Value)) -> Vec<String> {
    let mut now = summary();
    change(&mut now);
    let mut found = Vec::new();
    compare(
        Some(&summary().to_string()),
        Some(&now.to_string()),
        &Tolerances::default(),
        &mut found,
    );
    found
        .iter()
        .map(|finding| format!("{} {}", finding.part.name(), finding.name))
        .collect()
}

#[test]
fn what_names_the_run_is_not_compared_and_a_number_within_tolerance_is_the_same() {
    let same = findings(|now| {
        now["run_id"] = json!("other");
        now["psd"] = json!("9.9.9");
        now["plan"]["sha256"] = json!("other");
        now["procedures"]["hit"]["results"]["x"]["value"] = json!(0.5 * (1.0 + 0.9e-9));
        // Relative to the longest entry, and to the value that it is the uncertainty of.
        now["procedures"]["hit"]["results"]["drift"]["value"][0] = json!(1e-3 + 1.9e-12);
        now["procedures"]["hit"]["results"]["x"]["u"] = json!(1e-3 + 0.4e-9);
    });
    assert_eq!(same, Vec::<String>::new());
}

#[test]
fn every_difference_has_its_name() {
    let results = |now: &mut Value, result: &str, value: Value| {
        now["procedures"]["hit"]["results"][result]["value"] = value;
    };
    assert_eq!(
        findings(|now| results(now, "x", json!(0.500_000_001))),
        ["result hit.x"]
    );
    assert_eq!(
        findings(|now| results(now, "drift", json!([1e-3, 2.1e-3]))),
        ["result hit.drift[1]"]
    );
    assert_eq!(
        findings(|now| results(now, "drift", json!([1e-3]))),
        ["result hit.drift"]
    );
    assert_eq!(
        findings(|now| results(now, "stop_time", json!(0.1))),
        ["result hit.stop_time"]
    );
    assert_eq!(
        findings(|now| now["procedures"]["hit"]["inputs"]["mass"]["value"] = json!(2.1)),
        ["cause input hit.mass"]
    );
    assert_eq!(
        findings(|now| now["events"][0]["text"] = json!("said")),
        ["other event 1: text"]
    );
    assert_eq!(
        findings(|now| now["plan"]["title"] = json!("U")),
        ["cause plan.title"]
    );
    assert_eq!(
        findings(|now| now["requirements"] = json!([])),
        ["requirement require \"stays\""]
    );
    let verdicts = findings(|now| {
        now["verdict"] = json!("fail");
        now["requirements"][0]["verdict"] = json!("fail");
        now["requirements"][0]["margin"] = json!(-0.5);
    });
    assert_eq!(
        verdicts,
        ["verdict verdict", "requirement require \"stays\": verdict"]
    );
    let gone = findings(|now| {
        now["procedures"]["hit"]["results"]
            .as_object_mut()
            .unwrap()
            .remove("x");
    });
    assert_eq!(gone, ["result hit.x"]);
}

#[test]
fn one_new_result_is_one_difference() {
    let named = findings(|now| {
        let hit = &mut now["procedures"]["hit"];
        hit["results"].as_object_mut().unwrap().shift_insert(
            1,
            "y".to_owned(),
            json!({ "value": 1.0, "unit": "m", "u": 1e-3 }),
        );
        let budget = json!({ "unit": "m", "u": 1e-3, "contributions": [] });
        hit["uncertainty_budgets"]
            .as_object_mut()
            .unwrap()
            .shift_insert(0, "y".to_owned(), budget);
    });
    assert_eq!(named, ["result hit.y"]);
    // A list has a budget for each of its numbers.
    let gone = findings(|now| {
        let hit = &mut now["procedures"]["hit"];
        hit["results"]
            .as_object_mut()
            .unwrap()
            .shift_remove("drift");
        hit["uncertainty_budgets"]
            .as_object_mut()
            .unwrap()
            .shift_remove("drift[1]");
    });
    assert_eq!(gone, ["result hit.drift"]);
    // The budget of a result that had none is a difference of its own, and so is a new input, wherever it stands.
    let named = findings(|now| {
        let budgets = &mut now["procedures"]["hit"]["uncertainty_budgets"];
        budgets["stop_time"] = json!({ "unit": "s", "u": 1e-3, "contributions": [] });
        let line = json!({ "input": "velocity", "contribution": 2e-3 });
        budgets["x"]["contributions"]
            .as_array_mut()
            .unwrap()
            .insert(0, line);
    });
    assert_eq!(
        named,
        [
            "result budget of hit.x: velocity",
            "result budget of hit.stop_time"
        ]
    );
}

#[test]
fn every_number_has_its_own_unit() {
    let mut now = summary();
    let of = |now: &mut Value, path: &str, value: f64| {
        *now.pointer_mut(path).unwrap_or_else(|| panic!("{path}")) = json!(value);
    };
    let x = "/procedures/hit/results/x";
    let budget = "/procedures/hit/uncertainty_budgets/x";
    for (path, value) in [
        (format!("{x}/u"), 2e-3),
        (format!("{x}/degrees_of_freedom"), 9.0),
        (format!("{x}/k"), 2.3),
        (format!("{budget}/degrees_of_freedom"), 9.0),
        (format!("{budget}/contributions/0/input_u"), 0.2),
        (format!("{budget}/contributions/0/sensitivity"), 0.02),
        (format!("{budget}/contributions/1/contribution"), 2e-5),
        ("/requirements/0/guard_band".to_owned(), 0.2),
        ("/requirements/0/conditions/0/guard_band".to_owned(), 0.2),
        ("/requirements/0/conditions/0/conforms".to_owned(), 0.8),
        (
            "/requirements/0/conditions/0/in_finer_steps/1".to_owned(),
            0.7,
        ),
    ] {
        of(&mut now, &path, value);
    }
    let mut found = Vec::new();
    compare(
        Some(&summary().to_string()),
        Some(&now.to_string()),
        &Tolerances::default(),
        &mut found,
    );
    let lines: Vec<String> = found
        .iter()
        .map(|finding| {
            let Change::Moved(moved) = &finding.change else {
                panic!("{finding:?}")
            };
            let unit = psd_text::units::display::si_unit(moved.dimension);
            format!("{} [{unit}]", finding.name)
        })
        .collect();
    assert_eq!(
        lines,
        [
            "hit.x.u [m]",
            "hit.x.degrees_of_freedom [1]",
            "hit.x.k [1]",
            "budget of hit.x: degrees_of_freedom [1]",
            "budget of hit.x: mass: input_u [kg]",
            "budget of hit.x: mass: sensitivity [m/kg]",
            "budget of hit.x: noise: contribution [m]",
            "require \"stays\", condition 1: guard_band [m]",
            "require \"stays\", condition 1: conforms [1]",
            "require \"stays\", condition 1: in_finer_steps.1 [m]",
        ]
    );
}

#[test]
fn an_input_is_a_cause_unless_a_result_before_it_changed() {
    let changed = |first: bool| {
        findings(|now| {
            let procedures = now["procedures"].as_object_mut().unwrap();
            if first {
                procedures["hit"]["results"]["x"]["value"] = json!(0.6);
            }
            procedures["again"]["inputs"]["mass"]["value"] = json!(3.0);
        })
    };
    assert_eq!(changed(false), ["cause input again.mass"]);
    assert_eq!(changed(true), ["result hit.x", "other input again.mass"]);
}

/// A comparison with a published number: its statement and its published number count, its difference follows from the value.
#[test]
fn a_reproduction_is_named_and_its_difference_follows() {
    let with = |statement: &str, published: f64, difference: f64| {
        let mut summary = summary();
        summary["reproductions"] = json!([{ "name": "peak", "statement": statement, "value": 0.5, "published": published,
            "tolerance": 0.1, "difference": difference, "unit": "m", "u": null }]);
        summary.to_string()
    };
    let compared = |is: String| {
        let mut found = Vec::new();
        let was = with("reproduces", 0.45, 0.05);
        compare(Some(&was), Some(&is), &Tolerances::default(), &mut found);
        found
            .iter()
            .map(|finding| finding.name.clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(compared(with("reproduces", 0.45, 0.06)), [""; 0]);
    assert_eq!(
        compared(with("does not reproduce", 0.45, 0.05)),
        ["reproduces peak: statement"]
    );
    assert_eq!(
        compared(with("reproduces", 0.46, 0.05)),
        ["reproduces peak: published"]
    );
}
