//! The assemblies of a frame on the rig: its tested storeys or elements, each with its actuator. In: a frame, displacements and forces of
//! its floors. Out: those of the actuators, and back. It knows no rig, no model and no equation of motion.
//!
//! Adjacent tested storeys a…b are one assembly on the strong floor. Its axis j imposes u_j = λ_x (x_j − x_(a−1)), and its cell reads f_j.
//! The forces n f_j/λ_f act at the floors; the negative sum acts at floor a−1, or at the ground (Shing & Mahin 1984). λ_x and λ_f are the
//! scale of the specimen, which is one of n equal parts. Only shear is transmitted: no rotation and no moment is imposed. A measured floor
//! stands on the measured floors below it. So the drift of a tested storey is the measured one, and that of a computed storey is the
//! imposed one.
//!
//! In a frame of matrices with elements, K is computed, and each tested element is an assembly of its own: u = λ_x (x_to − x_from), and
//! n f/λ_f acts at its second end, the negative of it at the first. The displacement of a degree of freedom is the imposed one; an
//! element has a measured deformation of its own.

use super::elements::{ElementReading, Elements, deformation};
use super::frame::{Frame, Member, Part, Scale, Storey};
use super::shear_building::shears;
use crate::statistics::DeclaredNoise;

/// What carries a storey.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Support {
    /// A model computes its shear.
    Computed,
    /// It is the lowest storey of an assembly.
    StrongFloor,
    /// It stands on the storey below, in the same assembly.
    Below,
}

/// The storeys or elements of a frame that are on the rig, and their assemblies.
#[derive(Clone, Debug, PartialEq)]
pub struct Assemblies {
    /// From the ground up, or in the order of the elements.
    pub(super) supports: Vec<Support>,
    /// The same; full for a computed storey.
    pub(super) scales: Vec<Scale>,
    /// None for storeys, of which each joins its floor to the one below.
    pub(super) elements: Option<Elements>,
    /// The geometric stiffness of the axial load in the reading of each storey \[N/m\]; 0 without an axial load.
    axial: Vec<f64>,
}

/// From the ground up, or in the order of the elements; empty for a matrix on the rig.
fn supports(frame: &Frame) -> Vec<Support> {
    let mut stood = false;
    let is_chain = !frame.has_elements();
    let support = |member: Member<'_>| match member.part {
        Part::Computed => {
            stood = false;
            Support::Computed
        }
        Part::Tested { apart, .. } => {
            let joined = std::mem::replace(&mut stood, true) && !apart && is_chain;
            if joined {
                Support::Below
            } else {
                Support::StrongFloor
            }
        }
    };
    frame.members().map(support).collect()
}

/// The scale of every storey or element; full for a computed one.
fn scales(frame: &Frame) -> Vec<Scale> {
    frame.members().map(|member| member.part.scale()).collect()
}

/// The storeys on the rig from the ground up, or the elements, each with whether it stands on the strong floor.
pub fn on_the_rig(frame: &Frame) -> impl Iterator<Item = (Member<'_>, bool)> {
    let storeys = frame.members().zip(supports(frame));
    storeys.filter_map(|(storey, support)| match support {
        Support::Computed => None,
        support => Some((storey, support == Support::StrongFloor)),
    })
}

/// Stiffness of the specimens at their axes, row by row, in numbers of the rig \[N/m\].
#[must_use]
pub fn stiffness_on_the_rig(frame: &Frame) -> Vec<Vec<f64>> {
    if Assemblies::of(frame).is_none() {
        return frame.stiffness.clone();
    }
    let storeys: Vec<(f64, bool)> = on_the_rig(frame)
        .map(|(storey, stands)| {
            let stiffness = storey.part.scale().stiffness_on_the_rig(storey.stiffness);
            (stiffness, stands)
        })
        .collect();
    let mut rows = vec![vec![0.0; storeys.len()]; storeys.len()];
    for (axis, (stiffness, stands)) in storeys.into_iter().enumerate() {
        rows[axis][axis] += stiffness;
        if !stands {
            rows[axis - 1][axis - 1] += stiffness;
            rows[axis - 1][axis] = -stiffness;
            rows[axis][axis - 1] = -stiffness;
        }
    }
    rows
}

/// Drifts of the storeys on the rig, from the displacements or velocities of their axes, each with whether its storey stands on the strong
/// floor.
pub fn assembly_drifts(axes: impl Iterator<Item = (f64, bool)>) -> impl Iterator<Item = f64> {
    axes.scan(0.0, |below, (axis, stands)| {
        let below = std::mem::replace(below, axis);
        Some(axis - if stands { 0.0 } else { below })
    })
}

/// The readings that the shear and the drift of a storey are computed from, in numbers of the prototype.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoreyReadings {
    /// That of one load cell and one transducer.
    pub noise: DeclaredNoise,
    /// Number of load cells of which the shear is the sum.
    pub cells: f64,
    /// Whether the drift is the difference of two transducers.
    pub is_difference: bool,
    /// The P-Δ per drift that is in the shear \[N/m\], by the axial load on the rig: so much can its tangent be below 0.
    pub axial_stiffness: f64,
}

impl StoreyReadings {
    /// One degree of freedom.
    #[must_use]
    pub const fn of_one(noise: DeclaredNoise) -> Self {
        Self {
            noise,
            cells: 1.0,
            is_difference: false,
            axial_stiffness: 0.0,
        }
    }

    /// A frame with a load cell and a transducer at every floor.
    #[must_use]
    pub fn of_floors(noise: DeclaredNoise, floors: usize) -> Vec<Self> {
        Assemblies::whole(floors).readings(noise)
    }

    /// Standard deviation of the shear of independent cells \[N\].
    #[must_use]
    pub fn shear_noise(&self) -> f64 {
        self.cells.sqrt() * self.noise.force
    }
}

impl Assemblies {
    /// None if the whole frame is one specimen on the rig at full scale, without an axial load.
    #[must_use]
    pub fn of(frame: &Frame) -> Option<Self> {
        let (supports, scales) = (supports(frame), scales(frame));
        // A stiffness that is no matrix has no properties either: nothing is integrated with it.
        if let Ok(Some(elements)) = frame.elements() {
            return Some(Self {
                axial: vec![0.0; supports.len()],
                supports,
                scales,
                elements: Some(elements),
            });
        }
        let whole = |(storey, support): (usize, &Support)| {
            let as_one = if storey == 0 {
                Support::StrongFloor
            } else {
                Support::Below
            };
            *support == as_one && scales[storey] == Scale::FULL
        };
        let is_whole = supports.iter().enumerate().all(whole) && !frame.has_axial_load();
        let axial = frame.storeys.iter().map(Storey::axial_stiffness);
        (!is_whole).then(|| Self {
            axial: axial.collect(),
            supports,
            scales,
            elements: None,
        })
    }

    /// So many floors, as one specimen on the rig.
    #[must_use]
    pub fn whole(floors: usize) -> Self {
        let above = std::iter::repeat_n(Support::Below, floors.saturating_sub(1));
        Self {
            supports: std::iter::once(Support::StrongFloor).chain(above).collect(),
            scales: vec![Scale::FULL; floors.max(1)],
            elements: None,
            axial: vec![0.0; floors.max(1)],
        }
    }

    /// The elements of a frame of matrices; None for storeys.
    #[must_use]
    pub const fn elements(&self) -> Option<&Elements> {
        self.elements.as_ref()
    }

    /// Whether every storey is tested, and all stand on each other: the specimen is the frame, at full scale or not.
    #[must_use]
    pub fn is_whole_frame(&self) -> bool {
        let storeys = self.supports.iter().skip(1);
        storeys.fold(
            self.elements.is_none() && self.supports.first() == Some(&Support::StrongFloor),
            |is, it| is && *it == Support::Below,
        )
    }

    /// Actuators, each with a load cell.
    #[must_use]
    pub fn axes(&self) -> usize {
        self.tested().count()
    }

    /// The storey of each axis, from 0.
    pub fn tested(&self) -> impl Iterator<Item = usize> {
        let storeys = self.supports.iter().enumerate();
        storeys.filter_map(|(storey, support)| (*support != Support::Computed).then_some(storey))
    }

    /// Whether the storey of each axis stands on the strong floor.
    #[must_use]
    pub fn standing(&self) -> Vec<bool> {
        self.tested()
            .map(|storey| self.supports[storey] == Support::StrongFloor)
            .collect()
    }

    /// The storeys of each assembly, from the ground up.
    #[must_use]
    pub fn specimens(&self) -> Vec<Vec<usize>> {
        let mut specimens: Vec<Vec<usize>> = Vec::new();
        for storey in self.tested() {
            match specimens.last_mut() {
                Some(last) if self.supports[storey] == Support::Below => last.push(storey),
                _ => specimens.push(vec![storey]),
            }
        }
        specimens
    }

    /// The storeys that models compute.
    #[must_use]
    pub fn computed(&self) -> Vec<usize> {
        let storeys = 0..self.supports.len();
        storeys
            .filter(|storey| self.supports[*storey] == Support::Computed)
            .collect()
    }

    /// The floor on which the assembly of a tested storey stands; None for the ground.
    fn base_of(&self, storey: usize) -> Option<usize> {
        let lowest = (0..=storey)
            .rev()
            .find(|lower| self.supports[*lower] == Support::StrongFloor);
        lowest.unwrap_or(0).checked_sub(1)
    }

    /// The scale of the specimen at each axis.
    #[must_use]
    pub fn scales(&self) -> Vec<Scale> {
        self.at_axes(&self.scales)
    }

    /// Whether a specimen on the rig is another one than its storeys.
    #[must_use]
    pub fn is_scaled(&self) -> bool {
        self.scales.iter().any(|scale| *scale != Scale::FULL)
    }

    /// Displacements or velocities of the floors become those of the tested storeys in their assemblies; 0 for computed ones. The numbers
    /// are those of the prototype.
    #[must_use]
    pub fn in_assemblies(&self, floors: &[f64]) -> Vec<f64> {
        if let Some(elements) = &self.elements {
            // Without a motion there are no velocities.
            let moving = if floors.is_empty() {
                0
            } else {
                self.supports.len()
            };
            let elements = elements.ends.iter().zip(&self.supports).take(moving);
            let relative = elements.map(|(ends, support)| match support {
                Support::Computed => 0.0,
                _ => deformation(*ends, floors),
            });
            return relative.collect();
        }
        let (mut below, mut base) = (0.0, 0.0);
        let storeys = self.supports.iter().zip(floors);
        let relative = storeys.map(|(support, floor)| {
            let below = std::mem::replace(&mut below, *floor);
            if *support == Support::StrongFloor {
                base = below;
            }
            if *support == Support::Computed {
                0.0
            } else {
                floor - base
            }
        });
        relative.collect()
    }

    /// The restoring forces of the floors become those of the actuators at the tested storeys \[N\]; 0 for computed ones. The numbers are
    /// those of the prototype. Those of elements do not follow from the forces of the degrees of freedom.
    #[must_use]
    pub fn forces_in_assemblies(&self, floors: &[f64]) -> Vec<f64> {
        let mut shear = vec![0.0; floors.len()];
        shears(floors, &mut shear);
        let force = |storey: usize| match (self.supports[storey], self.supports.get(storey + 1)) {
            (Support::Computed, _) => 0.0,
            (_, Some(Support::Below)) => floors[storey],
            // The shear of the storey above, which is of another substructure, acts at the same floor.
            _ => shear[storey],
        };
        (0..floors.len()).map(force).collect()
    }

    /// The entries of the tested storeys; none without entries.
    #[must_use]
    pub fn at_axes<T: Copy>(&self, storeys: &[T]) -> Vec<T> {
        let entry = |storey: usize| storeys.get(storey).copied();
        self.tested().filter_map(entry).collect()
    }

    /// Displacements of the axes \[m\], or their velocities \[m/s\], from those of the floors.
    #[must_use]
    pub fn axes_of(&self, floors: &[f64]) -> Vec<f64> {
        self.on_the_rig(self.in_assemblies(floors), |scale, prototype| {
            prototype * scale.displacement
        })
    }

    /// Displacements of the axes \[m\], from the deformations of all elements of a frame of matrices.
    #[must_use]
    pub fn axes_of_elements(&self, deformation: Vec<f64>) -> Vec<f64> {
        self.on_the_rig(deformation, |scale, prototype| {
            prototype * scale.displacement
        })
    }

    /// Forces of the axes \[N\], from the restoring forces of the floors.
    #[must_use]
    pub fn forces_of(&self, floors: &[f64]) -> Vec<f64> {
        self.on_the_rig(self.forces_in_assemblies(floors), |scale, prototype| {
            prototype / scale.forces()
        })
    }

    /// Measured displacements \[m\] and forces \[N\] of the axes, from those of the floors; the elements of a frame of matrices have
    /// their own `readings`.
    #[must_use]
    pub fn axes_read(
        &self,
        [displacement, force]: [&[f64]; 2],
        readings: &[ElementReading],
    ) -> [Vec<f64>; 2] {
        if self.elements.is_none() {
            return [self.axes_of(displacement), self.forces_of(force)];
        }
        let of = |value: fn(&ElementReading) -> f64| readings.iter().map(value).collect();
        [
            self.axes_of_elements(of(|read| read.deformation)),
            self.on_the_rig(of(|read| read.force), |scale, prototype| {
                prototype / scale.forces()
            }),
        ]
    }

    /// Command and measured displacement \[m\], and force \[N\] of the axis of every storey or element, from those of the axes; None for a
    /// computed one.
    #[must_use]
    pub fn of_members(
        &self,
        command: Vec<f64>,
        [displacement, force]: [Vec<f64>; 2],
    ) -> Vec<Option<[f64; 3]>> {
        let mut members = vec![None; self.supports.len()];
        let axes = command.into_iter().zip(displacement).zip(force);
        for (member, ((command, displacement), force)) in self.tested().zip(axes) {
            members[member] = Some([command, displacement, force]);
        }
        members
    }

    /// Stiffnesses of the storeys at the axes on the rig \[N/m\], from those of all storeys of the prototype.
    #[must_use]
    pub fn stiffnesses_of(&self, storeys: Vec<f64>) -> Vec<f64> {
        self.on_the_rig(storeys, Scale::stiffness_on_the_rig)
    }

    /// The numbers of the prototype, one per storey, become those of the axes.
    fn on_the_rig(&self, mut storeys: Vec<f64>, to: fn(&Scale, f64) -> f64) -> Vec<f64> {
        for (value, scale) in storeys.iter_mut().zip(&self.scales) {
            *value = to(scale, *value);
        }
        self.at_axes(&storeys)
    }

    /// The readings of every storey in numbers of the prototype, if each cell and each transducer of the rig has this noise.
    #[must_use]
    pub fn readings(&self, noise: DeclaredNoise) -> Vec<StoreyReadings> {
        #[expect(clippy::cast_precision_loss, reason = "no frame has 2^53 storeys")]
        let storey = |storey: usize| StoreyReadings {
            noise: if self.supports[storey] == Support::Computed {
                DeclaredNoise::NONE
            } else {
                self.scales[storey].noise_of_prototype(noise)
            },
            cells: self.shear_of(storey).len() as f64,
            is_difference: self.supports[storey] == Support::Below,
            axial_stiffness: self.axial[storey],
        };
        (0..self.supports.len()).map(storey).collect()
    }

    /// The axis of a storey, from 0; None for a computed one.
    fn axis_of(&self, storey: usize) -> Option<usize> {
        self.tested().position(|tested| tested == storey)
    }

    /// The readings of the storeys at the axes in numbers of the rig, from those of all storeys of the prototype.
    #[must_use]
    pub fn readings_of(&self, storeys: &[StoreyReadings]) -> Vec<StoreyReadings> {
        let tested = self.at_axes(storeys).into_iter().zip(self.scales());
        let on_the_rig = tested.map(|(readings, scale)| StoreyReadings {
            noise: scale.noise_on_the_rig(readings.noise),
            axial_stiffness: scale.stiffness_on_the_rig(readings.axial_stiffness),
            ..readings
        });
        on_the_rig.collect()
    }

    /// The noise of a cell and of a transducer in numbers of the prototype, at the storey where it is largest.
    #[must_use]
    pub fn largest_noise(&self, noise: DeclaredNoise) -> DeclaredNoise {
        let largest = |factor: fn(&Scale) -> f64| {
            let factors = self.tested().map(|storey| factor(&self.scales[storey]));
            factors.reduce(f64::max).unwrap_or(1.0)
        };
        DeclaredNoise {
            force: noise.force * largest(Scale::forces),
            resolution: noise.resolution * largest(Scale::displacements),
        }
    }

    /// Whether the displacement of a floor is the sum of measured ones alone, or the element is on the rig.
    #[must_use]
    pub fn is_measured(&self, floor: usize) -> bool {
        let first = self.elements.as_ref().map_or(0, |_| floor);
        let mut supports = self.supports[first..=floor].iter();
        supports.all(|support| *support != Support::Computed)
    }

    /// The axes of which the measured displacement of a floor is the sum, each with the factor from the rig to the prototype. An element
    /// has its own deformation.
    #[must_use]
    pub fn positions_of(&self, floor: usize) -> Vec<(usize, f64)> {
        if self.elements.is_some() {
            let own = self.axis_of(floor).into_iter();
            return own
                .map(|axis| (axis, self.scales[floor].displacements()))
                .collect();
        }
        let (mut axes, mut next) = (Vec::new(), Some(floor));
        while let Some(floor) = next {
            next = match self.axis_of(floor) {
                None => floor.checked_sub(1),
                Some(axis) => {
                    axes.push((axis, self.scales[floor].displacements()));
                    self.base_of(floor)
                }
            };
        }
        axes
    }

    /// The axes of which the restoring force of a floor is the sum, each with the factor from the rig to the prototype and the sign of its
    /// force: its own, and those of the assembly that stands on the floor. An element has its own force.
    #[must_use]
    pub fn forces_at(&self, floor: usize) -> Vec<(usize, f64)> {
        let forces = |storey: usize| self.scales[storey].forces();
        let own = self.axis_of(floor).map(|axis| (axis, forces(floor)));
        let standing = self.tested().enumerate();
        let standing = standing
            .filter(|(_, storey)| self.elements.is_none() && self.base_of(*storey) == Some(floor));
        own.into_iter()
            .chain(standing.map(|(axis, storey)| (axis, -forces(storey))))
            .collect()
    }

    /// The axes of which the measured shear of a storey is the sum; none for a computed one.
    #[must_use]
    pub fn shear_of(&self, storey: usize) -> Vec<usize> {
        let in_assembly = self.supports[storey + 1..].iter();
        let above = in_assembly
            .take_while(|support| **support == Support::Below)
            .count();
        self.axis_of(storey)
            .map_or_else(Vec::new, |axis| (axis..=axis + above).collect())
    }

    /// The axis of a storey, and that of the storey below in its assembly: their difference is the measured drift.
    #[must_use]
    pub fn drift_of(&self, storey: usize) -> [Option<usize>; 2] {
        let own = self.axis_of(storey);
        let is_below = self.supports[storey] == Support::Below;
        [
            own,
            own.filter(|_| is_below)
                .and_then(|axis| axis.checked_sub(1)),
        ]
    }
}
