//! The guarantee of the stopping rule, on the counts and looks of a study itself.

use super::*;
use crate::study::data_set::Outcome;
use crate::study::data_set::testing::metadata as any_metadata;
use psd_physics::study::Confidence;
use psd_physics::study::sampling::philox::{Philox, Purpose};

/// A study whose only requirement fails with a probability below `limit`.
fn metadata(limit: f64) -> Metadata {
    let mut metadata = any_metadata(0);
    metadata.requirements.truncate(1);
    metadata.studied = vec![StudiedRequirement {
        label: "rarely".to_owned(),
        text: "scatter.probability fails".to_owned(),
        requirement: 0,
        event: Event::Fails,
        comparison: Comparison::Less,
        limit,
    }];
    metadata
}

fn decided(at_most: u64) -> Runs {
    Runs::Decided {
        confidence: Confidence::new(0.95).unwrap(),
        at_most,
    }
}

/// The end of a study.
struct End {
    runs: u64,
    interval: Interval,
    decision: Decision,
}

/// Runs that fail with this probability, until the study is over.
fn study(runs: Runs, metadata: &Metadata, seed: u64, probability: f64) -> End {
    let stream = Philox::new(seed);
    let mut looks = Looks::of(runs, metadata);
    let mut row = StudyRow {
        run: 0,
        inputs: Vec::new(),
        results: Vec::new(),
        outcomes: vec![Outcome::Met],
        reason: None,
    };
    let mut last = None;
    while !looks.are_over() {
        let fails = stream.uniform(Purpose::Value, row.run, 0) < probability;
        row.outcomes[0] = if fails { Outcome::NotMet } else { Outcome::Met };
        let planned = looks.planned();
        looks.add(&row);
        row.run += 1;
        last = planned.filter(|look| look.runs == row.run);
    }
    let interval = looks
        .counts
        .of(0, Event::Fails)
        .interval(last.expect("a study ends at a look").confidence);
    End {
        runs: row.run,
        interval,
        decision: decide(&metadata.studied[0], interval),
    }
}

/// At the limit itself, any decision is wrong: of 1000 studies of up to 8192 runs at most 5 % decide. The intervals at the chosen end
/// contain the truth in at least 95 %.
#[test]
fn a_study_at_its_limit_decides_wrongly_at_most_with_alpha() {
    let metadata = metadata(0.02);
    let (mut wrong, mut covered) = (0, 0);
    for seed in 0..1000 {
        let end = study(decided(8192), &metadata, seed, 0.02);
        wrong += u32::from(end.decision != Decision::Undecided);
        covered += u32::from(end.interval.contains(0.02));
    }
    assert!(wrong <= 50, "{wrong} of 1000");
    assert!(covered >= 950, "{covered} of 1000");
}

/// Far from the limit, studies decide rightly and early.
#[test]
fn a_study_far_from_its_limit_decides_soon() {
    let metadata = metadata(0.05);
    for seed in 0..50 {
        let low = study(decided(1 << 20), &metadata, seed, 0.005);
        assert_eq!(low.decision, Decision::Met);
        let high = study(decided(1 << 20), &metadata, seed, 0.2);
        assert_eq!(high.decision, Decision::NotMet);
        assert!(low.runs <= 1024 && high.runs <= 512);
    }
}

#[test]
fn a_half_width_is_reached_or_the_study_ends_with_its_last_run() {
    let until = |half_width, at_most| Runs::HalfWidth {
        half_width,
        confidence: Confidence::new(0.95).unwrap(),
        at_most,
    };
    let metadata = metadata(0.02);
    let wide = study(until(0.02, 100_000), &metadata, 1, 0.1);
    assert!(wide.interval.half_width() <= 0.02 && wide.runs < 100_000);
    let narrow = study(until(1e-6, 1000), &metadata, 1, 0.1);
    assert!(narrow.runs == 1000 && narrow.interval.half_width() > 1e-6);
}

#[test]
fn a_limit_inside_the_interval_is_undecided() {
    let interval = Interval {
        low: 0.01,
        high: 0.03,
    };
    let of = |comparison, limit| {
        let mut studied = metadata(limit).studied.remove(0);
        studied.comparison = comparison;
        decide(&studied, interval)
    };
    let below = |limit| of(Comparison::Less, limit);
    assert_eq!(
        [0.04, 0.03, 0.02, 0.01].map(below),
        [
            Decision::Met,
            Decision::Undecided,
            Decision::Undecided,
            Decision::NotMet
        ]
    );
    assert_eq!(of(Comparison::LessEqual, 0.03), Decision::Met);
    let above = |limit| of(Comparison::GreaterEqual, limit);
    assert_eq!(
        [0.04, 0.03, 0.02, 0.01].map(above),
        [
            Decision::NotMet,
            Decision::Undecided,
            Decision::Undecided,
            Decision::Met
        ]
    );
}
