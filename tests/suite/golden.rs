//! `psd test` as started from a shell: accepted results, reported differences, exit codes, files on disk.

use serde_json::Value;

use super::workspace::{Ended, Workspace, every_file};

/// A small plan with a result, a table and a figure.
const PLAN: &str = r#"plan "A small impact" {
  edition = 1
}

specimen beam {
  mass      = 1 kg
  behaviour = elastic(stiffness: 327.65 N/m)
}

striker hammer {
  mass     = 10 kg
  velocity = 1 m/s
}

impact hit {
  striker   = hammer
  time_step = 10 ms
  duration  = 1 s
}

require "stays in travel" hit.max_displacement < 0.16 m

report {
  figures = [displacement(hit)]
  formats = [csv]
}
"#;

/// A workspace with these plans in `plans`.
fn with_plans(plans: &[(&str, &str)]) -> Workspace {
    let workspace = Workspace::new(&[]);
    for (name, text) in plans {
        workspace.write(format!("plans/{name}.psd"), text);
    }
    workspace
}

impl Workspace {
    /// Replaces text in a file, which must contain that text.
    fn edit(&self, path: &str, from: &str, to: &str) {
        let text = self.read(path);
        assert!(text.contains(from), "{path} holds no `{from}`:\n{text}");
        self.write(path, text.replacen(from, to, 1));
    }
}

impl Ended {
    #[track_caller]
    fn prints(self, words: &[&str]) -> Self {
        for word in words {
            assert!(
                self.stderr.contains(word),
                "`{word}` is not said in:\n{}",
                self.stderr
            );
        }
        self
    }
}

#[test]
fn a_plan_is_accepted_then_passes_and_is_not_accepted_again() {
    let workspace = with_plans(&[("small", PLAN)]);
    workspace.psd(&["test"]).with(5).prints(&[
        "FAILED    plans/small  no accepted results in reports/small",
        "--accept",
    ]);
    workspace.psd(&["test", "--accept"]).with(0).prints(&[
        "accepted  plans/small  new, in reports/small",
        "1 plan, 1 accepted",
    ]);
    assert_eq!(
        workspace.read("reports/small/plan.txt"),
        "plans/small.psd\n"
    );
    workspace
        .psd(&["test"])
        .with(0)
        .prints(&["ok        plans/small  pass", "1 plan as accepted"]);
    assert!(
        !workspace.path("runs").exists(),
        "a test that passes leaves nothing"
    );
    let accepted = every_file(&workspace.path("reports"));
    workspace
        .psd(&["test", "--accept"])
        .with(0)
        .prints(&["same      plans/small  within tolerance: nothing written"]);
    assert_eq!(every_file(&workspace.path("reports")), accepted);

    // `psd run --accept` does the same: it writes nothing if nothing changed, and writes the same files if none exist.
    workspace
        .psd(&["run", "plans/small.psd", "--accept", "--out", "here"])
        .with(0)
        .prints(&["nothing written"]);
    std::fs::remove_dir_all(workspace.path("reports")).unwrap();
    workspace
        .psd(&["run", "plans/small.psd", "--accept", "--out", "again"])
        .with(0)
        .prints(&["accepted  plans/small  new, in reports/small"]);
    assert_eq!(every_file(&workspace.path("reports")), accepted);
    assert_eq!(
        workspace.undated_summary("reports/small"),
        workspace.undated_summary("again")
    );
    workspace
        .psd(&["run", "plans/small.psd", "--accept", "--date", "2026-05-31"])
        .with(2)
        .prints(&["as it is written"]);

    // A different last digit from a different machine is never written to the repository; `--anew` writes it anyway.
    let value = serde_json::from_str::<Value>(&workspace.read("reports/small/summary.json"))
        .unwrap()["procedures"]["hit"]["results"]["max_displacement"]["value"]
        .as_f64()
        .unwrap();
    workspace.edit(
        "reports/small/summary.json",
        &value.to_string(),
        &(value * (1.0 + 1e-12)).to_string(),
    );
    let other = every_file(&workspace.path("reports"));
    workspace.psd(&["test"]).with(0);
    workspace
        .psd(&["test", "--accept"])
        .with(0)
        .prints(&["nothing written"]);
    assert_eq!(every_file(&workspace.path("reports")), other);
    workspace
        .psd(&["test", "--accept", "--anew"])
        .with(0)
        .prints(&["written again, no result changed"]);
    assert_eq!(every_file(&workspace.path("reports")), accepted);
}

#[test]
fn every_kind_of_difference_is_found_and_named_the_same_however_many_run_at_a_time() {
    let names = [
        "column", "figure", "gone", "more", "near", "number", "rows", "same", "state", "verdict",
    ];
    let workspace = with_plans(&names.map(|name| (name, PLAN)));
    workspace.write(
        "plans/near.psd",
        format!("{PLAN}\ngolden {{\n  results = [tolerance(hit.max_displacement, 0.1 mm)]\n  columns = [tolerance(hit.restoring_force_n, 0.2 %)]\n}}\n"),
    );
    workspace
        .psd(&["test", "--accept"])
        .with(0)
        .prints(&["10 plans, 10 accepted"]);
    let table = |name: &str| format!("reports/{name}/tables/hit.csv");
    let summary = |name: &str| format!("reports/{name}/summary.json");
    let displacement = "0.15786";
    assert!(workspace.read(&summary("number")).contains(displacement));
    let text = workspace.read(&table("near"));
    let of = |line: usize| {
        text.lines()
            .nth(line)
            .unwrap()
            .split(',')
            .map(str::to_owned)
            .collect::<Vec<String>>()
    };
    let (heads, mut cells) = (of(0), of(11));
    let index = heads
        .iter()
        .position(|head| head == "restoring_force_n")
        .unwrap();
    let row = cells.join(",");
    cells[index] = (cells[index].parse::<f64>().unwrap() * 1.001).to_string();
    let moved = cells.join(",");
    // Within the tolerance of its plan, and the same change without a tolerance.
    workspace.edit(&table("near"), &row, &moved);
    workspace.edit(&summary("near"), displacement, "0.15789");
    workspace.edit(&table("column"), &row, &moved);
    workspace.edit(&summary("number"), displacement, "0.15789");
    workspace.edit(&table("gone"), "restoring_force_n", "old_force_n");
    let last = workspace
        .read(&table("rows"))
        .lines()
        .last()
        .unwrap()
        .to_owned();
    workspace.edit(&table("rows"), &format!("{last}\n"), "");
    workspace.edit(
        &table("more"),
        &format!("{last}\n"),
        &format!("{last}\n{last}\n"),
    );
    workspace.edit(&table("state"), ",contact,", ",limit,");
    workspace.edit(
        &summary("verdict"),
        "\"verdict\": \"pass\"",
        "\"verdict\": \"fail\"",
    );
    let figure = workspace.read("reports/figure/figures.json");
    let curve = figure
        .lines()
        .find(|line| line.contains("structure X"))
        .unwrap();
    let point = curve
        .split("[0.1,")
        .nth(1)
        .unwrap()
        .split(']')
        .next()
        .unwrap();
    workspace.edit(
        "reports/figure/figures.json",
        &format!("[0.1,{point}]"),
        "[0.1,0.25]",
    );

    let alone = workspace
        .psd(&["test", "--format", "json", "--jobs", "1"])
        .with(5);
    let together = workspace
        .psd(&["test", "--format", "json", "--jobs", "4"])
        .with(5);
    assert_eq!(alone.stdout, together.stdout);
    let report = alone.json();
    assert_eq!(
        (&report["schema"], &report["good"], &report["failed"]),
        (&"psd.test/1".into(), &2.into(), &8.into())
    );
    let found = |name: &str| -> Vec<String> {
        let plan = report["plans"]
            .as_array()
            .unwrap()
            .iter()
            .find(|plan| plan["plan"] == format!("plans/{name}"))
            .unwrap();
        let described = |found: &Value| {
            format!(
                "{} {} {}",
                found["part"].as_str().unwrap(),
                found["name"].as_str().unwrap(),
                found["kind"].as_str().unwrap()
            )
        };
        plan["differences"]
            .as_array()
            .unwrap()
            .iter()
            .map(described)
            .collect()
    };
    assert_eq!(found("same"), Vec::<String>::new());
    assert_eq!(found("near"), Vec::<String>::new());
    assert_eq!(found("column"), ["table hit.restoring_force_n moved"]);
    assert_eq!(
        found("gone"),
        [
            "table hit.old_force_n gone",
            "table hit.restoring_force_n new"
        ]
    );
    assert_eq!(found("rows"), ["table table of hit length"]);
    assert_eq!(found("more"), ["table table of hit length"]);
    assert_eq!(found("state"), ["table hit.state text"]);
    assert_eq!(found("verdict"), ["verdict verdict text"]);
    assert_eq!(found("number")[0], "result hit.max_displacement moved");
    assert_eq!(
        found("figure"),
        ["figure figure hit_displacement, structure X: y moved"]
    );

    let column = &report["plans"][0]["differences"][0];
    assert_eq!(
        (&column["first"]["step"], &column["rows"], &column["unit"]),
        (&10.into(), &1.into(), &"N".into())
    );
    assert!((column["by_fraction"].as_f64().unwrap() + 0.001 / 1.001).abs() < 1e-6);

    // The remaining results to inspect, only of plans that failed.
    let left = |path: &str| workspace.path("runs/golden-failures").join(path).exists();
    assert!(
        left("column/hit_restoring_force_n.png")
            && left("column/hit_restoring_force_n_difference.png")
    );
    assert!(
        left("figure/hit_displacement.png")
            && left("number/new/summary.json")
            && left("number/difference.txt")
    );
    assert!(!left("same") && !left("near"));
    let output = workspace.psd(&["test", "--filter", "column"]).with(5);
    output.prints(&[
        "FAILED    plans/column  1 difference",
        "first at step 10, 0.1000 s; 1 of 30 rows",
        "−0.0999 %",
        "see runs/golden-failures/column",
    ]);

    // After acceptance it passes, and its output is removed. Plans that did not run stay unchanged.
    workspace
        .psd(&["test", "--filter", "column", "--accept"])
        .with(0)
        .prints(&["accepted  plans/column  1 changed", "hit.restoring_force_n"]);
    workspace.psd(&["test", "--filter", "column"]).with(0);
    assert!(!left("column") && left("number"));

    let fast = workspace
        .psd(&["test", "--fail-fast", "--jobs", "4", "--tap"])
        .with(5)
        .stdout;
    assert_eq!(
        fast,
        workspace
            .psd(&["test", "--fail-fast", "--jobs", "1", "--tap"])
            .with(5)
            .stdout
    );
    assert!(
        fast.contains("ok 1 - plans/column\nnot ok 2 - plans/figure\n")
            && fast.matches("# SKIP").count() == 8,
        "{fast}"
    );
}

#[test]
fn the_cause_comes_first_then_a_requirement_that_changes_its_verdict() {
    let workspace = with_plans(&[("small", PLAN)]);
    workspace.psd(&["test", "--accept"]).with(0);
    workspace.edit("plans/small.psd", "velocity = 1 m/s", "velocity = 1.1 m/s");
    let output = workspace.psd(&["test"]).with(5).prints(&[
        "\"pass\" → \"fail\"",
        "require \"stays in travel\": verdict",
        "hit.max_displacement  ",
    ]);
    let position = |words: &str| output.stderr.find(words).unwrap();
    assert!(position("  cause        text of the plan") < position("  verdict "));
    assert!(
        position("  verdict ") < position("stays in travel")
            && position("stays in travel") < position("hit.max_displacement")
    );
    // The plan that fails is also a result, once it is accepted.
    workspace.psd(&["test", "--accept"]).with(0);
    workspace
        .psd(&["test"])
        .with(0)
        .prints(&["ok        plans/small  fail"]);
}

#[test]
fn a_plan_that_must_fail_to_check_has_its_words_accepted() {
    let wrong = PLAN.replace("velocity = 1 m/s", "velocity = 1 m");
    let workspace = with_plans(&[("wrong", &wrong)]);
    workspace
        .psd(&["test", "--accept"])
        .with(0)
        .prints(&["accepted  plans/wrong  new"]);
    assert!(
        workspace
            .read("reports/wrong/diagnostics.txt")
            .contains("E301")
    );
    workspace
        .psd(&["test"])
        .with(0)
        .prints(&["ok        plans/wrong  fails to check, as accepted"]);
    workspace.edit("plans/wrong.psd", "velocity = 1 m", "velocity = 2 m");
    workspace
        .psd(&["test"])
        .with(5)
        .prints(&["diagnostics.txt"]);
    workspace.write("plans/wrong.psd", PLAN);
    workspace
        .psd(&["test"])
        .with(5)
        .prints(&["the plan checks, but is accepted as a plan that does not"]);
    workspace.psd(&["test", "--accept"]).with(0);
    assert!(!workspace.path("reports/wrong/diagnostics.txt").exists());
    // The opposite change requires an explicit option.
    workspace.write("plans/wrong.psd", &wrong);
    workspace
        .psd(&["test"])
        .with(5)
        .prints(&["the plan fails to check"]);
    workspace
        .psd(&["test", "--accept"])
        .with(5)
        .prints(&["delete its results folder first"]);
    assert!(workspace.path("reports/wrong/summary.json").exists());
}

/// Plans of one name in folders side by side have one folder of results: it is that of the first plan accepted.
#[test]
fn the_results_of_another_plan_are_neither_compared_nor_replaced() {
    let workspace = Workspace::new(&[]);
    workspace.write("a/t.psd", PLAN);
    workspace.write("b/t.psd", PLAN.replace("327.65 N/m", "400 N/m"));
    workspace.psd(&["test", "a", "--accept"]).with(0);
    assert_eq!(workspace.read("reports/t/plan.txt"), "a/t.psd\n");
    let accepted = every_file(&workspace.path("reports"));
    let refusal = "reports/t has the accepted results of a/t.psd, not of b/t.psd";
    for arguments in [&["test", "b", "--accept"][..], &["test", "b"]] {
        workspace.psd(arguments).with(5).prints(&[refusal]);
    }
    workspace
        .psd(&["run", "b/t.psd", "--accept", "--out", "here"])
        .with(2)
        .prints(&[refusal]);
    workspace
        .psd(&["test", "a", "b", "--accept"])
        .with(2)
        .prints(&["a/t.psd and b/t.psd would share the accepted results in reports/t"]);
    assert_eq!(every_file(&workspace.path("reports")), accepted);
    workspace.psd(&["test", "a"]).with(0);
    // Its own folder, named from any place.
    workspace
        .psd(&["test", "b", "--accept", "--golden", "b/kept"])
        .with(0)
        .prints(&["accepted  b/t  new, in b/kept/t"]);
    assert_eq!(workspace.read("b/kept/t/plan.txt"), "t.psd\n");
    let folder = workspace.path("b/kept");
    workspace
        .psd(&["test", "b", "--golden", folder.to_str().unwrap()])
        .with(0);
    // `plan.txt` is deleted after the plan was moved.
    std::fs::remove_file(workspace.path("reports/t/plan.txt")).unwrap();
    workspace.psd(&["test", "a"]).with(0);
    workspace.psd(&["test", "a", "--accept"]).with(0);
    assert_eq!(every_file(&workspace.path("reports")), accepted);
}

#[test]
fn names_are_found_listed_and_missed() {
    let workspace = with_plans(&[("one", PLAN), ("two", PLAN)]);
    workspace.write("plans/lib/parts.psd", "let mass = 1 kg\n");
    workspace.write("reports/old/summary.json", "{}");
    workspace.write("reports/notes/readme.txt", "no results");
    let listed = workspace.psd(&["test", "--list"]).with(0).stdout;
    assert_eq!(
        listed,
        "plans/one  (not accepted)\nplans/two  (not accepted)\n"
    );
    workspace
        .psd(&["test", "--filter", "three"])
        .with(2)
        .prints(&["no plan with `three` in its name in plans"]);
    workspace
        .psd(&["test", "nowhere"])
        .with(3)
        .prints(&["nowhere"]);
    workspace.psd(&["test", "--anew"]).with(2);
    workspace
        .psd(&["test", "--tap", "--format", "json"])
        .with(2);
    workspace
        .psd(&["test", "--accept", "--golden", "kept", "plans/one.psd"])
        .with(0);
    assert!(
        workspace.path("kept/one/summary.json").exists() && !workspace.path("reports/one").exists()
    );
    workspace
        .psd(&["test", "--accept"])
        .with(0)
        .prints(&["unused    reports/old  no plan has this name"]);
    let output = workspace.psd(&["test", "plans/one.psd"]).with(0);
    assert!(!output.stderr.contains("unused"), "{}", output.stderr);
    assert!(!output.stderr.contains("notes"), "{}", output.stderr);
}

#[test]
fn runs_are_laid_side_by_side_with_differences_or_with_their_spread() {
    let workspace = with_plans(&[(
        "small",
        &PLAN
            .replace("mass      = 1 kg", "mass      = weight")
            .replace(
                "time_step = 10 ms",
                "contact   = restitution(0.5)\n  time_step = 10 ms",
            )
            .replace("< 0.16 m", "< 0.3 m")
            .replace(
                "specimen",
                "param weight = 1 kg between 0.5 kg .. 2 kg\n\nspecimen",
            ),
    )]);
    for (index, mass) in ["1 kg", "1.1 kg", "1.2 kg"].iter().enumerate() {
        workspace
            .psd(&[
                "run",
                "plans/small.psd",
                "--set",
                &format!("weight={mass}"),
                "--out",
                &format!("run-{}", index + 1),
            ])
            .with(0);
    }
    let two = workspace
        .psd(&["compare", "run-1", "run-2", "--out", "two"])
        .with(0)
        .stdout;
    for word in [
        "hit.max_displacement",
        "difference",
        "parameters.weight  1.0 kg  1.1 kg",
        "stays in travel  pass  pass",
    ] {
        assert!(two.contains(word), "`{word}` is not in:\n{two}");
    }
    assert!(!two.contains("run_id") && !two.contains("Plan of"), "{two}");
    let value = |run: &str| -> f64 {
        let summary: Value =
            serde_json::from_str(&workspace.read(&format!("{run}/summary.json"))).unwrap();
        summary["procedures"]["hit"]["results"]["max_displacement"]["value"]
            .as_f64()
            .unwrap()
    };
    let table = workspace.read("two/results.csv");
    let row = table
        .lines()
        .find(|line| line.starts_with("hit.max_displacement,m,"))
        .unwrap();
    let cells: Vec<f64> = row
        .split(',')
        .skip(2)
        .map(|cell| cell.parse().unwrap_or(f64::NAN))
        .collect();
    assert_eq!(
        (cells[0], cells[2], cells[7]),
        (
            value("run-1"),
            value("run-2"),
            value("run-2") - value("run-1")
        )
    );
    let page = workspace.read("two/comparison.html");
    assert!(
        page.contains("data:image/png;base64,") && !page.contains("://"),
        "the page needs no other file"
    );
    assert!(
        workspace
            .path("two/figures/hit_displacement_1.png")
            .exists()
    );

    // A folder of accepted results contains the same numbers; a different plan has the same common parts.
    workspace.psd(&["test", "--accept"]).with(0);
    let accepted = workspace
        .psd(&["compare", "reports/small", "run-1"])
        .with(0)
        .stdout;
    assert!(
        accepted.contains("0 %") && !accepted.contains("Differences\n  hit"),
        "{accepted}"
    );
    workspace.write("plans/ramp.psd", "specimen s {\n  mass = 1 kg\n  behaviour = elastic(stiffness: 300 N/m)\n}\n\nstiffness ramp k0 {\n  displacements = 1 mm .. 5 mm step 1 mm\n}\n\nreport {\n  formats = [csv]\n}\n");
    workspace
        .psd(&["run", "plans/ramp.psd", "--out", "ramp"])
        .with(0);
    let apart = workspace.psd(&["compare", "run-1", "ramp"]).with(0).stdout;
    assert!(
        apart.contains("Results of some runs only")
            && !apart.contains("\nResults, ")
            && apart.contains("k0.stiffness"),
        "{apart}"
    );

    let three = workspace
        .psd(&["compare", "run-1", "run-2", "run-3"])
        .with(0)
        .stdout;
    assert!(
        three.contains("deviation") && three.contains("mean"),
        "{three}"
    );
    workspace.psd(&["compare", "run-1"]).with(2);
    workspace
        .psd(&["compare", "run-1", "plans"])
        .with(3)
        .prints(&["is not a run"]);
    workspace
        .psd(&["compare", "run-1", "run-2", "--out", "two"])
        .with(3);
}
