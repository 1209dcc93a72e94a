//! The settling time of the virtual rig. In: the plan's criterion and the lag of the piston. Out: the waiting time \[s\].

use psd_physics::relaxation::maxwell::MaxwellBranch;
use psd_physics::relaxation::relaxation_state::RelaxationState;
use psd_physics::structure::cell_damping::StrengthRate;
use psd_plan::Settle;

/// The motion after the reference has arrived.
#[derive(Clone, Copy, Debug)]
pub struct Unsettled {
    /// abs(reference − position) \[m\], which decays with `lag`.
    pub lagging: f64,
    /// \[s\]
    pub lag: f64,
    /// abs(target − reference) \[m\], which is constant.
    pub miss: f64,
    /// Stiffness \[N/m\] and viscous damping \[N·s/m\], which convert motion into a force rate.
    pub stiffness: f64,
    pub damping: f64,
    /// \[N/s\]
    pub drift: f64,
    /// Restoring force \[N\] that increases with the speed, and its law.
    pub rate: Option<(f64, StrengthRate)>,
}

impl Unsettled {
    /// abs(dF/dt) minus the zero drift at a lag of `lagging` \[m\], in \[N/s\]. With v = e/lag it is K v + c v/lag. A force R that
    /// increases with (v/v₀)ⁿ adds R n (v/v₀)ⁿ/lag.
    fn force_rate(&self, lagging: f64) -> f64 {
        let velocity = lagging / self.lag;
        let steady = self.stiffness * velocity + self.damping * velocity / self.lag;
        steady
            + self.rate.map_or(0.0, |(force, rate)| {
                force.abs() * rate.exponent * rate.gain(velocity) / self.lag
            })
    }
}

/// Time \[s\] until displacement and force rate have both been inside their bounds for the dwell. None if that is not
/// reached within the timeout. A zero band requires nothing; a zero force rate leaves only the band.
///
/// The lag error e decays as e·exp(−t/lag): |target − x| ≤ miss + |e| and |dF/dt| ≤ K·|e|/lag + c·|e|/lag² + |drift|. Both
/// fall, so the settling time is the time at which a bound on |e| is met: t = lag·ln(|e|/bound). Noise does not count as
/// force rate: a real rig filters it.
pub fn settling_time(settle: &Settle, unsettled: &Unsettled) -> Option<f64> {
    if settle.band == 0.0 {
        return Some(0.0);
    }
    let mut bound = settle.band - unsettled.miss;
    if settle.force_rate > 0.0 {
        let left = settle.force_rate - unsettled.drift.abs();
        if left < 0.0 {
            return None;
        }
        if unsettled.lag > 0.0 {
            let rate_per_lagging =
                (unsettled.stiffness + unsettled.damping / unsettled.lag) / unsettled.lag;
            bound = bound.min(left / rate_per_lagging);
            if unsettled.rate.is_some() {
                bound = largest_below(bound.min(unsettled.lagging), |lagging| {
                    unsettled.force_rate(lagging) <= left
                });
            }
        }
    }
    if bound < 0.0 {
        return None;
    }
    let wait = if unsettled.lagging <= bound {
        0.0
    } else {
        unsettled.lag * (unsettled.lagging / bound).ln()
    };
    let total = wait + settle.dwell;
    (total <= settle.timeout).then_some(total)
}

/// The relaxing branches of several specimens.
pub fn dying(relaxing: &[&RelaxationState]) -> Vec<MaxwellBranch> {
    relaxing
        .iter()
        .flat_map(|relaxing| relaxing.decaying())
        .copied()
        .collect()
}

/// The criterion with half of its force rate reserved for relaxation. If nothing relaxes, the lag has all of it.
pub fn shared(settle: &Settle, unsettled: &Unsettled, relaxes: bool) -> Settle {
    let left = settle.force_rate - unsettled.drift.abs();
    if !relaxes || settle.force_rate <= 0.0 || left <= 0.0 || unsettled.lag == 0.0 {
        return *settle;
    }
    Settle {
        force_rate: settle.force_rate - 0.5 * left,
        ..*settle
    }
}

/// Further time \[s\], after the `waited` of the lag, until the force rate of the relaxing branches is within their part of the bound,
/// for the whole dwell. None if that is not reached within the timeout. The rates decrease, so the first such instant is found by
/// bisection.
pub fn relaxing_time(
    settle: &Settle,
    unsettled: &Unsettled,
    branches: &[MaxwellBranch],
    waited: f64,
) -> Option<f64> {
    if branches.is_empty() || settle.band == 0.0 || settle.force_rate <= 0.0 {
        return Some(0.0);
    }
    let left =
        (settle.force_rate - unsettled.drift.abs()) * if unsettled.lag == 0.0 { 1.0 } else { 0.5 };
    let met = |seconds: f64| {
        branches
            .iter()
            .map(|branch| branch.rate_after(seconds))
            .sum::<f64>()
            <= left
    };
    if met(0.0) {
        return Some(0.0);
    }
    let (mut low, mut high) = (0.0, settle.timeout - waited - settle.dwell);
    if high < 0.0 || !met(high) {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if met(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(high + settle.dwell)
}

/// The largest lag up to `most` that satisfies `met`, which all smaller lags also satisfy. It is found by bisection over a range of
/// powers of two, because an exponent below 1 may need a lag far below the band.
fn largest_below(most: f64, met: impl Fn(f64) -> bool) -> f64 {
    if most <= 0.0 || met(most) {
        return most;
    }
    let (mut low, mut high) = (-1000.0_f64, 0.0_f64);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if met(most * middle.exp2()) {
            low = middle;
        } else {
            high = middle;
        }
    }
    most * low.exp2()
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_physics::relaxation::maxwell::Motion;

    const SETTLE: Settle = Settle {
        band: 1e-5,
        force_rate: 0.0,
        dwell: 0.3,
        timeout: 10.0,
    };
    const LAGGING: Unsettled = Unsettled {
        lagging: 1e-3,
        lag: 0.1,
        miss: 0.0,
        stiffness: 1e5,
        damping: 0.0,
        drift: 0.0,
        rate: None,
    };

    #[test]
    fn waits_for_the_band_then_for_the_force_rate_and_dwells() {
        let band = settling_time(&SETTLE, &LAGGING).unwrap();
        assert!((band - (0.1 * 100_f64.ln() + 0.3)).abs() < 1e-12);
        // 5 N/s at 1e5 N/m and 0.1 s allow 5 µm of lag, which is reached later than the 10 µm band.
        let rate = settling_time(
            &Settle {
                force_rate: 5.0,
                ..SETTLE
            },
            &LAGGING,
        )
        .unwrap();
        assert!((rate - (0.1 * 200_f64.ln() + 0.3)).abs() < 1e-12);
    }

    #[test]
    fn what_never_comes_inside_is_not_settled() {
        assert_eq!(
            settling_time(
                &SETTLE,
                &Unsettled {
                    miss: 2e-5,
                    ..LAGGING
                }
            ),
            None
        );
        assert_eq!(
            settling_time(
                &Settle {
                    timeout: 0.5,
                    ..SETTLE
                },
                &LAGGING
            ),
            None
        );
        assert_eq!(
            settling_time(
                &Settle {
                    force_rate: 5.0,
                    ..SETTLE
                },
                &Unsettled {
                    drift: 6.0,
                    ..LAGGING
                }
            ),
            None
        );
        assert_eq!(
            settling_time(
                &Settle {
                    band: 0.0,
                    ..SETTLE
                },
                &LAGGING
            ),
            Some(0.0)
        );
    }

    /// R = 1000 N increases with (v/v₀)^½, v₀ = 1 m/s, without stiffness: dF/dt = R ½ √(e/0.1)/0.1 ≤ 50 N/s at e = 1e-5 m.
    #[test]
    fn a_strength_that_grows_with_speed_keeps_the_force_moving_longer() {
        let rate = Some((
            1000.0,
            StrengthRate {
                reference_velocity: 1.0,
                exponent: 0.5,
            },
        ));
        let unsettled = Unsettled {
            stiffness: 0.0,
            rate,
            ..LAGGING
        };
        let settle = Settle {
            band: 1e-3,
            force_rate: 50.0,
            dwell: 0.0,
            timeout: 60.0,
        };
        let wait = settling_time(&settle, &unsettled).expect("it settles");
        let by_hand = 0.1 * (1e-3_f64 / 1e-5).ln();
        assert!((wait - by_hand).abs() < 1e-9, "{wait} s is not {by_hand} s");
    }

    /// 200 N that relax with 2 s change by 100 N/s at first: the rate is 5 N/s after 2 ln 20 s.
    #[test]
    fn what_relaxes_keeps_the_rig_unsettled_until_it_is_slow() {
        let mut branch = MaxwellBranch::new(1e5, 2.0);
        branch.follow(&Motion::even(2e-3 / 1e-6, 1e-6));
        let settle = Settle {
            force_rate: 5.0,
            ..SETTLE
        };
        let still = Unsettled {
            lagging: 0.0,
            lag: 0.0,
            ..LAGGING
        };
        assert_eq!(shared(&settle, &still, true), settle);
        let wait = relaxing_time(&settle, &still, &[branch], 0.3).unwrap();
        assert!((wait - (2.0 * 20_f64.ln() + 0.3)).abs() < 1e-5, "{wait}");
        assert_eq!(
            relaxing_time(
                &Settle {
                    timeout: 5.0,
                    ..settle
                },
                &still,
                &[branch],
                0.3
            ),
            None
        );
        assert_eq!(
            relaxing_time(&SETTLE, &still, &[branch], 0.3),
            Some(0.0),
            "a band alone does not ask"
        );
        // With a lag, each of the two has half of the remaining bound.
        let drifting = Unsettled {
            drift: 1.0,
            ..LAGGING
        };
        assert_eq!(shared(&settle, &drifting, true).force_rate, 3.0);
        let wait = relaxing_time(&settle, &drifting, &[branch], 0.3).unwrap();
        assert!((wait - (2.0 * 50_f64.ln() + 0.3)).abs() < 1e-5, "{wait}");
    }
}
