//! Actuators that lag and fall short, as they are expected to follow: in closed form from step to step, without a rig. In: targets.
//! Out: where the actuators stand when a step is read. It knows no specimen, and nothing of a path between two targets.

/// What a set of actuators misses, and how it is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manner {
    /// Share of each increment that is not reached, taken from where an actuator stands.
    pub short: f64,
    /// Time constant of the first-order lag, s of rig time.
    pub lag: f64,
    pub pace: Pace,
}

/// How the actuators go from target to target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// Evenly at `speed` (m/s), all arriving at once; then until every one is inside `band` (m, 0: at once) and lags by no more than
    /// `slow` (m), where the force changes as slowly as it must, and `rest` (s) more.
    Paused { speed: f64, band: f64, slow: f64, rest: f64 },
    /// Past each target after so long, s of rig time.
    Continuous { step: f64 },
}

impl Manner {
    /// Whether nothing is missed at all.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.short == 0.0 && self.lag == 0.0
    }
}

/// Actuators under way. With e = reference − position: e₁ = v·lag + (e₀ − v·lag)·exp(−T/lag) over a move of T at the velocity v.
#[derive(Clone, Debug)]
pub struct Followers {
    manner: Manner,
    axes: Vec<Axis>,
    /// Σ of what was missed times the increment, and of increments squared, m².
    missed: f64,
    increments: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    target: f64,
    reference: f64,
    /// e, m
    lagging: f64,
}

impl Followers {
    /// All at 0.
    #[must_use]
    pub fn new(manner: Manner, axes: usize) -> Self {
        Self { manner, axes: vec![Axis::default(); axes], missed: 0.0, increments: 0.0 }
    }

    /// Sends every axis to its target, m; where each is read is in `places`.
    pub fn go(&mut self, targets: &[f64], places: &mut [f64]) {
        let Manner { short, lag, pace } = self.manner;
        let aim = |(axis, target): (&Axis, &f64)| target - short * (target - (axis.reference - axis.lagging));
        let aims: Vec<f64> = self.axes.iter().zip(targets).map(aim).collect();
        let seconds = match pace {
            Pace::Continuous { step } => step,
            Pace::Paused { speed, .. } => {
                let ways = self.axes.iter().zip(&aims).map(|(axis, aim)| (aim - axis.reference).abs());
                ways.fold(0.0, f64::max) / speed
            }
        };
        for (axis, aim) in self.axes.iter_mut().zip(&aims) {
            if lag > 0.0 && seconds > 0.0 {
                let steady = (aim - axis.reference) / seconds * lag;
                axis.lagging = steady + (axis.lagging - steady) * (-seconds / lag).exp();
            }
            axis.reference = *aim;
        }
        if let Pace::Paused { band, slow, rest, .. } = pace
            && lag > 0.0
        {
            let waits = self.axes.iter().zip(targets).map(|(axis, target)| {
                let bound = (band - (target - axis.reference).abs()).min(slow);
                if bound > 0.0 { (axis.lagging.abs() / bound).ln().max(0.0) * lag } else { 0.0 }
            });
            let wait = waits.fold(0.0, f64::max) + rest;
            for axis in &mut self.axes {
                axis.lagging *= (-wait / lag).exp();
            }
        }
        for ((axis, target), place) in self.axes.iter_mut().zip(targets).zip(places) {
            *place = axis.reference - axis.lagging;
            let increment = target - axis.target;
            self.missed += (target - *place) * increment;
            self.increments += increment * increment;
            axis.target = *target;
        }
    }

    /// Mean delay so far over a step: what is missed by the increment, in least squares.
    #[must_use]
    pub fn delay(&self) -> f64 {
        if self.increments > 0.0 { self.missed / self.increments } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::monitor::Monitor;

    const AMPLITUDE: f64 = 0.01;
    const STIFFNESS: f64 = 1000.0;

    /// Energy that the last of five cycles of a sine puts into a spring, J, and the delay over a step; `per_cycle` steps.
    fn cycle(manner: Manner, per_cycle: u32) -> (f64, f64) {
        let (mut followers, mut place, mut before) = (Followers::new(manner, 1), [0.0], 0.0);
        let mut monitor = Monitor::new(0.0, 0.0, 0.0);
        for step in 1..=5 * per_cycle {
            let target = AMPLITUDE * (std::f64::consts::TAU * f64::from(step) / f64::from(per_cycle)).sin();
            followers.go(&[target], &mut place);
            let found = monitor.take(target, place[0], STIFFNESS * place[0]);
            if step == 4 * per_cycle {
                before = found.energy_error;
            }
        }
        (before - monitor.tracking().energy_error, followers.delay())
    }

    /// Late by D, a sine puts πKA² sin(ωD) into a spring in a cycle, 2π sin(ωD) of its energy: as a damper with ζ = −ωD/2 would,
    /// which takes 4πζ of it. A lag τ at the scale s is late by τ/s, with gain cos φ.
    #[test]
    fn a_lag_is_negative_damping() {
        let energy = 0.5 * STIFFNESS * AMPLITUDE * AMPLITUDE;
        // 0.04 rad of phase: 40 steps of 1 s.
        let per_cycle = 400;
        let lag = 0.04 / std::f64::consts::TAU * f64::from(per_cycle);
        let phase: f64 = 0.04_f64.atan();
        let manner = Manner { short: 0.0, lag, pace: Pace::Continuous { step: 1.0 } };
        let (found, delay) = cycle(manner, per_cycle);
        let exact = std::f64::consts::TAU * phase.sin() * phase.cos() * energy;
        assert!((found / exact - 1.0).abs() < 1e-3, "{found} J is not {exact} J");
        let damping = -0.5 * 0.04;
        assert!((found / (-4.0 * std::f64::consts::PI * damping * energy) - 1.0).abs() < 3e-3, "{found} J");
        assert!((delay / lag - 1.0).abs() < 0.01, "{delay} steps are not {lag}");
    }

    /// What is missed of each increment is late by Δt·t/(1 − t).
    #[test]
    fn what_is_missed_of_each_increment_is_late_too() {
        let manner =
            Manner { short: 0.2, lag: 0.0, pace: Pace::Paused { speed: 1.0, band: 0.0, slow: f64::INFINITY, rest: 0.0 } };
        let (found, delay) = cycle(manner, 1000);
        assert!((delay - 0.25).abs() < 1e-3, "{delay}");
        let late = std::f64::consts::TAU / 1000.0 * 0.25;
        let exact = std::f64::consts::PI * STIFFNESS * AMPLITUDE * AMPLITUDE * late;
        assert!((found / exact - 1.0).abs() < 1e-3, "{found} J is not {exact} J");
    }

    /// 1 mm at 10 mm/s with a lag of 50 ms: 0.5 mm·(1 − e⁻²) behind, which a rest of 0.1 s lets die by e⁻², and a band of 10 µm
    /// ends at 10 µm, or sooner.
    #[test]
    fn a_pause_and_a_band_let_a_lag_die() {
        let behind = |band: f64, slow: f64, rest: f64| {
            let manner = Manner { short: 0.0, lag: 0.05, pace: Pace::Paused { speed: 0.01, band, slow, rest } };
            let (mut followers, mut place) = (Followers::new(manner, 1), [0.0]);
            followers.go(&[1e-3], &mut place);
            1e-3 - place[0]
        };
        let arrived = 5e-4 * (1.0 - (-2.0_f64).exp());
        let any = f64::INFINITY;
        assert!((behind(0.0, any, 0.0) - arrived).abs() < 1e-15);
        assert!((behind(0.0, any, 0.1) - arrived * (-2.0_f64).exp()).abs() < 1e-15);
        assert!((behind(1e-5, any, 0.0) - 1e-5).abs() < 1e-15);
        assert!((behind(1e-5, any, 0.1) - 1e-5 * (-2.0_f64).exp()).abs() < 1e-15);
        assert!((behind(1e-5, 2e-6, 0.0) - 2e-6).abs() < 1e-15, "the force decides");
    }
}
