//! What an actuator that misses its targets would do to an impact, or to each mode of a frame: the growth of its amplitude,
//! foretold by closed forms, and the energy, foretold step by step. In: what the rig declares, the steps of a dry run. Out:
//! rows of text.
//!
//! A place that is late by D of virtual time is felt as the damper −K·D, and an amplitude grows by exp(πωD) a cycle to the first
//! order of ωΔt; what is told is the growth to every order, of the integrator that runs (`mechanics::growth`). The time that a move
//! takes, and so what an actuator with a pause lags behind by, goes with its increment: the mean of all steps counts, as the energy of
//! a vibration weighs them, by their increments squared. What lies inside the settling band or a quantum may be against the motion at
//! every step: δ in all, and an amplitude A grows by 4δ a cycle, at worst, and what it grew by grows on.

use crate::check::tracking;
use crate::mechanics::growth::{Following, Lag, Mode as Vibration};
use crate::plan::{Impact, Integrator, Link, Mode, Plan, Shake, Stepping, StoreyImpact, VIRTUAL_SPEED};
use crate::quantity::Dimension;
use crate::quantity::display::{minus, readable, significant};
use crate::record::{Floors, ImpactHistory, Modes, ProcedureRecord, ShakeHistory, StoreyImpactHistory};

/// What is foretold of one impact; nothing where the rig declares nothing that it misses.
pub(super) fn rows(plan: &Plan, impact: &Impact, procedure: &ProcedureRecord, history: &ImpactHistory) -> Vec<Vec<String>> {
    let commands: Vec<[f64; 1]> = history.steps.iter().map(|step| [step.command]).collect();
    let following = following(plan, &impact.stepping, history.time_step, commands.iter().map(<[f64; 1]>::as_slice));
    let (late, unsettled) = (late(following, history.time_step), uncertain(plan, impact.stepping.mode));
    let input = |name: &str| procedure.inputs.iter().find(|(field, ..)| *field == name).map(|(_, estimate, _)| estimate.value);
    let (Some(mass), Some(stiffness)) = (input("mass"), input("stiffness")) else { return Vec::new() };
    let amplitude = history.steps.iter().map(|step| step.computed.abs()).fold(0.0, f64::max);
    let last = history.steps.last().map_or(0.0, |step| step.time);
    if (late == 0.0 && unsettled == 0.0) || amplitude == 0.0 {
        return Vec::new();
    }
    if impact.stepping.i_modification {
        return vec![vec!["growth by tracking".to_owned(), CORRECTED.to_owned()]];
    }
    let omega = (stiffness / mass).sqrt();
    let damping_ratio = input("damping").unwrap_or(0.0) / (2.0 * (stiffness * mass).sqrt());
    let growth =
        Growth::of(following, impact.stepping.integrator, (omega, history.time_step), damping_ratio, unsettled / amplitude);
    let cycles = last * omega / std::f64::consts::TAU;
    vec![
        late_by(late, unsettled),
        vec![
            "growth by tracking".to_owned(),
            format!(
                "amplitude ×{} a cycle, ×{} in the {} cycles of the run, at worst",
                significant(growth.over(1.0), 4),
                significant(growth.over(cycles), 4),
                significant(cycles, 2)
            ),
        ],
    ]
}

/// How an amplitude grows.
#[derive(Clone, Copy)]
struct Growth {
    /// ln of it, a cycle.
    a_cycle: f64,
    /// δ over the amplitude.
    relative: f64,
}

impl Growth {
    /// Of a mode of ω (rad/s), in steps of Δt (s).
    fn of(
        following: Following,
        integrator: Integrator,
        (omega, time_step): (f64, f64),
        damping_ratio: f64,
        relative: f64,
    ) -> Self {
        let vibration = Vibration { angle: omega * time_step, damping_ratio, operator: 1.0, i_modification: false };
        // A mode that the steps do not resolve grows as slow ones do.
        let slowly = || std::f64::consts::PI * vibration.angle * following.delay();
        Self { a_cycle: following.growth(integrator, &vibration).unwrap_or_else(slowly), relative }
    }

    /// Factor over so many cycles n: A' = ln g·A + 4δ a cycle, gⁿ + 4δ(gⁿ − 1)/ln g.
    fn over(self, cycles: f64) -> f64 {
        let exponent = self.a_cycle * cycles;
        let each = if exponent.abs() < 1e-12 { cycles } else { exponent.exp_m1() / self.a_cycle };
        exponent.exp() + 4.0 * self.relative * each
    }
}

/// The same of a frame on moving ground.
pub(super) fn shake_rows(plan: &Plan, shake: &Shake, history: &ShakeHistory) -> Vec<Vec<String>> {
    let modes = (history.modes.as_ref(), history.damping_ratios.as_slice());
    frame_rows(plan, &shake.stepping, history.time_step, modes, &history.steps)
}

/// The same of a frame that is struck.
pub(super) fn storey_rows(plan: &Plan, impact: &StoreyImpact, history: &StoreyImpactHistory) -> Vec<Vec<String>> {
    let modes = (history.modes.as_ref(), history.damping_ratios.as_slice());
    frame_rows(plan, &impact.stepping, history.blow.time_step, modes, &history.floors)
}

/// What a delay is to each mode, and how the largest displacement may grow in it. Beside it stands the damping of the mode, which
/// works the other way.
fn frame_rows<S: Floors>(
    plan: &Plan,
    stepping: &Stepping,
    time_step: f64,
    (modes, ratios): (Option<&Modes>, &[f64]),
    steps: &[S],
) -> Vec<Vec<String>> {
    let following = following(plan, stepping, time_step, steps.iter().map(S::command));
    let (late, unsettled) = (late(following, time_step), uncertain(plan, stepping.mode));
    let amplitude = steps.iter().flat_map(S::computed).map(|place| place.abs()).fold(0.0, f64::max);
    let Some(modes) = modes.filter(|_| (late != 0.0 || unsettled != 0.0) && amplitude > 0.0) else {
        return Vec::new();
    };
    if stepping.i_modification {
        return vec![vec!["growth by tracking".to_owned(), CORRECTED.to_owned()]];
    }
    let mut rows = vec![late_by(late, unsettled)];
    for (mode, period) in modes.periods.iter().enumerate() {
        let omega = modes.angular_frequency(mode);
        let damping = ratios.get(mode).copied().unwrap_or(0.0);
        let growth = Growth::of(following, stepping.integrator, (omega, time_step), damping, unsettled / amplitude);
        let percent = |ratio: f64| format!("{} %", minus(&significant(100.0 * ratio, 3)));
        rows.push(vec![
            if mode == 0 { "growth by tracking".to_owned() } else { String::new() },
            format!(
                "mode {}, {}: amplitude ×{} a cycle at worst, as a damping ratio of {}; its own is {}",
                mode + 1,
                readable(*period, Dimension::TIME),
                significant(growth.over(1.0), 4),
                percent(-growth.over(1.0).ln() / std::f64::consts::TAU),
                percent(damping),
            ),
        ]);
    }
    rows
}

/// What tracking is to make of the energy of a run, from the share that the rig misses of its increments.
pub(super) fn energy(plan: &Plan, procedure: usize) -> Vec<Vec<String>> {
    let Some(tracking::Forecast { foretold, .. }) = tracking::foretold(plan, procedure) else { return Vec::new() };
    let share = significant(100.0 * foretold.share.abs(), 2);
    let does = if foretold.share < 0.0 { "put in" } else { "taken out" };
    let held = foretold.passed.map_or_else(String::new, |time| format!("; held at about {}", readable(time, Dimension::TIME)));
    vec![vec!["energy by tracking".to_owned(), format!("up to {share} % of the input {does}{held}")]]
}

const CORRECTED: &str = "none to first order: the I-modification corrects the force to the target";

fn late_by(late: f64, unsettled: f64) -> Vec<String> {
    let either_way = if unsettled > 0.0 { format!(", ± {}", readable(unsettled, Dimension::LENGTH)) } else { String::new() };
    vec!["late by".to_owned(), format!("{} of virtual time{either_way}", readable(late, Dimension::TIME))]
}

/// How the actuators of the rig follow targets (m) that go so.
fn following<'a>(plan: &Plan, stepping: &Stepping, time_step: f64, targets: impl Iterator<Item = &'a [f64]>) -> Following {
    let none = Lag::Paused { behind: 0.0, carried: 0.0 };
    let Link::Virtual(link) = &plan.rig.link else { return Following { short: 0.0, lag: none } };
    let lag = match stepping.mode {
        Mode::Continuous { time_scale } => Lag::Gliding { steps: link.lag / (time_scale * time_step) },
        Mode::StepAndPause if link.lag > 0.0 && plan.rig.settle.band == 0.0 => {
            let pause = stepping.pause.constant().unwrap_or(0.0);
            let speed = Some(plan.limits.speed.high).filter(|speed| speed.is_finite()).unwrap_or(VIRTUAL_SPEED);
            paused(link.lag, pause, speed, targets)
        }
        Mode::StepAndPause => none,
    };
    Following { short: link.tracking, lag }
}

/// Behind and carried, by the squares of the increments. All axes arrive at once, the one with the longest way at `speed` (m/s).
fn paused<'a>(lag: f64, pause: f64, speed: f64, targets: impl Iterator<Item = &'a [f64]>) -> Lag {
    let (mut before, mut sums): (Option<&[f64]>, [f64; 3]) = (None, [0.0; 3]);
    for targets in targets {
        let ways = before.into_iter().flatten().zip(targets).map(|(from, to)| (to - from).abs());
        let (weight, longest) = ways.fold((0.0, 0.0_f64), |(sum, most), way| (sum + way * way, most.max(way)));
        let (moving, rest) = (longest / (speed * lag), (-pause / lag).exp());
        if moving > 0.0 {
            let behind = -(-moving).exp_m1() / moving;
            for (sum, part) in sums.iter_mut().zip([1.0, behind * rest, (-moving).exp() * rest]) {
                *sum += weight * part;
            }
        }
        before = Some(targets);
    }
    let [all, behind, carried] = sums;
    if all > 0.0 {
        Lag::Paused { behind: behind / all, carried: carried / all }
    } else {
        Lag::Paused { behind: 0.0, carried: 0.0 }
    }
}

/// D, s of virtual time.
fn late(following: Following, time_step: f64) -> f64 {
    if following.short < 1.0 { time_step * following.delay() } else { f64::INFINITY }
}

/// δ, m: what settling lets pass, and half a quantum.
fn uncertain(plan: &Plan, mode: Mode) -> f64 {
    let resolution = match &plan.rig.link {
        Link::Virtual(link) => link.resolution,
        Link::Real(link) => link.readings.resolution,
    };
    let lags = plan.rig.link.as_virtual().is_none_or(|link| link.lag > 0.0);
    let settles = lags && mode == Mode::StepAndPause;
    0.5 * resolution + if settles { plan.rig.settle.band } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OMEGA: f64 = 4.0 * std::f64::consts::PI;

    /// Published, of ten cycles of fifty steps: behind by δ = 2 % of A an amplitude is ×1.7856 in the last of them. 4δ a cycle is the most
    /// that it can be, and what is missing of it falls with the step.
    #[test]
    fn a_band_against_the_motion_is_the_most_it_can_be() {
        let told = Growth { a_cycle: 0.0, relative: 0.02 }.over(10.0);
        assert!(told > 1.7856 && told < 1.01 * 1.7856, "{told}");
        let growing = Growth { a_cycle: 0.05, relative: 0.02 };
        // One cycle after the other.
        let mut amplitude = 1.0;
        for _ in 0..10_000 {
            amplitude += (growing.a_cycle * amplitude + 4.0 * growing.relative) * 1e-3;
        }
        assert!((growing.over(10.0) / amplitude - 1.0).abs() < 1e-3, "{amplitude}, told {}", growing.over(10.0));
    }

    /// The mean of steps by their increments squared: one long one of T = τ/2 and a hundred that are so short that they lag wholly.
    #[test]
    fn long_steps_weigh_most() {
        let mut targets = vec![[0.0], [1e-3]];
        targets.extend((0..100).map(|step| [1e-3 + 1e-9 * f64::from(step)]));
        let Lag::Paused { behind, carried } = paused(2.0, 1.0, 1e-3, targets.iter().map(<[f64; 1]>::as_slice)) else { panic!() };
        let (half, rest): (f64, f64) = ((-0.5_f64).exp(), (-0.5_f64).exp());
        assert!((behind - 2.0 * (1.0 - half) * rest).abs() < 1e-6 && (carried - half * rest).abs() < 1e-6);
        let gone = Growth::of(
            Following { short: 0.0, lag: Lag::Paused { behind, carried } },
            Integrator::Explicit,
            (OMEGA, 1e-5),
            0.0,
            0.0,
        );
        let first = std::f64::consts::PI * OMEGA * 1e-5 * behind / (1.0 - carried);
        assert!((gone.a_cycle / first - 1.0).abs() < 1e-3);
    }
}
