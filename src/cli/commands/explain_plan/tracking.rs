//! The delay of an actuator that misses its targets, and the resulting growth of amplitudes to first order. The energy error in a dry run
//! on the lagging rig. In: the declared errors of the rig, the steps of a dry run. Out: rows of text.
//!
//! A delay D in simulated time acts as the damper −K·D. An amplitude then grows by exp(πωD) per cycle. A position error inside the
//! settling band or the resolution may oppose the motion at every step. The sum of these errors is δ. In the worst case an amplitude A
//! grows by 4δ in each cycle.

use psd::procedures::stepping::tracking::delay;
use psd::run::{self, Keep, Unwatched};
use psd_physics::statistics::DeclaredNoise;
use psd_physics::structure::substructures::Assemblies;
use psd_plan::procedures::impact::block::MASS;
use psd_plan::record::{
    Floors, ImpactHistory, Modes, Outcome, ProcedureRecord, Record, ShakeHistory, StruckFrame,
};
use psd_plan::schema::procedures::STIFFNESS;
use psd_plan::schema::procedures::tracking::TRACKING_ENERGY_ERROR;
use psd_plan::{Impact, Link, Mode, Plan, Shake, Stepping, VirtualLink};
use psd_rig::virtual_rig;
use psd_text::units::Dimension;
use psd_text::units::display::{minus, readable, significant};

/// The predicted growth of one impact; empty if the rig declares no tracking error.
pub(crate) fn rows(
    plan: &Plan,
    impact: &Impact,
    procedure: &ProcedureRecord,
    history: &ImpactHistory,
) -> Vec<Vec<String>> {
    let (late, unsettled) = (
        delay(plan, &impact.stepping, history.time_step),
        uncertain(plan, impact.stepping.mode),
    );
    let input = |name: &str| {
        procedure
            .inputs
            .iter()
            .find(|(field, ..)| *field == name)
            .map(|(_, estimate, _)| estimate.value)
    };
    let (Some(mass), Some(stiffness)) = (input(MASS.name), input(STIFFNESS.name)) else {
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
    let growth = Growth {
        a_cycle: a_cycle(omega, late),
        relative: unsettled / amplitude,
    };
    let cycles = last * omega / std::f64::consts::TAU;
    vec![
        late_by(late, unsettled),
        vec![
            "growth by tracking".to_owned(),
            format!(
                "amplitude ×{} per cycle, ×{} in the {} cycles of the run (worst case)",
                significant(growth.over(1.0), 4),
                significant(growth.over(cycles), 4),
                significant(cycles, 2)
            ),
        ],
    ]
}

/// Growth of an amplitude.
#[derive(Clone, Copy)]
struct Growth {
    /// Natural logarithm of the growth factor per cycle.
    a_cycle: f64,
    /// δ over the amplitude.
    relative: f64,
}

impl Growth {
    /// Factor over n cycles, from A' = ln g·A + 4δ per cycle: gⁿ + 4δ(gⁿ − 1)/ln g.
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

/// Growth of a mode of circular frequency `omega` \[rad/s\] in a cycle with the delay `late` \[s\], to first order.
fn a_cycle(omega: f64, late: f64) -> f64 {
    std::f64::consts::PI * omega * late
}

/// The same for a frame in a ground-motion test.
pub(crate) fn shake_rows(plan: &Plan, shake: &Shake, history: &ShakeHistory) -> Vec<Vec<String>> {
    frame_rows(
        plan,
        &shake.stepping,
        history.time_step,
        history.modes.as_ref(),
        &history.damping_ratios,
        &history.steps,
    )
}

/// The same for a frame under impact.
pub(crate) fn storey_rows(
    plan: &Plan,
    impact: &Impact,
    time_step: f64,
    history: &StruckFrame,
) -> Vec<Vec<String>> {
    frame_rows(
        plan,
        &impact.stepping,
        time_step,
        history.modes.as_ref(),
        &history.damping_ratios,
        &history.floors,
    )
}

/// The effect of a delay on each mode, and the possible growth of its largest displacement. The damping of the mode, which reduces the
/// amplitude, is listed beside it.
fn frame_rows<S: Floors>(
    plan: &Plan,
    stepping: &Stepping,
    time_step: f64,
    modes: Option<&Modes>,
    ratios: &[f64],
    steps: &[S],
) -> Vec<Vec<String>> {
    let (late, unsettled) = (
        delay(plan, stepping, time_step),
        uncertain(plan, stepping.mode),
    );
    let amplitude = steps
        .iter()
        .flat_map(S::computed)
        .map(|displacement| displacement.abs())
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
        let growth = Growth {
            a_cycle: a_cycle(omega, late),
            relative: unsettled / amplitude,
        };
        let percent = |ratio: f64| format!("{} %", minus(&significant(100.0 * ratio, 3)));
        rows.push(vec![
            if mode == 0 { "growth by tracking".to_owned() } else { String::new() },
            format!(
                "mode {}, {}: amplitude ×{} per cycle (worst case), equivalent damping ratio {}; its own ratio is {}",
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

/// A dry run on a rig with the lag and undershoot of the plan's rig, and no other error; None if the rig has neither.
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
        Keep::Steps,
    ))
}

/// The energy that tracking errors add to or remove from a procedure of the lagging dry run.
pub(crate) fn energy(lagging: Option<&Record>, procedure: usize) -> Vec<Vec<String>> {
    let Some((lagging, found)) =
        lagging.and_then(|run| Some((run, run.procedures.get(procedure)?)))
    else {
        return Vec::new();
    };
    let Some(share) = found.number(TRACKING_ENERGY_ERROR.name) else {
        return Vec::new();
    };
    let does = if share < 0.0 { "put in" } else { "taken out" };
    let held = match &lagging.outcome {
        Outcome::Completed => String::new(),
        _ if found.complete => String::new(),
        _ => "; the run is stopped".to_owned(),
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
        "delay".to_owned(),
        format!(
            "{} of simulated time{either_way}",
            readable(late, Dimension::TIME)
        ),
    ]
}

/// δ \[m\]: the settling band plus half a resolution, in numbers of the prototype where it is largest.
fn uncertain(plan: &Plan, mode: Mode) -> f64 {
    let resolution = match &plan.rig.link {
        Link::Virtual(link) => link.resolution,
        Link::Real(link) => link.readings.resolution,
    };
    let lags = plan.rig.link.as_virtual().is_none_or(|link| link.lag > 0.0);
    let settles = lags && mode == Mode::StepAndPause;
    let on_the_rig = DeclaredNoise {
        force: 0.0,
        resolution: 0.5 * resolution + if settles { plan.rig.settle.band } else { 0.0 },
    };
    let assemblies = plan.frame_on_the_rig().and_then(Assemblies::of);
    let largest = assemblies.map(|assemblies| assemblies.largest_noise(on_the_rig));
    largest.unwrap_or(on_the_rig).resolution
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published case of ten cycles of fifty steps: a lag of δ = 2 % of A gives an amplitude of ×1.7856 in the last cycle. The bound is
    /// 4δ per cycle. The difference from the bound decreases with the step.
    #[test]
    fn a_band_against_the_motion_is_the_most_it_can_be() {
        let factor = Growth {
            a_cycle: 0.0,
            relative: 0.02,
        }
        .over(10.0);
        assert!(factor > 1.7856 && factor < 1.01 * 1.7856, "{factor}");
        let growing = Growth {
            a_cycle: 0.05,
            relative: 0.02,
        };
        // One cycle after another.
        let mut amplitude = 1.0;
        for _ in 0..10_000 {
            amplitude += (growing.a_cycle * amplitude + 4.0 * growing.relative) * 1e-3;
        }
        assert!(
            (growing.over(10.0) / amplitude - 1.0).abs() < 1e-3,
            "{amplitude}, predicted {}",
            growing.over(10.0)
        );
    }
}
