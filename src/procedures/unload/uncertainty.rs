//! Effect of the rig's calibration and of the reading errors on the unloaded position of a specimen, and on the force that remains there.
//! In: the position of rest, the path to it, the unloading stiffness. Out: the same with the contribution of each source, in closed form.
//! It moves no rig and re-integrates no run.
//!
//! A specimen is unloaded where R + K(x₀ − x) = 0, with K the stiffness measured on the path. Force errors f shift this position by
//! −K⁻¹f. The stiffness that was assumed for the moves does not change the position: to first order it is not a source. The event that
//! left the specimen there, for example an impact, is not measured by the position and is not a source either.

use crate::procedures::common::perturbed_inputs::UncertainRun;
use psd_physics::integrator::tangent::NOISE_MULTIPLE;
use psd_physics::structure::{Loaded, Unloading};
use psd_plan::record::{Rest, UnloadStep};
use psd_plan::uncertainty::{Contribution, NOISE, Source};

/// The method by which the contributions to its uncertainty were found.
pub(crate) const UNCERTAINTY: &str = "In closed form, from the unloaded position: R + K(x₀ − x) = 0 with the \
 stiffness measured during the unloading.";

/// A storey shows a stiffness if its storey drift changes by more than this fraction of the largest change on the path; less is rounding.
const SIGNIFICANT_FRACTION: f64 = 1e-6;

/// Errors of one reading of an axis: standard deviations \[N\] and \[m\].
type Errors = Vec<(f64, f64)>;

impl UncertainRun<'_> {
    /// For a specimen that was unloaded by `steps`, with the unloading stiffness expected from `unloading`.
    pub fn unloaded(&self, rest: &mut Rest, unloading: &Unloading, steps: &[UnloadStep]) {
        let errors = self.errors(rest);
        let unloading = shown(unloading, steps, &errors);
        let floors = errors.len();
        self.read(rest, &errors);
        let exact = rest
            .of_displacement
            .iter()
            .chain(&rest.of_force)
            .all(Vec::is_empty);
        let instruments = self.instruments(floors);
        for (axis, (force_error, _)) in errors.iter().enumerate() {
            let calibration = self.whole.rig.calibration_of(axis);
            moves(
                rest,
                &unloading,
                Source::ForceZero(axis),
                &alone(axis, calibration.zero(), floors),
            );
            let below = instruments.below(axis)[0].error_of(rest.force[axis]);
            moves(
                rest,
                &unloading,
                Source::ForceBelowRange(axis),
                &alone(axis, below, floors),
            );
            moves(
                rest,
                &unloading,
                self.reading(2 * floors + axis),
                &alone(axis, *force_error, floors),
            );
        }
        let most = |values: &mut dyn Iterator<Item = f64>| {
            values.fold(0.0, |most: f64, value| most.max(value.abs()))
        };
        let explained = NOISE * most(&mut errors.iter().map(|error| error.0));
        let explained =
            explained.max(unloading.force_of(most(&mut errors.iter().map(|error| error.1))));
        if !exact && most(&mut rest.force.iter().copied()) > explained {
            let UncertainRun {
                procedure, impact, ..
            } = *self;
            let force = rest.force.clone();
            moves(
                rest,
                &unloading,
                Source::RestLoad { procedure, impact },
                &force,
            );
        }
    }

    /// For a specimen that was moved to a position, whatever force it carries there.
    pub fn brought(&self, rest: &mut Rest) {
        let errors = self.errors(rest);
        self.read(rest, &errors);
    }

    fn errors(&self, rest: &Rest) -> Errors {
        let instruments = self.instruments(rest.force.len());
        let of_axis = |axis| {
            let errors = instruments.errors(axis);
            let [force, displacement] = errors.quantization();
            (errors.noise.hypot(force), displacement)
        };
        (0..rest.force.len()).map(of_axis).collect()
    }

    const fn reading(&self, reading: usize) -> Source {
        let UncertainRun {
            procedure, impact, ..
        } = *self;
        // Three readings of each of at most MOST_STOREYS floors.
        #[expect(clippy::cast_possible_truncation, reason = "at most 3 · 64")]
        let reading = reading as u16;
        Source::RestReading {
            procedure,
            impact,
            reading,
        }
    }

    /// The reading there is as uncertain as any other.
    fn read(&self, rest: &mut Rest, errors: &Errors) {
        let floors = errors.len();
        let (mut of_displacement, mut of_force) = (Vec::new(), Vec::new());
        let instruments = self.instruments(floors);
        for (axis, (force_error, displacement_error)) in errors.iter().enumerate() {
            let calibration = self.whole.rig.calibration_of(axis);
            let (displacement, force) = (rest.displacement[axis], rest.force[axis]);
            let [force_below, displacement_below] = instruments.below(axis);
            of_displacement.push(some([
                (
                    Source::DisplacementScale(axis),
                    displacement * calibration.displacement_uncertainty,
                ),
                (
                    Source::DisplacementBelowRange(axis),
                    displacement_below.error_of(displacement),
                ),
                (self.reading(axis), *displacement_error),
            ]));
            of_force.push(some([
                (
                    Source::ForceScale(axis),
                    force * calibration.force_uncertainty,
                ),
                (Source::ForceBelowRange(axis), force_below.error_of(force)),
                (Source::ForceZero(axis), calibration.zero()),
                (self.reading(floors + axis), *force_error),
            ]));
        }
        (rest.of_displacement, rest.of_force) = (of_displacement, of_force);
    }
}

/// The effect of force errors \[N\] of a source at the floors on the position of zero force.
fn moves(rest: &mut Rest, unloading: &Unloading, source: Source, force: &[f64]) {
    for (parts, amount) in rest.of_displacement.iter_mut().zip(unloading.moves(force)) {
        parts.extend((amount != 0.0).then(|| Contribution::new(source, amount)));
    }
}

/// A force \[N\] on one floor alone.
fn alone(axis: usize, force: f64, floors: usize) -> Vec<f64> {
    let mut all = vec![0.0; floors];
    all[axis] = force;
    all
}

fn some<const COUNT: usize>(parts: [(Source, f64); COUNT]) -> Vec<Contribution> {
    parts
        .into_iter()
        .filter(|(_, amount)| *amount != 0.0)
        .map(|(source, amount)| Contribution::new(source, amount))
        .collect()
}

/// The measured unloading stiffness: for each storey by eq. (6) over the last move that shows it, otherwise the expected one. An
/// unloading branch that is softer than expected shows it by a longer move.
fn shown(expected: &Unloading, steps: &[UnloadStep], errors: &Errors) -> Unloading {
    let moves = || {
        steps
            .windows(2)
            .map(|pair| (loaded(&pair[0]), loaded(&pair[1])))
    };
    let change = |(from, to): (Loaded<'_>, Loaded<'_>)| {
        let changes = from
            .displacement
            .iter()
            .zip(to.displacement)
            .map(|(from, to)| (to - from).abs());
        changes.fold(0.0, f64::max)
    };
    let farthest = moves().map(change).fold(0.0, f64::max);
    // The noise of a shear is that of all cells above it; the noise of a storey drift is that of two positions.
    let of_storey = |storey: usize| {
        let force = errors[storey..]
            .iter()
            .map(|error| error.0 * error.0)
            .sum::<f64>()
            .sqrt();
        let below = storey.checked_sub(1).map_or(0.0, |below| errors[below].1);
        (force, errors[storey].1.hypot(below))
    };
    let least = SIGNIFICANT_FRACTION * farthest;
    let readings = steps.iter().map(loaded);
    let mut unloading = expected
        .clone()
        .expecting_the_branch(readings, &of_storey, least);
    for (from, to) in moves() {
        unloading.learn_where(from, to, &|storey, stiffness, moved| {
            let (force, rest_displacement) = of_storey(storey);
            moved.abs() > least.max(NOISE_MULTIPLE * rest_displacement.max(force / stiffness))
        });
    }
    unloading
}

fn loaded(step: &UnloadStep) -> Loaded<'_> {
    Loaded {
        displacement: &step.displacement,
        force: &step.restoring_force,
    }
}
