//! A frame as a run recorded it: the shear of each storey over its storey drift, along the path. The run can be re-integrated with an
//! input perturbed a little and without a model of the frame. In: targets of all floors and the readings there, in order. Out: the
//! readings at targets near those, step by step.
//!
//! Each storey of a shear building has its own path (`recorded_path`): a result that is exact for one specimen is exact for every storey.
//! If the stiffness of a frame is not that of storeys, its readings are those of the same step of the record. Away from the recorded
//! position they change with the initial stiffness: this is exact for an elastic frame. At the recorded targets the readings are
//! bit-identical to the recorded ones.
//!
//! If the rig carries a part of the frame, the record is that of its axes, in numbers of the rig. The computed storeys are computed again
//! from their state at the start of the run.

use super::recorded_path::{ContinuousMotion, Reading, RecordedPath, Retrace, lag, nearest};
use crate::reintegration::perturbation::Perturbation;
use crate::statistics::DeclaredNoise;
use crate::structure::assemblies::{Assemblies, StoreyReadings, assembly_drifts};
use crate::structure::elements::ElementReading;
use crate::structure::substructures::Substructures;
use crate::structure::{SymmetricBand, storeys_of};

/// One step of the record, one entry per floor or axis.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameReading {
    /// Commanded displacement \[m\].
    pub target: Vec<f64>,
    /// \[m\]
    pub displacement: Vec<f64>,
    /// \[N\]
    pub force: Vec<f64>,
    /// Those of a frame of matrices, in numbers of the prototype.
    pub elements: Vec<ElementReading>,
}

/// Readings of all axes along the path.
#[derive(Clone, Debug)]
pub struct FramePath {
    /// Of the axes.
    readings: Vec<FrameReading>,
    /// Of the floors as they were recorded; empty if the axes are the floors.
    floors: Vec<FrameReading>,
    /// Velocity at each target \[m/s\], one entry per axis; empty for readings at rest.
    velocities: Vec<Vec<f64>>,
    bends: Bends,
    /// Whether the storey of each axis stands on the strong floor.
    stands: Vec<bool>,
    /// At the start of the run; None if the rig carries the whole frame.
    substructures: Option<Substructures>,
    /// \[s\]
    time_step: f64,
}

#[derive(Clone, Debug)]
enum Bends {
    /// From the ground up: shear over storey drift; of a tested element, force over deformation.
    Storeys(Vec<RecordedPath>),
    /// Initial K \[N/m\]; lag of each floor behind its target \[s\].
    Together(SymmetricBand, Vec<f64>),
}

impl FramePath {
    /// `readings` and velocities are those of the floors. `motion` has no velocities where the run was not continuous; `stiffness` is the initial K of the frame; `storeys` are the readings of
    /// its storeys; `substructures` are those at the start of the run. None without readings.
    #[must_use]
    pub fn new(
        readings: Vec<FrameReading>,
        motion: ContinuousMotion<Vec<Vec<f64>>>,
        stiffness: &SymmetricBand,
        storeys: &[StoreyReadings],
        substructures: Option<&Substructures>,
    ) -> Option<Self> {
        readings.first()?;
        let assemblies = substructures.map(Substructures::assemblies);
        let stands = assemblies.map_or_else(
            || (0..stiffness.order()).map(|axis| axis == 0).collect(),
            Assemblies::standing,
        );
        let ContinuousMotion {
            mut velocities,
            time_step,
        } = motion;
        let (mut readings, mut floors) = (readings, Vec::new());
        if let Some(assemblies) = assemblies {
            let at_axes = |floors: &FrameReading| {
                let read = [floors.displacement.as_slice(), &floors.force];
                let [displacement, force] = assemblies.axes_read(read, &floors.elements);
                FrameReading {
                    target: assemblies.axes_of(&floors.target),
                    displacement,
                    force,
                    elements: Vec::new(),
                }
            };
            floors = readings;
            readings = floors.iter().map(at_axes).collect();
            for velocities in &mut velocities {
                *velocities = assemblies.axes_of(velocities);
            }
        }
        let of_axes = |read: fn(&FrameReading) -> &Vec<f64>,
                       to_storeys: fn(&[f64], &[bool]) -> Vec<f64>| {
            readings
                .iter()
                .map(|reading| to_storeys(read(reading), &stands))
                .collect::<Vec<Vec<f64>>>()
        };
        let elements = assemblies.and_then(Assemblies::elements);
        let members = match elements {
            Some(elements) => Some(elements.stiffness.clone()),
            None => storeys_of(stiffness),
        };
        let bends = match members {
            None => {
                let of_axis = |axis: usize| {
                    let passed = readings.iter().zip(&velocities);
                    let behind = passed.map(|(reading, velocity)| {
                        (
                            reading.target[axis] - reading.displacement[axis],
                            velocity[axis],
                        )
                    });
                    if velocities.is_empty() {
                        0.0
                    } else {
                        lag(behind, storeys[axis].noise.resolution)
                    }
                };
                Bends::Together(
                    stiffness.clone(),
                    (0..stiffness.order()).map(of_axis).collect(),
                )
            }
            Some(stiffnesses) => {
                let (stiffnesses, tested) = match assemblies {
                    Some(axes) => (axes.stiffnesses_of(stiffnesses), axes.readings_of(storeys)),
                    None => (stiffnesses, storeys.to_vec()),
                };
                let targets = of_axes(|reading| &reading.target, drifts);
                let displacements = of_axes(|reading| &reading.displacement, drifts);
                let forces = of_axes(|reading| &reading.force, shears);
                let passed: Vec<Vec<f64>> = velocities
                    .iter()
                    .map(|axes| drifts(axes, &stands))
                    .collect();
                let path = |(storey, stiffness): (usize, f64)| {
                    let at = |step: usize| Reading {
                        target: targets[step][storey],
                        displacement: displacements[step][storey],
                        force: forces[step][storey],
                    };
                    let read = &tested[storey];
                    let noise = DeclaredNoise {
                        force: read.shear_noise(),
                        resolution: if read.is_difference {
                            read.noise.resolution * 2.0_f64.sqrt()
                        } else {
                            read.noise.resolution
                        },
                    };
                    let readings: Vec<Reading> = (0..readings.len()).map(at).collect();
                    let passed: Vec<f64> = passed.iter().map(|storeys| storeys[storey]).collect();
                    let motion = (!passed.is_empty()).then_some(ContinuousMotion {
                        velocities: passed.as_slice(),
                        time_step,
                    });
                    RecordedPath::new(readings, motion, stiffness, noise)
                };
                Bends::Storeys(
                    stiffnesses
                        .into_iter()
                        .enumerate()
                        .map(path)
                        .collect::<Option<_>>()?,
                )
            }
        };
        Some(Self {
            readings,
            floors,
            velocities,
            bends,
            stands,
            substructures: substructures.cloned(),
            time_step,
        })
    }

    /// Whether the velocities at its targets are known.
    #[must_use]
    pub const fn knows_velocities(&self) -> bool {
        !self.velocities.is_empty()
    }

    /// The readings of the floors, without the branches derived from them.
    #[must_use]
    pub fn into_readings(self) -> Vec<FrameReading> {
        if self.floors.is_empty() {
            self.readings
        } else {
            self.floors
        }
    }

    /// Begins a re-run along the path, with the stiffnesses of the computed storeys multiplied by `factors`.
    #[must_use]
    pub fn retrace<'a>(&'a self, readings: &'a Perturbation, factors: &[f64]) -> FrameRetrace<'a> {
        let walks = match &self.bends {
            Bends::Storeys(paths) => paths
                .iter()
                .map(|path| (path, path.retrace(readings.finer)))
                .collect(),
            Bends::Together(..) => Vec::new(),
        };
        let first = &self.readings[0];
        let target = first
            .target
            .iter()
            .zip(&readings.axes)
            .map(|(position, axis)| axis.displaced(*position));
        let mut retrace = FrameRetrace {
            path: self,
            readings,
            storeys: walks,
            own_step: 0,
            step: 0,
            target: target.collect(),
            position: first.target.clone(),
            velocity: vec![0.0; first.target.len()],
            displacement: first.displacement.clone(),
            force: first.force.clone(),
            floors: self.substructures.clone().map(|substructures| Floors {
                substructures: substructures.stiffer(factors),
                is_as_recorded: factors.iter().all(|factor| *factor == 1.0),
                displacement: Vec::new(),
                force: Vec::new(),
                elements: Vec::new(),
            }),
        };
        retrace.read();
        if let Some(floors) = &mut retrace.floors {
            let (mut target, mut force) = (Vec::new(), Vec::new());
            let axes = (retrace.target.as_slice(), retrace.force.as_slice());
            floors.substructures.floors(axes, &mut target, &mut force);
            let recorded = &self.floors[0];
            if retrace.target == first.target {
                target.clone_from(&recorded.target);
            }
            retrace.target = target;
            let target = retrace.target.clone();
            retrace.read_floors(&target);
        }
        retrace
    }
}

/// Drifts of the storeys at the axes, from the displacements of the axes: within each assembly.
fn drifts(axes: &[f64], stands: &[bool]) -> Vec<f64> {
    let axes = axes.iter().copied().zip(stands.iter().copied());
    assembly_drifts(axes).collect()
}

/// Shears of the storeys at the axes \[N\], from the forces of the axes: within each assembly.
fn shears(axes: &[f64], stands: &[bool]) -> Vec<f64> {
    let mut shear = axes.to_vec();
    for axis in (1..shear.len()).rev() {
        if !stands[axis] {
            shear[axis - 1] += shear[axis];
        }
    }
    shear
}

/// The floors during a re-run of a frame of which the rig carries a part.
#[derive(Clone, Debug)]
struct Floors {
    substructures: Substructures,
    /// Whether the computed storeys are those of the run.
    is_as_recorded: bool,
    displacement: Vec<f64>,
    force: Vec<f64>,
    elements: Vec<ElementReading>,
}

/// The path during a re-run.
#[derive(Clone, Debug)]
pub struct FrameRetrace<'a> {
    path: &'a FramePath,
    readings: &'a Perturbation,
    storeys: Vec<(&'a RecordedPath, Retrace<'a>)>,
    /// Number of its own steps so far.
    own_step: usize,
    /// The nearest step of the record.
    step: usize,
    /// The first position \[m\].
    target: Vec<f64>,
    /// The last targets, in metres of the record.
    position: Vec<f64>,
    /// The velocities at the last targets \[m/s\], in metres of the record.
    velocity: Vec<f64>,
    displacement: Vec<f64>,
    force: Vec<f64>,
    /// None if the rig carries the whole frame: the axes are then the floors.
    floors: Option<Floors>,
}

impl FrameRetrace<'_> {
    /// The first position of the floors \[m\].
    #[must_use]
    pub fn start(&self) -> &[f64] {
        &self.target
    }

    /// The last reading of displacements \[m\].
    #[must_use]
    pub fn displacement(&self) -> &[f64] {
        self.floors
            .as_ref()
            .map_or(&self.displacement, |floors| &floors.displacement)
    }

    /// The last reading of forces \[N\].
    #[must_use]
    pub fn force(&self) -> &[f64] {
        self.floors
            .as_ref()
            .map_or(&self.force, |floors| &floors.force)
    }

    /// The last reading of the elements of a frame of matrices.
    #[must_use]
    pub fn elements(&self) -> &[ElementReading] {
        self.floors.as_ref().map_or(&[], |floors| &floors.elements)
    }

    /// Whether a storey has departed from the record.
    #[must_use]
    pub fn departed(&self) -> bool {
        self.storeys.iter().any(|(_, retrace)| retrace.departed())
    }

    /// Moves the floors to the targets of the next step \[m\] and reads. `velocities` \[m/s\] are those at the targets if it does not stop
    /// there.
    pub fn move_to(&mut self, targets: &[f64], velocities: &[f64]) {
        let Some(floors) = &mut self.floors else {
            return self.move_axes(targets, velocities);
        };
        let seconds = self.path.time_step / f64::from(self.readings.finer);
        floors.substructures.advance(targets, seconds);
        let axes = floors.substructures.assemblies().axes_of(targets);
        let velocities = floors.substructures.assemblies().axes_of(velocities);
        self.move_axes(&axes, &velocities);
        self.read_floors(targets);
    }

    /// The floors at these targets \[m\], from the present reading of the axes. At the recorded targets it is that of the record, bit for
    /// bit: sums of drifts have rounding errors.
    fn read_floors(&mut self, targets: &[f64]) {
        let Some(floors) = &mut self.floors else {
            return;
        };
        let (axes, recorded) = (&self.path.readings, &self.path.floors);
        if let (Some(axes), Some(recorded)) = (axes.get(self.step), recorded.get(self.step))
            && floors.is_as_recorded
            && recorded.target == targets
            && axes.displacement == self.displacement
            && axes.force == self.force
        {
            floors.displacement.clone_from(&recorded.displacement);
            floors.force.clone_from(&recorded.force);
            floors.elements.clone_from(&recorded.elements);
            return;
        }
        let axes = (self.displacement.as_slice(), self.force.as_slice());
        let substructures = &floors.substructures;
        substructures.floors(axes, &mut floors.displacement, &mut floors.force);
        floors.elements = substructures.elements_read(axes);
    }

    fn move_axes(&mut self, targets: &[f64], velocities: &[f64]) {
        self.own_step += 1;
        self.step = nearest(self.own_step, self.readings.finer);
        for (axis, (to, from)) in self.position.iter_mut().zip(targets).enumerate() {
            *to = self.readings.recorded_position(axis, *from);
        }
        for (axis, (to, from)) in self.velocity.iter_mut().zip(velocities).enumerate() {
            *to = self.readings.recorded(axis, *from);
        }
        let recorded = &self.path.readings[self.step.min(self.path.readings.len() - 1)];
        self.displacement.copy_from_slice(&recorded.displacement);
        self.force.copy_from_slice(&recorded.force);
        match &self.path.bends {
            Bends::Storeys(_) => self.bend_storeys(),
            Bends::Together(stiffness, lags) => {
                let mut off: Vec<f64> = self
                    .position
                    .iter()
                    .zip(&recorded.target)
                    .map(|(position, target)| position - target)
                    .collect();
                if let Some(passed_with) = self.path.velocities.get(self.step) {
                    let faster = self
                        .velocity
                        .iter()
                        .zip(passed_with)
                        .map(|(now, then)| now - then);
                    for (off, (faster, lag)) in off.iter_mut().zip(faster.zip(lags)) {
                        *off -= lag * faster;
                    }
                }
                for (displacement, off) in self.displacement.iter_mut().zip(&off) {
                    *displacement += off;
                }
                stiffness.mul_add(1.0, &off, &mut self.force);
            }
        }
        self.read();
    }

    /// Adds the force changes of every storey away from its recorded storey drift to the recorded readings.
    fn bend_storeys(&mut self) {
        let (mut below, mut slower, mut off) = (0.0, 0.0, 0.0);
        for storey in 0..self.storeys.len() {
            let stands = self.path.stands[storey];
            if stands {
                (below, slower, off) = (0.0, 0.0, 0.0);
            }
            let drift = self.position[storey] - below;
            let velocity = self.velocity[storey] - slower;
            (below, slower) = (self.position[storey], self.velocity[storey]);
            let (path, retrace) = &mut self.storeys[storey];
            let (displacement, shear) = retrace.pass(drift, velocity);
            let recorded = *path.recorded(self.step);
            off += displacement - recorded.displacement;
            self.displacement[storey] += off;
            let more = shear - recorded.force;
            self.force[storey] += more;
            if !stands {
                self.force[storey - 1] -= more;
            }
        }
    }

    fn read(&mut self) {
        for axis in 0..self.force.len() {
            let exact = (self.displacement[axis], self.force[axis]);
            (self.displacement[axis], self.force[axis]) =
                self.readings.read(self.own_step as u64, axis, 1, exact);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::storey_stiffness;

    const STIFFNESSES: [f64; 3] = [3000.0, 2000.0, 1000.0];

    fn elastic(target: &[f64]) -> FrameReading {
        let mut force = vec![0.0; target.len()];
        storey_stiffness(&STIFFNESSES).mul_into(target, &mut force);
        FrameReading {
            target: target.to_vec(),
            displacement: target.iter().map(|position| position + 1e-5).collect(),
            force,
            elements: Vec::new(),
        }
    }

    fn targets() -> Vec<[f64; 3]> {
        (0..60)
            .map(f64::from)
            .map(|step| {
                [
                    0.01 * (0.2 * step).sin(),
                    0.02 * (0.17 * step).sin(),
                    0.02 * (0.31 * step).sin(),
                ]
            })
            .collect()
    }

    fn path(stiffness: &SymmetricBand) -> FramePath {
        FramePath::new(
            targets().iter().map(|target| elastic(target)).collect(),
            ContinuousMotion::default(),
            stiffness,
            &StoreyReadings::of_floors(DeclaredNoise::NONE, 3),
            None,
        )
        .unwrap()
    }

    #[test]
    fn at_the_recorded_targets_the_recorded_readings_come_back_to_the_bit() {
        let mut coupled = storey_stiffness(&STIFFNESSES);
        coupled.set(0, 0, 5500.0);
        for stiffness in [storey_stiffness(&STIFFNESSES), coupled] {
            let path = path(&stiffness);
            let none = Perturbation::none(3);
            let mut retrace = path.retrace(&none, &[]);
            assert_eq!(retrace.start(), targets()[0]);
            for reading in path.readings.iter().skip(1) {
                retrace.move_to(&reading.target, &[0.0; 3]);
                assert_eq!(
                    (retrace.displacement(), retrace.force()),
                    (reading.displacement.as_slice(), reading.force.as_slice())
                );
            }
        }
    }

    /// R = D_f·K·D_d⁻¹·X + zero offset, whatever the path and past its end: each axis has its own factors.
    #[test]
    fn an_elastic_frame_off_its_targets_is_elastic() {
        for stiffness in [storey_stiffness(&STIFFNESSES), {
            // The same frame without storeys: its first row is not that of storeys.
            let mut other = storey_stiffness(&STIFFNESSES);
            other.set(0, 0, 5000.5);
            other
        }] {
            let storeys = storeys_of(&stiffness).is_some();
            let path = path(&stiffness);
            let mut readings = Perturbation::none(3);
            for (axis, instruments) in readings.axes.iter_mut().enumerate() {
                instruments.force_scale = [1.1, 0.9, 1.2][axis];
                instruments.displacement_scale = [1.05, 0.95, 1.0][axis];
                instruments.zero_offset = [1.0, 2.0, -3.0][axis];
            }
            let mut retrace = path.retrace(&readings, &[]);
            for (step, target) in targets()
                .iter()
                .chain(&[[0.03, 0.01, -0.04]; 3])
                .enumerate()
                .skip(1)
            {
                let off: Vec<f64> = target.iter().map(|position| position + 1e-3).collect();
                retrace.move_to(&off, &[0.0; 3]);
                let positions: Vec<f64> = off
                    .iter()
                    .enumerate()
                    .map(|(axis, off)| readings.recorded(axis, *off))
                    .collect();
                let by_hand = elastic(&positions).force;
                for (axis, by_hand) in by_hand.iter().enumerate() {
                    let expected =
                        readings.axes[axis].force_scale * by_hand + readings.axes[axis].zero_offset;
                    // Away from its path, of at most 50 mm, the frame without storeys is stiffer by 0.5 N/m.
                    let within = if storeys { 1e-9 } else { 0.5 * 0.05 * 1.2 };
                    assert!(
                        (retrace.force()[axis] - expected).abs() < within,
                        "step {step}, axis {axis}"
                    );
                }
            }
        }
    }
}
