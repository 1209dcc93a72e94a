//! The report of a study as a document. In: metadata, answers and drawn figures. Out: the document that HTML and PDF print. The first page
//! states what was decided; the rest shows from what.

use crate::physics::study::probability::Decision;
use crate::plan::Comparison;
use crate::plan::study::Sampling;
use crate::report::document::{Block, Column, Document, Style, Table, Text, Tone, Verdict};
use crate::report::number::comparison_sign;
use crate::report::wording::{LABELS, study as wording, verdict};
use crate::study::answers::{Answers, StudiedAnswer};
use crate::study::data_set::{Kind, Metadata, Stopping};

use super::figures::{FigureKind, percent};
use super::numbers::{probability, range};
use super::source::Source;
use super::{fragility, provenance, results, runs, subset};

/// The whole report.
pub fn document(source: &Source<'_>) -> Document {
    let Source {
        metadata, answers, ..
    } = source;
    let mut body = Vec::new();
    statements(source, &mut body);
    runs::requirements(source, &mut body);
    first_figure(source, &mut body);
    subset::section(source, &mut body);
    body.push(Block::NewPage);
    fragility::section(source, &mut body);
    results::section(source, &mut body);
    results::sensitivities(source, &mut body);
    runs::worst(source, &mut body);
    runs::reasons(source, &mut body);
    provenance::looks(source, &mut body);
    provenance::inputs(source, &mut body);
    provenance::section(source, &mut body);
    Document {
        kind: wording::KIND,
        replaces: None,
        title: metadata.title.as_str().into(),
        logo: None,
        id: source.id.to_owned(),
        date: None,
        dated: None,
        front: front(metadata, answers),
        missing_fields: Vec::new(),
        verdict: Verdict {
            tone: tone(answers),
            heading: heading(answers),
            text: statement(metadata, answers),
        },
        notices: Vec::new(),
        watermarks: vec![wording::WATERMARK],
        body,
        end: Text::from(wording::END).id(source.id).and(" —"),
        labels: LABELS,
        attachments: Vec::new(),
    }
}

fn front(metadata: &Metadata, answers: &Answers) -> Vec<(Text, Text)> {
    let ends = match &metadata.kind {
        Kind::Study(Stopping::Fixed) => wording::ENDS_FIXED.to_owned(),
        Kind::Study(Stopping::Decided) => wording::ENDS_DECIDED.to_owned(),
        Kind::Study(Stopping::HalfWidth(width)) => wording::ends_half_width(percent(*width)),
        Kind::Study(Stopping::Rare(rare)) => wording::ends_levels(rare.replicates, rare.points),
        Kind::Fragility(stripes) => wording::ends_stripes(stripes.values.len(), stripes.runs),
    };
    let sampling = match metadata.sampling {
        Sampling::Random => wording::RANDOM.to_owned(),
        Sampling::LatinHypercube => wording::LATIN_HYPERCUBE.to_owned(),
        Sampling::Sobol => wording::sobol(metadata.replicates),
        Sampling::Subset => wording::SUBSET.to_owned(),
    };
    let rows = [
        (wording::PLAN, metadata.plan.clone()),
        (wording::STUDY, metadata.study.clone()),
        (
            wording::RUNS,
            wording::runs_of(answers.runs, answers.at_most),
        ),
        (wording::ENDS, ends),
        (wording::SAMPLING, sampling),
        (wording::SEED, metadata.seed.to_string()),
        (wording::CONFIDENCE, percent(metadata.confidence)),
    ];
    rows.map(|(name, value)| (name.into(), value.into())).into()
}

/// Only the colour of a missed requirement is that of a failure: a study is a simulation and never green.
fn tone(answers: &Answers) -> Tone {
    let has = |decision| answers.studied.iter().any(|it| it.decision == decision);
    if has(Decision::NotMet) {
        Tone::Fail
    } else if has(Decision::Undecided) || !answers.complete {
        Tone::Inconclusive
    } else {
        Tone::Neutral
    }
}

/// The worst decision is part of the heading.
fn heading(answers: &Answers) -> String {
    let total = answers.studied.len();
    let count = |decision| named(answers, decision).len();
    let outcome = match (count(Decision::NotMet), count(Decision::Undecided)) {
        (0, 0) => return wording::HEADING.to_owned(),
        (0, undecided) => wording::undecided(undecided, total),
        (1, _) if total == 1 => verdict::REQUIREMENT_NOT_MET.to_owned(),
        (not_met, _) => verdict::requirements_not_met(not_met, total),
    };
    wording::outcome(wording::HEADING, outcome)
}

/// The labels of the requirements with this decision.
fn named(answers: &Answers, decision: Decision) -> Vec<&str> {
    let decided = answers.studied.iter().filter(|it| it.decision == decision);
    decided.map(|it| it.label.as_str()).collect()
}

fn statement(metadata: &Metadata, answers: &Answers) -> Text {
    let mut text = Text::new();
    if !answers.complete {
        let words = wording::incomplete(answers.runs, answers.at_most);
        text = text.with(Style::Strong, words).and(" ");
    }
    let decided = if let Some(curve) = fragility::statement(metadata, answers) {
        curve + " "
    } else if answers.studied.is_empty() {
        wording::NO_STUDIED.to_owned() + " "
    } else {
        let sentence = |decision, words: fn(String) -> String| {
            let names = named(answers, decision).join("; ");
            if names.is_empty() {
                names
            } else {
                words(names)
            }
        };
        sentence(Decision::NotMet, wording::names_not_met)
            + &sentence(Decision::Undecided, wording::names_undecided)
    };
    text.and(decided).and(wording::SIMULATED)
}

/// The statements of the first page.
fn statements(source: &Source<'_>, body: &mut Vec<Block>) {
    let answers = source.answers;
    if !answers.studied.is_empty() {
        body.push(Block::section(wording::STATEMENTS));
        let [requirement, chance, interval, limit, statement] = wording::STATEMENT_COLUMNS;
        body.push(Block::Table(Table {
            columns: vec![
                Column::words(requirement, 1),
                Column::numbers(chance),
                Column::numbers(interval),
                Column::numbers(limit),
                Column::short(statement),
            ],
            rows: answers
                .studied
                .iter()
                .zip(&source.metadata.studied)
                .map(|(answer, studied)| statement_row(answer, studied.comparison))
                .collect(),
        }));
        let confidence = percent(answers.confidence);
        if source.metadata.sampling == Sampling::Subset {
            body.push(Block::note(wording::level_intervals(confidence)));
            return;
        }
        body.push(Block::note(wording::intervals(confidence)));
        if !answers.looks.is_empty() {
            body.push(Block::note(wording::BY_LOOKS));
        }
        let probabilities = answers
            .studied
            .iter()
            .filter_map(|it| it.probability.as_ref());
        if probabilities
            .clone()
            .any(|probability| !probability.is_exact)
        {
            body.push(Block::note(wording::NOT_EXACT));
        }
    }
}

/// The curve of a fragility, or the first histogram.
fn first_figure(source: &Source<'_>, body: &mut Vec<Block>) {
    let first = source.figures.first().map(|figure| figure.kind);
    let shown = match first {
        Some(FigureKind::Fragility) => FigureKind::Fragility,
        _ => FigureKind::Histogram,
    };
    body.extend(source.figures_of(|figure| figure.kind == shown).take(1));
}

fn statement_row(answer: &StudiedAnswer, comparison: Comparison) -> Vec<Text> {
    let (style, word) = match answer.decision {
        Decision::Met => (Style::Strong, wording::MET),
        Decision::NotMet => (Style::Fail, wording::NOT_MET),
        Decision::Undecided => (Style::Inconclusive, wording::UNDECIDED),
    };
    let look = answer.look.map(wording::at_look).unwrap_or_default();
    vec![
        Text::from(answer.label.as_str()).line().code(&answer.text),
        probability(answer.probability.as_ref()),
        range(answer.probability.as_ref()),
        format!("{} {}", comparison_sign(comparison), percent(answer.limit)).into(),
        Text::new().with(style, word).soft(look),
    ]
}
