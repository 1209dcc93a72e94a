//! Studies of plans as text: ground-motion records and results of identification as inputs, and rare events, against closed forms.

use super::collection::{Collection, Ended};
use super::data_set::{Metadata, Outcome, Reader, Stopping, StudyKind, StudyRow};
use super::definition::Definition;
use super::definition::measured::{self, MeasuredError};
use super::metadata;
use super::simulation::Simulation;
use super::stopping::rare::RareRuns;
use super::testing::bytes;
use crate::check::{LoadError, Options, ParsedPlan};
use crate::study::answers::Answers;
use psd_physics::study::Confidence;
use psd_physics::study::distribution::normal;
use psd_plan::Plan;
use psd_rig::transport::MonotonicClock;

/// A pulse of 1 m/s² and one of half of it: the response of an elastic frame to the second is half that to the first.
fn pulses(path: &str) -> Result<String, LoadError> {
    let peak = match path {
        "strong.csv" => 1.0,
        "weak.csv" => 0.5,
        _ => return Err(LoadError::NotFound),
    };
    Ok(format!(
        "time_s,acceleration_m_per_s2\n0,0\n0.1,{peak}\n0.2,0\n"
    ))
}

struct Parsed {
    parsed: ParsedPlan,
    plan: Plan,
}

fn parsed(text: &str) -> Parsed {
    let mut parsed = ParsedPlan::parse("study.psd", text, &pulses, &Options::default());
    let checked = parsed.check(&pulses);
    let plan = checked.plan;
    let plan = plan.unwrap_or_else(|| panic!("{text}: {:?}", checked.diagnostics));
    Parsed { parsed, plan }
}

/// An elastic storey under a pulse, and what is studied.
fn frame(rest: &str) -> String {
    format!(
        "specimen frame {{ storeys = [storey(mass: 1 t, height: 3 m, behaviour: elastic(stiffness: 100 kN/m))] }}\n\
         ground motion {{ file = [\"strong.csv\", \"weak.csv\"]\nrecord_number = 1\nscale = 1 }}\n\
         shake quake {{ ground = motion\ndamping_ratio = 5 %\ntime_step = 20 ms\nduration = 0.4 s }}\n{rest}\n"
    )
}

fn rows(of: &Parsed, runs: u64) -> Vec<StudyRow> {
    let definition = Definition::of(&of.plan.studies, None, None).unwrap();
    Simulation::new(&of.parsed, &of.plan, &definition).rows(0..runs)
}

/// Every run reads one of the two records, and the weak one moves the elastic frame half as far.
#[test]
fn a_study_draws_a_ground_motion_record_for_each_run() {
    let of = parsed(&frame(
        "study records { vary = [motion.record_number ~ any]\nruns = 40\ncollect = [max(quake.max_drift)] }",
    ));
    let mut counts = [0; 2];
    let mut drifts = [0.0; 2];
    for row in rows(&of, 40) {
        let at = usize::from(row.inputs != [1.0]);
        assert_eq!(row.inputs, [[1.0], [2.0]][at]);
        counts[at] += 1;
        drifts[at] = row.results[0].unwrap();
    }
    assert!(counts.iter().all(|count| *count > 8), "{counts:?}");
    assert!((drifts[0] / drifts[1] - 2.0).abs() < 1e-9, "{drifts:?}");
}

#[test]
fn a_fragility_knows_its_record() {
    let of = parsed(&frame(
        "fragility drift { intensity = motion.scale in [1, 2]\nexceeds = max(quake.max_drift) > 1 mm\n\
         vary = [quake.damping_ratio ~ normal(cv: 10 %), motion.record_number ~ any]\nruns = 2 }",
    ));
    let definition = Definition::of(&of.plan.studies, None, None).unwrap();
    let StudyKind::Fragility(stripes) = definition.kind else {
        panic!("a fragility");
    };
    assert_eq!(stripes.record, Some(2));
}

/// The largest drift is that of scale 1 times the scale, which is lognormal with mean 1 and coefficient of variation 30 %: it exceeds twice
/// its value with Φ(−(ln 2 + σ²/2)/σ), σ² = ln 1.09, in closed form 0.0069.
#[test]
fn a_rare_drift_of_a_frame_has_its_probability_in_closed_form() {
    let of = parsed(&frame("require \"usual\" max(quake.max_drift) < 1 m"));
    let record = {
        let mut rig = psd_rig::virtual_rig(&of.plan);
        let keep = crate::run::Keep::Results;
        crate::run::run_with(&of.plan, rig.as_mut(), &mut crate::run::Unwatched, keep)
    };
    let usual = &of.plan.requirements[0].conditions[0].value;
    let usual = usual.evaluate(&record, None).unwrap().value;
    let limit = 2.0 * usual;
    let of = parsed(&frame(&format!(
        "study rare {{ vary = [motion.scale ~ lognormal(cv: 30 %)]\nsampling = subset(points: 100, replicates: 3) }}\n\
         require \"drifts\" max(quake.max_drift) < {limit} m\n\
         require \"rarely\" rare.probability(fails: \"drifts\") < 10 %"
    )));
    let sigma = 1.09_f64.ln().sqrt();
    let truth = normal::below(-(2.0_f64.ln() + 0.5 * sigma * sigma) / sigma);
    let [whole, pieces] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let (path, metadata) = collected(&of, whole.path(), u32::MAX).unwrap();
    let answers = Answers::of(&Reader::open(&path).unwrap()).unwrap();
    let subset = answers.subset.as_ref().unwrap();
    let [low, high] = subset.interval;
    assert!(low <= truth && truth <= high, "{truth} {subset:?}");
    assert!(answers.complete && answers.runs < 3 * 400);
    assert_eq!(
        answers.studied[0].decision,
        psd_physics::study::probability::Decision::Met
    );
    assert!(answers.results.is_empty() && answers.requirements[0].probability.is_none());
    assert_eq!(answers.requirements[0].worst.len(), 10);
    // Stopped after every round and continued, it has the same bytes.
    let continued = loop {
        if let Some((path, _)) = collected(&of, pieces.path(), 1) {
            break path;
        }
    };
    assert_eq!(bytes(&continued), bytes(&path));
    // The same levels follow from the rows alone.
    let mut again = RareRuns::of(&metadata).unwrap();
    for row in Reader::open(&path).unwrap().rows() {
        assert!(!again.is_over());
        again.add(&row.unwrap());
    }
    let level = Confidence::new(0.95).unwrap();
    assert_eq!(
        again.answer(level).unwrap().probability.value,
        subset.probability
    );
    assert!(matches!(metadata.kind, StudyKind::Study(Stopping::Rare(_))));
}

/// The data set once it is finished, with the metadata of the study.
fn collected(
    of: &Parsed,
    folder: &std::path::Path,
    rounds: u32,
) -> Option<(std::path::PathBuf, Metadata)> {
    let definition = Definition::of(&of.plan.studies, None, None).unwrap();
    let simulation = Simulation::new(&of.parsed, &of.plan, &definition);
    let metadata = metadata::study_metadata("0.1.0 0", &of.plan, &definition, simulation.readout());
    let collection = Collection {
        simulation: &simulation,
        metadata: &metadata,
        runs: definition.runs,
        folder,
        shard: None,
    };
    let mut left = rounds;
    let (ended, _) = collection
        .run(&MonotonicClock::start(), &mut |_| {
            left -= 1;
            left > 0
        })
        .unwrap();
    match ended {
        Ended::Finished { path, .. } => Some((path, metadata)),
        Ended::Stopped { .. } => None,
    }
}

/// An impact on a beam whose stiffness a ramp with noise identifies, and what is studied.
fn identified(rig: &str, rest: &str) -> String {
    format!(
        "specimen beam {{ mass = 1 kg\nbehaviour = elastic(stiffness: 300 N/m) }}\n{rig}\n\
         stiffness ramp k0 {{ displacements = 1 mm .. 10 mm step 1 mm\nsamples = 5\nreturn = true }}\n\
         striker hammer {{ mass = 10 kg\nvelocity = 1 m/s }}\n\
         impact hit {{ striker = hammer\nduration = 1 s\ntime_step = 10 ms\nstiffness = k0.stiffness }}\n{rest}\n"
    )
}

const NOISY: &str = "rig noisy { link = virtual(noise: 0.05 N, seed: 3) }";

/// The result is drawn around the value of a run with its uncertainty, and the impact reads what was drawn.
#[test]
fn a_result_of_identification_is_drawn_with_its_measured_uncertainty() {
    let study = "study scatter { vary = [k0.stiffness]\nruns = 30\ncollect = [k0.stiffness, hit.critical_time_step] }";
    let mut of = parsed(&identified(NOISY, study));
    measured::known(&mut of.plan).unwrap();
    let nominal = of.plan.studies.studies[0].variation.inputs[0].nominal;
    assert!((nominal - 300.0).abs() < 3.0, "{nominal}");
    let rows = rows(&of, 30);
    let values: Vec<f64> = rows.iter().map(|row| row.inputs[0]).collect();
    let mean = values.iter().sum::<f64>() / 30.0;
    let sd = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 29.0).sqrt();
    assert!(
        sd > 0.0 && (mean - nominal).abs() < 4.0 * sd / 30_f64.sqrt(),
        "{sd}"
    );
    for row in &rows {
        // It is an input, and not a result as well.
        assert_eq!(row.results.len(), 1);
        // The critical step of a mass on a spring falls with the root of the stiffness that the impact was given.
        let first = &rows[0];
        let ratio = row.results[0].unwrap() / first.results[0].unwrap();
        let expected = (first.inputs[0] / row.inputs[0]).sqrt();
        assert!((ratio - expected).abs() < 1e-9, "{ratio} {expected}");
    }
}

#[test]
fn a_result_without_an_uncertainty_is_refused() {
    let study = "study scatter { vary = [k0.stiffness]\nruns = 3\ncollect = [hit.stop_time] }";
    let mut of = parsed(&identified("", study));
    let error = MeasuredError::NoUncertainty("k0.stiffness".to_owned());
    assert_eq!(measured::known(&mut of.plan), Err(error));
    let stated = study.replace(
        "k0.stiffness]",
        "k0.stiffness ~ normal(mean: 300 N/m, cv: 2 %)]",
    );
    let mut of = parsed(&identified("", &stated));
    measured::known(&mut of.plan).unwrap();
    assert!(
        rows(&of, 3)
            .iter()
            .all(|row| row.outcomes.is_empty() || row.outcomes[0] != Outcome::NoResult)
    );
}
