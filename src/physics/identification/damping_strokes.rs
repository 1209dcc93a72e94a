//! The properties of the specimen that the passes of a damping sweep show: whether it yielded, and its stiffness there. In: for each
//! pass, pairs of an outward and a return reading near one position. Out: numbers in SI. It fits no damping.
//!
//! Viscous and Coulomb damping forces are the same at every position of a pass. Half of (outward − return) is therefore one number. An
//! actuator that lags is behind in both directions, so that the two readings of a pair are apart. The mean of the two forces shows the
//! stiffness along the passes, and this stiffness corrects both readings to one position. A specimen that yields on the outward pass
//! returns along a different line. The difference then grows from the reversal point by (K − `K_t`)/2 per metre. It belongs to the
//! hysteresis loop and not to the damping.

use super::fit_line;

/// A change along a pass counts from this many standard errors.
const SURE: f64 = 5.0;

/// A change counts from this fraction of the mean difference: an actuator that has not quite settled leaves about a hundredth.
const SHARE: f64 = 0.1;

/// Fraction of the largest force below which a difference is rounding.
const ROUNDING: f64 = 1e-9;

/// An outward and a return reading near the same position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutAndBack {
    /// Half of (outward − return) of the velocities \[m/s\].
    pub velocity: f64,
    /// Mean of the two velocities \[m/s\]: 0 at the same speed out and back.
    pub unmatched_velocity: f64,
    /// Mean of the two positions \[m\].
    pub displacement: f64,
    /// Half of (outward − return) of the positions \[m\].
    pub half_apart: f64,
    /// Half of (outward − return) of the forces \[N\].
    pub half_difference: f64,
    /// Mean of the two forces \[N\].
    pub mean: f64,
}

impl OutAndBack {
    /// Half of (outward − return) at one position \[N\], for passes with the tangent `stiffness` \[N/m\].
    #[must_use]
    pub fn damping_force(&self, stiffness: f64) -> f64 {
        self.half_difference - stiffness * self.half_apart
    }

    /// The pair without the force of a `damping` \[N·s/m\] at different speeds out and back, which is no force of a stiffness.
    #[must_use]
    pub fn at_one_speed(self, damping: f64) -> Self {
        Self {
            mean: self.mean - damping * self.unmatched_velocity,
            unmatched_velocity: 0.0,
            ..self
        }
    }
}

/// The change of the damping force along a pass with the tangent `stiffness` \[N/m\], in N. None if the force is the same all along, or
/// if there are too few readings.
#[must_use]
pub fn change_along(stroke: &[OutAndBack], stiffness: f64) -> Option<f64> {
    let displacements: Vec<f64> = stroke.iter().map(|pair| pair.displacement).collect();
    let halves: Vec<f64> = stroke
        .iter()
        .map(|pair| pair.damping_force(stiffness))
        .collect();
    let line = fit_line(&displacements, &halves)?;
    let most =
        |read: fn(&OutAndBack) -> f64| stroke.iter().map(read).fold(f64::NEG_INFINITY, f64::max);
    let span = most(|pair| pair.displacement) + most(|pair| -pair.displacement);
    let (change, error) = ((line.slope * span).abs(), line.slope_error * span);
    #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
    let mean = halves.iter().sum::<f64>() / halves.len() as f64;
    let rounding = ROUNDING * most(|pair| pair.mean.abs());
    (change > SURE * error && change > SHARE * mean.abs() && change > rounding).then_some(change)
}

/// Stiffness K of the specimen along its passes, with its standard error \[N/m\]. All passes share one slope of the mean force. Each pass
/// has its own intercept, because the unloaded position may drift between them.
#[must_use]
pub fn own_stiffness<'a>(
    strokes: &(impl Iterator<Item = &'a [OutAndBack]> + Clone),
) -> Option<(f64, f64)> {
    let middle = |stroke: &[OutAndBack]| {
        #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
        let count = stroke.len() as f64;
        let sum = stroke.iter().fold((0.0, 0.0), |sum, pair| {
            (sum.0 + pair.displacement, sum.1 + pair.mean)
        });
        (sum.0 / count, sum.1 / count)
    };
    let away = || {
        strokes
            .clone()
            .filter(|stroke| !stroke.is_empty())
            .flat_map(move |stroke| {
                let (x, r) = middle(stroke);
                stroke
                    .iter()
                    .map(move |pair| (pair.displacement - x, pair.mean - r))
            })
    };
    let (xx, xr) = away().fold((0.0, 0.0), |sum, (x, r)| (sum.0 + x * x, sum.1 + x * r));
    let slope = xr / xx;
    let residual: f64 = away().map(|(x, r)| (r - slope * x).powi(2)).sum();
    #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
    let degrees = away().count() as f64
        - strokes.clone().filter(|stroke| !stroke.is_empty()).count() as f64
        - 1.0;
    (xx > 0.0 && degrees > 0.0).then(|| (slope, (residual / degrees / xx).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stroke(half: impl Fn(f64) -> f64, offset: f64) -> Vec<OutAndBack> {
        let pair = |index: u32| {
            let displacement = 0.02 + 2e-5 * f64::from(index);
            OutAndBack {
                velocity: 1e-3,
                unmatched_velocity: 0.0,
                displacement,
                half_apart: 0.0,
                half_difference: half(displacement),
                mean: offset + 4e5 * displacement,
            }
        };
        (0..40).map(pair).collect()
    }

    #[test]
    fn uniform_damping_does_not_change_along_the_stroke() {
        assert_eq!(change_along(&stroke(|_| 3.0, 0.0), 4e5), None);
        assert_eq!(
            change_along(&stroke(|_| 0.0, 0.0), 4e5),
            None,
            "nor does what does not resist"
        );
        assert_eq!(
            change_along(
                &stroke(|displacement| 3.0 + 100.0 * (displacement - 0.02), 0.0),
                4e5
            ),
            None,
            "3 %: an actuator that settles"
        );
        let noisy = |displacement: f64| 0.5 + (displacement * 9e6).sin();
        assert_eq!(change_along(&stroke(noisy, 0.0), 4e5), None);
    }

    /// Half of K − `K_t` over the pass.
    #[test]
    fn an_unloading_branch_by_another_line_does() {
        let change = change_along(
            &stroke(|displacement| 1.5 + 1.8e5 * (0.0208 - displacement), 0.0),
            4e5,
        )
        .unwrap();
        assert!((change - 1.8e5 * 39.0 * 2e-5).abs() < 1e-6, "{change}");
    }

    /// An actuator that lags by 1 mm in both directions: 3 N of damping, from the stiffness of the passes alone.
    #[test]
    fn readings_at_different_positions_are_corrected_to_one_position() {
        let behind = 1e-3;
        let force = |displacement: f64, damping: f64| 4e5 * displacement + damping;
        let pair = |index: u32| {
            let displacement = 0.02 + 2e-5 * f64::from(index);
            let (out, back) = (displacement - behind, displacement + behind);
            let (out_force, back_force) = (force(out, 3.0), force(back, -3.0));
            OutAndBack {
                velocity: 1e-3,
                unmatched_velocity: 0.0,
                displacement,
                half_apart: 0.5 * (out - back),
                half_difference: 0.5 * (out_force - back_force),
                mean: 0.5 * (out_force + back_force),
            }
        };
        let pairs: Vec<OutAndBack> = (0..40).map(pair).collect();
        let (stiffness, _) = own_stiffness(&[pairs.as_slice()].into_iter()).unwrap();
        assert!((stiffness - 4e5).abs() < 1e-4);
        assert!(
            pairs
                .iter()
                .all(|pair| (pair.damping_force(stiffness) - 3.0).abs() < 1e-6)
        );
        assert_eq!(change_along(&pairs, stiffness), None);
    }

    #[test]
    fn strokes_that_rest_elsewhere_have_one_stiffness() {
        let strokes = [stroke(|_| 0.0, 0.0), stroke(|_| 0.0, 250.0), Vec::new()];
        let (stiffness, error) = own_stiffness(&strokes.iter().map(Vec::as_slice)).unwrap();
        assert!(
            (stiffness - 4e5).abs() < 1e-4 && error < 1e-3,
            "{stiffness} {error}"
        );
        assert_eq!(own_stiffness(&[&[][..]].into_iter()), None);
    }
}
