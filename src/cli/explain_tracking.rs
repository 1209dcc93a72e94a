//! What an actuator that misses its targets would do to an impact, or to each mode of a frame: the growth of its amplitude,
//! foretold by closed forms, and the energy, foretold step by step. In: what the rig declares, the steps of a dry run. Out:
//! rows of text.
//!
//! A place that is late by D of virtual time is felt as the damper −K·D, and an amplitude grows by exp(πωD) a cycle. An
//! actuator that falls short of its increments by the share t, which it takes from where it stands, is late by D =
//! Δt·t/(1 − t); one with the lag τ that moves for T and rests for P before it is read, by Δt·(τ/T)(1 − e^(−T/τ))e^(−P/τ); in
//! continuous mode by τ over the time scale. What lies inside the settling band or a quantum may be against the motion at
//! every step: δ in all, and an amplitude A grows by 4δ a cycle, at worst. (The published numbers are those of ten cycles at 50
//! steps: 10 % short ×1.55, δ = 2 % of A ×1.79.)

use crate::check::tracking;
use crate::plan::{Impact, Link, Mode, Plan, Shake, Stepping, StoreyImpact};
use crate::quantity::Dimension;
use crate::quantity::display::{minus, readable, significant};
use crate::record::{Floors, ImpactHistory, Modes, ProcedureRecord, ShakeHistory, StoreyImpactHistory};

/// What is foretold of one impact; nothing where the rig declares nothing that it misses.
pub(super) fn rows(plan: &Plan, impact: &Impact, procedure: &ProcedureRecord, history: &ImpactHistory) -> Vec<Vec<String>> {
    let pause = impact.stepping.pause.constant().unwrap_or(0.0);
    let ends = history.steps.first().zip(history.steps.last());
    let wall = ends.map_or(0.0, |(first, last)| last.wall_time - first.wall_time);
    let run = Ran {
        mode: impact.stepping.mode,
        pause,
        time_step: history.time_step,
        wall,
        steps: ends.map_or(0, |(_, last)| last.step),
    };
    let (late, unsettled) = (delay(plan, &run), uncertain(plan, impact.stepping.mode));
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
    let growth = Growth { omega: (stiffness / mass).sqrt(), late, relative: unsettled / amplitude };
    let cycles = last * growth.omega / std::f64::consts::TAU;
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
    /// rad/s
    omega: f64,
    /// s
    late: f64,
    /// δ over the amplitude.
    relative: f64,
}

impl Growth {
    /// Factor over so many cycles.
    fn over(self, cycles: f64) -> f64 {
        (std::f64::consts::PI * self.omega * self.late * cycles).exp() + 4.0 * self.relative * cycles
    }
}

/// The same of a frame on moving ground.
pub(super) fn shake_rows(plan: &Plan, shake: &Shake, history: &ShakeHistory) -> Vec<Vec<String>> {
    let ends = history.steps.first().zip(history.steps.last());
    let ends = ends.map(|(first, last)| (last.wall_time - first.wall_time, last.step));
    let moved = Moved { ends, time_step: history.time_step, modes: history.modes.as_ref(), ratios: &history.damping_ratios };
    frame_rows(plan, &shake.stepping, &moved, &history.steps)
}

/// The same of a frame that is struck.
pub(super) fn storey_rows(plan: &Plan, impact: &StoreyImpact, history: &StoreyImpactHistory) -> Vec<Vec<String>> {
    let ends = history.blow.steps.first().zip(history.blow.steps.last());
    let ends = ends.map(|(first, last)| (last.wall_time - first.wall_time, last.step));
    let moved = Moved { ends, time_step: history.blow.time_step, modes: history.modes.as_ref(), ratios: &history.damping_ratios };
    frame_rows(plan, &impact.stepping, &moved, &history.floors)
}

/// What a dry run of a frame tells.
struct Moved<'a> {
    /// Rig time of all steps, s, and their number.
    ends: Option<(f64, u64)>,
    /// s
    time_step: f64,
    modes: Option<&'a Modes>,
    ratios: &'a [f64],
}

/// What a delay is to each mode, and how the largest displacement may grow in it. Beside it stands the damping of the mode, which
/// works the other way.
fn frame_rows<S: Floors>(plan: &Plan, stepping: &Stepping, moved: &Moved<'_>, steps: &[S]) -> Vec<Vec<String>> {
    let pause = stepping.pause.constant().unwrap_or(0.0);
    let (wall, count) = moved.ends.unwrap_or_default();
    let run = Ran { mode: stepping.mode, pause, time_step: moved.time_step, wall, steps: count };
    let (late, unsettled) = (delay(plan, &run), uncertain(plan, stepping.mode));
    let amplitude = steps.iter().flat_map(S::computed).map(|place| place.abs()).fold(0.0, f64::max);
    let Some(modes) = moved.modes.filter(|_| (late != 0.0 || unsettled != 0.0) && amplitude > 0.0) else {
        return Vec::new();
    };
    if stepping.i_modification {
        return vec![vec!["growth by tracking".to_owned(), CORRECTED.to_owned()]];
    }
    let mut rows = vec![late_by(late, unsettled)];
    for (mode, period) in modes.periods.iter().enumerate() {
        let omega = modes.angular_frequency(mode);
        let damping = moved.ratios.get(mode).copied().unwrap_or(0.0);
        let growth = Growth { omega, late, relative: unsettled / amplitude };
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
    let text = format!("{} of virtual time, ± {}", readable(late, Dimension::TIME), readable(unsettled, Dimension::LENGTH));
    vec!["late by".to_owned(), text]
}

/// How a procedure went from target to target in the dry run.
struct Ran {
    mode: Mode,
    /// s
    pause: f64,
    /// s
    time_step: f64,
    /// Rig time of all steps, s.
    wall: f64,
    steps: u64,
}

/// D, s of virtual time.
fn delay(plan: &Plan, run: &Ran) -> f64 {
    let Link::Virtual(link) = &plan.rig.link else { return 0.0 };
    let short = if link.tracking < 1.0 { run.time_step * link.tracking / (1.0 - link.tracking) } else { f64::INFINITY };
    let lagging = match run.mode {
        Mode::Continuous { time_scale } => link.lag / time_scale,
        Mode::StepAndPause if link.lag > 0.0 && plan.rig.settle.band == 0.0 => {
            #[expect(clippy::cast_precision_loss, reason = "no run has 2^53 steps")]
            let moving = (run.wall / run.steps.max(1) as f64 - run.pause).max(0.0);
            let ratio = link.lag / moving;
            let behind = if moving > 0.0 { ratio * (1.0 - (-1.0 / ratio).exp()) } else { 1.0 };
            run.time_step * behind * (-run.pause / link.lag).exp()
        }
        Mode::StepAndPause => 0.0,
    };
    short + lagging
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

    /// ω of a period of half a second, Δt 10 ms: the published factors of ten cycles.
    #[test]
    fn the_published_growth_is_foretold() {
        let omega = std::f64::consts::TAU / 0.5;
        let short = Growth { omega, late: 0.01 * 0.1 / 0.9, relative: 0.0 };
        assert!((short.over(10.0) - 1.549).abs() < 0.003, "{}", short.over(10.0));
        let beyond = Growth { omega, late: -0.01 * 0.1 / 1.1, relative: 0.0 };
        assert!((beyond.over(10.0) - 0.723).abs() < 0.03, "{}", beyond.over(10.0));
        let behind = Growth { omega, late: 0.0, relative: 0.02 };
        assert!((behind.over(10.0) - 1.7856).abs() < 0.02);
    }
}
