//! Labels that contain markup or control characters, in every output: page, terminal, tables, JSON, file names, manifest, record. Each
//! must appear as plain text.

use psd::check::{Checked, Options, check, no_files};
use psd::golden::comparison::page;
use psd::golden::comparison::{Comparison, Side, csv};
use psd::golden::print::json as golden_json;
use psd::golden::{
    Change, Finding, FindingPart, Outcome as TestOutcome, Report, Tested, junit, tap,
};
use psd::report::{Figures, OutputFile, console};
use psd_plan::Format;
use psd_plan::record::{EventKind, Outcome};
use psd_rig::journal::{Durability, EntryKind, FileStorage, Journal, recover};
use psd_text::diagnostic::{json, render};
use psd_text::sanitize;
use rayon::prelude::*;

use super::fixture::{Finished, finished};

/// The labels, and one longer than any that a person would write.
fn labels() -> Vec<String> {
    let mut labels: Vec<String> =
        serde_json::from_str(include_str!("../../hostile_labels.json")).unwrap();
    labels.push("long ".repeat(20_000));
    labels.push("=".repeat(5_000));
    labels
}

/// A run with the label at every position of an external text.
fn run_with(label: &str) -> Finished {
    let mut finished = finished();
    let own = || label.to_owned();
    finished.plan.title = own();
    finished.plan.report.title = Some(own());
    finished.plan.report.sign = vec![own(), own()];
    finished.plan.report.figures.clear();
    finished.plan.report.formats = vec![Format::Html, Format::Csv];
    for field in [
        "customer",
        "operator",
        "laboratory",
        "specimen_id",
        "deviations",
        "notes",
        "date",
    ] {
        finished.plan.particulars.push((field, own()));
    }
    finished.plan.settings.push((own(), own()));
    finished.plan.rig.name = own();
    for file in &mut finished.plan.files {
        file.name = own();
        file.text = own().into();
    }
    for (requirement, outcome) in finished
        .plan
        .requirements
        .iter_mut()
        .zip(&mut finished.assessment.requirements)
    {
        requirement.label = own();
        outcome.label = own();
        for condition in &mut outcome.conditions {
            condition.text = own();
            condition.reason = Some(own());
        }
    }
    let rig = &mut finished.record.rig;
    (rig.name, rig.model, rig.serial, rig.firmware) = (own(), own(), own(), own());
    for (event, kind) in finished
        .record
        .events
        .iter_mut()
        .zip([EventKind::Fault, EventKind::Inspection])
    {
        (event.kind, event.text) = (kind, own());
    }
    finished.record.outcome = Outcome::Aborted { reason: own() };
    finished.provenance.date = Some(own());
    finished
}

fn text<'a>(files: &'a [OutputFile], path: &str) -> &'a str {
    str::from_utf8(&files.iter().find(|file| file.path == path).unwrap().bytes).unwrap()
}

/// The control characters of a text, except newlines.
fn steering(text: &str) -> String {
    text.chars()
        .filter(|c| sanitize::is_control_like(*c) && *c != '\n')
        .collect()
}

/// The tags of a page, each with the names of its attributes.
fn tags(page: &str) -> Vec<String> {
    let names = |tag: &str| {
        let mut outside = String::new();
        for (at, part) in tag.split('"').enumerate() {
            outside.push_str(if at % 2 == 0 { part } else { "" });
        }
        outside
    };
    page.split('<')
        .skip(1)
        .map(|after| names(after.split('>').next().unwrap()))
        .collect()
}

#[test]
fn no_label_is_markup_on_a_page() {
    let plain = tags(text(
        &super::files(&run_with("a plain label")),
        "report.html",
    ));
    assert!(plain.len() > 200);
    labels().par_iter().for_each(|label| {
        let files = super::files(&run_with(label));
        let page = text(&files, "report.html");
        assert_eq!(steering(page), "", "{label:?}");
        // A label without letters may be reported as missing. A label with several lines adds lines to the plan.
        if !label.trim().is_empty()
            && !label.contains([
                '\n', '\r', '\u{85}', '\u{2028}', '\u{2029}', '\u{b}', '\u{c}',
            ])
        {
            let tags = tags(page);
            assert!(tags == plain, "{label:?}");
        }
        for forbidden in [
            "<script",
            "<img src=x",
            "<!--",
            "src=\"http",
            "href=",
            "@import",
            "url(",
        ] {
            assert!(!page.contains(forbidden), "{label:?}: {forbidden}");
        }
    });
}

/// Every text reaches the PDF as data: typst would fail on invalid markup, and an archival format allows no script and no link.
#[test]
fn no_label_is_markup_on_paper() {
    let paper = |label: &str| {
        let mut finished = run_with(label);
        finished.plan.report.formats = vec![Format::Pdf];
        finished.provenance.date = Some("2026-05-31".to_owned());
        super::files(&finished)
            .into_iter()
            .find(|file| file.path == "report.pdf")
            .unwrap()
            .bytes
    };
    // One label of each kind, because a PDF takes long.
    let marks = [
        "#eval",
        "<script",
        "</style",
        "[31m",
        "\u{202e}",
        "\u{e0041}",
        "\u{0}",
        "\u{2028}",
        "\u{ffff}",
        "CON",
        "long ",
        "\u{301}",
    ];
    let all = labels();
    let of = |mark: &&str| {
        all.iter()
            .find(|label| label.contains(*mark))
            .unwrap()
            .chars()
            .take(2000)
            .collect::<String>()
    };
    let labels: Vec<String> = marks.iter().map(of).collect();
    labels.par_iter().for_each(|label| {
        let bytes = paper(label);
        let holds = |word: &[u8]| bytes.windows(word.len()).any(|found| found == word);
        assert!(
            bytes.starts_with(b"%PDF-1.7") && holds(b"<pdfaid:part>3"),
            "{label:?}"
        );
        for forbidden in [
            b"/JavaScript".as_slice(),
            b"/Launch",
            b"/OpenAction",
            b"/URI",
        ] {
            assert!(!holds(forbidden), "{label:?}");
        }
    });
    assert!(
        paper(&labels[0]) == paper(&labels[0]),
        "the same bytes again"
    );
}

#[test]
fn no_label_steers_a_terminal_or_makes_another_line() {
    let lines = |label: &str| {
        console::verdict_text(&run_with(label).run(), false)
            .lines()
            .count()
    };
    let plain = lines("a plain label");
    for label in labels() {
        let shown = console::verdict_text(&run_with(&label).run(), true);
        assert_eq!(
            steering(&sanitize::terminal(&shown).replace("\u{1b}[", "")),
            "",
            "{label:?}"
        );
        assert_eq!(
            steering(&console::verdict_text(&run_with(&label).run(), false)),
            "",
            "{label:?}"
        );
        assert!(lines(&label) <= plain, "{label:?}");
        assert_eq!(steering(&sanitize::one_line(&label)), "");
        let gated = sanitize::terminal(&label);
        assert!(
            steering(&gated)
                .chars()
                .all(|c| matches!(c, '\u{1b}' | '\t')),
            "{label:?}: {gated:?}"
        );
    }
}

#[test]
fn no_label_is_lost_or_loose_in_json() {
    for label in labels() {
        let files = super::files(&run_with(&label));
        let summary = text(&files, "summary.json");
        assert_eq!(steering(summary), "", "{label:?}");
        let value: serde_json::Value = serde_json::from_str(summary).unwrap();
        assert_eq!(value["plan"]["title"], label.as_str());
        assert_eq!(value["requirements"][0]["name"], label.as_str());
        assert_eq!(value["outcome"]["reason"], label.as_str());
    }
}

#[test]
fn no_label_is_a_formula_in_a_table() {
    for label in labels() {
        let cell = sanitize::cell(&label);
        assert!(
            !cell
                .trim_start()
                .starts_with(['=', '+', '-', '@', '\t', '\r', '\u{ff1d}']),
            "{label:?}"
        );
        assert_eq!(steering(&cell), "");
        assert!(!cell.contains('\n'));
    }
    // Numbers remain numbers, including negative ones.
    let files = super::files(&run_with("x"));
    let table = text(&files, "tables/hit.csv");
    assert!(
        table
            .lines()
            .skip(1)
            .any(|line| line.split(',').any(|cell| cell.starts_with('-')))
            && !table.contains('\'')
    );
}

#[test]
fn no_label_is_another_path_or_another_line_of_the_manifest() {
    for label in labels() {
        let mut finished = run_with(&label);
        finished.plan.files[0].text = "first".into();
        for (at, name) in ["con", "Hit", "hit"].into_iter().enumerate() {
            finished.record.procedures[at].name = name.to_owned();
        }
        let files = super::files(&finished);
        let mut seen = std::collections::BTreeSet::new();
        for file in &files {
            assert!(
                seen.insert(file.path.to_lowercase()),
                "{label:?}: {} twice",
                file.path
            );
            for part in file.path.split('/') {
                // A name that was cut and then numbered is longer than one that was only cut.
                assert!(
                    sanitize::file_part(part) == part || (100..256).contains(&part.len()),
                    "{label:?}: {}",
                    file.path
                );
            }
            assert!(
                [
                    "plan/",
                    "tables/",
                    "report.",
                    "summary.json",
                    "manifest.sha256"
                ]
                .iter()
                .any(|own| file.path.starts_with(own))
            );
        }
        assert!(
            seen.contains("tables/con-.csv")
                && seen.contains("tables/hit.csv")
                && seen.contains("tables/hit-2.csv")
        );
        assert_eq!(
            text(&files, "manifest.sha256").lines().count(),
            files.len() - 1,
            "{label:?}"
        );
    }
}

/// A test report in which every text is the label.
fn tested_with(label: &str) -> Report {
    let own = || label.to_owned();
    let found = vec![
        Finding::text(FindingPart::Verdict, label, label, label),
        Finding::new(FindingPart::Table, label, Change::Missing),
    ];
    let outcomes = [
        TestOutcome::Same {
            verdict: Some("pass"),
        },
        TestOutcome::Differs(found),
        TestOutcome::NotAccepted,
        TestOutcome::Failed(own()),
        TestOutcome::NotRun,
    ];
    Report {
        tested: outcomes
            .into_iter()
            .map(|outcome| Tested {
                folder: own(),
                name: own(),
                outcome,
            })
            .collect(),
        unused: vec![own()],
    }
}

#[test]
fn no_label_is_another_result_of_a_test() {
    let begins = |text: &str, with: &[&str]| {
        text.lines()
            .filter(|line| with.iter().any(|word| line.starts_with(word)))
            .count()
    };
    let xml_tags = |text: &str| {
        // A suite is a folder: a label with a slash is a different folder.
        let named = tags(text)
            .into_iter()
            .map(|tag| tag.split(' ').next().unwrap().to_owned());
        named
            .filter(|tag| !tag.starts_with("testsuite") && !tag.starts_with("/testsuite"))
            .collect::<Vec<_>>()
    };
    let plain = tested_with("a plain label");
    let (plain_tap, plain_xml) = (tap(&plain), junit(&plain).unwrap());
    for label in labels() {
        let report = tested_with(&label);
        let text = tap(&report);
        assert_eq!(steering(&text), "", "{label:?}");
        assert_eq!(
            text.lines().count(),
            plain_tap.lines().count(),
            "{label:?}: {text}"
        );
        for word in [
            "ok ",
            "not ok ",
            "1..",
            "Bail out!",
            "# unused",
            "  ---",
            "  ...",
        ] {
            assert_eq!(
                begins(&text, &[word]),
                begins(&plain_tap, &[word]),
                "{label:?}: {word} in {text}"
            );
        }
        assert_eq!(
            text.lines()
                .filter(|line| line.starts_with("ok ") && line.contains('#'))
                .count(),
            1,
            "only what was not run is skipped"
        );
        let page = junit(&report).unwrap();
        assert_eq!(steering(&page), "", "{label:?}");
        assert_eq!(xml_tags(&page), xml_tags(&plain_xml), "{label:?}: {page}");
        assert!(!page.contains("<!"), "{label:?}: {page}");
        let document = golden_json::comparison_as_json(&report);
        assert_eq!(steering(&document), "", "{label:?}");
        let read: serde_json::Value = serde_json::from_str(&document).unwrap();
        assert_eq!(
            (&read["plans"][3]["message"], &read["unused"][0]),
            (&label.as_str().into(), &label.as_str().into())
        );
        assert_eq!(read["plans"][1]["differences"].as_array().unwrap().len(), 2);
    }
}

/// A comparison of two runs, each with the label at every position of an external text.
fn compared_with(label: &str) -> Comparison {
    let summary: serde_json::Value =
        serde_json::from_str(text(&super::files(&run_with(label)), "summary.json")).unwrap();
    let side = |name: String| Side {
        name,
        summary: summary.clone(),
        figures: Figures::default(),
        plan: Some(label.to_owned()),
    };
    Comparison::of(&[side(label.to_owned()), side(format!("{label} again"))])
}

#[test]
fn no_label_is_markup_or_a_formula_in_a_comparison() {
    let made = |label: &str| {
        let compared = compared_with(label);
        (
            page::page(&compared, &[(label.to_owned(), Vec::new())]),
            csv(&compared),
        )
    };
    let (plain_page, plain_table) = made("a plain label");
    labels().par_iter().for_each(|label| {
        let (page, table) = made(label);
        assert_eq!(
            (steering(&page), steering(&table)),
            (String::new(), String::new()),
            "{label:?}"
        );
        assert!(tags(&page) == tags(&plain_page), "{label:?}");
        assert_eq!(
            table.lines().count(),
            plain_table.lines().count(),
            "{label:?}"
        );
        for begin in [",=", ",\"=", ",+", ",\"+", ",@", ",\"@", ",\u{ff1d}"] {
            assert!(
                !table.lines().next().unwrap().contains(begin) || label.contains(begin),
                "{label:?}: {begin}"
            );
        }
    });
}

#[test]
fn no_label_steers_a_terminal_from_a_diagnostic() {
    for label in labels() {
        let quoted = label.replace('\\', "\\\\").replace('"', "\\\"");
        for plan in [
            label.clone(),
            format!(
                "plan \"{quoted}\" {{ customr = \"{quoted}\" }}\nuse \"{quoted}\"\nparam x = {label}\n"
            ),
        ] {
            let Checked {
                diagnostics,
                sources,
                ..
            } = check("plan.psd", &plan, &no_files, &Options::default());
            let shown = render::render_all(&diagnostics, &sources, &render::Appearance::plain());
            assert_eq!(steering(&shown), "", "{label:?}: {shown}");
            let found: Vec<_> = diagnostics
                .iter()
                .map(|found| json::diagnostic(found, &sources, &label, ""))
                .collect();
            let document = json::printed_diagnostics(&found);
            assert_eq!(steering(&document), "", "{label:?}");
            let read: serde_json::Value = serde_json::from_str(&document).unwrap();
            assert_eq!(
                read["diagnostics"].as_array().unwrap().len(),
                diagnostics.len()
            );
        }
    }
}

#[test]
fn no_label_is_another_record() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("journal.psdj");
    let mut journal = Journal::create(
        Box::new(FileStorage::create(&path).unwrap()),
        Durability::Buffered,
    );
    journal
        .append(EntryKind::Header, &serde_json::json!({}))
        .unwrap();
    let labels: Vec<String> = labels()
        .into_iter()
        .map(|label| label.chars().take(8192).collect())
        .collect();
    for label in &labels {
        journal
            .append(EntryKind::Event, &serde_json::json!({ "text": label }))
            .unwrap();
    }
    journal.sync_point().unwrap();
    drop(journal);
    let bytes = std::fs::read(&path).unwrap();
    assert!(
        bytes
            .iter()
            .all(|byte| (b' '..=b'~').contains(byte) || *byte == b'\n')
    );
    let found = recover(&bytes.into()).unwrap();
    let texts: Vec<String> = found.lines[1..]
        .iter()
        .map(|line| line.body()["text"].as_str().unwrap().to_owned())
        .collect();
    assert_eq!(texts, labels);
}
