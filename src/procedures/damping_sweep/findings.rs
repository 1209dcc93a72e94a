//! The properties of the specimen that the strokes of a damping sweep show beside its damping: stiffness, plastic deformation. In: pairs of
//! readings. Out: findings, and observations for the reader of c. It moves nothing.

use super::pairing::{Paired, velocity_of};
use super::sweep::{Stroke, Sweep};
use psd_physics::identification::damping_strokes::{OutAndBack, change_along, own_stiffness};
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// A stroke with fewer pairs of steady readings than this has an observation.
const FEW: usize = 3;

/// Relative velocity error of the piston that has no observation.
const OFF_SPEED: f64 = 0.05;

/// The K of the strokes contradicts that of the plan if the two differ by this many standard errors, and by the fraction below.
const CONTRADICTS: f64 = 5.0;
const OFF_STIFFNESS: f64 = 0.1;

/// Fraction of the largest force below which the force of a stiffness over the stroke is rounding.
const ROUNDING: f64 = 1e-9;

/// The properties of the specimen that the strokes show beside c.
pub(super) struct Findings {
    /// K of the valid strokes and its standard error \[N/m\], if they show it.
    pub stiffness: Option<(f64, f64)>,
    /// First steps of the strokes with plastic deformation, where others had none.
    pub left_out: Vec<usize>,
    pub ratio_of: RatioOf,
    pub observations: Vec<String>,
}

/// The stiffness of the damping ratio.
#[derive(Clone, Copy)]
pub(super) enum RatioOf {
    Plan,
    /// K of the strokes and its standard error, N/m: it is not that of the plan.
    Strokes((f64, f64)),
    /// The strokes contradict that of the plan, and show none.
    Nothing,
}

impl Findings {
    /// The strokes that count.
    pub(super) fn kept<'a, 'b>(
        &'a self,
        strokes: &'a [Paired<'b>],
    ) -> impl Iterator<Item = &'a Paired<'b>> + Clone {
        strokes
            .iter()
            .filter(|(stroke, _)| !self.left_out.contains(&stroke.out.start))
    }
}

impl Sweep {
    /// Observations on readings that make c doubtful.
    pub(super) fn observations(&self, paired: &[Paired<'_>]) -> Vec<String> {
        let of_stroke = |(stroke, pairs): &Paired<'_>| {
            let pairs = pairs.len();
            let shown = readable(stroke.speed, Dimension::VELOCITY);
            let few = (!stroke.on_grid && pairs < FEW).then(|| {
                format!(
                    "the strokes at {shown} have {pairs} steady pairs of readings: communication too slow, or stroke too short"
                )
            });
            let off = [&stroke.out, &stroke.back].into_iter().filter(|_| !stroke.on_grid).find_map(|pass| {
                let moved = velocity_of(&self.steps[pass.clone()])?;
                let error = (moved.slope.abs() - stroke.speed).abs();
                let differs = error > OFF_SPEED * stroke.speed + 3.0 * moved.slope_error;
                let measured = readable(moved.slope.abs(), Dimension::VELOCITY);
                differs.then(|| {
                    format!("stroke speed from the reading times is {measured}, not {shown}: c has the same relative error")
                })
            });
            few.into_iter().chain(off)
        };
        paired.iter().flat_map(of_stroke).collect()
    }

    /// The properties of the specimen beside its damping.
    pub(super) fn findings(&self, strokes: &[Paired<'_>]) -> Findings {
        let of_all = own_stiffness(&strokes.iter().map(|(_, pairs)| pairs.as_slice()));
        let of_all = of_all.map_or_else(|| self.planned(), |(stiffness, _)| stiffness);
        let yielded: Vec<(&Stroke, f64)> = strokes
            .iter()
            .filter_map(|(stroke, pairs)| Some((*stroke, change_along(pairs, of_all)?)))
            .collect();
        let all = yielded.len() == strokes.len();
        let mut observations: Vec<String> = Vec::new();
        for (stroke, change) in &yielded {
            let (speed, change) = (
                readable(stroke.speed, Dimension::VELOCITY),
                readable(*change, Dimension::FORCE),
            );
            let so = if all {
                "c and the Coulomb force include its hysteresis"
            } else {
                "the stroke is excluded"
            };
            observations.push(format!(
                "the stroke at {speed} shows yielding: half of out minus back changes by {change} along it; {so}"
            ));
        }
        let left_out: Vec<usize> = yielded
            .iter()
            .filter(|_| !all)
            .map(|(stroke, _)| stroke.out.start)
            .collect();
        let kept = strokes
            .iter()
            .filter(|(stroke, _)| !left_out.contains(&stroke.out.start));
        let stiffness = own_stiffness(&kept.map(|(_, pairs)| pairs.as_slice()));
        let own_stiffness = stiffness.filter(|(own, error)| self.contradicts(*own, *error));
        let resists = |(own, error): (f64, f64)| {
            let pairs = || strokes.iter().flat_map(|(_, pairs)| pairs);
            let most = |read: fn(&OutAndBack) -> f64| pairs().map(read).fold(0.0, f64::max);
            let force = most(|pair| pair.mean.abs() + pair.half_difference.abs());
            own > CONTRADICTS * error
                && own * most(|pair| pair.displacement.abs()) > ROUNDING * force
        };
        let shown = |stiffness| readable(stiffness, Dimension::STIFFNESS);
        let ratio_of = match own_stiffness.map(|own| (own, resists(own))) {
            None => RatioOf::Plan,
            Some((own, true)) => RatioOf::Strokes(own),
            Some((_, false)) => RatioOf::Nothing,
        };
        let assumed = shown(self.planned());
        match ratio_of {
            RatioOf::Plan => {}
            RatioOf::Strokes((own, _)) => observations.push(format!(
                "the strokes have a stiffness of {}, not the {assumed} of `stiffness`: the damping ratio uses the measured one",
                shown(own)
            )),
            RatioOf::Nothing => {
                observations
                    .push(format!("no damping ratio: the strokes show no stiffness, not the {assumed} of `stiffness`"));
            }
        }
        Findings {
            stiffness,
            left_out,
            ratio_of,
            observations,
        }
    }

    /// Whether the K of the strokes (N/m, with its standard error) differs from that of the plan.
    fn contradicts(&self, own: f64, error: f64) -> bool {
        let Some(assumed) = self.stiffness else {
            return false;
        };
        let sure = CONTRADICTS * error.hypot(assumed.uncertainty.unwrap_or(0.0));
        (own - assumed.value).abs() > sure.max(OFF_STIFFNESS * assumed.value)
    }
}
