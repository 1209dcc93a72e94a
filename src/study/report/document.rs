//! The report of a study as a document. In: metadata, answers and drawn figures. Out: the document that HTML and PDF print. The first page
//! states what was decided; the rest shows from what.

use crate::report::document::{Block, Column, Document, Style, Table, Text, Tone, Verdict};
use crate::report::number::comparison_sign;
use crate::report::wording::study::in_the_box;
use crate::report::wording::{LABELS, study as wording, verdict};
use crate::study::answers::{Answers, LookAnswer, StudiedAnswer};
use crate::study::data_set::{Metadata, Stopping, StudyKind};
use psd_physics::study::probability::Decision;
use psd_plan::Comparison;
use psd_plan::study::Sampling;

use super::figures::{FigureKind, percent};
use super::numbers::{estimate, percents, probability, range};
use super::source::Source;
use super::{fragility, provenance, results, runs, subset};

/// The whole report.
pub fn document(source: &Source<'_>) -> Document {
    let Source {
        metadata, answers, ..
    } = source;
    let mut body = Vec::new();
    statements(source, &mut body);
    if metadata.has_series {
        body.push(Block::note(wording::SERIES));
    }
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
        StudyKind::Study(Stopping::Fixed) => wording::ENDS_FIXED.to_owned(),
        StudyKind::Study(Stopping::Decided) => wording::ENDS_DECIDED.to_owned(),
        StudyKind::Study(Stopping::HalfWidth(width)) => wording::ends_half_width(percent(*width)),
        StudyKind::Study(Stopping::Rare(rare)) => {
            wording::ends_levels(rare.replicates, rare.points)
        }
        StudyKind::Fragility(stripes) => wording::ends_stripes(stripes.values.len(), stripes.runs),
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
    let count = |decision| {
        let decided = answers.studied.iter();
        decided.filter(|it| it.decision == decision).count()
    };
    let outcome = match (count(Decision::NotMet), count(Decision::Undecided)) {
        (0, 0) if total == 0 => return wording::HEADING.to_owned(),
        (0, 0) if total == 1 => verdict::REQUIREMENT_MET.to_owned(),
        (0, 0) => verdict::requirements_met(total),
        (0, undecided) => wording::undecided(undecided, total),
        (1, _) if total == 1 => verdict::REQUIREMENT_NOT_MET.to_owned(),
        (not_met, _) => verdict::requirements_not_met(not_met, total),
    };
    wording::outcome(wording::HEADING, outcome)
}

fn statement(metadata: &Metadata, answers: &Answers) -> Text {
    let mut text = Text::new();
    if !answers.complete {
        let words = wording::incomplete(answers.runs, answers.at_most);
        text = text.with(Style::Strong, words).and(" ");
    }
    if let Some(curve) = fragility::statement(metadata, answers) {
        text = text.and(curve).line();
    } else if answers.studied.is_empty() {
        text = text.and(wording::NO_STUDIED).line();
    }
    for (answer, comparison) in answered_first(metadata, answers).take(IN_THE_BOX) {
        text = text
            .with(Style::Strong, in_the_box::name(&answer.label))
            .and(answer_in_words(answer, comparison, answers.confidence))
            .line();
    }
    if answers.studied.len() > IN_THE_BOX {
        text = text
            .and(in_the_box::more(answers.studied.len() - IN_THE_BOX))
            .line();
    }
    text.and(wording::SIMULATED)
}

/// Requirements whose answers are in the box of the first page; the table below it has all.
const IN_THE_BOX: usize = 4;

/// The requirements with the ones that are not met first, then the undecided ones.
fn answered_first<'a>(
    metadata: &'a Metadata,
    answers: &'a Answers,
) -> impl Iterator<Item = (&'a StudiedAnswer, Comparison)> {
    let order = [Decision::NotMet, Decision::Undecided, Decision::Met];
    order.into_iter().flat_map(|decision| {
        let all = answers.studied.iter().zip(&metadata.studied);
        all.filter(move |(answer, _)| answer.decision == decision)
            .map(|(answer, studied)| (answer, studied.comparison))
    })
}

/// `met. Probability 0.98 % (95 % interval: 0.43 % to 1.87 %), limit < 2 %.`
fn answer_in_words(answer: &StudiedAnswer, comparison: Comparison, confidence: f64) -> String {
    let decision = match answer.decision {
        Decision::Met => in_the_box::MET,
        Decision::NotMet => in_the_box::NOT_MET,
        Decision::Undecided => in_the_box::UNDECIDED,
    };
    let limit = limit_of(answer, comparison);
    let Some(found) = &answer.probability else {
        return in_the_box::without_probability(decision, limit);
    };
    in_the_box::answer(
        decision,
        estimate(found),
        percent(confidence),
        percents(found.interval),
        limit,
    )
}

/// `< 2 %`
fn limit_of(answer: &StudiedAnswer, comparison: Comparison) -> String {
    format!("{} {}", comparison_sign(comparison), percent(answer.limit))
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
                .map(|(answer, studied)| statement_row(answers, answer, studied.comparison))
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

fn statement_row(answers: &Answers, answer: &StudiedAnswer, comparison: Comparison) -> Vec<Text> {
    let (style, word) = match answer.decision {
        Decision::Met => (Style::Strong, wording::MET),
        Decision::NotMet => (Style::Fail, wording::NOT_MET),
        Decision::Undecided => (Style::Inconclusive, wording::UNDECIDED),
    };
    let decided = |look: &&LookAnswer| Some(look.number) == answer.look;
    let look = answers.looks.iter().find(decided);
    let look = look.map_or_else(String::new, |look| wording::after_runs(look.runs));
    vec![
        Text::from(answer.label.as_str()).line().code(&answer.text),
        probability(answer.probability.as_ref()),
        range(answer.probability.as_ref()),
        limit_of(answer, comparison).into(),
        Text::new().with(style, word).soft(look),
    ]
}
