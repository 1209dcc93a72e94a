//! Runs of studies made by hand: alone and in batches, invalid, stopped, and taken again by `--set`.

use super::*;
use crate::check::{LoadError, Options, check};
use crate::study::answers::setting;
use crate::study::data_set::Outcome;
use crate::study::metadata::{column, study_metadata};
use crate::study::testing::{Studied, checked, plan, usual, variation};
use psd_physics::study::distribution::{Distribution, Spread};
use psd_physics::study::inputs::Source;
use psd_plan::formula::{Formula, ProcedureId, ResultPart, ResultReference};
use psd_plan::study::{Collected, Fragility, Variation};
use psd_plan::{Comparison, Condition, Test};
use psd_text::units::Dimension;

/// Files beside the examples.
pub(super) fn folder(path: &str) -> Result<String, LoadError> {
    std::fs::read_to_string(format!("../plans/{path}")).map_err(|_| LoadError::NotFound)
}

/// Inputs and results as bits.
fn bits(rows: &[StudyRow]) -> Vec<(u64, Vec<u64>, Vec<Option<u64>>)> {
    let of = |row: &StudyRow| {
        (
            row.run,
            row.inputs.iter().map(|value| value.to_bits()).collect(),
            row.results
                .iter()
                .map(|value| value.map(f64::to_bits))
                .collect(),
        )
    };
    rows.iter().map(of).collect()
}

const EVERYTHING: &str = "require \"everything\" hit.max_displacement < 180 mm and hit.stop_time < 0.3 s and \
    hit.max_contact_force > 1 N and hit.absorbed_energy > 1 mJ and hit.max_velocity > 0.1 m/s and hit.impulse > 1 N*s and \
    abs(hit.energy_error) < 50 % and hit.final_displacement > 1 mm and hit.critical_time_step > 1 us";

/// Some impacts are stopped by a limit, some begin with an error, some do not end or reach no peak. All outcomes occur, the rows are the
/// same, and no run leaves its batch.
#[test]
fn runs_in_batches_are_the_runs_one_by_one() {
    let bilinear = |text: String| {
        text.replace(
            "elastic(stiffness: 300 N/m)",
            "bilinear(stiffness: 300 N/m, yield_force: 45 N, post_yield_ratio: 0.1)",
        )
    };
    let cases = [
        usual(),
        plan("", EVERYTHING),
        plan("contact = limit(force: 80 N)", EVERYTHING),
        plan("until = duration", EVERYTHING),
        bilinear(plan("", EVERYTHING)),
        plan(
            "",
            &format!(
                "limits {{ displacement = -1 mm .. 185 mm\nforce = -1 N .. 55 N\nincrement = 10.5 mm }}\n{EVERYTHING}"
            ),
        ),
        plan("", EVERYTHING).replace("duration = 1 s", "duration = 0.26 s"),
        plan("", EVERYTHING).replace("duration = 1 s", "duration = 50 ms"),
        plan(
            "contact = limit(force: 80 N)",
            &format!("limits {{ force = -1 N .. 20 N }}\n{EVERYTHING}"),
        ),
        plan("", &format!("limits {{ increment = 5 mm }}\n{EVERYTHING}")),
        plan("", EVERYTHING).replace(
            "param weight = 1 kg",
            "param weight = 1 kg between 0.8 kg .. 1.2 kg",
        ),
        plan("", EVERYTHING).replace("time_step = 10 ms", "time_step = 0.01 * critical"),
        // The rig measures it at rest, where a damper has no force.
        plan("", EVERYTHING).replace("mass = weight", "mass = weight\ndamping = 20 N*s/m"),
    ];
    let mut seen = Vec::new();
    for text in cases {
        let studied = Studied::of(&text, 100);
        let definition = studied.definition();
        let simulation = || Simulation::new(&studied.parsed, &studied.plan, &definition);
        assert!(simulation().is_batched(), "{text}");
        let in_batches = simulation();
        let batched = in_batches.block(0..100);
        assert_eq!(in_batches.left().text(), None, "{text}");
        let alone = simulation().one_by_one().block(0..100);
        assert_eq!(bits(&batched), bits(&alone), "{text}");
        assert_eq!(batched, alone, "{text}");
        seen.extend(batched.into_iter().flat_map(|row| row.outcomes));
    }
    for outcome in [Outcome::Met, Outcome::NotMet, Outcome::NoResult] {
        assert!(seen.contains(&outcome), "{outcome:?}");
    }
}

/// Friction that the values of a run give its specimen needs the rig.
#[test]
fn a_run_that_leaves_its_batch_is_counted_with_the_reason() {
    let text = usual()
        .replace("param weight = 1 kg", "param weight = 0 kg")
        .replace("mass = weight", "mass = 1 kg\ncoulomb = weight * 1 m/s^2");
    let studied = Studied::of(&text, 10);
    let definition = studied.definition();
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    assert!(simulation.is_batched());
    let batched = simulation.block(0..10);
    let alone = Simulation::new(&studied.parsed, &studied.plan, &definition)
        .one_by_one()
        .block(0..10);
    assert_eq!(batched, alone);
    assert_eq!(
        simulation.left().text().unwrap(),
        "10 runs left the batches: 10 with values that need the rig"
    );
}

/// Every example that is one impact on an ideal rig: its results in a batch are those of its run.
#[test]
fn every_example_that_a_batch_takes_has_the_same_results_in_it() {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir("../plans").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "psd") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let found = check("plan.psd", &text, &folder, &Options::default());
        let Some(plan) = found.plan else { continue };
        let Some(impact) = batches::impact(&plan) else {
            continue;
        };
        let alone = simulated_alone(&plan);
        let mut batch = Batch::default();
        batch.add(0, impact);
        let all = alone.procedures[0].results.iter();
        let references: Vec<ResultReference> = all
            .filter(|result| crate::procedures::impact::batched::gives(result.name))
            .map(|result| ResultReference {
                procedure: ProcedureId(0),
                name: result.name,
                part: ResultPart::Value,
            })
            .collect();
        assert!(references.len() > 10);
        let mut found = None;
        batch.run(&plan, &references, |_, record| {
            found = Some(record.unwrap().clone());
        });
        let found = found.unwrap();
        assert_eq!(found.procedures[0].results.len(), references.len());
        for ResultReference { name, .. } in references {
            let number = |record: &psd_plan::record::Record| {
                record.procedures[0].number(name).map(f64::to_bits)
            };
            assert_eq!(number(&found), number(&alone), "{}: {name}", path.display());
        }
        paths.push(path);
    }
    assert!(paths.len() >= 3, "{paths:?}");
}

#[test]
fn a_plan_that_reads_more_than_a_batch_gives_runs_one_by_one() {
    for (text, is_batched) in [
        (usual(), true),
        (plan("", "require \"a\" hit.restoring_energy > 1 mJ"), false),
        (plan("", "require \"a\" hit.steps > 3"), false),
        (plan("", "require \"a\" hit.peak_error < 1 mm"), false),
        (
            plan(
                "contact = restitution(coefficient: 0.5)",
                "require \"a\" hit.impulse > 0 N*s",
            ),
            false,
        ),
        (
            plan(
                "",
                "rig noisy { link = virtual(noise: 1 N) }\nrequire \"a\" hit.impulse > 0 N*s",
            ),
            false,
        ),
        (usual() + "\nunload back { }", false),
        (
            usual().replace(
                "elastic(stiffness: 300 N/m)",
                "maxwell(of: elastic(stiffness: 300 N/m), stiffness: 200 N/m, time_constant: 0.1 s)",
            ),
            false,
        ),
    ] {
        let Ok(studied) = std::panic::catch_unwind(|| Studied::of(&text, 1)) else {
            panic!("{text}");
        };
        let definition = studied.definition();
        let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
        assert_eq!(simulation.is_batched(), is_batched, "{text}");
    }
}

/// The printed settings of a run give the plan whose run has the same results, to the last bit.
#[test]
fn a_run_is_reproduced_by_its_settings() {
    let text = plan("", EVERYTHING);
    let studied = Studied::of(&text, 20);
    let definition = studied.definition();
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    for row in simulation.block(0..20) {
        let settings: Vec<(String, String)> = definition
            .inputs
            .iter()
            .zip(&row.inputs)
            .map(|(input, value)| {
                let setting = setting(&column(input), *value);
                let (name, value) = setting.split_once('=').unwrap();
                (name.to_owned(), value.trim_matches('"').to_owned())
            })
            .collect();
        let (_, plan) = checked(&text, &settings);
        let record = simulated_alone(&plan);
        let kept = simulation.readout.read(&plan, &record);
        let values = |results: &[Option<f64>]| -> Vec<Option<u64>> {
            results.iter().map(|it| it.map(f64::to_bits)).collect()
        };
        assert_eq!(values(&kept.results), values(&row.results), "{settings:?}");
        assert_eq!(kept.outcomes, row.outcomes);
    }
}

/// A study evaluates no U, and decides the condition of a series on its value alone. A run that evaluates U ends where it is withheld.
#[test]
fn u_ends_no_series_of_a_study() {
    let text = "param speed = 1 m/s\nparam weight = 1 kg\n\
        specimen beam { mass = weight\nbehaviour = bilinear(stiffness: 300 N/m, yield_force: 18 N, post_yield_ratio: 0.1) }\n\
        striker hammer { mass = 8 kg\nvelocity = 1 m/s }\n\
        escalate up { striker = hammer\nspeeds = [0.2 * speed, 0.4 * speed, 0.6 * speed]\nwhile = max_displacement < 150 mm\n\
        time_step = critical / 40\nduration = 0.7 s }\nrequire \"three\" up.passed >= 3\n";
    let studied = Studied::of(text, 4);
    let definition = studied.definition();
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    for row in simulation.block(0..4) {
        assert_eq!(
            (&row.results[..], &row.outcomes[..]),
            (&[Some(3.0)][..], &[Outcome::Met][..])
        );
    }
    let readout = simulation.readout();
    assert!(study_metadata("0.1.0 0", &studied.plan, &definition, readout).has_series);
    let record = crate::run::run(
        &studied.plan,
        virtual_rig(&studied.plan).as_mut(),
        &mut Unwatched,
    );
    let passed = record.procedures[0]
        .results
        .iter()
        .find(|result| result.name == "passed");
    assert_eq!(passed.and_then(|passed| passed.value.number()), Some(0.0));
}

/// The scale of the specimen changes all numbers of the rig and none of the prototype.
#[test]
fn a_study_varies_the_scale_of_a_specimen() {
    let text = "param lambda = 0.5\nspecimen frame { storeys = [\n\
        storey(mass: 2 t, stiffness: 3 MN/m, part: tested(scale: lambda, represents: 2)),\n\
        storey(mass: 1.5 t, part: computed, behaviour: bilinear(2 MN/m, 5 kN, 10 %)) ] }\n\
        striker hammer { mass = 100 kg\nvelocity = 4 m/s }\n\
        impact hit { striker = hammer\nstorey = 1\nduration = 0.2 s }\n\
        require \"displacement\" hit.max_displacement < 30 mm";
    let lambda = Variation {
        inputs: vec![psd_plan::study::Input {
            name: "lambda".to_owned(),
            dimension: Dimension::NUMBER,
            text: String::new(),
            nominal: 0.5,
            is_record: false,
        }],
        sources: vec![Source::Distribution(
            Distribution::normal(0.5, Spread::Sd(0.05)).unwrap(),
        )],
        correlations: Vec::new(),
        ..variation()
    };
    let studied = Studied::varied(text, 20, lambda);
    let definition = studied.definition();
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    let rows = simulation.block(0..20);
    let displacement = |row: &StudyRow| row.results[0].unwrap();
    let first = displacement(&rows[0]);
    assert!(first > 1e-3);
    for row in &rows {
        assert!((displacement(row) - first).abs() < 1e-12 * first, "{row:?}");
    }
    let of_rig = |row: &StudyRow| row.inputs[0];
    assert!(rows.iter().any(|row| of_rig(row) < 0.48));
    assert!(rows.iter().any(|row| of_rig(row) > 0.52));
}

#[test]
fn a_run_without_a_result_states_the_reason() {
    let row = |text: &str, speed: f64| {
        let speed = Distribution::uniform(speed, speed * 1.000_001).unwrap();
        let studied = Studied::varied(
            text,
            1,
            Variation {
                inputs: variation().inputs[..1].to_vec(),
                sources: vec![Source::Distribution(speed)],
                correlations: Vec::new(),
                ..variation()
            },
        );
        let definition = studied.definition();
        Simulation::new(&studied.parsed, &studied.plan, &definition)
            .block(0..1)
            .remove(0)
    };
    let bounded = usual().replace("speed = 1 m/s", "speed = 1 m/s between 0.5 m/s .. 1.5 m/s");
    let invalid = row(&bounded, 2.0);
    assert_eq!(invalid.outcomes, [Outcome::NoResult]);
    assert_eq!(invalid.results, [None]);
    assert!(
        invalid
            .reason
            .unwrap()
            .starts_with("the plan with these inputs is invalid: ")
    );

    let limited = plan(
        "",
        "limits { displacement = -1 mm .. 185 mm }\nrequire \"stays in travel\" hit.max_displacement < 180 mm",
    );
    let stopped = row(&limited, 1.3);
    assert_eq!(
        (stopped.outcomes, stopped.results),
        (vec![Outcome::NoResult], vec![None])
    );
    assert!(stopped.reason.unwrap().contains("outside its limit"));

    let short = usual().replace("duration = 1 s", "duration = 50 ms");
    let missing = row(
        &short.replace("max_displacement < 180 mm", "stop_time < 1 s"),
        1.0,
    );
    assert_eq!(
        (missing.outcomes, missing.results),
        (vec![Outcome::NoResult], vec![None])
    );
    assert!(missing.reason.unwrap().contains("stop_time"));

    let rising = row(&short, 1.0);
    assert_eq!(
        (rising.outcomes, rising.results),
        (vec![Outcome::NoResult], vec![None])
    );
    assert!(rising.reason.unwrap().contains("peak"));
}

#[test]
fn rows_do_not_depend_on_the_number_of_threads() {
    let studied = Studied::of(&plan("", EVERYTHING), 200);
    let definition = studied.definition();
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| simulation.rows(0..200))
    };
    let one = with(1);
    assert_eq!(one.len(), 200);
    assert_eq!(bits(&with(4)), bits(&one));
    assert_eq!(simulation.rows(150..160), one[150..160]);
}

/// An impact that ends in half of its way exceeds a limit already: the limit is decided, and no largest value is a peak.
#[test]
fn a_peak_that_was_not_reached_is_no_result_of_a_run() {
    let text = plan("", "require \"short\" hit.max_displacement < 50 mm");
    let short = text.replace("duration = 1 s", "duration = 0.15 s");
    let mut studied = Studied::of(&short, 4);
    studied.plan.studies.studies[0].collect = vec![Collected {
        text: "-hit.max_displacement".to_owned(),
        value: Formula::Negate(Box::new(Formula::Result(ResultReference {
            procedure: ProcedureId(0),
            name: psd_plan::procedures::impact::block::MAX_DISPLACEMENT.name,
            part: ResultPart::Value,
        }))),
        dimension: Dimension::LENGTH,
    }];
    let definition = studied.definition();
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    assert!(simulation.is_batched());
    let batched = simulation.block(0..4);
    let alone = Simulation::new(&studied.parsed, &studied.plan, &definition).one_by_one();
    assert_eq!(bits(&batched), bits(&alone.block(0..4)));
    for row in batched {
        assert_eq!(row.outcomes, [Outcome::NotMet]);
        assert_eq!(row.results, [None, None]);
        let why = row.reason.unwrap_or_default();
        assert!(why.contains("is not a peak"), "{why}");
    }
}

/// An exceedance at one of three speeds, and a collected number.
#[test]
fn a_fragility_decides_its_condition_at_each_stripe() {
    let mut studied = Studied::of(&usual(), 1);
    let displacement = Formula::Result(ResultReference {
        procedure: ProcedureId(0),
        name: psd_plan::procedures::impact::block::MAX_DISPLACEMENT.name,
        part: ResultPart::Value,
    });
    studied.plan.studies.studies[0].collect = vec![Collected {
        text: "2 * hit.max_displacement".to_owned(),
        value: Formula::Binary(
            psd_plan::formula::Operator::Multiply,
            Box::new(Formula::Constant(2.0)),
            Box::new(displacement.clone()),
        ),
        dimension: Dimension::LENGTH,
    }];
    let definition = studied.definition();
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    let rows = simulation.block(0..3);
    let names: Vec<String> = simulation
        .readout()
        .columns()
        .into_iter()
        .map(|column| column.name)
        .collect();
    assert_eq!(names, ["hit.max_displacement", "2 * hit.max_displacement"]);
    for row in &rows {
        assert_eq!(row.results[1], row.results[0].map(|value| 2.0 * value));
    }

    let mass = Variation {
        inputs: variation().inputs[1..].to_vec(),
        sources: vec![Source::Distribution(
            Distribution::lognormal(1.0, Spread::Cv(0.01)).unwrap(),
        )],
        correlations: Vec::new(),
        ..variation()
    };
    studied.plan.studies.studies.clear();
    studied.plan.studies.fragilities.push(Fragility {
        name: "tip".to_owned(),
        intensity: variation().inputs[0].clone(),
        stripes: vec![0.5, 1.0, 1.5],
        exceeds: Condition {
            text: "hit.max_displacement > 190 mm".to_owned(),
            value: displacement,
            test: Test::Compare {
                comparison: Comparison::Greater,
                limit: Formula::Constant(0.19),
            },
            dimension: Dimension::LENGTH,
        },
        variation: Some(mass),
        runs: 4,
        confidence: definition.confidence,
    });
    let definition = studied.definition();
    assert_eq!(definition.runs.at_most(), 12);
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    for row in simulation.block(0..12) {
        assert_eq!(row.inputs.len(), 2);
        let expected = if row.inputs[0] == 0.5 {
            Outcome::NotMet
        } else {
            row.outcomes[0]
        };
        assert_eq!(row.outcomes, [expected]);
        if row.inputs[0] == 1.5 {
            assert_eq!(row.outcomes, [Outcome::Met], "{row:?}");
        }
        let value = row.results[0].unwrap();
        assert_eq!(value > 0.19, row.outcomes[0] == Outcome::Met);
    }
}
