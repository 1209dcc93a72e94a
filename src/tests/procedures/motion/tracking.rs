//! Floors that follow sines on a virtual rig with known errors. Indicator, energy error, NRMS and peak of each axis are compared with
//! closed forms, in both modes. Some runs are held because of these values.

use crate::procedures::stepping::end_of_step::{AxesState, Balance, EndOfStep};
use crate::procedures::stepping::operator_stability_watch::StifferSprings;
use crate::procedures::stepping::setting::Start;
use crate::procedures::stepping::setting::Steps;
use crate::procedures::stepping::step_loop::{self, Stepped};
use crate::procedures::stepping::tracking::TrackingSummary;
use crate::run::Unwatched;
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::tests::testing::struck_frame;
use psd_physics::integrator::state::FrameState;
use psd_physics::structure::elements::ElementReading;
use psd_physics::structure::frame_properties::FrameProperties;
use psd_physics::structure::{Damping, FrameEnergies};
use psd_physics::tracking::monitor::Tracking;
use psd_plan::record::{NamedResult, Outcome};
use psd_plan::{Integrator, Interval, Link, Mode, Plan, ProcedureKind, Stepping, VirtualLink};
use psd_rig::{Reading, virtual_rig};

/// Largest command of each floor, m: within the elastic range of `struck_frame`.
const AMPLITUDES: [f64; 2] = [0.010, 0.018];
/// K of the frame \[N/m\].
const STIFFNESS: [[f64; 2]; 2] = [[800.0, -300.0], [-300.0, 300.0]];
/// Period of the sine \[s\].
const PERIOD: f64 = 2.0;
const CYCLES: u32 = 5;
/// Time scale of a continuous run.
const SCALE: f64 = 40.0;

/// Every floor follows A sin ωt, independent of the readings.
struct Sine {
    per_cycle: u32,
    state: FrameState,
    kept: Vec<Vec<Tracking>>,
}

impl Sine {
    fn angle(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "few steps")]
        let step = self.state.step as f64 + 1.0;
        std::f64::consts::TAU * step / f64::from(self.per_cycle)
    }
}

impl EndOfStep for &mut Sine {
    fn axes(&self) -> AxesState<'_> {
        AxesState::of(&self.state)
    }

    fn sum_up(&mut self) -> Balance {
        Balance {
            error: 0.0,
            input: 1.0,
        }
    }

    fn keep(&mut self, axes: &[Tracking], _: f64) {
        self.kept.push(axes.to_vec());
    }

    fn is_struck(&self) -> bool {
        false
    }
}

impl Stepped for &mut Sine {
    fn predict(&mut self, target: &mut [f64]) {
        let sine = self.angle().sin();
        target.copy_from_slice(&AMPLITUDES.map(|amplitude| amplitude * sine));
        self.state.target.copy_from_slice(target);
    }

    fn predicted_velocity(&mut self, velocity: &mut [f64]) -> bool {
        let rate = std::f64::consts::TAU / PERIOD * self.angle().cos();
        velocity.copy_from_slice(&AMPLITUDES.map(|amplitude| amplitude * rate));
        false
    }

    fn effective_force_at_start(&self, start: &Start) -> Vec<f64> {
        start.reading.force.clone()
    }

    fn effective_force(&self, force: &mut [f64]) {
        force.copy_from_slice(&self.state.restoring_force);
    }

    fn read_elements(&mut self, _: &[ElementReading]) {}

    fn complete(&mut self, reading: &Reading) {
        self.state.step += 1;
        self.state
            .measured_displacement
            .clone_from(&reading.displacement);
        self.state.restoring_force.clone_from(&reading.force);
    }

    fn cut_off(&mut self, _: &[f64], _: &Reading, _: f64, _: f64) {}

    fn over(&self) -> bool {
        false
    }
}

/// Monitor values of each axis after every step, from which a procedure forms its results.
fn followed(
    link: VirtualLink,
    mode: Mode,
    per_cycle: u32,
) -> (Vec<Vec<Tracking>>, TrackingSummary) {
    let mut plan = struck_frame();
    plan.rig.link = Link::Virtual(link);
    plan.limits.tracking_energy_error.high = 1e6;
    let properties =
        FrameProperties::of(plan.specimens[0].frame.as_ref().unwrap(), &Damping::None).unwrap();
    let time_step = PERIOD / f64::from(per_cycle);
    let steps = Steps {
        time_step,
        critical_time_step: time_step,
        count: u64::from(per_cycle * CYCLES),
        pause: 0.0,
        max_tangent_ratio: 1.0,
    };
    let ProcedureKind::Impact(impact) = &plan.procedures[0].kind else {
        panic!("another procedure")
    };
    let stepping = Stepping {
        mode,
        integrator: Integrator::Explicit,
        ..impact.stepping.clone()
    };
    let nothing = || vec![0.0; 2];
    let state = FrameState {
        step: 0,
        time: 0.0,
        displacement: nothing(),
        target: nothing(),
        measured_displacement: nothing(),
        velocity: nothing(),
        acceleration: nothing(),
        restoring_force: nothing(),
        force_at_computed: nothing(),
        gravity_force: Vec::new(),
        load: nothing(),
        storey_stiffness: Vec::new(),
        elements: Vec::new(),
        energies: FrameEnergies::default(),
    };
    let mut sine = Sine {
        per_cycle,
        state,
        kept: Vec::new(),
    };
    let (mut rig, mut observer, mut followed) =
        (virtual_rig(&plan), Unwatched, TrackingSummary::default());
    let Ok(mut session) = Session::begin(&plan, rig.as_mut(), &mut observer) else {
        panic!("no session")
    };
    let ran: Result<(), Stop> =
        step_loop::run(&steps, &stepping, &mut followed, &mut session, |start| {
            Ok((
                &mut sine,
                StifferSprings::of_storeys(&properties, &stepping, time_step, start),
            ))
        });
    ran.unwrap_or_else(|stop| panic!("{stop}"));
    (sine.kept, followed)
}

/// Contribution of the last cycle in steady state, and its expected value. The floors follow B sin(ωt − φ), B = gain·A. Per axis: energy
/// error, indicator, mean square error over ½A². For a sine read at N points, the trapezoidal rule gives ∮ B sin(θ − φ) d(A sin θ) = −πAB
/// sin φ · sin(2π/N)/(2π/N).
fn last_cycle(
    kept: &[Vec<Tracking>],
    per_cycle: u32,
    (gain, phase): (f64, f64),
) -> Vec<([f64; 3], [f64; 3])> {
    let (before, after) = (
        &kept[((CYCLES - 1) * per_cycle) as usize],
        &kept[(CYCLES * per_cycle) as usize],
    );
    let step = std::f64::consts::TAU / f64::from(per_cycle);
    let area = |size: f64, amplitude: f64| {
        -std::f64::consts::PI * size * amplitude * phase.sin() * step.sin() / step
    };
    let axis = |floor: usize| {
        let amplitude = AMPLITUDES[floor];
        let force: f64 = STIFFNESS[floor]
            .iter()
            .zip(AMPLITUDES)
            .map(|(stiffness, other)| stiffness * gain * other)
            .sum();
        let squares = |cycles: u32, axis: &Tracking| axis.nrms_error.powi(2) * f64::from(cycles);
        let found = [
            after[floor].energy_error - before[floor].energy_error,
            after[floor].indicator - before[floor].indicator,
            squares(CYCLES, &after[floor]) - squares(CYCLES - 1, &before[floor]),
        ];
        let error = 1.0 - 2.0 * gain * phase.cos() + gain * gain;
        (
            found,
            [
                area(force, amplitude),
                area(gain * amplitude, amplitude),
                error,
            ],
        )
    };
    (0..AMPLITUDES.len()).map(axis).collect()
}

fn worst(pairs: &[([f64; 3], [f64; 3])]) -> f64 {
    let apart = |(found, exact): &([f64; 3], [f64; 3])| {
        found
            .iter()
            .zip(exact)
            .map(|(found, exact)| (found / exact - 1.0).abs())
            .fold(0.0, f64::max)
    };
    pairs.iter().map(apart).fold(0.0, f64::max)
}

fn list(results: &[NamedResult], name: &str) -> Vec<f64> {
    match results
        .iter()
        .find(|result| result.name == name)
        .map(|result| &result.value)
    {
        Some(psd_plan::formula::ResultValue::List(values)) => values.clone(),
        other => panic!("{name}: {other:?}"),
    }
}

/// Each increment misses its target by a fraction t, measured from the present position of the actuator: x₁ = (1 − t)d₁ + t·x₀. Its gain
/// on a sine is (1 − t)/(1 − t·e^(−iωΔt)), to rounding.
#[test]
fn a_missed_fraction_of_each_increment_shows_as_in_the_closed_form() {
    for missed in [0.2, -0.2] {
        let per_cycle = 40;
        let link = VirtualLink {
            tracking: missed,
            ..VirtualLink::default()
        };
        let (kept, followed) = followed(link, Mode::RampAndHold, per_cycle);
        let step = std::f64::consts::TAU / f64::from(per_cycle);
        let (real, imaginary) = (1.0 - missed * step.cos(), missed * step.sin());
        let (gain, phase) = (
            (1.0 - missed) / real.hypot(imaginary),
            imaginary.atan2(real),
        );
        let pairs = last_cycle(&kept, per_cycle, (gain, phase));
        assert!(worst(&pairs) < 1e-9, "{missed}: {pairs:?}");
        // A result shows the end of the run. With undershoot, the error grows to the steady one, which is sampled. With overshoot, the
        // first error is the largest.
        let results = followed.of_each();
        let error = (1.0 - 2.0 * gain * phase.cos() + gain * gain).sqrt();
        for floor in 0..2 {
            let last = &kept[kept.len() - 1][floor];
            assert_eq!(
                list(&results, "floor_tracking_indicator")[floor],
                last.indicator
            );
            let peak = if missed > 0.0 {
                error
            } else {
                -missed * step.sin()
            };
            assert!(
                (list(&results, "floor_peak_error")[floor] / AMPLITUDES[floor] / peak - 1.0).abs()
                    < 4e-3
            );
            assert!((list(&results, "floor_nrms_error")[floor] / error - 1.0).abs() < 0.01);
            // Relative to an input of 1 J.
            assert!(
                (list(&results, "floor_tracking_energy_error")[floor] / last.energy_error - 1.0)
                    .abs()
                    < 0.2
            );
            assert_eq!(
                last.energy_error < 0.0,
                missed > 0.0,
                "falling short feeds energy in"
            );
        }
        let [energy, indicator, ..] = followed.of_all();
        let of = |value: &NamedResult| match value.value {
            psd_plan::formula::ResultValue::Number {
                value: Some(value), ..
            } => value,
            _ => panic!("{value:?}"),
        };
        let summed: f64 = kept[kept.len() - 1].iter().map(|axis| axis.indicator).sum();
        assert_eq!(of(&indicator), summed);
        assert_eq!(Some(of(&energy)), followed.worst());
    }
}

/// A lag τ in continuous mode is τ/scale of simulated time: gain cos φ, φ = atan(ωτ/scale), to the order of the paths between the
/// readings.
#[test]
fn a_lag_during_the_motion_shows_as_in_the_closed_form() {
    let lag = 2.0;
    let apart = |per_cycle: u32| {
        let link = VirtualLink {
            lag,
            ..VirtualLink::default()
        };
        let (kept, _) = followed(link, Mode::Continuous { time_scale: SCALE }, per_cycle);
        let phase = (std::f64::consts::TAU / PERIOD * lag / SCALE).atan();
        let pairs = last_cycle(&kept, per_cycle, (phase.cos(), phase));
        assert!(
            pairs
                .iter()
                .all(|(found, _)| found[0] < 0.0 && found[1] < 0.0),
            "{pairs:?}"
        );
        worst(&pairs)
    };
    let (coarse, fine) = (apart(40), apart(80));
    assert!(fine < 1e-4 && coarse / fine > 4.0, "{coarse} and {fine}");
}

/// On hold in both modes, because of the axis with the largest NRMS error if the plan limits it.
#[test]
fn tracking_error_holds_an_impact_on_a_storey_in_both_modes() {
    let struck = |mode: Mode, link: VirtualLink, limit: fn(&mut Plan)| {
        let mut plan = struck_frame();
        plan.rig.link = Link::Virtual(link);
        limit(&mut plan);
        if let ProcedureKind::Impact(impact) = &mut plan.procedures[0].kind {
            impact.stepping.mode = mode;
        }
        crate::run::run(&plan, virtual_rig(&plan).as_mut(), &mut Unwatched).outcome
    };
    let lagging = VirtualLink {
        lag: 2.0,
        ..VirtualLink::default()
    };
    let short = VirtualLink {
        tracking: 0.6,
        ..VirtualLink::default()
    };
    let continuous = Mode::Continuous { time_scale: SCALE };
    for (mode, link) in [(continuous, lagging), (Mode::RampAndHold, short)] {
        let energy = struck(mode, link, |plan| {
            plan.limits.tracking_energy_error = Interval {
                low: 0.0,
                high: 0.03,
            }
        });
        assert!(
            matches!(&energy, Outcome::Aborted { reason } if reason.contains("tracking energy")),
            "{mode:?}: {energy:?}"
        );
        let nrms = struck(mode, link, |plan| {
            plan.limits.tracking_energy_error.high = 1e6;
            plan.limits.nrms_error.high = 0.01;
        });
        assert!(
            matches!(&nrms, Outcome::Aborted { reason } if reason.contains("NRMS")),
            "{mode:?}: {nrms:?}"
        );
        assert_eq!(
            struck(mode, link, |plan| plan.limits.tracking_energy_error.high =
                1e6),
            Outcome::Completed
        );
    }
}
