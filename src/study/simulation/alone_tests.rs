//! Runs of a study, one by one: each has the results of the run that is recorded, to the last bit, and a step allocates nothing.

use super::Simulation;
use super::simulated_alone as simulate;
use super::tests::folder;
use crate::check::{Options, check};
use crate::run::{Keep, Unwatched, run_with};
use crate::study::answers::setting;
use crate::study::metadata::column;
use crate::study::testing::{Studied, checked, variation};
use crate::tests::testing::{elastic_plan, impact, struck_frame};
use crate::verdict;
use psd_physics::study::distribution::{Distribution, Spread};
use psd_physics::study::inputs::Source;
use psd_plan::formula::{Formula, ResultValue};
use psd_plan::record::{History, NamedResult, Outcome, Record};
use psd_plan::study::{Input, Variation};
use psd_plan::{DecisionRule, Interval, Plan, ProcedureKind};
use psd_rig::{Reading, Rig, RigFault, VirtualRig};
use psd_testing::forwarded;
use psd_text::units::Dimension;

/// A virtual rig whose calls are recorded one by one, as in `psd run`.
struct Recorded(VirtualRig);

impl Rig for Recorded {
    forwarded!(0: identity, degrees_of_freedom, time, propose, execute, pause, read, traverse, follow_paths, hold, declared_noise);

    fn read_moved(&mut self) -> Result<(Reading, Option<[f64; 2]>), RigFault> {
        self.0.read_moved()
    }
}

fn recorded(plan: &Plan) -> Record {
    let mut rig = Recorded(VirtualRig::of_plan(plan));
    run_with(plan, &mut rig, &mut Unwatched, Keep::Steps)
}

/// Name and bits of a result.
fn bits(result: &NamedResult) -> (&'static str, Vec<Option<u64>>) {
    let values = match &result.value {
        ResultValue::Number { value, .. } => vec![value.map(f64::to_bits)],
        ResultValue::List(values) => values.iter().map(|value| Some(value.to_bits())).collect(),
    };
    (result.name, values)
}

/// Verdict and reason of every condition.
fn decided(plan: &Plan, record: &Record) -> Vec<(verdict::Verdict, Option<String>)> {
    let requirements = verdict::assess(plan, record).requirements.into_iter();
    let conditions = requirements.flat_map(|requirement| requirement.conditions);
    conditions
        .map(|condition| (condition.verdict, condition.reason))
        .collect()
}

/// Compares both runs of a plan; gives the outcome.
fn compare(plan: &Plan, what: &str) -> Outcome {
    let (one, other) = (simulate(plan), recorded(plan));
    assert_eq!(one.outcome, other.outcome, "{what}");
    assert_eq!(one.events, other.events, "{what}");
    assert_eq!(one.procedures.len(), other.procedures.len(), "{what}");
    for (one, other) in one.procedures.iter().zip(&other.procedures) {
        let what = format!("{what}: {}", one.name);
        assert_eq!(one.complete, other.complete, "{what}");
        assert_eq!(one.inputs, other.inputs, "{what}");
        let [found, expected] =
            [one, other].map(|it| it.results.iter().map(bits).collect::<Vec<_>>());
        assert_eq!(found, expected, "{what}");
        match (&one.history, &other.history) {
            (History::Impact(one), History::Impact(other)) => {
                assert_eq!(one.ending, other.ending, "{what}");
                let [growing, expected] =
                    [one, other].map(|it| it.frame.as_ref().map(|frame| &frame.growing));
                assert_eq!(growing, expected, "{what}");
                assert_eq!(one.steps.last(), other.steps.last(), "{what}");
                assert!(one.steps.len() <= 2, "{what}");
            }
            (History::Shake(one), History::Shake(other)) => {
                assert_eq!(one.steps.last(), other.steps.last(), "{what}");
                assert!(one.steps.len() <= 2, "{what}");
            }
            _ => {}
        }
    }
    assert_eq!(decided(plan, &one), decided(plan, &other), "{what}");
    one.outcome
}

/// The largest absolute displacement and force of the steps of a run.
fn reach(plan: &Plan, record: &Record) -> [f64; 2] {
    let mut reach = [0.0_f64; 2];
    for procedure in &record.procedures {
        crate::procedures::readings(plan, &procedure.history, &mut |displacement, force| {
            for (reach, values) in reach.iter_mut().zip([displacement, force]) {
                let values = values.iter().map(|value| value.abs());
                *reach = values.fold(*reach, f64::max);
            }
        });
    }
    reach
}

/// Every example, and each with limits that stop it: of force, of displacement, of the increment.
#[test]
fn a_run_of_a_study_is_the_recorded_run() {
    let (mut completed, mut stopped) = (0, 0);
    for entry in std::fs::read_dir("../plans").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "psd") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let Some(mut plan) = check("plan.psd", &text, &folder, &Options::default()).plan else {
            continue;
        };
        plan.decision_rule = DecisionRule::ValueAlone;
        let name = path.display().to_string();
        let [displacement, force] = reach(&plan, &recorded(&plan));
        let within = |high: f64| Interval { low: -high, high };
        let mut variants = vec![(name.clone(), plan.clone())];
        let mut limited = plan.clone();
        limited.limits.force = within(0.5 * force);
        variants.push((format!("{name}, half of its force"), limited));
        let mut limited = plan.clone();
        limited.limits.displacement = within(0.5 * displacement);
        variants.push((format!("{name}, half of its displacement"), limited));
        let mut limited = plan.clone();
        limited.limits.increment.high = 0.02 * displacement;
        variants.push((format!("{name}, short increments"), limited));
        for (name, plan) in variants {
            match compare(&plan, &name) {
                Outcome::Completed => completed += 1,
                _ => stopped += 1,
            }
        }
    }
    assert!(completed >= 20 && stopped >= 10, "{completed}, {stopped}");
}

/// The weight and the height of a floor and the scale of a specimen, of a frame whose upper storey is computed. Run i is the recorded run
/// of the plan with its values.
#[test]
fn a_study_varies_a_weight_a_height_and_a_scale() {
    let text = "param load = 60 kN\nparam rise = 3 m\nparam lambda = 0.5\n\
        specimen frame { storeys = [\n\
        storey(mass: 2 t, height: rise, gravity: load, part: tested(scale: lambda, represents: 2), stiffness: 300 kN/m,\n\
        behaviour: bilinear(stiffness: 150 kN/m * lambda, yield_force: 0.5 kN * (lambda / 0.5) ^ 2, post_yield_ratio: 10 %)),\n\
        storey(mass: 1.5 t, height: 3 m, gravity: 40 kN, part: computed, behaviour: bilinear(200 kN/m, 3 kN, 10 %)) ] }\n\
        striker hammer { mass = 300 kg\nvelocity = 3 m/s }\n\
        impact hit { striker = hammer\nstorey = 2\nduration = 0.5 s\ntime_step = 5 ms\nintegrator = alpha_os(alpha: -0.05) }\n\
        require \"moves\" hit.max_base_shear > 1 N and hit.max_displacement > 1 mm";
    let varied = [
        ("load", Dimension::FORCE, 60e3),
        ("rise", Dimension::LENGTH, 3.0),
        ("lambda", Dimension::NUMBER, 0.5),
    ];
    let of_input = |(name, dimension, nominal): (&str, Dimension, f64)| Input {
        name: name.to_owned(),
        dimension,
        text: String::new(),
        nominal,
        is_record: false,
    };
    let scattered = |(_, _, nominal): (&str, Dimension, f64)| {
        Source::Distribution(Distribution::normal(nominal, Spread::Cv(0.05)).unwrap())
    };
    let studied = Studied::varied(
        text,
        20,
        Variation {
            inputs: varied.map(of_input).into(),
            sources: varied.map(scattered).into(),
            correlations: Vec::new(),
            ..variation()
        },
    );
    let definition = studied.definition();
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    let rows = simulation.block(0..20);
    let mut shears = Vec::new();
    for row in &rows {
        let settings = definition.inputs.iter().zip(&row.inputs);
        let settings: Vec<(String, String)> = settings
            .map(|(input, value)| {
                let setting = setting(&column(input), *value);
                let (name, value) = setting.split_once('=').unwrap();
                (name.to_owned(), value.trim_matches('"').to_owned())
            })
            .collect();
        let (_, plan) = checked(text, &settings);
        let storey = &plan.specimens[0].frame.as_ref().unwrap().storeys[0];
        let values = [
            storey.gravity,
            storey.height.unwrap(),
            storey.part.scale().displacement,
        ];
        assert_eq!(values, row.inputs[..]);
        assert_eq!(compare(&plan, &format!("{settings:?}")), Outcome::Completed);
        let kept = simulation.readout().read(&plan, &recorded(&plan));
        let bits = |results: &[Option<f64>]| -> Vec<Option<u64>> {
            results.iter().map(|it| it.map(f64::to_bits)).collect()
        };
        assert_eq!(bits(&kept.results), bits(&row.results), "{settings:?}");
        shears.push(row.results[0].unwrap());
    }
    shears.sort_by(f64::total_cmp);
    shears.dedup();
    assert_eq!(shears.len(), rows.len(), "the inputs change the results");
}

/// Allocations of a run of a study.
fn allocations(plan: &Plan) -> u64 {
    let info = allocation_counter::measure(|| {
        assert_eq!(simulate(plan).outcome, Outcome::Completed);
    });
    info.count_total
}

/// A longer run allocates as often as a shorter one.
#[test]
fn a_step_allocates_nothing() {
    let of_impact = |mut plan: Plan, duration: f64| {
        for procedure in &mut plan.procedures {
            if let ProcedureKind::Impact(impact) = &mut procedure.kind {
                impact.duration = Formula::Constant(duration);
                impact.until = psd_plan::Until::Duration;
            }
        }
        plan
    };
    let point = || {
        elastic_plan(
            300.0,
            vec![ProcedureKind::Impact(impact(Formula::Constant(300.0)))],
        )
    };
    let text = std::fs::read_to_string("../plans/fragility_two_storeys.psd").unwrap();
    let of_shake = |duration: &str| {
        let text = text.replace(
            "integrator    =",
            &format!("duration = {duration}\n  integrator ="),
        );
        let found = check("plan.psd", &text, &folder, &Options::default());
        found
            .plan
            .unwrap_or_else(|| panic!("{:?}", found.diagnostics))
    };
    let cases = [
        (
            "impact",
            [2.0, 6.0].map(|duration| of_impact(point(), duration)),
        ),
        (
            "impact on a storey",
            [2.0, 6.0].map(|duration| of_impact(struck_frame(), duration)),
        ),
        ("shake", ["2 s", "6 s"].map(of_shake)),
    ];
    for (name, [short, long]) in cases {
        assert_eq!(allocations(&short), allocations(&long), "{name}");
    }
}
