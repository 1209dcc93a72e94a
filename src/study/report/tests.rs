//! Tests of the report of a study: what it states, and what it must never state.

use super::*;
use crate::report::OutputFile;
use crate::study::answers::testing::{
    answers, fragility_metadata, fragility_rows, metadata, normals, rows,
};
use crate::study::data_set::{Event, Metadata, StudiedRequirement};
use psd_physics::study::sampling::Design;
use psd_plan::Comparison;

/// A study of 1000 runs with a requirement on its probability.
fn study(limit: f64, runs: u64) -> (Metadata, Answers) {
    let metadata = Metadata {
        studied: vec![StudiedRequirement {
            label: "rarely too far".to_owned(),
            text: "scatter.probability(fails: \"small\") < 5 %".to_owned(),
            requirement: 0,
            event: Event::Fails,
            comparison: Comparison::Less,
            limit,
        }],
        ..metadata(1000)
    };
    let drawn = rows(&normals(Design::Random, 4), runs, |run| run % 200 == 7);
    let answers = answers(&metadata, &drawn);
    (metadata, answers)
}

fn files(metadata: &Metadata, answers: &Answers) -> Vec<OutputFile> {
    let mut files = Vec::new();
    put(metadata, answers, &mut files).unwrap();
    files
}

fn page(metadata: &Metadata, answers: &Answers) -> String {
    let files = files(metadata, answers);
    let page = files
        .iter()
        .find(|file| file.path == "report.html")
        .unwrap();
    String::from_utf8(page.bytes.clone()).unwrap()
}

#[test]
fn a_study_has_its_files_and_they_depend_on_the_data_alone() {
    let (metadata, answers) = study(0.05, 1000);
    let made = files(&metadata, &answers);
    let paths: Vec<&str> = made.iter().map(|file| file.path.as_str()).collect();
    for path in [
        "summary.json",
        "figures/y_histogram.png",
        "figures/y_cumulative.svg",
        "figures/y_sensitivities.png",
        "figures/y_against_b.png",
        "report.html",
        "report.pdf",
    ] {
        assert!(paths.contains(&path), "{path} in {paths:?}");
    }
    assert!(made == files(&metadata, &answers));
    let summary: serde_json::Value = serde_json::from_slice(&made[0].bytes).unwrap();
    assert_eq!(summary["schema"], SCHEMA);
    assert_eq!(summary["answers"]["studied"][0]["decision"], "met");
    assert_eq!(summary["answers"]["requirements"][0]["no_result"], 5);
    assert_eq!(summary["study"]["inputs"][0]["unit"], "m");
}

/// Whatever is decided, a study is headed as a simulation; it says met, not met or undecided, and never pass.
#[test]
fn a_study_is_never_a_pass() {
    for (limit, word) in [(0.05, "MET"), (0.001, "NOT MET"), (0.02, "UNDECIDED")] {
        let (metadata, answers) = study(limit, 1000);
        let page = page(&metadata, &answers);
        assert!(page.contains("STUDY (SIMULATION)"));
        assert!(page.contains(&format!(">{word}</")), "{word}");
        assert!(!page.contains(">PASS") && !page.contains("verdict pass"));
    }
}

/// The box at the top of the first page answers each requirement in words.
#[test]
fn the_box_of_the_first_page_has_the_answer() {
    for (limit, answer, heading) in [
        (0.05, "met.", "requirement met"),
        (0.001, "not met.", "requirement not met"),
        (0.02, "undecided.", "1 of 1 requirements undecided"),
    ] {
        let (metadata, answers) = study(limit, 1000);
        let found = answers.studied[0].probability.as_ref().unwrap();
        let [low, high] = found.interval.map(numbers::short_percent);
        let page = page(&metadata, &answers);
        let sentence = format!(
            "{answer} Probability {} (95 % interval: {low} to {high}), limit &lt; {}.",
            numbers::estimate(found),
            figures::percent(limit)
        );
        assert!(page.contains(&sentence), "{sentence}");
        assert!(page.contains(&format!("STUDY (SIMULATION): {heading}")));
    }
}

/// The first page says how a series was decided, and the worst runs are not all promised to the bit.
#[test]
fn a_study_of_a_series_says_that_a_run_outside_of_it_may_end_earlier() {
    let (metadata, answers) = study(0.05, 1000);
    let of_series = Metadata {
        has_series: true,
        ..metadata.clone()
    };
    let (one, series) = (page(&metadata, &answers), page(&of_series, &answers));
    let note = "the condition of a series of impacts is decided on its value alone";
    let (worst, unless) = (
        "A run is reproduced bit for bit by",
        "A run whose series U does not end earlier is reproduced",
    );
    assert!(!one.contains(note) && one.contains(worst) && !one.contains(unless));
    assert!(series.contains(note) && !series.contains(worst) && series.contains(unless));
}

#[test]
fn an_incomplete_study_is_marked_on_its_first_page() {
    let (metadata, answers) = study(0.05, 500);
    let page = page(&metadata, &answers);
    assert!(page.contains("INCOMPLETE: 500 of up to 1000 runs"));
    assert!(page.contains(">UNDECIDED</"));
}

/// The page of a fragility has its parameters, the stripes and the curve.
#[test]
fn a_fragility_shows_its_curve_or_why_there_is_none() {
    let values = [0.4, 0.6, 0.8, 1.0, 1.2];
    let metadata = fragility_metadata(&values, 100);
    let answers = answers(&metadata, &fragility_rows(&values, 100));
    let made = files(&metadata, &answers);
    let paths: Vec<&str> = made.iter().map(|file| file.path.as_str()).collect();
    assert!(paths.contains(&"figures/tip_fragility.png"), "{paths:?}");
    let shown = page(&metadata, &answers);
    assert!(shown.contains("Median θ") && shown.contains("0.4 m"));
    let few = [0.1, 0.15];
    let metadata = fragility_metadata(&few, 10);
    let none = crate::study::answers::testing::answers(&metadata, &fragility_rows(&few, 10));
    let without = page(&metadata, &none);
    let reason = "No curve fits: no run exceeds the limit";
    assert_eq!(
        without.matches(reason).count(),
        2,
        "on the first page and in the section"
    );
    assert!(!without.contains("dashed") && !without.contains("dispersion comes"));
    assert!(shown.contains("dashed") && !shown.contains("ground motion"));
}

/// Names and labels are data: none of them is markup in the page.
#[test]
fn labels_are_not_markup() {
    let (mut metadata, answers) = study(0.05, 1000);
    metadata.title = "<script>alert(1)</script>".to_owned();
    assert!(!page(&metadata, &answers).contains("<script>"));
}

/// Every key of the summary is described on its page.
#[test]
fn every_key_of_the_summary_is_on_its_page() {
    fn keys(value: &serde_json::Value, into: &mut std::collections::BTreeSet<String>) {
        match value {
            serde_json::Value::Object(fields) => {
                for (key, value) in fields {
                    into.insert(key.clone());
                    keys(value, into);
                }
            }
            serde_json::Value::Array(items) => items.iter().for_each(|item| keys(item, into)),
            _ => {}
        }
    }
    const PAGE: &str = include_str!("../../../docs/reference/study.md");
    let values = [0.4, 0.8, 1.2];
    let fragility = fragility_metadata(&values, 50);
    let studies = [
        study(0.05, 1000),
        (
            fragility.clone(),
            answers(&fragility, &fragility_rows(&values, 50)),
        ),
    ];
    let mut found = std::collections::BTreeSet::new();
    for (metadata, answers) in &studies {
        let summary = summary(metadata, answers);
        keys(&serde_json::from_str(&summary).unwrap(), &mut found);
    }
    assert!(found.len() > 60, "{found:?}");
    let missing: Vec<&String> = found
        .iter()
        .filter(|key| !PAGE.contains(&format!("`{key}`")))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}
