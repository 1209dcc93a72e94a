//! The delay of an actuator that misses its targets and the growth of amplitudes by it, to first order, and the energy that a dry run on the
//! lagging rig shows. In: what the rig declares, the steps of a dry run. Out: rows of text.
//!
//! A place that is late by D of virtual time is felt as the damper −K·D, and an amplitude grows by exp(πωD) a cycle. What lies inside
//! the settling band or a quantum may be against the motion at every step: δ in all, and an amplitude A grows by 4δ a cycle, at worst, and
//! grows on.

use crate::plan::formula::ResultValue;
use crate::plan::{Impact, Link, Mode, Plan, Shake, Stepping, VirtualLink};
use crate::procedures::stepping::delay::late;
use crate::record::{
    Floors, ImpactHistory, Modes, Outcome, ProcedureRecord, Record, ShakeHistory, StruckFrame,
};
use crate::rig::virtual_rig;
use crate::run::{self, Settings, Unwatched};
use crate::units::Dimension;
use crate::units::display::{minus, readable, significant};

/// What is foretold of one impact; nothing where the rig declares nothing that it misses.
pub(crate) fn rows(
    plan: &Plan,
    impact: &Impact,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
) -> Vec<Vec<String>> {
    let (late, unsettled) = (
        late(plan, &impact.stepping, history.time_step),
        uncertain(plan, impact.stepping.mode),
    );
    let input = |name: &str| {
        procedure
            .inputs
            .iter()
            .find(|(field, ..)| *field == name)
            .map(|(_, estimate, _)| estimate.value)
    };
    let (Some(mass), Some(stiffness)) = (input("mass"), input("stiffness")) else {
        return Vec::new();
    };
    let amplitude = history
        .steps
        .iter()
        .map(|step| step.computed.abs())
        .fold(0.0, f64::max);
    let last = history.steps.last().map_or(0.0, |step| step.time);
    if (late == 0.0 && unsettled == 0.0) || amplitude == 0.0 {
        return Vec::new();
    }
    if impact.stepping.i_modification {
        return vec![vec!["growth by tracking".to_owned(), CORRECTED.to_owned()]];
    }
    let omega = (stiffness / mass).sqrt();
    let growth = Growth::of(late, omega, unsettled / amplitude);
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
    /// Of a mode of ω (rad/s) that is late by so much (s), to first order.
    fn of(late: f64, omega: f64, relative: f64) -> Self {
        Self {
            a_cycle: std::f64::consts::PI * omega * late,
            relative,
        }
    }

    /// Factor over so many cycles n: A' = ln g·A + 4δ a cycle, gⁿ + 4δ(gⁿ − 1)/ln g.
    fn over(self, cycles: f64) -> f64 {
        let exponent = self.a_cycle * cycles;
        let each = if exponent.abs() < 1e-12 {
            cycles
        } else {
            exponent.exp_m1() / self.a_cycle
        };
        exponent.exp() + 4.0 * self.relative * each
    }
}

/// The same of a frame on moving ground.
pub(crate) fn shake_rows(plan: &Plan, shake: &Shake, history: &ShakeHistory) -> Vec<Vec<String>> {
    let modes = (history.modes.as_ref(), history.damping_ratios.as_slice());
    frame_rows(
        plan,
        &shake.stepping,
        history.time_step,
        modes,
        &history.steps,
    )
}

/// The same of a frame that is struck.
pub(crate) fn storey_rows(
    plan: &Plan,
    impact: &Impact,
    time_step: f64,
    history: &StruckFrame,
) -> Vec<Vec<String>> {
    let modes = (history.modes.as_ref(), history.damping_ratios.as_slice());
    frame_rows(plan, &impact.stepping, time_step, modes, &history.floors)
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
    let (late, unsettled) = (
        late(plan, stepping, time_step),
        uncertain(plan, stepping.mode),
    );
    let amplitude = steps
        .iter()
        .flat_map(S::computed)
        .map(|place| place.abs())
        .fold(0.0, f64::max);
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
        let growth = Growth::of(late, omega, unsettled / amplitude);
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

/// A dry run on a rig that lags and falls short as the plan's does, and is ideal otherwise; None where it does neither.
pub(crate) fn lagging(plan: &Plan) -> Option<Record> {
    let Link::Virtual(VirtualLink {
        lag,
        tracking,
        seed,
        ..
    }) = plan.rig.link
    else {
        return None;
    };
    if lag <= 0.0 && tracking == 0.0 {
        return None;
    }
    let mut lagging = plan.clone();
    lagging.rig.link = Link::Virtual(VirtualLink {
        lag,
        tracking,
        seed,
        ..VirtualLink::default()
    });
    Some(run::run_with(
        &lagging,
        &mut *virtual_rig(&lagging),
        &mut Unwatched,
        Settings { uncertainty: false },
    ))
}

/// The energy that tracking puts into a procedure of the lagging dry run or takes out.
pub(crate) fn energy(lagging: Option<&Record>, procedure: usize) -> Vec<Vec<String>> {
    let Some((lagging, found)) =
        lagging.and_then(|run| Some((run, run.procedures.get(procedure)?)))
    else {
        return Vec::new();
    };
    let share = found
        .result("tracking_energy_error")
        .map(|result| &result.value);
    let Some(ResultValue::Number {
        value: Some(share), ..
    }) = share
    else {
        return Vec::new();
    };
    let does = if *share < 0.0 { "put in" } else { "taken out" };
    let held = match &lagging.outcome {
        Outcome::Completed => String::new(),
        _ if found.complete => String::new(),
        _ => "; the run is held".to_owned(),
    };
    let share = significant(100.0 * share.abs(), 2);
    vec![vec![
        "energy by tracking".to_owned(),
        format!("up to {share} % of the input {does}{held}"),
    ]]
}

const CORRECTED: &str = "none to first order: the I-modification corrects the force to the target";

fn late_by(late: f64, unsettled: f64) -> Vec<String> {
    let either_way = if unsettled > 0.0 {
        format!(", ± {}", readable(unsettled, Dimension::LENGTH))
    } else {
        String::new()
    };
    vec![
        "late by".to_owned(),
        format!(
            "{} of virtual time{either_way}",
            readable(late, Dimension::TIME)
        ),
    ]
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

    /// Published, of ten cycles of fifty steps: behind by δ = 2 % of A an amplitude is ×1.7856 in the last of them. 4δ a cycle is the most
    /// that it can be, and what is missing of it falls with the step.
    #[test]
    fn a_band_against_the_motion_is_the_most_it_can_be() {
        let told = Growth {
            a_cycle: 0.0,
            relative: 0.02,
        }
        .over(10.0);
        assert!(told > 1.7856 && told < 1.01 * 1.7856, "{told}");
        let growing = Growth {
            a_cycle: 0.05,
            relative: 0.02,
        };
        // One cycle after the other.
        let mut amplitude = 1.0;
        for _ in 0..10_000 {
            amplitude += (growing.a_cycle * amplitude + 4.0 * growing.relative) * 1e-3;
        }
        assert!(
            (growing.over(10.0) / amplitude - 1.0).abs() < 1e-3,
            "{amplitude}, told {}",
            growing.over(10.0)
        );
    }
}
