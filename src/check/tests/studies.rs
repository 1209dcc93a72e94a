//! Studies: the checked data are those of the plan's text, and a run of the plan does not depend on them.

use std::collections::BTreeMap;

use crate::check::{Options, ParsedPlan};
use crate::codes::E666;
use psd_language::codes::E665;
use psd_physics::study::distribution::{Distribution, Spread};
use psd_physics::study::inputs::{Source, StudyInputs};
use psd_physics::study::sampling::Design;
use psd_plan::study::{RareEvent, Runs, Sampling, Study, StudyEvent};
use psd_plan::{Comparison, Plan};
use psd_text::diagnostic::Code;
use psd_text::units::{Dimension, Quantity};

use super::{checked, files};

const MEASURED: &str = "# shop floor\nname,mass_kg,K_kn_per_m\nA,0.9,290\nB,1.1,310\n";
const FILES: &[(&str, &str)] = &[("measured.csv", MEASURED)];

/// A plan with these items behind its test.
fn text(items: &str) -> String {
    format!(
        "param speed = 1 m/s between 0.5 m/s .. 3 m/s\n\
         param stiffness = 300 kN/m\n\
         specimen beam {{\n  mass = 1 kg\n  mass_uncertainty = 5 g\n  behaviour = elastic(stiffness: stiffness)\n}}\n\
         striker hammer {{\n  mass = 4 kg\n  velocity = speed\n}}\n\
         impact hit {{\n  striker = hammer\n  duration = 1 s\n  time_step = 0.1 ms\n}}\n\
         require \"stays\" hit.max_displacement < 1 m\n{items}\n"
    )
}

fn plan(items: &str) -> Plan {
    let (checked, _) = checked(&text(items), &files(FILES), &[]);
    checked
        .plan
        .unwrap_or_else(|| panic!("{:?}", checked.diagnostics))
}

fn study(fields: &str) -> Study {
    let mut studies = plan(&format!("study scatter {{\n{fields}\n}}"))
        .studies
        .studies;
    assert_eq!(studies.len(), 1);
    studies.remove(0)
}

/// The distribution of the only input.
fn distribution(written: &str) -> Distribution {
    let study = study(&format!("vary = [{written}]"));
    match study.variation.sources.as_slice() {
        [Source::Distribution(found)] => *found,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_distribution_is_around_the_value_of_the_plan_or_a_stated_mean() {
    let normal = |mean, sd| Distribution::normal(mean, Spread::Sd(sd)).unwrap();
    for (written, expected) in [
        ("speed ~ normal(sd: 50 mm/s)", normal(1.0, 0.05)),
        ("speed ~ normal(50 mm/s)", normal(1.0, 0.05)),
        (
            "speed ~ normal(sd: 50 mm/s, mean: 2 m/s)",
            normal(2.0, 0.05),
        ),
        ("beam.mass", normal(1.0, 0.005)),
        ("beam.mass ~ measured", normal(1.0, 0.005)),
        (
            "speed ~ normal(sd: 50 mm/s, between: 0.9 .. 1.2 m/s)",
            normal(1.0, 0.05).truncated(0.9, 1.2).unwrap(),
        ),
        (
            "hammer.mass ~ lognormal(cv: 2 %)",
            Distribution::lognormal(4.0, Spread::Cv(0.02)).unwrap(),
        ),
        (
            "hammer.mass ~ weibull(cv: 2 %)",
            Distribution::weibull(4.0, Spread::Cv(0.02)).unwrap(),
        ),
        (
            "hammer.mass ~ gumbel(cv: 2 %)",
            Distribution::gumbel(4.0, Spread::Cv(0.02)).unwrap(),
        ),
        (
            "hammer.mass ~ uniform(3.5 .. 4.5 kg)",
            Distribution::uniform(3.5, 4.5).unwrap(),
        ),
        (
            "hammer.mass ~ uniform(cv: 2 %)",
            Distribution::uniform_around(4.0, Spread::Cv(0.02)).unwrap(),
        ),
        (
            "hammer.mass ~ triangular(3 .. 4.5 kg)",
            Distribution::triangular(&(3.0..=4.5), 4.0).unwrap(),
        ),
        (
            "hammer.mass ~ triangular(3 .. 4.5 kg, mode: 3.2 kg)",
            Distribution::triangular(&(3.0..=4.5), 3.2).unwrap(),
        ),
    ] {
        assert_eq!(distribution(written), expected, "{written}");
    }
}

/// The standard deviation of a symmetric triangular distribution of half-width h is h/√6; 20,000 points, four standard errors of it
/// (kurtosis 2.4: relative standard error √(1.4/4n)).
#[test]
fn a_triangular_distribution_has_the_stated_deviation() {
    let study = study("vary = [hammer.mass ~ triangular(sd: 100 g)]");
    let inputs = StudyInputs::new(study.variation.sources, &[], Design::Random, 1).unwrap();
    let mut values = Vec::new();
    let runs = 20_000_u32;
    let squares: f64 = (0..u64::from(runs))
        .map(|run| {
            inputs.draw(run, &mut values);
            (values[0] - 4.0).powi(2)
        })
        .sum();
    let deviation = (squares / f64::from(runs)).sqrt();
    let error = (1.4 / (4.0 * f64::from(runs))).sqrt();
    assert!((deviation / 0.1 - 1.0).abs() < 4.0 * error, "{deviation}");
}

#[test]
fn columns_of_one_file_are_one_source_and_correlations_name_sources() {
    let study = study(
        "vary = [\n\
         beam.mass ~ from(\"measured.csv\", column: \"mass_kg\"),\n\
         speed ~ normal(cv: 5 %),\n\
         stiffness ~ from(\"measured.csv\", column: \"K_kn_per_m\"),\n\
         hammer.mass ~ normal(cv: 1 %),\n]\n\
         correlate = [rank(hammer.mass, speed, -0.5)]",
    );
    let names: Vec<&str> = study
        .variation
        .inputs
        .iter()
        .map(|input| input.name.as_str())
        .collect();
    assert_eq!(names, ["beam.mass", "stiffness", "speed", "hammer.mass"]);
    assert_eq!(study.variation.inputs[1].nominal, 300e3);
    assert_eq!(study.variation.sources.len(), 3);
    let rows = vec![vec![0.9, 290e3], vec![1.1, 310e3]];
    assert_eq!(study.variation.sources[0], Source::Rows(rows));
    let pair = study.variation.correlations[0];
    assert_eq!((pair.inputs, pair.correlation), ([2, 1], -0.5));
}

#[test]
fn the_end_of_a_study_is_a_number_or_a_rule() {
    let runs = |fields: &str| {
        let require = "require \"rare\" scatter.probability(fails: \"stays\") < 2 %";
        let study =
            format!("study scatter {{\nvary = [speed ~ normal(cv: 5 %)]\n{fields}\n}}\n{require}");
        plan(&study).studies.studies.remove(0).runs
    };
    assert_eq!(runs(""), Runs::Fixed(10_000));
    assert_eq!(runs("runs = 10000000000"), Runs::Fixed(10_000_000_000));
    let level = |runs| match runs {
        Runs::Decided { confidence, .. } | Runs::HalfWidth { confidence, .. } => confidence.error(),
        Runs::Fixed(_) | Runs::Rare(_) => f64::NAN,
    };
    let decided = runs("until = decided(at_most: 5000)\nconfidence = 99 %");
    assert_eq!(decided.at_most(), 5000);
    assert!(
        (level(decided) - 0.01).abs() < 1e-12,
        "the study's confidence"
    );
    let own = runs("until = decided(confidence: 90 %, at_most: 5000)\nconfidence = 99 %");
    assert!(
        (level(own) - 0.1).abs() < 1e-12,
        "the rule's own confidence"
    );
    assert!(matches!(
        runs("sampling = subset(points: 500)"),
        Runs::Rare(RareEvent {
            points: 500,
            replicates: 10,
            numbers: 1,
            requirement: 0,
            falls: false
        })
    ));
    let width = runs("until = half_width(0.5 %, at_most: 7000)");
    assert!(
        matches!(width, Runs::HalfWidth { half_width, at_most: 7000, .. } if half_width == 0.005)
    );
}

#[test]
fn a_requirement_on_a_probability_is_one_of_the_study_and_not_of_a_run() {
    let plan = plan(
        "require \"rare\" 2 % > scatter.probability(fails: \"gentle\")\n\
         require \"gentle\" hit.max_displacement < 2 m\n\
         require \"usual\" scatter.probability(holds: \"stays\") >= 90 %\n\
         study scatter {\nvary = [speed ~ normal(cv: 5 %)]\nsampling = sobol\nseed = 7\ncollect = [hit.stop_time]\n}",
    );
    let labels: Vec<&str> = plan
        .requirements
        .iter()
        .map(|requirement| requirement.label.as_str())
        .collect();
    assert_eq!(labels, ["stays", "gentle"]);
    let [rare, usual] = plan.studies.requirements.as_slice() else {
        panic!("{:?}", plan.studies.requirements)
    };
    assert_eq!(rare.event, StudyEvent::Fails { requirement: 1 });
    assert_eq!((rare.comparison, rare.limit), (Comparison::Less, 0.02));
    assert_eq!(usual.event, StudyEvent::Holds { requirement: 0 });
    assert_eq!(
        (usual.comparison, usual.limit),
        (Comparison::GreaterEqual, 0.9)
    );
    assert_eq!(
        plan.studies.requirement_names().unwrap(),
        "\"rare\", \"usual\""
    );
    let study = &plan.studies.studies[0];
    assert_eq!(
        (study.variation.sampling, study.variation.seed),
        (Sampling::Sobol, 7)
    );
    assert_eq!(study.collect[0].text, "hit.stop_time");
}

#[test]
fn a_fragility_has_the_stripes_of_its_range() {
    let plan = plan(
        "fragility tip {\nintensity = hammer.velocity in 0.5 .. 1.5 step 0.5 m/s\nexceeds = hit.max_displacement > 10 mm\n\
         vary = [beam.mass]\nruns = 20\n}",
    );
    let tip = &plan.studies.fragilities[0];
    assert_eq!(tip.stripes, [0.5, 1.0, 1.5]);
    assert_eq!(
        (tip.intensity.name.as_str(), tip.intensity.nominal),
        ("hammer.velocity", 1.0)
    );
    assert_eq!(
        (tip.runs, tip.exceeds.text.as_str()),
        (20, "hit.max_displacement > 10 mm")
    );
    assert_eq!(tip.variation.as_ref().unwrap().inputs[0].text, "measured");
}

/// A run of the plan is the same with and without its studies, and a bound plan has none.
#[test]
fn a_run_does_not_depend_on_the_studies_of_its_plan() {
    let with = text("study scatter {\nvary = [speed ~ normal(cv: 5 %)]\n}");
    let mut parsed = ParsedPlan::parse("plan.psd", &with, &files(FILES), &Options::default());
    assert!(parsed.check(&files(FILES)).plan.is_some());
    let values = BTreeMap::from([("speed".to_owned(), Quantity::new(1.25, Dimension::VELOCITY))]);
    let mut bound = parsed.bind(&values).unwrap();
    assert!(bound.studies.studies.is_empty());
    let set = [("speed", "1.25 m/s")];
    let mut alone = checked(&text(""), &files(FILES), &set).0.plan.unwrap();
    bound.files.clear();
    alone.files.clear();
    assert_eq!(format!("{bound:?}"), format!("{alone:?}"));
}

/// The ends of the inputs are checked, but not for one run of the study, of which a value is set.
#[test]
fn the_plan_must_be_valid_at_the_ends_of_its_inputs() {
    let far = text("study scatter {\nvary = [speed ~ uniform(0.4 .. 2 m/s)]\n}");
    let (found, _) = checked(&far, &files(FILES), &[]);
    let codes: Vec<Code> = found.diagnostics.iter().map(|found| found.code).collect();
    assert_eq!(codes, [E666]);
    assert!(found.plan.is_none());
    let (set, _) = checked(&far, &files(FILES), &[("speed", "1.5 m/s")]);
    assert!(set.plan.is_some(), "{:?}", set.diagnostics);
}

#[test]
fn studies_are_not_run_on_a_real_rig() {
    let rig = "rig bench {\nlink = serial(port: \"/dev/ttyUSB0\", dialect: native, serial_number: \"PSD-0001\")\n\
               settle = within(0.01 mm, 5 N/s, for: 0.3 s, timeout: 10 s)\nsafe_state = hold\n\
               pretest_check = probe(0.02 mm, stiffness: 250 kN/m .. 350 kN/m, zero: 20 N)\n\
               calibration = \"UKAS 4711\"\ncalibration_due = \"2027-03-01\"\n}\n\
               study scatter {\nvary = [speed ~ normal(cv: 5 %)]\n}";
    let codes = |for_studies| {
        let options = Options {
            rig: Some("bench".to_owned()),
            for_studies,
            ..Options::default()
        };
        let mut parsed = ParsedPlan::parse("plan.psd", &text(rig), &files(FILES), &options);
        let found = parsed.check(&files(FILES)).diagnostics;
        let errors = found.iter().filter(|found| found.is_error());
        errors.map(|found| found.code).collect::<Vec<_>>()
    };
    let plain = codes(false);
    assert!(!plain.contains(&E665), "{plain:?}");
    assert!(codes(true).contains(&E665));
}
