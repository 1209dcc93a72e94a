//! The energy of a loop between its points: how much of it the readings leave open. In: the points of a loop. Out: energies \[J\].

use psd_physics::identification::loop_sampling::left_open;
use psd_physics::reintegration::perturbation::ReadingErrors;

/// The part of the energy that these points of a loop of this stiffness \[N/m\] leave undetermined \[J\]; each is the mean of so many
/// samples.
pub(crate) fn left_open_by(
    points: &[(f64, f64)],
    stiffness: f64,
    errors: ReadingErrors,
    samples: u32,
) -> f64 {
    let [force, displacement] = errors.quantization();
    let rounding = force.hypot(stiffness * displacement);
    left_open(
        points,
        (errors.noise / f64::from(samples).sqrt()).hypot(rounding),
    )
}

/// The standard uncertainty of an energy of which the points leave so much open [J]: a rectangular distribution between the trapezia
/// and the most.
pub(crate) fn of_open(most: f64) -> f64 {
    most / 3.0_f64.sqrt()
}
