//! The tangent stiffness of a structure, storey by storey (Melo et al. 2006, eq. 6): the secant of its shear over its storey drift; one
//! degree of freedom is one storey. An element of a frame of matrices has the secant of its force over its deformation. In: the readings
//! of the actuators. Out: storey stiffnesses, and whether one changed.

use std::fmt::Debug;

use super::step_form::{Moment, Motion, StepContact, StepForm};
use super::tangent::{Following, TangentStiffness};
use crate::statistics::DeclaredNoise;
use crate::structure::assemblies::StoreyReadings;
use crate::structure::elements::{ElementReading, Elements};
use crate::structure::matrix::one_degree::{Body, LEAST_CHANGE, Secant};
use crate::structure::matrix::{Matrix, Vector};
use crate::structure::{Matrices, SymmetricBand, set_storeys, storeys_of};

/// `K_t` of the tangent form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tangents {
    /// K0 throughout: for a frame without storeys in its matrix.
    Initial,
    /// Each storey's or element's own secant, within `[0, largest_ratio · k0]`. The frame is a shear building, or has elements. The bounds
    /// of a storey with an axial load on the rig are lower by the P-Δ in its reading.
    Storeys { largest_ratio: f64 },
}

/// Largest effect of rounding on a secant, over its first-order bound: products and the specimen's own arithmetic contribute too. With
/// less, a linear frame is factored again in every step; with much more, a slow change is missed.
const ROUNDING_MARGIN: f64 = 4.0;

/// The current tangent stiffness `K_t`.
pub trait FollowedTangents: Clone + Debug {
    type Vector: Vector;

    /// Within `[0, largest_ratio · k0]`, with the readings of each storey, from their first values (m, N); None if the stiffness is not that of
    /// storeys.
    fn new(
        stiffness: &<Self::Vector as Vector>::Matrix,
        largest_ratio: f64,
        readings: &[StoreyReadings],
        displacement: &Self::Vector,
        force: &Self::Vector,
    ) -> Option<Self>;

    /// The same for the elements of a frame of matrices.
    fn of_elements(
        elements: &Elements,
        largest_ratio: f64,
        readings: &[StoreyReadings],
        displacement: &Self::Vector,
        read: &[ElementReading],
    ) -> Option<Self>;

    /// From the ground up \[N/m\].
    fn stiffness(&self) -> &Self::Vector;

    /// `K_t` into `operator`.
    fn compose(&self, operator: &mut <Self::Vector as Vector>::Matrix);

    /// Adds the readings at the end of a step. True if the stiffness of a storey changed by more than rounding: only then is a new
    /// factorisation necessary.
    fn take(
        &mut self,
        displacement: &Self::Vector,
        force: &Self::Vector,
        elements: &[ElementReading],
    ) -> bool;
}

/// A vector of a structure whose tangent stiffness can be followed.
pub trait HasTangents: Vector {
    type Tangents: FollowedTangents<Vector = Self>;

    /// The whole step in tangent form, except the force at its end, which is read later.
    #[allow(
        private_interfaces,
        private_bounds,
        reason = "no other crate steps a form"
    )]
    fn predict(
        form: &mut StepForm<Self>,
        tangents: Option<&Self::Tangents>,
        from: &Moment<Self>,
        load_end: &Self,
        to: &mut Motion<Self>,
        contact: impl StepContact,
    );

    /// The tangents have changed.
    #[allow(
        private_interfaces,
        private_bounds,
        reason = "no other crate steps a form"
    )]
    fn follow(form: &mut StepForm<Self>, tangents: &Self::Tangents);
}

#[allow(
    private_interfaces,
    private_bounds,
    reason = "no other crate steps a form"
)]
impl HasTangents for f64 {
    type Tangents = StoreyTangent;

    #[inline]
    fn predict(
        form: &mut StepForm<f64>,
        tangents: Option<&StoreyTangent>,
        from: &Moment<f64>,
        load_end: &f64,
        to: &mut Motion<f64>,
        contact: impl StepContact,
    ) {
        let Matrices { mass, damping, .. } = form.matrices;
        let point = Point {
            body: Body::new([mass, damping], form.time_step),
            damped: form.damping().is_some(),
            secant: tangents.map_or(Secant::of(*form.operator()), |tangents| tangents.secant),
            motion: [*from.displacement, *from.velocity, *from.acceleration],
            unbalanced: load_end - from.force,
        };
        let ([displacement, velocity, acceleration], force) = point.step(contact);
        (to.displacement, to.velocity, to.acceleration) = (displacement, velocity, acceleration);
        form.set_contact_force(force);
    }

    /// A whole step has its tangent as a ratio; only a part of one needs the factor.
    #[inline]
    fn follow(form: &mut StepForm<f64>, tangents: &StoreyTangent) {
        if form.is_divided {
            let _ = form.set_tangent(|stiffness| tangents.compose(stiffness));
        }
    }
}

#[allow(
    private_interfaces,
    private_bounds,
    reason = "no other crate steps a form"
)]
impl HasTangents for Vec<f64> {
    type Tangents = StoreyTangents;

    /// A frame of one floor is one degree of freedom.
    #[inline]
    fn predict(
        form: &mut StepForm<Self>,
        tangents: Option<&StoreyTangents>,
        from: &Moment<Self>,
        load_end: &Self,
        to: &mut Motion<Self>,
        contact: impl StepContact,
    ) {
        if load_end.len() > 1 {
            return form.predict(from, load_end, to, contact);
        }
        let constant = || Secant::of(form.operator().at(0, 0));
        let Matrices {
            mass,
            damping,
            gravity,
            ..
        } = &form.matrices;
        let net = |secant: Secant| match gravity {
            Some(gravity) => secant.less(gravity.at(0, 0)),
            None => secant,
        };
        let point = Point {
            body: Body::new([mass.at(0, 0), damping.at(0, 0)], form.time_step),
            damped: form.damping().is_some(),
            secant: tangents
                .and_then(|tangents| Some((tangents.only.as_ref()?, &tangents.axial)))
                .map_or_else(constant, |(only, axial)| {
                    net(axial
                        .as_ref()
                        .map_or(only.secant, |axial| only.secant.less(axial.shares[0])))
                }),
            motion: [from.displacement[0], from.velocity[0], from.acceleration[0]],
            unbalanced: load_end[0] - from.force[0],
        };
        let ([displacement, velocity, acceleration], force) = point.step(contact);
        to.displacement[0] = displacement;
        to.velocity[0] = velocity;
        to.acceleration[0] = acceleration;
        form.set_contact_force(force);
    }

    /// The tangent of the only storey is a ratio, as that of one degree of freedom.
    fn follow(form: &mut StepForm<Self>, tangents: &StoreyTangents) {
        if tangents.only.is_some() && !form.is_divided {
            return;
        }
        // No storey tangent is negative, so that M̂ has a factor because M has one; after a failure by rounding the last factor
        // remains.
        let _ = form.set_tangent(|stiffness| tangents.compose(stiffness));
    }
}

/// A step of one degree of freedom.
struct Point {
    body: Body,
    damped: bool,
    secant: Secant,
    /// X, Ẋ, Ẍ
    motion: [f64; 3],
    /// f₁ − R \[N\]
    unbalanced: f64,
}

impl Point {
    /// X₁, Ẋ₁, Ẍ₁ and F \[N\].
    #[inline]
    fn step(&self, mut contact: impl StepContact) -> ([f64; 3], f64) {
        let [displacement, velocity, acceleration] = self.motion;
        let unforced = self.body.unforced(
            self.damped,
            [velocity, acceleration],
            self.unbalanced,
            &self.secant,
        );
        let [top, bottom] = contact.joined(self.body.half, &unforced);
        let acceleration = top / bottom;
        let [displacement, velocity] = self.body.travel(displacement, &unforced, acceleration);
        (
            [displacement, velocity, acceleration],
            contact.settled(velocity),
        )
    }
}

/// The tangent of one degree of freedom: of exact readings a ratio, which a step solves without a division.
#[derive(Clone, Debug)]
pub struct StoreyTangent {
    secant: Secant,
    /// \[N/m\]
    largest: f64,
    /// The last reading \[m\], \[N\].
    last: [f64; 2],
    /// None if readings are exact.
    noisy: Option<Box<TangentStiffness>>,
    /// \[N/m\]
    stiffness: f64,
}

/// The tangents of storeys, or of the elements of a frame of matrices.
#[derive(Clone, Debug)]
pub struct StoreyTangents {
    /// That of the only storey.
    only: Option<StoreyTangent>,
    /// None for storeys.
    elements: Option<Elements>,
    storeys: Vec<Storey>,
    /// \[N/m\]
    stiffnesses: Vec<f64>,
    axial: Option<AxialShares>,
}

/// The P-Δ of axial loads on the rig. The tangents are followed without it, within their bounds, and are given with it.
#[derive(Clone, Debug)]
struct AxialShares {
    /// In the reading of each storey \[N/m\].
    shares: Vec<f64>,
    /// Tangents with it \[N/m\].
    net: Vec<f64>,
}

impl AxialShares {
    fn of(readings: &[StoreyReadings], stiffnesses: &[f64]) -> Option<Self> {
        let shares: Vec<f64> = readings
            .iter()
            .map(|storey| storey.axial_stiffness)
            .collect();
        shares.iter().any(|share| *share != 0.0).then(|| Self {
            shares,
            net: stiffnesses.to_vec(),
        })
    }

    /// The reading without the P-Δ.
    fn without(&self, storey: usize, reading: Reading) -> Reading {
        Reading {
            shear: reading.shear + self.shares[storey] * reading.drift,
            ..reading
        }
    }

    fn update(&mut self, stiffnesses: &[f64]) {
        let storeys = self.net.iter_mut().zip(stiffnesses).zip(&self.shares);
        storeys.for_each(|((net, stiffness), share)| *net = stiffness - share);
    }
}

#[derive(Clone, Debug)]
struct Storey {
    followed: TangentStiffness,
    last: Reading,
}

/// One storey at one instant.
#[derive(Clone, Copy, Debug)]
struct Reading {
    /// \[m\]
    drift: f64,
    /// \[N\]
    shear: f64,
    /// \[m\] and \[N\]: the largest effect of rounding on them.
    drift_rounding: f64,
    shear_rounding: f64,
}

impl Storey {
    fn new(stiffness: f64, following: Following, last: Reading) -> Self {
        let followed = TangentStiffness::new(stiffness, following, last.drift, last.shear);
        Self { followed, last }
    }

    /// Adds the next reading of one storey of several; returns whether `stiffness` \[N/m\] changed by more than rounding.
    #[inline]
    fn take(&mut self, now: Reading, stiffness: &mut f64) -> bool {
        self.followed.take(now.drift, now.shear);
        let last = std::mem::replace(&mut self.last, now);
        let difference = (self.followed.value() - *stiffness).abs();
        let rounding = last.shear_rounding
            + now.shear_rounding
            + *stiffness * (last.drift_rounding + now.drift_rounding);
        // |Δk| > margin · rounding / |Δδ|, without the division.
        let changed = difference * (now.drift - last.drift).abs() > ROUNDING_MARGIN * rounding;
        if changed {
            *stiffness = self.followed.value();
        }
        changed
    }
}

/// Calls with each storey's reading, from the top down: a storey drift is the difference of two displacements, a shear the sum of the
/// restoring forces of the floors above.
#[inline]
fn each_reading(displacement: &[f64], force: &[f64], mut take: impl FnMut(usize, Reading)) {
    let (mut shear, mut size, mut cells) = (0.0, 0.0, 0.0);
    for storey in (0..force.len()).rev() {
        let (here, below) = (
            displacement[storey],
            if storey == 0 {
                0.0
            } else {
                displacement[storey - 1]
            },
        );
        shear += force[storey];
        size += force[storey].abs();
        cells += 1.0;
        let drift_rounding = f64::EPSILON * (here.abs() + below.abs());
        take(
            storey,
            Reading {
                drift: here - below,
                shear,
                drift_rounding,
                shear_rounding: f64::EPSILON * cells * size,
            },
        );
    }
}

/// The same with the reading of each element, between floors at these displacements \[m\].
fn each_element(
    elements: &Elements,
    displacement: &[f64],
    read: &[ElementReading],
    mut take: impl FnMut(usize, Reading),
) {
    for (element, (ends, read)) in elements.ends.iter().zip(read).enumerate() {
        let ends = ends.iter().flatten();
        let size: f64 = ends.map(|end| displacement[*end].abs()).sum();
        take(
            element,
            Reading {
                drift: read.deformation,
                shear: read.force,
                drift_rounding: f64::EPSILON * size,
                shear_rounding: f64::EPSILON * read.force.abs(),
            },
        );
    }
}

/// The parameters of the tangent of one storey.
fn following(largest_ratio: f64, readings: Option<&StoreyReadings>) -> Following {
    let noise = readings.map_or(DeclaredNoise::NONE, |readings| DeclaredNoise {
        force: readings.shear_noise(),
        resolution: if readings.is_difference {
            2.0 * readings.noise.resolution
        } else {
            readings.noise.resolution
        },
    });
    Following {
        largest_ratio,
        noise,
    }
}

impl FollowedTangents for StoreyTangent {
    type Vector = f64;

    fn new(
        stiffness: &f64,
        largest_ratio: f64,
        readings: &[StoreyReadings],
        displacement: &f64,
        force: &f64,
    ) -> Option<Self> {
        let following = following(largest_ratio, readings.first());
        let exact = following.noise == DeclaredNoise::NONE;
        let noisy = || TangentStiffness::new(*stiffness, following, *displacement, *force);
        Some(Self {
            secant: Secant::of(*stiffness),
            largest: following.largest_ratio * stiffness,
            last: [*displacement, *force],
            noisy: (!exact).then(|| Box::new(noisy())),
            stiffness: *stiffness,
        })
    }

    fn of_elements(
        _: &Elements,
        _: f64,
        _: &[StoreyReadings],
        _: &f64,
        _: &[ElementReading],
    ) -> Option<Self> {
        None
    }

    #[inline]
    fn stiffness(&self) -> &f64 {
        &self.stiffness
    }

    #[inline]
    fn compose(&self, operator: &mut f64) {
        operator.become_copy(&self.stiffness);
    }

    #[inline]
    fn take(&mut self, displacement: &f64, force: &f64, _: &[ElementReading]) -> bool {
        let [change, rise] = [displacement - self.last[0], force - self.last[1]];
        self.last = [*displacement, *force];
        self.secant = match &mut self.noisy {
            None => self.secant.after(rise, change, self.largest, LEAST_CHANGE),
            Some(followed) => Secant::of(followed.take(*displacement, *force)),
        };
        let before = std::mem::replace(&mut self.stiffness, self.secant.stiffness());
        self.stiffness != before
    }
}

impl FollowedTangents for StoreyTangents {
    type Vector = Vec<f64>;

    fn new(
        stiffness: &SymmetricBand,
        largest_ratio: f64,
        readings: &[StoreyReadings],
        displacement: &Vec<f64>,
        force: &Vec<f64>,
    ) -> Option<Self> {
        let mut stiffnesses = storeys_of(stiffness)?;
        let axial = AxialShares::of(readings, &stiffnesses);
        if let Some(axial) = &axial {
            let storeys = stiffnesses.iter_mut().zip(&axial.shares);
            storeys.for_each(|(stiffness, share)| *stiffness += share);
        }
        let mut storeys = Vec::with_capacity(stiffnesses.len());
        each_reading(displacement, force, |storey, first| {
            let following = following(largest_ratio, readings.get(storey));
            let first = axial
                .as_ref()
                .map_or(first, |axial| axial.without(storey, first));
            storeys.push(Storey::new(stiffnesses[storey], following, first));
        });
        storeys.reverse();
        let only = match (&stiffnesses[..], &storeys[..]) {
            ([only], [storey]) => StoreyTangent::new(
                only,
                largest_ratio,
                readings,
                &storey.last.drift,
                &storey.last.shear,
            ),
            _ => None,
        };
        Some(Self {
            only,
            elements: None,
            storeys,
            stiffnesses,
            axial,
        })
    }

    fn of_elements(
        elements: &Elements,
        largest_ratio: f64,
        readings: &[StoreyReadings],
        displacement: &Vec<f64>,
        read: &[ElementReading],
    ) -> Option<Self> {
        let mut followed = Vec::with_capacity(read.len());
        each_element(elements, displacement, read, |element, first| {
            let following = following(largest_ratio, readings.get(element));
            followed.push(Storey::new(elements.stiffness[element], following, first));
        });
        Some(Self {
            only: None,
            elements: Some(elements.clone()),
            storeys: followed,
            stiffnesses: elements.stiffness.clone(),
            axial: None,
        })
    }

    fn stiffness(&self) -> &Vec<f64> {
        self.axial
            .as_ref()
            .map_or(&self.stiffnesses, |axial| &axial.net)
    }

    fn compose(&self, operator: &mut SymmetricBand) {
        match &self.elements {
            Some(elements) => elements.compose(&self.stiffnesses, operator),
            None => set_storeys(self.stiffness(), operator),
        }
    }

    fn take(&mut self, displacement: &Vec<f64>, force: &Vec<f64>, read: &[ElementReading]) -> bool {
        let mut changed = false;
        let Self {
            only,
            elements,
            storeys,
            stiffnesses,
            axial,
        } = self;
        if let Some(elements) = elements {
            each_element(elements, displacement, read, |element, now| {
                changed |= storeys[element].take(now, &mut stiffnesses[element]);
            });
            return changed;
        }
        if let Some(only) = only {
            let share = axial.as_ref().map(|axial| axial.shares[0]);
            let force = share.map_or(force[0], |share| force[0] + share * displacement[0]);
            changed = only.take(&displacement[0], &force, &[]);
            stiffnesses[0] = only.stiffness;
        } else {
            each_reading(displacement, force, |storey, now| {
                let now = axial
                    .as_ref()
                    .map_or(now, |axial| axial.without(storey, now));
                changed |= storeys[storey].take(now, &mut stiffnesses[storey]);
            });
        }
        if let Some(axial) = axial {
            axial.update(stiffnesses);
        }
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::{floor_forces, storey_stiffness};

    const INITIAL: [f64; 3] = [3000.0, 2000.0, 1000.0];

    fn read(stiffnesses: &[f64; 3], drift: &[f64; 3]) -> (Vec<f64>, Vec<f64>) {
        let displacement = [
            drift[0],
            drift[0] + drift[1],
            drift[0] + drift[1] + drift[2],
        ];
        let shear = [
            stiffnesses[0] * drift[0],
            stiffnesses[1] * drift[1],
            stiffnesses[2] * drift[2],
        ];
        let mut force = [0.0; 3];
        floor_forces(&shear, &mut force);
        (displacement.to_vec(), force.to_vec())
    }

    fn at_rest(noise: f64, resolution: f64) -> StoreyTangents {
        let noise = DeclaredNoise {
            force: noise,
            resolution,
        };
        StoreyTangents::new(
            &storey_stiffness(&INITIAL),
            2.0,
            &StoreyReadings::of_floors(noise, 3),
            &vec![0.0; 3],
            &vec![0.0; 3],
        )
        .expect("storeys")
    }

    /// A small linear motion leaves the stiffness of every storey exactly as it is.
    #[test]
    fn rounding_is_no_stiffness() {
        let mut tangents = at_rest(0.0, 0.0);
        for step in 0..20_000 {
            let time = f64::from(step) * 1e-3;
            let drift = [
                (3.0 * time).sin(),
                0.3 * (7.0 * time).cos(),
                1e-3 * (11.0 * time).sin(),
            ];
            let (displacement, force) = read(&INITIAL, &drift);
            assert!(
                !tangents.take(&displacement, &force, &[]),
                "step {step}: {:?}",
                tangents.stiffness()
            );
        }
        assert_eq!(tangents.stiffness(), &INITIAL);
    }

    /// One storey softens, a second one stiffens beyond its bound: each by its own storey drift. The third does not change.
    #[test]
    fn each_storey_is_followed_by_its_own_drift() {
        let mut tangents = at_rest(0.0, 0.0);
        let (displacement, force) = read(&[3000.0, 500.0, 9000.0], &[1e-3, -2e-3, 3e-3]);
        assert!(tangents.take(&displacement, &force, &[]));
        let found = tangents.stiffness();
        assert_eq!((found[0], found[2]), (3000.0, 2000.0));
        assert!((found[1] - 500.0).abs() < 1e-9);
    }

    /// Load cells of 1 N: a shear of three has √3 N, so that the first storey needs 10·√3/3000 m for a slope, the third 10/1000.
    #[test]
    fn a_change_below_the_resolution_gives_no_tangent() {
        let indefinite = |drift: [f64; 3], storey: usize| {
            let mut tangents = at_rest(1.0, 0.0);
            let (displacement, force) = read(&[300.0, 200.0, 100.0], &drift);
            tangents.take(&displacement, &force, &[]);
            tangents.stiffness()[storey] != INITIAL[storey]
        };
        assert!(!indefinite([0.0057, 0.0, 0.0], 0) && indefinite([0.0059, 0.0, 0.0], 0));
        assert!(!indefinite([0.0, 0.0, 0.0099], 2) && indefinite([0.0, 0.0, 0.0101], 2));
        let mut coarse = at_rest(0.0, 1e-3);
        let (displacement, force) = read(&[300.0, 200.0, 100.0], &[1.5e-3, 1.5e-3, 2.5e-3]);
        coarse.take(&displacement, &force, &[]);
        assert_eq!(
            coarse.stiffness()[1],
            INITIAL[1],
            "two readings, two quantization steps"
        );
        assert!(coarse.stiffness()[0] < INITIAL[0] && coarse.stiffness()[2] < INITIAL[2]);
    }
}
