//! A small data set for tests: metadata of one study, and rows that depend on their number alone.

use std::path::Path;

use super::{
    Column, Decision, Event, Limit, Metadata, Outcome, Stopping, StudiedRequirement, StudyKind,
    StudyRow, Writer,
};
use psd_plan::Comparison;
use psd_plan::study::Sampling;
use psd_text::units::Dimension;

/// Two inputs, two results, two requirements; runs from `first` on.
pub fn metadata(first: u64) -> Metadata {
    let input = |name, dimension, text| Column {
        nominal: Some(1.0),
        ..Column::new(name, dimension, text)
    };
    Metadata {
        version: "0.1.0 (test)".to_owned(),
        title: "Beam".to_owned(),
        plan: "beam.psd".to_owned(),
        digest: "00".repeat(32),
        settings: Vec::new(),
        study: "scatter".to_owned(),
        kind: StudyKind::Study(Stopping::Fixed),
        seed: u64::MAX,
        sampling: Sampling::Random,
        replicates: 1,
        correlations: Vec::new(),
        is_correlated: false,
        has_series: false,
        confidence: 0.95,
        at_most: 1_000_000,
        first,
        end: first,
        inputs: vec![
            input("speed", Dimension::VELOCITY, "normal(sd: 0.05 m/s)"),
            input("k", Dimension::HERTZ_STIFFNESS, "lognormal(cv: 2 %)"),
        ],
        results: vec![
            Column::new(
                "hit.max_displacement",
                Dimension::LENGTH,
                "largest displacement",
            ),
            Column::new(
                "hit.stop_time",
                Dimension::TIME,
                "time at which the striker stops",
            ),
        ],
        requirements: vec![
            Decision {
                label: "stays in travel".to_owned(),
                text: "hit.max_displacement < 0.2 m".to_owned(),
                limit: Some(Limit {
                    result: 0,
                    value: 0.2,
                }),
            },
            Decision {
                label: "stops".to_owned(),
                text: "hit.stop_time < 1 s".to_owned(),
                limit: None,
            },
        ],
        studied: vec![StudiedRequirement {
            label: "rarely too far".to_owned(),
            text: "scatter.probability(fails: \"stays in travel\") < 2 %".to_owned(),
            requirement: 0,
            event: Event::Fails,
            comparison: Comparison::Less,
            limit: 0.02,
        }],
    }
}

/// Numbers with all bits in use, both zeros, the smallest and the largest number, results that do not exist.
pub fn row(run: u64) -> StudyRow {
    let [first, second] = [0x9e37_79b9_7f4a_7c15, 0xd1b5_4a32_d192_ed03_u64].map(|factor: u64| {
        let number = f64::from_bits((run + 1).wrapping_mul(factor));
        if number.is_finite() { number } else { f64::MAX }
    });
    let special = match run % 7 {
        0 => 0.0,
        1 => -0.0,
        2 => f64::from_bits(1),
        3 => f64::MAX,
        _ => second,
    };
    let is_lost = run % 10 == 3;
    let outcome = |holds: bool| if holds { Outcome::Met } else { Outcome::NotMet };
    StudyRow {
        run,
        inputs: vec![first, special],
        results: vec![Some(special), (!is_lost).then_some(second)],
        outcomes: vec![
            outcome(special < 0.2),
            if is_lost {
                Outcome::NoResult
            } else {
                outcome(second < 1.0)
            },
        ],
        reason: is_lost.then(|| format!("run {run}: „stopped“ at 0.1 m")),
    }
}

/// Writes the rows.
pub fn written(path: &Path, metadata: &Metadata, rows: &[StudyRow]) {
    let mut writer = Writer::create(path, metadata).unwrap();
    for row in rows {
        writer.push(row).unwrap();
    }
    writer.finish().unwrap();
}
