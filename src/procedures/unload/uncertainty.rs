//! Effect of the rig's calibration and of the reading errors on the unloaded position of a specimen, and on the force that remains there.
//! In: the position of rest, the path to it, the unloading stiffness. Out: the same with the contribution of each source, in closed form.
//! It moves no rig and re-integrates no run.
//!
//! A specimen is unloaded where R + K(x₀ − x) = 0, with K the stiffness measured on the path. Force errors f shift this position by
//! −K⁻¹f. The stiffness that was assumed for the moves does not change the position: to first order it is not a source. The event that
//! left the specimen there, for example an impact, is not measured by the position and is not a source either.

use crate::procedures::common::perturbed_inputs::UncertainRun;
use psd_physics::integrator::tangent::NOISE_MULTIPLE;
use psd_physics::structure::assemblies::Assemblies;
use psd_physics::structure::{Loaded, Unloading};
use psd_physics::tracking::trajectory::longest_travel;
use psd_plan::record::{Rest, UnloadStep};
use psd_plan::uncertainty::{Contribution, NOISE, Source};

/// The method by which the contributions to its uncertainty were found.
pub(crate) const UNCERTAINTY: &str = "In closed form, from the unloaded position: R + K(x₀ − x) = 0 with the \
 stiffness measured during the unloading.";

/// A storey shows a stiffness if its storey drift changes by more than this fraction of the largest change on the path; less is rounding.
const SIGNIFICANT_FRACTION: f64 = 1e-6;

/// Errors of one reading of an axis on the rig: standard deviations \[N\] and \[m\].
type Errors = Vec<(f64, f64)>;

impl UncertainRun<'_> {
    /// For a specimen that was unloaded by `steps`, with the unloading stiffness expected from `unloading`.
    pub fn unloaded(&self, rest: &mut Rest, unloading: &Unloading, steps: &[UnloadStep]) {
        let axes = self.axes(rest);
        let errors = self.errors(axes.axes());
        let unloading = shown(unloading, steps, &axes, &errors);
        self.read(rest, &axes, &errors);
        let exact = rest
            .of_displacement
            .iter()
            .chain(&rest.of_force)
            .all(Vec::is_empty);
        let instruments = self.instruments(errors.len());
        let floors = rest.force.len();
        let [_, forces] = at_the_axes(&axes, rest);
        let alone = |axis: usize, force: f64| -> Vec<f64> {
            let at = |floor: usize| axes.forces_at(floor).into_iter().filter(|at| at.0 == axis);
            let floors = 0..floors;
            floors
                .map(|floor| at(floor).map(|at| at.1 * force).sum())
                .collect()
        };
        for (axis, (force_error, _)) in errors.iter().enumerate() {
            let calibration = self.whole.rig.calibration_of(axis);
            moves(
                rest,
                &unloading,
                Source::ForceZero(axis),
                &alone(axis, calibration.zero()),
            );
            let below = instruments.below(axis)[0].error_of(forces[axis]);
            moves(
                rest,
                &unloading,
                Source::ForceBelowRange(axis),
                &alone(axis, below),
            );
            moves(
                rest,
                &unloading,
                self.reading(2 * errors.len() + axis),
                &alone(axis, *force_error),
            );
        }
        let most = |values: &mut dyn Iterator<Item = f64>| {
            values.fold(0.0, |most: f64, value| most.max(value.abs()))
        };
        let scales = axes.scales();
        let of_prototype = || errors.iter().zip(&scales);
        let explained =
            NOISE * most(&mut of_prototype().map(|(error, scale)| error.0 * scale.forces()));
        let displaced = of_prototype().map(|(error, scale)| error.1 * scale.displacements());
        let explained = explained.max(unloading.force_of(most(&mut { displaced })));
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
        let axes = self.axes(rest);
        let errors = self.errors(axes.axes());
        self.read(rest, &axes, &errors);
    }

    /// The axes from which the floors were read.
    fn axes(&self, rest: &Rest) -> Assemblies {
        let assemblies = self.whole.frame_on_the_rig().and_then(Assemblies::of);
        assemblies.unwrap_or_else(|| Assemblies::whole(rest.force.len()))
    }

    fn errors(&self, axes: usize) -> Errors {
        let instruments = self.instruments(axes);
        let of_axis = |axis| {
            let errors = instruments.errors(axis);
            let [force, displacement] = errors.quantization();
            (errors.noise.hypot(force), displacement)
        };
        (0..axes).map(of_axis).collect()
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
    fn read(&self, rest: &mut Rest, axes: &Assemblies, errors: &Errors) {
        let instruments = self.instruments(errors.len());
        let [displacements, forces] = at_the_axes(axes, rest);
        let of_position = |(axis, factor): (usize, f64)| {
            let calibration = self.whole.rig.calibration_of(axis);
            let [_, below] = instruments.below(axis);
            [
                (
                    Source::DisplacementScale(axis),
                    displacements[axis] * calibration.displacement_uncertainty,
                ),
                (
                    Source::DisplacementBelowRange(axis),
                    below.error_of(displacements[axis]),
                ),
                (self.reading(axis), errors[axis].1),
            ]
            .map(|(source, amount)| (source, factor * amount))
        };
        let of_cell = |(axis, factor): (usize, f64)| {
            let calibration = self.whole.rig.calibration_of(axis);
            let [below, _] = instruments.below(axis);
            [
                (
                    Source::ForceScale(axis),
                    forces[axis] * calibration.force_uncertainty,
                ),
                (Source::ForceBelowRange(axis), below.error_of(forces[axis])),
                (Source::ForceZero(axis), calibration.zero()),
                (self.reading(errors.len() + axis), errors[axis].0),
            ]
            .map(|(source, amount)| (source, factor * amount))
        };
        let floors = || 0..rest.force.len();
        let positions = |floor: usize| axes.positions_of(floor).into_iter().flat_map(of_position);
        let cells = |floor: usize| axes.forces_at(floor).into_iter().flat_map(of_cell);
        let of_displacement = floors()
            .map(|floor| Contribution::of_each(positions(floor)))
            .collect();
        let of_force = floors()
            .map(|floor| Contribution::of_each(cells(floor)))
            .collect();
        (rest.of_displacement, rest.of_force) = (of_displacement, of_force);
        rest.on_computed = floors().filter(|floor| !axes.is_measured(*floor)).collect();
        rest.computed = axes.computed();
    }
}

/// Displacements \[m\] and forces \[N\] of the axes.
fn at_the_axes(axes: &Assemblies, rest: &Rest) -> [Vec<f64>; 2] {
    axes.axes_read([&rest.displacement, &rest.force], &rest.elements())
}

/// The effect of force errors \[N\] of a source at the floors or elements on the position of zero force.
fn moves(rest: &mut Rest, unloading: &Unloading, source: Source, force: &[f64]) {
    for (parts, amount) in rest.of_displacement.iter_mut().zip(unloading.moves(force)) {
        parts.extend((amount != 0.0).then(|| Contribution::new(source, amount)));
    }
}

/// The measured unloading stiffness: for each storey by eq. (6) over the last move that shows it, otherwise the expected one. An
/// unloading branch that is softer than expected shows it by a longer move.
fn shown(
    expected: &Unloading,
    steps: &[UnloadStep],
    axes: &Assemblies,
    errors: &Errors,
) -> Unloading {
    let moves = || {
        steps
            .windows(2)
            .map(|pair| (loaded(&pair[0]), loaded(&pair[1])))
    };
    let change =
        |(from, to): (Loaded<'_>, Loaded<'_>)| longest_travel(from.displacement, to.displacement);
    let farthest = moves().map(change).fold(0.0, f64::max);
    // The noise of a shear is that of all cells above it; the noise of a storey drift is that of two positions.
    let scales = axes.scales();
    let of_storey = |storey: usize| {
        let of_cell = |axis: usize| errors[axis].0 * scales[axis].forces();
        let force = axes
            .shear_of(storey)
            .into_iter()
            .map(|axis| of_cell(axis) * of_cell(axis))
            .sum::<f64>()
            .sqrt();
        let displaced = |axis: usize| errors[axis].1 * scales[axis].displacements();
        let of_position = |axis: Option<usize>| axis.map_or(0.0, displaced);
        let [own, below] = axes.drift_of(storey).map(of_position);
        (force, own.hypot(below))
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
