//! What a `stiffness ramp` reads directly, beside its fits, and what the calibration of the rig and the errors of its readings make of
//! it. In: the readings of the ramp. Out: forces, displacements, secants and the energy of its loops, and what each source contributes:
//! they are reckoned again from readings with one source moved at a time, by ±u, and from readings with drawn errors. It fits nothing.

use super::propagation::quanta;
use super::results::largest;
use super::samples::mean;
use super::stiffness_ramp::{Point, point, secant};
use super::study::{draws_of, give};
use crate::formula::{ProcedureId, ResultValue};
use crate::mechanics::identification::loop_energy;
use crate::mechanics::noisy_largest::NoisyLargest;
use crate::mechanics::recorded_path::Noise;
use crate::plan::{Plan, StiffnessRamp};
use crate::record::{NamedResult, RampStep};
use crate::rig::DeclaredNoise;
use crate::uncertainty::{Contribution, Source};

/// What is read directly.
pub(super) const DIRECT: [&str; 6] =
    ["secant_stiffness", "max_force", "max_displacement", "loop_energy", "relaxation", "tangent_stiffness"];

/// Those of which two readings alone tell: `secant_doubts` knows them.
const OF_TWO_READINGS: [&str; 2] = ["secant_stiffness", "tangent_stiffness"];

/// A ramp as it was read.
#[derive(Clone)]
pub(super) struct Readings {
    /// Before the first increment of each repeat.
    pub starts: Vec<Point>,
    pub steps: Vec<RampStep>,
}

impl Readings {
    /// In the order of [`DIRECT`]; None of what there is not. `noise` is that of one reading of the cell, N.
    pub(super) fn direct(&self, plan: &StiffnessRamp, noise: f64) -> [Option<f64>; DIRECT.len()] {
        let Self { starts, steps } = self;
        let targets = plan.displacements.len();
        let a_repeat = if plan.return_path { 2 * targets } else { targets };
        let last = steps.iter().rposition(|step| !step.returning);
        let before = last.filter(|last| last % a_repeat != 0).map(|last| point(&steps[last - 1]));
        let tangent = before.zip(last).and_then(|(before, last)| secant(before, point(&steps[last])));
        let sizes = steps.iter().map(|step| step.restoring_force.abs());
        let first_secant = starts.first().zip(steps.first()).and_then(|(start, step)| secant(*start, point(step)));
        let whole = steps.chunks_exact(a_repeat.max(1)).zip(starts).filter(|_| plan.return_path);
        let loops: Vec<f64> = whole
            .map(|(steps, start)| {
                let (x, r): (Vec<f64>, Vec<f64>) = std::iter::once(*start).chain(steps.iter().map(point)).unzip();
                loop_energy(&x, &r)
            })
            .collect();
        [
            first_secant,
            NoisyLargest::of(noise / f64::from(plan.samples.max(1)).sqrt(), sizes).value(),
            largest(steps.iter().map(|step| step.displacement)),
            (!loops.is_empty()).then(|| mean(loops.iter().copied())),
            (!steps.is_empty()).then(|| mean(steps.iter().map(|step| step.relaxation))),
            tangent,
        ]
    }

    /// As a cell of another factor and zero (N), and a transducer of another factor, would have read them.
    fn by_another(&self, force: f64, zero: f64, displacement: f64) -> Self {
        let mut other = self.clone();
        for (x, r) in &mut other.starts {
            (*x, *r) = (displacement * *x, force * *r + zero);
        }
        for step in &mut other.steps {
            step.displacement *= displacement;
            step.restoring_force = force * step.restoring_force + zero;
            step.relaxation *= force;
        }
        other
    }

    /// With drawn errors of standard deviation (N, m): of a reading alone, and of the mean at a step. Signs only, so that few draws do.
    fn erring(&self, draw: u16, alone: (f64, f64), averaged: (f64, f64)) -> Self {
        let mut other = self.clone();
        let noise = |(force, displacement)| Noise { force, displacement, draw };
        for (repeat, (x, r)) in (0_u64..).zip(&mut other.starts) {
            let [force, displacement] = noise(alone).errors(repeat, 1);
            (*x, *r) = (*x + displacement, *r + force);
        }
        for step in &mut other.steps {
            let [force, displacement] = noise(averaged).errors(step.step, 0);
            let [settled, _] = noise(alone).errors(step.step, 2);
            step.displacement += displacement;
            step.restoring_force += force;
            step.relaxation += settled - force;
        }
        other
    }
}

/// Gives what was read directly its contributions.
pub(super) fn propagate(
    readings: &Readings,
    plan: &StiffnessRamp,
    (whole, declared): (&Plan, DeclaredNoise),
    procedure: ProcedureId,
    told: &mut [NamedResult],
) {
    let calibration = &whole.rig.calibration_of(0);
    let (force, zero, displacement) = (calibration.force_uncertainty, calibration.zero(), calibration.displacement_uncertainty);
    let values = |readings: &Readings, noise| readings.direct(plan, noise).map(|value| value.unwrap_or(f64::NAN));
    let nominal = values(readings, declared.force);
    let mut contributions: Vec<Vec<Contribution>> = vec![Vec::new(); DIRECT.len()];
    let sources = [
        (Source::ForceScale(0), force, [force, 0.0, 0.0]),
        (Source::DisplacementScale(0), displacement, [0.0, 0.0, displacement]),
        (Source::ForceZero(0), zero, [0.0, zero, 0.0]),
    ];
    for (source, _, [force, zero, displacement]) in sources.into_iter().filter(|(_, uncertainty, _)| *uncertainty > 0.0) {
        let up = values(&readings.by_another(1.0 + force, zero, 1.0 + displacement), declared.force);
        let down = values(&readings.by_another(1.0 - force, -zero, 1.0 - displacement), declared.force);
        for (parts, (up, down)) in contributions.iter_mut().zip(up.into_iter().zip(down)) {
            parts.push(Contribution::new(source, 0.5 * (up - down)));
        }
    }
    let quanta = quanta(whole, declared, 0);
    // What rounds does so alike at one place: the mean of many readings keeps it.
    let rounding = 12.0_f64.sqrt();
    let of = |samples: f64| ((quanta.noise / samples.sqrt()).hypot(quanta.force / rounding), quanta.displacement / rounding);
    let (alone, averaged) = (of(1.0), of(f64::from(plan.samples.max(1))));
    if alone.0 > 0.0 || alone.1 > 0.0 {
        let draws = draws_of(readings.steps.len() as u64);
        for draw in 0..draws {
            let found = values(&readings.erring(draw, alone, averaged), quanta.noise);
            for ((parts, found), nominal) in contributions.iter_mut().zip(found).zip(nominal) {
                let amount = (found - nominal) / f64::from(draws).sqrt();
                parts.push(Contribution::new(Source::Readings { procedure, draw }, amount));
            }
        }
    }
    for (name, parts) in DIRECT.into_iter().zip(contributions).filter(|(name, _)| !OF_TWO_READINGS.contains(name)) {
        if let Some(result) = told.iter_mut().find(|result| result.name == name)
            && matches!(result.value, ResultValue::Number { value: Some(_), .. })
        {
            give(result, parts);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::formula::Formula::Constant;
    use crate::plan::{Behaviour, Calibration, Link, ProcedureKind, StiffnessRamp, VirtualLink};
    use crate::run::testing::{elastic_plan, number, ramp, run_unwatched};
    use crate::uncertainty::Source;

    const STIFFNESS: f64 = 1000.0;

    fn record(link: VirtualLink, calibration: Calibration, samples: u32) -> crate::record::Record {
        let out = StiffnessRamp { return_path: true, samples, pause: Constant(0.1), ..ramp(2e-3) };
        let mut plan = elastic_plan(STIFFNESS, vec![ProcedureKind::StiffnessRamp(out)]);
        plan.specimens[0].behaviour = Some(Behaviour::Bilinear { stiffness: STIFFNESS, yield_force: 10.0, hardening: 0.1 });
        plan.rig.link = Link::Virtual(link);
        plan.rig.calibration = calibration;
        run_unwatched(&plan)
    }

    /// F goes with the cell, X with the transducer, a slope with their ratio, a loop with their product; a zero shifts forces alone.
    #[test]
    fn a_calibration_reaches_what_is_read_by_its_powers() {
        let calibration = Calibration {
            force_uncertainty: 0.02,
            displacement_uncertainty: 0.01,
            zero_uncertainty: 0.4,
            ..Calibration::default()
        };
        let record = record(VirtualLink::default(), calibration, 1);
        for (name, [force, displacement], zero) in [
            ("secant_stiffness", [1.0, -1.0], 0.0),
            ("max_force", [1.0, 0.0], 0.4),
            ("max_displacement", [0.0, 1.0], 0.0),
            ("loop_energy", [1.0, 1.0], 0.0),
            ("tangent_stiffness", [1.0, -1.0], 0.0),
        ] {
            let (value, u) = number(&record, 0, name);
            let value = value.unwrap();
            let parts = &record.procedures[0].result(name).unwrap().contributions;
            let of = |source| parts.iter().find(|part| part.source == source).map_or(0.0, |part| part.amount);
            let by_hand = [0.02 * force * value, 0.01 * displacement * value, zero];
            for (source, by_hand) in
                [Source::ForceScale(0), Source::DisplacementScale(0), Source::ForceZero(0)].into_iter().zip(by_hand)
            {
                assert!((of(source) - by_hand).abs() < 2e-4 * 0.02 * value.abs() + 1e-9, "{name}: {}, {by_hand}", of(source));
            }
            let all = by_hand.iter().map(|part| part * part).sum::<f64>().sqrt();
            assert!((u.unwrap() / all - 1.0).abs() < 1e-3, "{name}");
        }
    }

    /// Noise σ of a cell, n samples: σ/√n on a largest force, σ√(1 + 1/n) on a first secant over its increment, σ√(2/n) on a tangent,
    /// σ√((1 + 1/n)/N) on the mean relaxation of N pauses.
    #[test]
    fn noise_reaches_what_is_read_by_its_weights() {
        let (noise, samples, step) = (0.05, 4, 2e-3);
        let record = record(VirtualLink { noise, seed: 3, ..VirtualLink::default() }, Calibration::default(), samples);
        let n = f64::from(samples);
        for (name, by_hand) in [
            ("max_force", noise / n.sqrt()),
            ("secant_stiffness", noise * (1.0 + 1.0 / n).sqrt() / step),
            ("tangent_stiffness", noise * (2.0 / n).sqrt() / step),
            ("relaxation", noise * ((1.0 + 1.0 / n) / 20.0).sqrt()),
        ] {
            let u = number(&record, 0, name).1.unwrap();
            assert!((u / by_hand - 1.0).abs() < 3.0 / 128.0_f64.sqrt(), "{name}: {u}, by hand {by_hand}");
        }
        // Nothing was rounded of the displacements, and nothing calibrated.
        assert_eq!(number(&record, 0, "max_displacement").1, None);
    }

    /// Sixty readings of a force that stays: the largest of them is 2.3σ too large, and of sixty runs U would hold two.
    #[test]
    fn the_largest_of_many_noisy_readings_is_that_of_the_force() {
        let (noise, mut sum, mut held) = (4.0, 0.0, 0);
        for seed in 1..=60 {
            let displacements = (1..=60).map(|index| Constant(5e-4 * f64::from(index))).collect();
            let mut plan =
                elastic_plan(STIFFNESS, vec![ProcedureKind::StiffnessRamp(StiffnessRamp { displacements, ..ramp(1.0) })]);
            plan.specimens[0].behaviour = Some(Behaviour::Bilinear { stiffness: 9e4, yield_force: 420.0, hardening: 0.0 });
            plan.rig.link = Link::Virtual(VirtualLink { noise, seed, ..VirtualLink::default() });
            let (value, u) = number(&run_unwatched(&plan), 0, "max_force");
            let error = value.unwrap() - 420.0;
            sum += error / 60.0;
            held += u32::from(error.abs() <= 2.0 * u.unwrap());
        }
        assert!(sum.abs() < 3.0 * noise / 60.0_f64.sqrt(), "{sum} N off on the average");
        assert!(held >= 53, "{held} of 60");
    }

    /// A line through a yielding ramp is the stiffness of nothing, and says so; through a straight one, and one that noise bends, not.
    #[test]
    fn a_line_through_a_bend_is_remarked_on() {
        let says = |behaviour, noise| {
            let mut plan = elastic_plan(STIFFNESS, vec![ProcedureKind::StiffnessRamp(ramp(2e-3))]);
            plan.specimens[0].behaviour = Some(behaviour);
            plan.rig.link = Link::Virtual(VirtualLink { noise, seed: 9, ..VirtualLink::default() });
            run_unwatched(&plan).events.iter().any(|event| event.text.starts_with("the outward steps bend near"))
        };
        for noise in [0.0, 0.1] {
            assert!(says(Behaviour::Bilinear { stiffness: STIFFNESS, yield_force: 10.0, hardening: 0.05 }, noise));
            assert!(!says(Behaviour::Elastic { stiffness: STIFFNESS }, noise));
        }
    }
}
