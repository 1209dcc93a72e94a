//! What the readings of a run will scatter by, where a dry run on an ideal rig reads without an error: the standard errors of its fits
//! are those that the run is to show. In: what the rig that it stands for declares of a reading. Out: variances about a fit, N². Of
//! any other run there is nothing to foresee: its own scatter tells.
//!
//! Noise of σ leaves σ²/n of a mean of n samples. Rounding leaves of its errors what no number of the fit takes up: with C their
//! covariance over all places of the grid (`mechanics::rounding`) and u an orthonormal basis of what the fit can be, the scatter
//! is (tr C − Σ uᵀC u) over the degrees of freedom.

use super::propagation::quanta;
use super::rounding_doubts::{Curve, Quanta};
use crate::mechanics::backbone::fit_bilinear_of;
use crate::mechanics::identification::LineFit;
use crate::mechanics::multilinear_fit::{BreakCount, fit_multilinear_of};
use crate::mechanics::rounding::Rounded;
use crate::plan::{Link, Plan, VirtualLink};
use crate::record::{BilinearFit, MultilinearFit};
use crate::rig::DeclaredNoise;

/// Errors of readings that are yet to come.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foreseen {
    errors: Option<Quanta>,
}

impl Foreseen {
    pub(super) fn of(plan: &Plan) -> Self {
        let errors = match &plan.rig.link {
            Link::Virtual(VirtualLink { foretold: Some(_), .. }) => Some(quanta(plan, DeclaredNoise::default(), 0)),
            _ => None,
        };
        Self { errors: errors.filter(|errors| errors.noise > 0.0 || errors.force > 0.0 || errors.displacement > 0.0) }
    }

    /// Noise of the load cell that is yet to come, N.
    pub(super) fn noise(self) -> Option<f64> {
        self.errors.map(|errors| errors.noise).filter(|noise| *noise > 0.0)
    }

    /// A line through means of `samples` readings at these places, m.
    pub(super) fn line(self, fit: LineFit, places: &[f64], samples: u32) -> LineFit {
        let forces: Vec<f64> = places.iter().map(|x| fit.intercept + fit.slope * x).collect();
        let rows = [vec![1.0; places.len()], places.to_vec()];
        fit.scattering(places, self.scatter((places, &forces), &|_| fit.slope, &rows, samples))
    }

    /// The line of a sweep, of half the differences of two readings at one place: speeds (m/s) and the two forces of each, N.
    pub(super) fn damping(self, fit: LineFit, speeds: &[f64], forces: &[[f64; 2]]) -> LineFit {
        let Some(Quanta { noise, force, .. }) = self.errors else { return fit };
        let mut variance = 0.5 * noise * noise;
        if force > 0.0 && speeds.len() > 2 {
            let halves =
                |weights: &[f64]| -> Vec<f64> { weights.iter().flat_map(|weight| [0.5 * weight, -0.5 * weight]).collect() };
            let places: Vec<f64> = forces.iter().flatten().map(|each| each / force).collect();
            let of = |places: Vec<f64>| Rounded { places, open: Vec::new(), noise: noise / force, samples: 1 };
            let each: f64 = places.chunks(2).map(|pair| of(pair.to_vec()).variance(&[0.5, -0.5])).sum();
            let rounded = of(places);
            let taken: f64 =
                basis(&[vec![1.0; speeds.len()], speeds.to_vec()]).iter().map(|along| rounded.variance(&halves(along))).sum();
            #[expect(clippy::cast_precision_loss, reason = "far fewer pairs than 2^53")]
            let freedom = speeds.len() as f64 - 2.0;
            variance += force * force * (each - taken).max(0.0) / freedom;
        }
        fit.scattering(speeds, variance)
    }

    /// A fit of two lines, once more with what is foreseen; None where that is nothing.
    pub(super) fn bilinear(self, fit: &BilinearFit, (x, r): (&[f64], &[f64]), samples: u32) -> Option<BilinearFit> {
        let hidden = self.about(&Curve::of_bilinear(fit), x, samples);
        fit_bilinear_of(x, r, hidden).filter(|_| hidden > 0.0)
    }

    /// The same of more stretches; their number stays.
    pub(super) fn multilinear(self, fit: &MultilinearFit, (x, r): (&[f64], &[f64]), samples: u32) -> Option<MultilinearFit> {
        let count = BreakCount::Exactly(fit.breaks.len());
        let hidden = self.about(&Curve::of_multilinear(fit), x, samples);
        let again = fit_multilinear_of(x, r, count, hidden).filter(|_| hidden > 0.0)?;
        Some(MultilinearFit { criterion: fit.criterion.clone(), ..again })
    }

    /// Single readings of a force, each by itself, N².
    pub(super) fn readings(self) -> f64 {
        self.errors.map_or(0.0, |errors| errors.noise * errors.noise + errors.force * errors.force / 12.0)
    }

    fn about(self, curve: &Curve, x: &[f64], samples: u32) -> f64 {
        let places: Vec<f64> = x.iter().map(|x| curve.way() * x).collect();
        let forces: Vec<f64> = places.iter().map(|x| curve.force(*x)).collect();
        let effects: Vec<Vec<f64>> = places.iter().map(|x| curve.effects(*x)).collect();
        let numbers = effects.first().map_or(0, Vec::len);
        let rows: Vec<Vec<f64>> = (0..numbers).map(|number| effects.iter().map(|row| row[number]).collect()).collect();
        self.scatter((&places, &forces), &|place| curve.slope(places[place]), &rows, samples)
    }

    /// Of readings at these places (m) with these forces (N), about a fit whose numbers have the effects of `rows`.
    fn scatter(self, (places, forces): (&[f64], &[f64]), slope: &dyn Fn(usize) -> f64, rows: &[Vec<f64>], samples: u32) -> f64 {
        let Some(Quanta { noise, force, displacement }) = self.errors else { return 0.0 };
        if places.len() <= rows.len() {
            return 0.0;
        }
        #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
        let (count, freedom) = (places.len() as f64, (places.len() - rows.len()) as f64);
        let taken_up = basis(rows);
        let left = |values: &[f64], quantum: f64, noise: f64, by: &dyn Fn(usize) -> f64| {
            if quantum <= 0.0 {
                return 0.0;
            }
            let each = Rounded { places: vec![0.0], open: Vec::new(), noise: noise / quantum, samples }.variance(&[1.0]);
            let squares: f64 = (0..values.len()).map(|place| by(place) * by(place)).sum::<f64>() / count;
            let rounded = Rounded {
                places: values.iter().map(|value| value / quantum).collect(),
                open: Vec::new(),
                noise: noise / quantum,
                samples,
            };
            let weighed =
                |along: &Vec<f64>| along.iter().enumerate().map(|(place, weight)| weight * by(place)).collect::<Vec<f64>>();
            let taken: f64 = taken_up.iter().map(|along| rounded.variance(&weighed(along))).sum();
            quantum * quantum * (count * squares * each - taken).max(0.0) / freedom
        };
        let of_noise = noise * noise / f64::from(samples.max(1));
        of_noise + left(forces, force, noise, &|_| 1.0) + left(places, displacement, 0.0, slope)
    }
}

/// An orthonormal basis of what these rows span (Gram and Schmidt, twice).
fn basis(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut found: Vec<Vec<f64>> = Vec::new();
    for row in rows {
        let size = |row: &[f64]| row.iter().map(|part| part * part).sum::<f64>().sqrt();
        let mut left = row.clone();
        for _ in 0..2 {
            for known in &found {
                let along: f64 = left.iter().zip(known).map(|(part, known)| part * known).sum();
                left.iter_mut().zip(known).for_each(|(part, known)| *part -= along * known);
            }
        }
        let length = size(&left);
        if length > 1e-9 * size(row) {
            found.push(left.into_iter().map(|part| part / length).collect());
        }
    }
    found
}
