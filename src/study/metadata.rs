//! The metadata of a study: what its data set says about itself. In: the build, the plan and the study. Out: the metadata of its first run.

use super::data_set::{Column, Event, Metadata, Setting, StudiedRequirement, StudyKind};
use super::definition::Definition;
use super::simulation::readout::Readout;
use psd_physics::study::inputs::Source;
use psd_plan::study::{Input, REPLICATES, Sampling, StudyEvent, Variation};
use psd_plan::{Plan, StudyRequirement};
use psd_text::digest::sha256;

/// The metadata of a study of `plan`, without runs. `version` names the build of psd that simulates them: runs of two builds are not mixed.
#[must_use]
pub fn study_metadata(
    version: &str,
    plan: &Plan,
    study: &Definition,
    readout: &Readout,
) -> Metadata {
    let variation = match study.kind {
        StudyKind::Study(_) => Some(&plan.studies.studies[study.index].variation),
        StudyKind::Fragility(_) => plan.studies.fragilities[study.index].variation.as_ref(),
    };
    let setting = |(name, text): &(String, String)| Setting {
        name: name.clone(),
        text: text.clone(),
    };
    Metadata {
        version: version.to_owned(),
        title: plan.title.clone(),
        plan: plan
            .files
            .first()
            .map_or_else(String::new, |file| file.name.clone()),
        digest: digest(plan),
        settings: plan.settings.iter().map(setting).collect(),
        study: study.name.clone(),
        kind: study.kind.clone(),
        seed: study.seed,
        sampling: study.sampling,
        replicates: match study.sampling {
            Sampling::Sobol => REPLICATES,
            Sampling::Random | Sampling::LatinHypercube | Sampling::Subset => 1,
        },
        correlations: variation.map_or_else(Vec::new, correlations),
        is_correlated: variation.is_some_and(is_correlated),
        has_series: plan.procedures.iter().any(|it| it.kind.is_series()),
        confidence: 1.0 - study.confidence.error(),
        at_most: study.runs.at_most(),
        first: 0,
        end: 0,
        inputs: study.inputs.iter().map(column).collect(),
        results: readout.columns(),
        requirements: readout.decisions(plan),
        studied: match study.kind {
            StudyKind::Study(_) => studied(&plan.studies.requirements, study.index),
            StudyKind::Fragility(_) => Vec::new(),
        },
    }
}

/// SHA-256 of all files and settings of a plan, and of the name of its rig.
fn digest(plan: &Plan) -> String {
    let mut text = String::new();
    let mut add = |part: &str| {
        // With its length, so that no two lists of parts give one text.
        text.push_str(&part.len().to_string());
        text.push(':');
        text.push_str(part);
    };
    for file in &plan.files {
        add(&file.name);
        add(&file.text);
    }
    add("settings");
    for (name, value) in &plan.settings {
        add(name);
        add(value);
    }
    add(&plan.rig.name);
    sha256(text.as_bytes())
}

pub(super) fn column(input: &Input) -> Column {
    Column {
        nominal: Some(input.nominal),
        ..Column::new(&input.name, input.dimension, &input.text)
    }
}

fn studied(requirements: &[StudyRequirement], study: usize) -> Vec<StudiedRequirement> {
    let own = requirements.iter().filter(|it| it.study == study);
    own.map(|it| {
        let (event, requirement) = match it.event {
            StudyEvent::Fails { requirement } => (Event::Fails, requirement),
            StudyEvent::Holds { requirement } => (Event::Holds, requirement),
        };
        StudiedRequirement {
            label: it.label.clone(),
            text: it.text.clone(),
            requirement,
            event,
            comparison: it.comparison,
            limit: it.limit,
        }
    })
    .collect()
}

/// Rank correlations as the plan writes them.
fn correlations(variation: &Variation) -> Vec<String> {
    let mut first = 0;
    let names: Vec<&str> = variation
        .sources
        .iter()
        .map(|source| {
            let name = variation.inputs.get(first);
            first += width(source);
            name.map_or("", |input| input.name.as_str())
        })
        .collect();
    let pairs = variation.correlations.iter();
    pairs
        .map(|pair| {
            let [first, second] = pair.inputs.map(|at| names[at]);
            format!("rank({first}, {second}, {})", pair.correlation)
        })
        .collect()
}

fn is_correlated(variation: &Variation) -> bool {
    !variation.correlations.is_empty() || variation.sources.iter().any(|source| width(source) > 1)
}

/// Number of inputs that a source gives.
fn width(source: &Source) -> usize {
    match source {
        Source::Distribution(_) => 1,
        Source::Rows(rows) => rows.first().map_or(0, Vec::len),
    }
}
