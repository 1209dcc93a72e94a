//! The uncertainty of the instruments of a rig: calibration, zero offset and reading errors, axis by axis. In: statements of the plan and
//! declarations of the rig. Out: sources, and readings with some of them perturbed. It knows no procedure.

use super::Source;
use crate::DeclaredNoise;
use crate::{BelowRange, Calibration, Link, Plan, ReadingRules, VirtualLink};
use psd_physics::identification::StatedVariance;
use psd_physics::reintegration::perturbation::{Instruments, Perturbation, ReadingErrors};

/// A reading up to this many standard deviations of its errors cannot be distinguished from zero.
pub const NOISE: f64 = 3.0;

/// Sources, each with the number of standard uncertainties by which it is perturbed.
pub type Shifts<'a> = &'a [(Source, f64)];

/// The instruments of every axis.
#[derive(Clone, Debug)]
pub struct InstrumentUncertainty {
    axes: Vec<(Calibration, ReadingErrors)>,
    /// Whether the readings of this run do not have these errors: a dry run on an ideal rig.
    expected: bool,
}

impl InstrumentUncertainty {
    /// The instruments of the rig of a plan, which declares this noise.
    #[must_use]
    pub fn of(plan: &Plan, declared: DeclaredNoise, axes: usize) -> Self {
        let of_axis = |axis| {
            (
                plan.rig.calibration_of(axis),
                reading_errors(plan, declared, axis),
            )
        };
        let expected = matches!(
            plan.rig.link,
            Link::Virtual(VirtualLink {
                predicted: Some(_),
                ..
            })
        );
        Self {
            axes: (0..axes).map(of_axis).collect(),
            expected,
        }
    }

    /// The errors of one reading of an axis.
    #[must_use]
    pub fn errors(&self, axis: usize) -> ReadingErrors {
        self.axes
            .get(axis)
            .map(|(_, errors)| *errors)
            .unwrap_or_default()
    }

    /// Forces and displacements of an axis below their calibrated ranges, with readings that their own errors cannot distinguish from
    /// zero.
    #[must_use]
    pub fn below(&self, axis: usize) -> [BelowRange; 2] {
        let Some((calibration, errors)) = self.axes.get(axis) else {
            return [BelowRange::default(); 2];
        };
        let [of_force, of_displacement] = errors.quantization();
        let zeros = [errors.noise.hypot(of_force), of_displacement].map(|error| NOISE * error);
        let [force, displacement] = [calibration.force_below(), calibration.displacement_below()];
        [(force, zeros[0]), (displacement, zeros[1])]
            .map(|(below, zero)| BelowRange { zero, ..below })
    }

    /// Whether a reading of any axis has errors.
    #[must_use]
    pub fn has_reading_errors(&self) -> bool {
        self.axes.iter().any(|(_, errors)| errors.any())
    }

    /// The variance of the mean of so many samples of an axis, for a fit whose scatter shows the noise: q²/12, which the samples at one
    /// position have in common. A dry run has no scatter: there the noise is added.
    #[must_use]
    pub fn stated_variance(&self, axis: usize, samples: u32) -> StatedVariance {
        let errors = self.errors(axis);
        let [force, displacement] = errors.quantization().map(|u| u * u);
        let noise = if self.expected {
            errors.noise * errors.noise / f64::from(samples.max(1))
        } else {
            0.0
        };
        StatedVariance {
            force: force + noise,
            displacement,
            expected: self.expected,
        }
    }

    /// Uncertain scale factors, zero offsets and readings below a calibrated range.
    pub fn sources(&self) -> impl Iterator<Item = Source> {
        self.axes
            .iter()
            .enumerate()
            .flat_map(|(axis, (calibration, _))| {
                let stated = [
                    (Source::ForceScale(axis), calibration.force_uncertainty),
                    (
                        Source::DisplacementScale(axis),
                        calibration.displacement_uncertainty,
                    ),
                    (Source::ForceZero(axis), calibration.zero()),
                    (
                        Source::ForceBelowRange(axis),
                        calibration.force_below().of_end(),
                    ),
                    (
                        Source::DisplacementBelowRange(axis),
                        calibration.displacement_below().of_end(),
                    ),
                ];
                stated
                    .into_iter()
                    .filter(|(_, uncertainty)| *uncertainty > 0.0)
                    .map(|(source, _)| source)
            })
    }

    /// Readings with the sources of the instruments perturbed, and with the errors of a trial.
    #[must_use]
    pub fn perturbed(&self, shifts: Shifts<'_>, trial: Option<u16>) -> Perturbation {
        let mut readings = Perturbation {
            trial,
            ..Perturbation::none(self.axes.len())
        };
        for (Instruments { errors, .. }, (_, declared)) in readings.axes.iter_mut().zip(&self.axes)
        {
            *errors = *declared;
        }
        for (source, by) in shifts {
            match *source {
                Source::ForceScale(axis) => {
                    readings.axes[axis].force_scale += by * self.axes[axis].0.force_uncertainty;
                }
                Source::DisplacementScale(axis) => {
                    readings.axes[axis].displacement_scale +=
                        by * self.axes[axis].0.displacement_uncertainty;
                }
                Source::ForceZero(axis) => {
                    readings.axes[axis].zero_offset += by * self.axes[axis].0.zero();
                }
                Source::ForceBelowRange(axis) => {
                    readings.axes[axis].force_below = self.below(axis)[0].times(*by);
                }
                Source::DisplacementBelowRange(axis) => {
                    readings.axes[axis].displacement_below = self.below(axis)[1].times(*by);
                }
                // All other sources are inputs.
                _ => {}
            }
        }
        readings
    }

    #[cfg(test)]
    pub(super) fn exact_but_for(errors: ReadingErrors) -> Self {
        Self {
            axes: vec![(Calibration::default(), errors)],
            expected: false,
        }
    }
}

/// The errors of one reading of an axis, as the rig declares them; in a dry run, those of the rig that it represents.
fn reading_errors(plan: &Plan, declared: DeclaredNoise, axis: usize) -> ReadingErrors {
    let (noise, resolution, force_resolution) = match &plan.rig.link {
        Link::Virtual(VirtualLink {
            predicted: Some(errors),
            ..
        }) => (errors.noise, errors.resolution, errors.force_resolution),
        Link::Virtual(_) => (
            declared.force,
            declared.resolution,
            plan.rig.force_resolution(),
        ),
        Link::Real(link) => {
            let ReadingRules {
                noise, resolution, ..
            } = link.readings_of(axis);
            (noise, resolution, plan.rig.force_resolution())
        }
    };
    ReadingErrors {
        noise,
        resolution,
        force_resolution,
    }
}
