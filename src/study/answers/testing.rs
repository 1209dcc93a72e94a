//! Studies in closed form for tests: their inputs, metadata and rows.

use tempfile::TempDir;

use super::Answers;
use crate::study::data_set::testing::{metadata as any_metadata, written};
use crate::study::data_set::{
    Column, Decision, Limit, Metadata, Outcome, Reader, Stripes, StudyKind, StudyRow,
};
use psd_physics::study::distribution::{Distribution, Spread};
use psd_physics::study::inputs::{Source, StudyInputs};
use psd_physics::study::sampling::Design;
use psd_text::units::Dimension;

/// y = a + 2b with a, b ~ N(1, 0.1): mean 3, standard deviation 0.1√5, first-order indices 0.2 and 0.8.
pub fn normals(design: Design, seed: u64) -> StudyInputs {
    let law = || Source::Distribution(Distribution::normal(1.0, Spread::Sd(0.1)).unwrap());
    StudyInputs::new(vec![law(), law()], &[], design, seed).unwrap()
}

/// The standard deviation of y.
pub fn scatter() -> f64 {
    0.1 * 5_f64.sqrt()
}

/// The requirement y < 3 + 2 standard deviations fails with Φ(−2) = 2.275 %.
pub fn metadata(runs: u64) -> Metadata {
    Metadata {
        at_most: runs,
        inputs: ["a", "b"]
            .map(|name| Column::new(name, Dimension::LENGTH, "normal(sd: 0.1 m)"))
            .to_vec(),
        results: vec![Column::new("y", Dimension::LENGTH, "a + 2b")],
        requirements: vec![Decision {
            label: "small".to_owned(),
            text: "y < limit".to_owned(),
            limit: Some(Limit {
                result: 0,
                value: 3.0 + 2.0 * scatter(),
            }),
        }],
        studied: Vec::new(),
        ..any_metadata(0)
    }
}

/// The runs of y; every run of `lost` has no result.
pub fn rows(inputs: &StudyInputs, runs: u64, lost: impl Fn(u64) -> bool) -> Vec<StudyRow> {
    let limit = 3.0 + 2.0 * scatter();
    let mut values = Vec::new();
    (0..runs)
        .map(|run| {
            inputs.draw(run, &mut values);
            let y = Some(values[0] + 2.0 * values[1]).filter(|_| !lost(run));
            let outcome = match y {
                Some(y) if y < limit => Outcome::Met,
                Some(_) => Outcome::NotMet,
                None => Outcome::NoResult,
            };
            StudyRow {
                run,
                inputs: values.clone(),
                results: vec![y],
                outcomes: vec![outcome],
                reason: y.is_none().then(|| "stopped".to_owned()),
            }
        })
        .collect()
}

pub fn answers(metadata: &Metadata, rows: &[StudyRow]) -> Answers {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("runs.parquet");
    written(&path, metadata, rows);
    Answers::of(&Reader::open(&path).unwrap()).unwrap()
}

/// Median and dispersion of the capacities of [`fragility_rows`].
pub const CAPACITY: [f64; 2] = [0.8, 0.4];

/// A fragility with these intensities: a run exceeds above its lognormal capacity.
pub fn fragility_metadata(values: &[f64], runs: u64) -> Metadata {
    let length = |name, text| Column::new(name, Dimension::LENGTH, text);
    Metadata {
        study: "tip".to_owned(),
        kind: StudyKind::Fragility(Stripes {
            intensity: 0,
            values: values.to_vec(),
            runs,
            record: None,
        }),
        inputs: vec![
            length("drop_height", ""),
            Column::new("strength", Dimension::NUMBER, "normal(sd: 1)"),
        ],
        results: vec![length("hit.max_displacement", "largest displacement")],
        requirements: vec![Decision {
            label: "exceeds".to_owned(),
            text: "hit.max_displacement > 50 mm".to_owned(),
            limit: Some(Limit {
                result: 0,
                value: 0.05,
            }),
        }],
        ..metadata(values.len() as u64 * runs)
    }
}

/// The rows of it; at the capacity, the displacement is 50 mm.
pub fn fragility_rows(values: &[f64], runs: u64) -> Vec<StudyRow> {
    let law = Distribution::normal(0.0, Spread::Sd(1.0)).unwrap();
    let inputs = StudyInputs::new(vec![Source::Distribution(law)], &[], Design::Random, 8).unwrap();
    let mut drawn = Vec::new();
    (0..values.len() as u64 * runs)
        .map(|run| {
            inputs.draw(run, &mut drawn);
            let intensity = values[usize::try_from(run).unwrap() % values.len()];
            let [median, dispersion] = CAPACITY;
            let used = intensity / (median * (dispersion * drawn[0]).exp());
            let outcome = if used > 1.0 {
                Outcome::Met
            } else {
                Outcome::NotMet
            };
            StudyRow {
                run,
                inputs: vec![intensity, drawn[0]],
                results: vec![Some(0.05 * used)],
                outcomes: vec![outcome],
                reason: None,
            }
        })
        .collect()
}
