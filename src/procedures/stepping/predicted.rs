//! Rows of `psd check --explain` for a procedure that integrates: its time step, the delay of an actuator that misses its targets, and the
//! resulting growth of amplitudes to first order. In: the declared errors of the rig, the steps of a dry run. Out: rows of text.
//!
//! A delay D in simulated time acts as the damper −K·D. An amplitude then grows by exp(πωD) per cycle. A position error inside the
//! settling band or the resolution may oppose the motion at every step. The sum of these errors is δ. In the worst case an amplitude A
//! grows by 4δ in each cycle.

use super::tracking::delay;
use crate::procedures::common::predicted::row;
use psd_physics::statistics::DeclaredNoise;
use psd_physics::statistics::samples::peak;
use psd_physics::structure::assemblies::Assemblies;
use psd_plan::record::{Floors, Modes};
use psd_plan::{Link, Mode, Plan, Stepping};
use psd_text::units::Dimension;
use psd_text::units::display::{minus, readable, significant};

/// The time steps of a dry run.
pub(crate) struct TimeSteps {
    /// \[s\]
    pub length: f64,
    /// \[s\]
    pub critical: f64,
    /// The cause of the critical time step, after it; empty if it needs none.
    pub cause: String,
    pub number: usize,
    /// Simulated time at the end \[s\].
    pub end: f64,
}

impl TimeSteps {
    /// The critical and the chosen time step, and the simulated time.
    pub(crate) fn rows(&self) -> [Vec<String>; 3] {
        let time = |value: f64| readable(value, Dimension::TIME);
        let ratio = self.length / self.critical;
        let judged = if ratio > 1.0 {
            "ABOVE critical"
        } else {
            "of it"
        };
        [
            row("critical time step", time(self.critical) + &self.cause),
            row(
                "chosen time step",
                format!("{}, {} {judged}", time(self.length), significant(ratio, 3)),
            ),
            row(
                "simulated time",
                format!("{} in {} steps", time(self.end), self.number),
            ),
        ]
    }
}

/// The motion of one degree of freedom.
pub(crate) struct PointMotion {
    /// ω \[rad/s\]
    pub angular_frequency: f64,
    /// The largest displacement \[m\].
    pub amplitude: f64,
    /// Simulated time \[s\].
    pub duration: f64,
}

/// The predicted growth of one degree of freedom; empty if the rig declares no tracking error.
pub(crate) fn growth_of_point(
    plan: &Plan,
    stepping: &Stepping,
    time_step: f64,
    motion: &PointMotion,
) -> Vec<Vec<String>> {
    let (late, unsettled) = (
        delay(plan, stepping, time_step),
        uncertain(plan, stepping.mode),
    );
    let (omega, amplitude) = (motion.angular_frequency, motion.amplitude);
    if (late == 0.0 && unsettled == 0.0) || amplitude == 0.0 {
        return Vec::new();
    }
    if stepping.i_modification {
        return vec![row("growth by tracking", CORRECTED.to_owned())];
    }
    let growth = Growth {
        a_cycle: a_cycle(omega, late),
        relative: unsettled / amplitude,
    };
    let cycles = motion.duration * omega / std::f64::consts::TAU;
    vec![
        late_by(late, unsettled),
        row(
            "growth by tracking",
            format!(
                "amplitude ×{} per cycle, ×{} in the {} cycles of the run (worst case)",
                significant(growth.over(1.0), 4),
                significant(growth.over(cycles), 4),
                significant(cycles, 2)
            ),
        ),
    ]
}

/// The effect of a delay on each mode, and the possible growth of its largest displacement. The damping of the mode, which reduces the
/// amplitude, is listed beside it.
pub(crate) fn growth_of_frame<S: Floors>(
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
    let amplitude = peak(steps.iter().flat_map(S::computed));
    let Some(modes) = modes.filter(|_| (late != 0.0 || unsettled != 0.0) && amplitude > 0.0) else {
        return Vec::new();
    };
    if stepping.i_modification {
        return vec![row("growth by tracking", CORRECTED.to_owned())];
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

const CORRECTED: &str = "none to first order: the I-modification corrects the force to the target";

fn late_by(late: f64, unsettled: f64) -> Vec<String> {
    let either_way = if unsettled > 0.0 {
        format!(", ± {}", readable(unsettled, Dimension::LENGTH))
    } else {
        String::new()
    };
    row(
        "delay",
        format!(
            "{} of simulated time{either_way}",
            readable(late, Dimension::TIME)
        ),
    )
}

/// δ \[m\]: the settling band plus half a resolution, in numbers of the prototype where it is largest.
fn uncertain(plan: &Plan, mode: Mode) -> f64 {
    let resolution = match &plan.rig.link {
        Link::Virtual(link) => link.resolution,
        Link::Real(link) => link.readings.resolution,
    };
    let lags = plan.rig.link.as_virtual().is_none_or(|link| link.lag > 0.0);
    let settles = lags && mode == Mode::RampAndHold;
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
