//! The last move of an actuator as an equivalent uniform motion. In: its times, in closed form or as positions in time.
//! Out: start and end of the uniform motion with the same mean instant and the same variance about it. For slow relaxation
//! the two are equal.

/// The instants of a motion, weighted by the distance.
pub(super) struct Instants {
    /// \[s\]
    pub mean: f64,
    /// About the mean \[s²\].
    pub variance: f64,
}

/// Start and end of a uniform motion with these instants. It begins no earlier than `start` \[s\]; if it would, only the mean is kept.
pub(super) fn even(start: f64, instants: &Instants) -> [f64; 2] {
    let Instants { mean, variance } = *instants;
    let from = (mean - (3.0 * variance.max(0.0)).sqrt()).max(start);
    [from, 2.0 * mean - from]
}

/// The same from positions \[m\] at times \[s\], from before the motion until after it, with linear interpolation. None if
/// there was no motion.
pub(super) fn from_positions(positions: &[(f64, f64)]) -> Option<[f64; 2]> {
    let (start, from) = *positions.first()?;
    let travel = positions.last()?.1 - from;
    let (mut once, mut twice) = (0.0, 0.0);
    for pair in positions.windows(2) {
        let [(before, at), (after, to)] = [pair[0], pair[1]];
        let (moved, [early, late]) = (to - at, [before - start, after - start]);
        once += moved * 0.5 * (early + late);
        twice += moved * (early * early + early * late + late * late) / 3.0;
    }
    let mean = once / travel;
    (travel != 0.0).then(|| {
        even(
            start,
            &Instants {
                mean: start + mean,
                variance: twice / travel - mean * mean,
            },
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_motion_is_itself_and_rest_is_none() {
        let positions: Vec<(f64, f64)> = [1.0, 1.05, 1.13, 1.2, 1.4, 1.7]
            .map(|time: f64| (time, 2e-3 * ((time - 1.0) / 0.2).min(1.0)))
            .to_vec();
        let [from, to] = from_positions(&positions).unwrap();
        assert!(
            (from - 1.0).abs() < 1e-12 && (to - 1.2).abs() < 1e-12,
            "{from} s to {to} s"
        );
        assert_eq!(from_positions(&[(0.0, 1.0), (1.0, 1.0)]), None);
        assert_eq!(from_positions(&[]), None);
    }

    /// A first-order lag delays a ramp of T by its time constant, and adds its square to the variance T²/12.
    #[test]
    fn a_lag_is_later_and_longer() {
        let (lag, travel) = (0.05, 0.4);
        let behind = |time: f64| {
            lag * (1.0 - (-time.min(travel) / lag).exp()) * (-(time - travel).max(0.0) / lag).exp()
        };
        let positions: Vec<(f64, f64)> = (0..=4000)
            .map(|index| f64::from(index) * 3e-4)
            .map(|t| (t, t.min(travel) - behind(t)))
            .collect();
        let found = from_positions(&positions).unwrap();
        let wanted = even(
            0.0,
            &Instants {
                mean: 0.5 * travel + lag,
                variance: travel * travel / 12.0 + lag * lag,
            },
        );
        assert!(
            found
                .iter()
                .zip(wanted)
                .all(|(found, wanted)| (found - wanted).abs() < 1e-6),
            "{found:?}, not {wanted:?}"
        );
    }

    /// A motion shorter than its lag is uniform from its start, with the same mean.
    #[test]
    fn no_motion_begins_before_it_does() {
        assert_eq!(
            even(
                2.0,
                &Instants {
                    mean: 2.5,
                    variance: 1.0
                }
            ),
            [2.0, 3.0]
        );
        assert_eq!(
            even(
                2.0,
                &Instants {
                    mean: 2.5,
                    variance: 0.0
                }
            ),
            [2.5, 2.5]
        );
    }
}
