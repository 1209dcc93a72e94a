//! What the calibration of the rig and the errors of its readings make of where a specimen rests, and of what it still carries
//! there. In: where it came to rest, the way there, how its forces fall. Out: the same with what each source contributes, in
//! closed form. It moves no rig, and takes no run again.
//!
//! A specimen carries no load where R + K(x₀ − x) = 0, K the stiffness that it showed on the way: forces that are read wrong by
//! f are off by −K⁻¹f in that place. With whatever stiffness it was sent there, it rests at the same place: to first order
//! that is no source. What left the specimen where it is, a blow say, is not measured by where it rests, and no source of it.

use crate::physics::integrator::tangent::NOISE_MULTIPLE;
use crate::physics::structure::{Loaded, Unloading};
use crate::plan::Plan;
use crate::plan::formula::ProcedureId;
use crate::record::{Rest, UnloadStep};
use crate::rig::DeclaredNoise;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::uncertainty::{Contribution, InstrumentUncertainty, Source};

/// Noise of the cell in a reading that is not to be mistaken for load, standard deviations.
pub(crate) const NOISE: f64 = 3.0;
/// A storey shows a stiffness where its drift changes by more than this share of the largest change on the way: less is rounding.
const TOLD: f64 = 1e-6;

/// Everything uncertain about a place of rest.
#[derive(Clone, Copy)]
pub(crate) struct RestUncertainty<'run> {
    whole: &'run Plan,
    noise: DeclaredNoise,
    procedure: ProcedureId,
    blow: u16,
}

/// Errors of one reading of an axis: standard deviations, N and m.
type Errors = Vec<(f64, f64)>;

impl<'run> RestUncertainty<'run> {
    pub fn new(whole: &'run Plan, inputs: &Inputs<'_>, session: &Session<'_>) -> Self {
        Self {
            whole,
            noise: session.guard.declared_noise(),
            procedure: inputs.procedure(),
            blow: 0,
        }
    }

    /// After another blow of the same procedure, from 0.
    pub fn of_blow(self, index: usize) -> Self {
        Self {
            blow: u16::try_from(index).unwrap_or(u16::MAX),
            ..self
        }
    }

    /// Of a specimen that was unloaded by `steps`, whose forces were expected to fall as `unloading` says.
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
        for (axis, (force_error, _)) in errors.iter().enumerate() {
            let zero = self.whole.rig.calibration_of(axis).zero();
            moves(
                rest,
                &unloading,
                Source::ForceZero(axis),
                &alone(axis, zero, floors),
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
        let told = NOISE * most(&mut errors.iter().map(|error| error.0));
        let told = told.max(unloading.force_of(most(&mut errors.iter().map(|error| error.1))));
        if !exact && most(&mut rest.force.iter().copied()) > told {
            let RestUncertainty {
                procedure, blow, ..
            } = *self;
            let force = rest.force.clone();
            moves(
                rest,
                &unloading,
                Source::RestLoad { procedure, blow },
                &force,
            );
        }
    }

    /// Of a specimen that was brought to a place, whatever it carries there.
    pub fn brought(&self, rest: &mut Rest) {
        let errors = self.errors(rest);
        self.read(rest, &errors);
    }

    fn errors(&self, rest: &Rest) -> Errors {
        let instruments = InstrumentUncertainty::of(self.whole, self.noise, rest.force.len());
        let of_axis = |axis| {
            let errors = instruments.errors(axis);
            let [force, displacement] = errors.quantization();
            (errors.noise.hypot(force), displacement)
        };
        (0..rest.force.len()).map(of_axis).collect()
    }

    const fn reading(&self, reading: usize) -> Source {
        let RestUncertainty {
            procedure, blow, ..
        } = *self;
        // Three of each of at most MOST_STOREYS floors.
        #[expect(clippy::cast_possible_truncation, reason = "at most 3 · 64")]
        let reading = reading as u16;
        Source::RestReading {
            procedure,
            blow,
            reading,
        }
    }

    /// What is read there is as uncertain as any reading.
    fn read(&self, rest: &mut Rest, errors: &Errors) {
        let floors = errors.len();
        let (mut of_displacement, mut of_force) = (Vec::new(), Vec::new());
        for (axis, (force_error, displacement_error)) in errors.iter().enumerate() {
            let calibration = self.whole.rig.calibration_of(axis);
            let (place, force) = (rest.displacement[axis], rest.force[axis]);
            of_displacement.push(some([
                (
                    Source::DisplacementScale(axis),
                    place * calibration.displacement_uncertainty,
                ),
                (self.reading(axis), *displacement_error),
            ]));
            of_force.push(some([
                (
                    Source::ForceScale(axis),
                    force * calibration.force_uncertainty,
                ),
                (Source::ForceZero(axis), calibration.zero()),
                (self.reading(floors + axis), *force_error),
            ]));
        }
        (rest.of_displacement, rest.of_force) = (of_displacement, of_force);
    }
}

/// Forces (N) that a source makes of the floors move the place where none is left.
fn moves(rest: &mut Rest, unloading: &Unloading, source: Source, force: &[f64]) {
    for (parts, amount) in rest.of_displacement.iter_mut().zip(unloading.moves(force)) {
        parts.extend((amount != 0.0).then(|| Contribution::new(source, amount)));
    }
}

/// A force (N) on one floor alone.
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

/// How the forces fell: of each storey by the last move that tells it, as eq. (6) asks for it; else as it was expected.
fn shown(expected: &Unloading, steps: &[UnloadStep], errors: &Errors) -> Unloading {
    let mut unloading = expected.clone();
    let moves = || {
        steps
            .windows(2)
            .map(|pair| (loaded(&pair[0]), loaded(&pair[1])))
    };
    let change = |(from, to): (Loaded<'_>, Loaded<'_>)| {
        let ways = from
            .displacement
            .iter()
            .zip(to.displacement)
            .map(|(from, to)| (to - from).abs());
        ways.fold(0.0, f64::max)
    };
    let farthest = moves().map(change).fold(0.0, f64::max);
    // The noise of a shear is that of all cells above it, of a drift that of two places.
    let of_storey = |storey: usize| {
        let force = errors[storey..]
            .iter()
            .map(|error| error.0 * error.0)
            .sum::<f64>()
            .sqrt();
        let below = storey.checked_sub(1).map_or(0.0, |below| errors[below].1);
        (force, errors[storey].1.hypot(below))
    };
    for (from, to) in moves() {
        unloading.learn_where(from, to, &|storey, stiffness, moved| {
            let (force, place) = of_storey(storey);
            moved.abs() > (TOLD * farthest).max(NOISE_MULTIPLE * place.max(force / stiffness))
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
