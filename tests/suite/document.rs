//! A procedure document as the plan of a laboratory: checked, run, verified, reported again from a log that was cut, formatted.
//! In: Markdown documents in a folder. Out: the run folder keeps the document, and its text is unchanged outside the plan.

use std::fs;

use super::workspace::Workspace;

const DOCUMENT: &str = "#  Procedure 7:   impact on a bracket\n\nThe bracket is  clamped.\n\n```psd\nspecimen bracket {\n  \
    mass      = 1 kg\n  behaviour = elastic(stiffness: 327.65 N/m)\n}\n```\n\n* The hammer:\n\n  ```psd\n  striker hammer {\n    \
    mass     = 10 kg\n    velocity = 1 m/s\n  }\n  ```\n\n```sh\npsd run   procedure.md\n```\n\n## Test\n\n```psd\nimpact hit {\n  \
    striker   = hammer\n  time_step = 10 ms\n  duration  = 1 s\n}\n\nrequire \"stays in travel\" hit.max_displacement < 0.16 m\n\n\
    report {\n  figures = []\n  formats = [html, csv]\n  annexes = [plan]\n}\n```\n";

#[test]
fn a_document_is_run_and_verified_and_the_run_folder_keeps_it() {
    let folder = Workspace::new(&[("procedure.md", DOCUMENT)]);
    folder.ends(0, &["run", "procedure.md", "--out", "run"]);
    assert_eq!(folder.read("run/plan/procedure.md"), DOCUMENT);
    let verified = folder.ends(0, &["verify", "run"]);
    assert!(!verified.contains("WRONG"), "{verified}");
    // The annex has the blocks of the plan, with the line numbers of the document.
    let report = folder.read("run/report.html");
    let line = |number: usize, text: &str| {
        report.contains(&format!("<span class=\"n\">{number}</span>{text}"))
    };
    assert!(line(6, "specimen bracket {") && line(15, "  striker hammer {"));
    assert!(!report.contains("psd run   procedure.md"));
    assert!(report.contains("plan/procedure.md"));

    let later = DOCUMENT.replace("0.16 m", "0.17 m");
    fs::write(folder.path("run/plan/procedure.md"), later).unwrap();
    let verified = folder.ends(3, &["verify", "run"]);
    assert!(verified.contains("WRONG"), "{verified}");
}

#[test]
fn a_run_of_a_document_that_was_cut_is_reported_from_its_log_alone() {
    let folder = Workspace::new(&[("procedure.md", DOCUMENT)]);
    let run = ["run", "procedure.md", "--out", "run", "--log", "full"];
    folder.ends(0, &run);
    let log = folder.read("run/journal.psdj");
    let cut: Vec<&str> = log.lines().take(30).collect();
    fs::create_dir(folder.path("cut")).unwrap();
    fs::write(folder.path("cut/journal.psdj"), cut.join("\n") + "\n").unwrap();
    fs::remove_file(folder.path("procedure.md")).unwrap();
    let reported = folder.ends(3, &["report", "cut"]);
    assert!(reported.contains("INCOMPLETE"), "{reported}");
    assert_eq!(folder.read("cut/plan/procedure.md"), DOCUMENT);
    folder.ends(0, &["verify", "cut"]);
}

#[test]
fn an_error_is_at_its_line_of_the_document() {
    let wrong = DOCUMENT.replace("mass     = 10 kg", "mass     = 10 mm");
    let folder = Workspace::new(&[("lab/procedure.md", &wrong)]);
    let found = folder.ends(2, &["check", "lab/procedure.md"]);
    assert!(
        found.contains("lab/procedure.md:16:") && found.contains("16 │     mass     = 10 mm"),
        "{found}"
    );
    let json = folder.ends(2, &["check", "--format", "json", "lab/procedure.md"]);
    assert!(json.contains("\"line\": 16"), "{json}");
}

#[test]
fn the_formatter_changes_the_plan_and_no_other_text() {
    let unformatted = DOCUMENT
        .replace("mass      = 1 kg", "mass=1 kg")
        .replace("    velocity = 1 m/s", "    velocity=1 m/s");
    let folder = Workspace::new(&[
        ("lab/procedure.md", &unformatted),
        ("lab/notes.md", "no   plan here\n"),
    ]);
    let shown = folder.ends(1, &["fmt", "--check", "lab"]);
    assert!(shown.contains("+  mass      = 1 kg"), "{shown}");
    assert_eq!(folder.read("lab/procedure.md"), unformatted);
    folder.ends(0, &["fmt", "lab"]);
    assert_eq!(folder.read("lab/procedure.md"), DOCUMENT);
    assert_eq!(folder.read("lab/notes.md"), "no   plan here\n");
    folder.ends(0, &["fmt", "--check", "lab/procedure.md"]);
}

#[test]
fn the_plans_of_a_folder_are_tested_as_documents_too() {
    let folder = Workspace::new(&[
        ("plans/procedure.md", DOCUMENT),
        (
            "plans/README.md",
            "# Plans\n\n```psd fragment\nno plan\n```\n",
        ),
    ]);
    let accepted = folder.ends(0, &["test", "plans", "--accept"]);
    assert!(accepted.contains("plans/procedure") && !accepted.contains("README"));
    folder.ends(0, &["test", "plans"]);
    fs::write(
        folder.path("plans/procedure.psd"),
        "move out { to = 1 mm }\n",
    )
    .unwrap();
    let refused = folder.ends(2, &["test", "plans"]);
    assert!(
        refused.contains("plans/procedure.md") && refused.contains("plans/procedure.psd"),
        "{refused}"
    );
}
