//! Tests of answers: known probabilities, quantiles, sensitivities and curves come back from data sets of models in closed form.

use tempfile::TempDir;

use super::moments::number;
use super::testing::{
    CAPACITY, answers, fragility_metadata, fragility_rows, metadata, normals, rows, scatter,
};
use super::*;
use crate::study::data_set::testing::written;
use crate::study::data_set::{Column, Event, Outcome, Stopping, Stripes, StudiedRequirement};
use crate::study::metadata::column;
use psd_physics::study::distribution::normal;
use psd_physics::study::probability::Decision;
use psd_physics::study::sampling::Design;
use psd_plan::Comparison;
use psd_plan::study::Input;
use psd_text::units::Dimension;

fn contains(interval: [f64; 2], value: f64) -> bool {
    interval[0] <= value && value <= interval[1]
}

/// Of 60 studies of 400 runs, 95 % or more contain the probability; below 51 would happen once in 10,000 times.
#[test]
fn a_known_failure_probability_is_in_its_interval() {
    let truth = normal::below(-2.0);
    let covered = (0..60)
        .filter(|seed| {
            let rows = rows(&normals(Design::Random, *seed), 400, |_| false);
            let answers = answers(&metadata(400), &rows);
            let [requirement] = &answers.requirements[..] else {
                panic!("one requirement")
            };
            let failed = rows.iter().filter(|row| row.outcomes[0] == Outcome::NotMet);
            let failed = failed.count() as u64;
            assert_eq!(
                [requirement.not_met, requirement.met],
                [failed, 400 - failed]
            );
            let probability = requirement.probability.clone().unwrap();
            assert!(probability.is_exact);
            assert_eq!(probability.bounds, [number(failed) / 400.0; 2]);
            contains(probability.interval, truth)
        })
        .count();
    assert!(covered >= 51, "{covered} of 60");
}

#[test]
fn a_study_without_failures_has_an_upper_bound() {
    let mut none = rows(&normals(Design::Random, 1), 300, |_| false);
    for row in &mut none {
        row.outcomes[0] = Outcome::Met;
    }
    let answers = answers(&metadata(300), &none);
    let probability = answers.requirements[0].probability.clone().unwrap();
    // Clopper and Pearson without failures: 1 − (α/2)^(1/n).
    let bound = 1.0 - 0.025_f64.powf(1.0 / 300.0);
    assert_eq!(probability.interval[0], 0.0);
    assert!((probability.interval[1] - bound).abs() < 1e-9);
}

/// Runs without a result are neither met nor missed: the probability has two bounds.
#[test]
fn lost_runs_are_counted_and_widen_every_answer() {
    let lost = rows(&normals(Design::Random, 3), 1000, |run| run % 20 == 7);
    let answers = answers(&metadata(1000), &lost);
    let [requirement] = &answers.requirements[..] else {
        panic!("one requirement")
    };
    let failed = number(requirement.not_met) / 1000.0;
    assert_eq!(requirement.no_result, 50);
    let probability = requirement.probability.clone().unwrap();
    assert!((probability.bounds[0] - failed).abs() < 1e-15);
    assert!((probability.bounds[1] - failed - 0.05).abs() < 1e-12);
    assert!(probability.interval[1] > 0.05 + failed);
    let [result] = &answers.results[..] else {
        panic!("one result")
    };
    assert_eq!([result.runs, result.no_result], [950, 50]);
    // The largest 5 % may be the lost ones: the upper quantile has no bound.
    assert_eq!(result.quantiles[2].interval[1], None);
    let [reason] = &answers.reasons[..] else {
        panic!("one reason")
    };
    assert_eq!((reason.runs, reason.first_run), (50, 7));
    assert!((result.cumulative.last().unwrap()[1] - 0.95).abs() < 1e-12);
}

#[test]
fn mean_quantiles_and_sensitivities_are_those_of_the_closed_form() {
    let answers = answers(
        &metadata(4000),
        &rows(&normals(Design::Random, 5), 4000, |_| false),
    );
    let [result] = &answers.results[..] else {
        panic!("one result")
    };
    assert!(contains(result.mean_interval.unwrap(), 3.0));
    assert!((result.standard_deviation.unwrap() / scatter() - 1.0).abs() < 0.05);
    for quantile in &result.quantiles {
        let truth = 3.0 + scatter() * normal::quantile(quantile.probability);
        let [low, high] = quantile.interval.map(Option::unwrap);
        assert!(contains([low, high], truth), "{quantile:?}");
        assert!(contains([low, high], quantile.estimates[0].unwrap()));
    }
    for (sensitivity, truth) in result.sensitivities.iter().zip([0.2, 0.8]) {
        let first = sensitivity.first_order.unwrap();
        assert!(contains(first.interval, truth), "{sensitivity:?}");
        assert!(!first.may_be_zero && sensitivity.rank_correlation.unwrap().value > 0.3);
    }
    let histogram = result.histogram.clone().unwrap();
    assert_eq!(histogram.counts.iter().sum::<u64>(), 4000);
    let last = result.cumulative.last().unwrap();
    assert_eq!(*last, [result.largest.unwrap(), 1.0]);
}

/// With correlated inputs, variance cannot be split among them: the rank correlation is left.
#[test]
fn correlated_inputs_have_no_first_order_index() {
    let correlated = Metadata {
        is_correlated: true,
        ..metadata(200)
    };
    let answers = answers(
        &correlated,
        &rows(&normals(Design::Random, 5), 200, |_| false),
    );
    for sensitivity in &answers.results[0].sensitivities {
        assert!(sensitivity.first_order.is_none() && sensitivity.rank_correlation.is_some());
    }
}

/// The interval of a Sobol' study is that of its replicates, and far narrower; a Latin hypercube has none.
#[test]
fn intervals_follow_the_sampling() {
    let of = |design, sampling, replicates| {
        let metadata = Metadata {
            sampling,
            replicates,
            ..metadata(2048)
        };
        answers(&metadata, &rows(&normals(design, 9), 2048, |_| false))
    };
    let width = |interval: [f64; 2]| interval[1] - interval[0];
    let random = of(Design::Random, Sampling::Random, 1);
    let sobol = of(Design::Sobol { replicates: 16 }, Sampling::Sobol, 16);
    let [random, sobol_result] = [&random.results[0], &sobol.results[0]];
    let [narrow, wide] = [sobol_result, random].map(|result| result.mean_interval.unwrap());
    assert!(contains(narrow, 3.0) && 4.0 * width(narrow) < width(wide));
    let median = &sobol_result.quantiles[1];
    let [low, high] = median.interval.map(Option::unwrap);
    assert!(contains([low, high], median.estimates[0].unwrap()));
    assert!(!sobol.requirements[0].probability.clone().unwrap().is_exact);
    let latin = of(
        Design::LatinHypercube { runs: 2048 },
        Sampling::LatinHypercube,
        1,
    );
    assert_eq!(latin.results[0].mean_interval, None);
    assert_eq!(latin.results[0].quantiles[0].interval, [None; 2]);
}

/// The worst run is the farthest beyond the limit; its settings are the shortest digits that give its inputs again.
#[test]
fn the_worst_runs_are_those_beyond_the_limit() {
    let rows = rows(&normals(Design::Random, 2), 300, |run| run == 11);
    let answers = answers(&metadata(300), &rows);
    let worst = &answers.requirements[0].worst;
    assert_eq!(worst.len(), 10);
    let largest = rows
        .iter()
        .max_by(|a, b| {
            a.results[0]
                .unwrap_or(0.0)
                .total_cmp(&b.results[0].unwrap_or(0.0))
        })
        .unwrap();
    assert_eq!(
        (worst[0].run, worst[0].value),
        (largest.run, largest.results[0])
    );
    let is_sorted = worst.windows(2).all(|pair| pair[0].value >= pair[1].value);
    assert!(is_sorted && worst[0].outcome == "not_met" && worst[9].outcome == "met");
    for (setting, input) in worst[0].settings.iter().zip(&largest.inputs) {
        let digits = setting.split(['"', ' ']).nth(1).unwrap();
        assert_eq!(digits.parse::<f64>().unwrap().to_bits(), input.to_bits());
    }
    assert_eq!(
        setting(&Column::new("n", Dimension::NUMBER, ""), -1e-9),
        "n=-0.000000001"
    );
    let angle = Input {
        name: "hammer.angle".to_owned(),
        dimension: Dimension::ANGLE,
        text: String::new(),
        nominal: 1.0,
        is_record: false,
    };
    assert_eq!(setting(&column(&angle), 1.04), "hammer.angle=\"1.04 rad\"");
}

fn studied(comparison: Comparison, limit: f64, event: Event) -> StudiedRequirement {
    StudiedRequirement {
        label: "rarely".to_owned(),
        text: "scatter.probability(fails: \"small\") < 5 %".to_owned(),
        requirement: 0,
        event,
        comparison,
        limit,
    }
}

#[test]
fn a_fixed_study_decides_by_its_interval_and_only_when_complete() {
    let all = rows(&normals(Design::Random, 4), 2000, |_| false);
    let decisions = |planned: u64, comparison, limit, event| {
        let metadata = Metadata {
            studied: vec![studied(comparison, limit, event)],
            ..metadata(planned)
        };
        let answers = answers(&metadata, &all);
        (answers.studied[0].decision, answers.complete)
    };
    let less = |limit| decisions(2000, Comparison::Less, limit, Event::Fails);
    assert_eq!(less(0.05), (Decision::Met, true));
    assert_eq!(less(0.01), (Decision::NotMet, true));
    assert_eq!(less(0.0228), (Decision::Undecided, true));
    let holds = |limit| decisions(2000, Comparison::Greater, limit, Event::Holds);
    assert_eq!(holds(0.95), (Decision::Met, true));
    assert_eq!(holds(0.99), (Decision::NotMet, true));
    let early = decisions(4000, Comparison::Less, 0.05, Event::Fails);
    assert_eq!(early, (Decision::Undecided, false));
}

/// A study that decides looks at 128, 256 … runs, and is complete at the first look that decides.
#[test]
fn a_study_with_a_rule_decides_at_a_look() {
    let all = rows(&normals(Design::Random, 6), 5000, |_| false);
    let of = |runs: usize, limit| {
        let metadata = Metadata {
            kind: StudyKind::Study(Stopping::Decided),
            studied: vec![studied(Comparison::Less, limit, Event::Fails)],
            ..metadata(1_000_000)
        };
        answers(&metadata, &all[..runs])
    };
    let far = of(512, 0.3);
    let runs: Vec<u64> = far.looks.iter().map(|look| look.runs).collect();
    assert_eq!(runs, [128, 256, 512]);
    assert_eq!(
        (far.studied[0].decision, far.studied[0].look),
        (Decision::Met, Some(1))
    );
    assert!(far.complete);
    // The look spends half of α: its interval is wider than that of a fixed number of runs.
    assert!((far.looks[0].confidence - 0.975).abs() < 1e-12);
    let shown = far.studied[0].probability.as_ref().unwrap();
    assert_eq!(shown.interval, far.looks[2].intervals[0]);
    let near = of(4096, 0.0228);
    assert_eq!(
        (near.complete, near.studied[0].decision),
        (false, Decision::Undecided)
    );
    // Between two looks no conclusion is drawn from later runs.
    assert_eq!(of(5000, 0.0228).looks.len(), 6);
}

/// Twenty records whose medians have the dispersion 0.3, and structures with 0.2 under each: the parts come back.
#[test]
fn the_dispersion_between_records_is_divided_from_that_of_the_structures() {
    let values = [0.4, 0.6, 0.8, 1.0, 1.2];
    let whole = fragility_metadata(&values, 200);
    let StudyKind::Fragility(stripes) = whole.kind.clone() else {
        panic!("a fragility");
    };
    let mut metadata = Metadata {
        kind: StudyKind::Fragility(Stripes {
            record: Some(2),
            ..stripes
        }),
        ..whole
    };
    let number = Column::new("motion.record_number", Dimension::NUMBER, "any");
    metadata.inputs.push(number);
    let mut rows = fragility_rows(&values, 200);
    for row in &mut rows {
        // Each record with each intensity.
        let record = f64::from(u32::try_from(row.run / 5 % 20).unwrap());
        let between = 0.3 * normal::quantile((record + 0.5) / 20.0);
        let used = row.inputs[0] / (0.8 * (between + 0.2 * row.inputs[1]).exp());
        row.inputs.push(record + 1.0);
        row.results = vec![Some(0.05 * used)];
        row.outcomes = vec![if used > 1.0 {
            Outcome::Met
        } else {
            Outcome::NotMet
        }];
    }
    let answers = answers(&metadata, &rows);
    let fragility = answers.fragility.unwrap();
    let split = fragility.fits[0].split.unwrap();
    assert_eq!(split.records, 20);
    assert!(contains(split.share_interval, 9.0 / 13.0), "{split:?}");
    assert!((split.record_to_record - 0.3).abs() < 0.06, "{split:?}");
    assert!((split.modelling - 0.2).abs() < 0.06, "{split:?}");
}

/// Capacities are lognormal: 8 stripes of 400 runs give back θ = 0.8 and β = 0.4 within their intervals.
#[test]
fn a_known_fragility_is_recovered() {
    const RUNS: u64 = 400;
    let values: Vec<f64> = (0..8_u32).map(|at| 0.3 + 0.2 * f64::from(at)).collect();
    let metadata = fragility_metadata(&values, RUNS);
    let rows = fragility_rows(&values, RUNS);
    let found = answers(&metadata, &rows);
    assert!(found.complete && found.results.is_empty());
    let fragility = found.fragility.unwrap();
    let [fit] = &fragility.fits[..] else {
        panic!("one fit")
    };
    assert!(contains(fit.median_interval.unwrap(), CAPACITY[0]));
    assert!(contains(fit.dispersion_interval.unwrap(), CAPACITY[1]));
    assert!(fit.goodness.unwrap() > 0.001 && fit.has_middle && fit.no_fit.is_none());
    for point in &fit.curve {
        assert!(contains(point.interval, point.probability));
        let inside = (values[0]..=values[7]).contains(&point.intensity);
        assert_eq!(point.is_extrapolated, !inside);
    }
    let stripe = &fragility.stripes[2];
    assert_eq!(stripe.exceeded + stripe.not_exceeded, RUNS);
    // All of them below the first capacity: no curve, with the reason in the unit of the intensity.
    let step: Vec<StudyRow> = rows
        .iter()
        .map(|row| StudyRow {
            outcomes: vec![if row.inputs[0] <= values[0] {
                Outcome::NotMet
            } else {
                Outcome::Met
            }],
            ..row.clone()
        })
        .collect();
    let fits = answers(&metadata, &step).fragility.unwrap().fits;
    let reason = fits[0].no_fit.clone().unwrap();
    assert!(
        reason.contains("up to 0.3 m, every run from 0.5 m"),
        "{reason}"
    );
}

/// Runs without a result give two curves, and a part of a study gives no answer.
#[test]
fn lost_runs_give_two_curves_and_a_part_none() {
    let metadata = Metadata {
        kind: StudyKind::Fragility(Stripes {
            intensity: 0,
            values: vec![0.9, 1.0, 1.1],
            runs: 100,
            record: None,
        }),
        ..metadata(300)
    };
    let row = |run: u64| StudyRow {
        run,
        inputs: vec![0.9 + 0.1 * number(run % 3), 1.0],
        results: vec![None],
        outcomes: vec![match run / 3 % 10 {
            0 => Outcome::NoResult,
            rest if rest < 3 * (run % 3) + 2 => Outcome::Met,
            _ => Outcome::NotMet,
        }],
        reason: None,
    };
    let rows: Vec<StudyRow> = (0..300).map(row).collect();
    let fragility = answers(&metadata, &rows).fragility.unwrap();
    let medians: Vec<f64> = fragility
        .fits
        .iter()
        .map(|fit| fit.median.unwrap())
        .collect();
    assert!(medians.len() == 2 && medians[1] < medians[0], "{medians:?}");
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("part.parquet");
    let part = Metadata {
        first: 100,
        ..metadata
    };
    written(&path, &part, &rows[100..]);
    let fault = Answers::of(&Reader::open(&path).unwrap()).unwrap_err();
    assert!(fault.reason.contains("merge the parts"), "{fault}");
}
