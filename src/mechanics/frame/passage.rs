//! Structure and striker on their way through one step, where the contact acts at its own instants. In: a frame, the state
//! at the step's start. Out: the motion after any part of the step. It knows no contact law.

use super::band::SymmetricBand;
use super::factor::{BandFactor, NotPositiveDefinite};
use super::schemes::{Course, Moment, Schemes};
use crate::mechanics::law::Advance;

/// The striker of a frame, and where it strikes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Striker {
    /// The struck degree of freedom, from 0.
    pub struck: usize,
    /// Ms, kg
    pub mass: f64,
    /// g of Ms Ẍs = Ms g − F, m/s²; 0 of a striker that does not fall.
    pub gravity: f64,
}

/// Striker and struck floor at a step's start.
#[derive(Clone, Copy)]
pub(super) struct Start {
    pub displacement: f64,
    pub velocity: f64,
    pub striker_displacement: f64,
    pub striker_velocity: f64,
    pub indentation: f64,
}

/// What a step through a contact came to; the frame's own end is its course.
pub(super) type Passed = Advance<()>;

/// A frame between two instants of a step.
pub(super) struct Passage<'a> {
    pub frame: &'a Schemes,
    /// M⁻¹ e_s, 1/kg
    pub push: Vec<f64>,
    mass: BandFactor,
    load: (&'a [f64], &'a [f64]),
    effective: SymmetricBand,
    factor: BandFactor,
}

impl<'a> Passage<'a> {
    /// From a step's start; loads go straight from that there to that at the end.
    pub fn new(frame: &'a Schemes, from: Moment<'a>, load_end: &'a [f64], struck: usize) -> Result<Self, NotPositiveDefinite> {
        let mass = BandFactor::new(&frame.matrices.mass)?;
        let mut push = vec![0.0; frame.matrices.order()];
        push[struck] = 1.0;
        mass.solve_in_place(&mut push);
        let effective = frame.effective();
        let factor = BandFactor::new(effective)?;
        Ok(Self { frame, push, mass, load: (from.load, load_end), effective: effective.clone(), factor })
    }

    /// Effective mass of the struck floor, kg: what a blow of no duration meets.
    pub fn struck_mass(&self, struck: usize) -> f64 {
        1.0 / self.push[struck]
    }

    /// The load of one degree of freedom at a part of the step, 0 to 1, N.
    pub fn load(&self, degree: usize, part: f64) -> f64 {
        let (first, last) = (self.load.0[degree], self.load.1[degree]);
        first + part * (last - first)
    }

    /// Makes M̂ = M + ½hC + ¼h²K_t, with `joined` kg more on one degree of freedom, the matrix that `solve` undoes.
    pub fn prepare(&mut self, duration: f64, joined: Option<(usize, f64)>) {
        let half = 0.5 * duration;
        let effective = &mut self.effective;
        effective.copy_from(self.frame.operator());
        effective.scale(half);
        if self.frame.is_damped() {
            effective.add(&self.frame.matrices.damping, 1.0);
        }
        effective.scale(half);
        effective.add(&self.frame.matrices.mass, 1.0);
        if let Some((place, mass)) = joined {
            effective.set(place, place, effective.entry(place, place) + mass);
        }
        // M̂ is positive definite as M is; if rounding ever denied it, the last factor would serve on.
        let _ = self.factor.renew(effective);
    }

    /// x ← M̂⁻¹ x.
    pub fn solve(&self, x: &mut [f64]) {
        self.factor.solve_in_place(x);
    }

    /// Eq. (5) from `from` over `duration`, to an end that is `part` of the step away from its start; `joined` is a mass that
    /// moves with one degree of freedom, kg, and its weight, N.
    pub fn follow(&mut self, from: &Course, duration: f64, part: f64, joined: Option<(usize, f64, f64)>, to: &mut Course) {
        self.prepare(duration, joined.map(|(place, mass, _)| (place, mass)));
        let half = 0.5 * duration;
        let glide = mixed(&from.velocity, half, &from.acceleration);
        let drift = mixed(&from.velocity, 0.5 * half, &from.acceleration);
        for (degree, (to, force)) in to.acceleration.iter_mut().zip(&from.force).enumerate() {
            *to = self.load(degree, part) - force;
        }
        if self.frame.is_damped() {
            self.frame.matrices.damping.mul_add(-1.0, &glide, &mut to.acceleration);
        }
        self.frame.operator().mul_add(-duration, &drift, &mut to.acceleration);
        if let Some((place, _, weight)) = joined {
            to.acceleration[place] += weight;
        }
        self.solve(&mut to.acceleration);
        for degree in 0..glide.len() {
            to.velocity[degree] = from.velocity[degree] + half * (from.acceleration[degree] + to.acceleration[degree]);
            to.displacement[degree] = from.displacement[degree] + half * (from.velocity[degree] + to.velocity[degree]);
        }
        self.spring(from, to);
    }

    /// R₁ = R + K_t(X₁ − X).
    pub fn spring(&self, from: &Course, to: &mut Course) {
        let moved: Vec<f64> = to.displacement.iter().zip(&from.displacement).map(|(to, from)| to - from).collect();
        to.force.copy_from_slice(&from.force);
        self.frame.operator().mul_add(1.0, &moved, &mut to.force);
    }

    /// M Ẍ = f − R − CẊ + F e_s at `part` of the step: the acceleration of an instant.
    pub fn settle(&self, struck: usize, force: f64, part: f64, at: &mut Course) {
        for (degree, (acceleration, restoring)) in at.acceleration.iter_mut().zip(&at.force).enumerate() {
            *acceleration = self.load(degree, part) - restoring;
        }
        at.acceleration[struck] += force;
        self.frame.matrices.damping.mul_add(-1.0, &at.velocity, &mut at.acceleration);
        self.mass.solve_in_place(&mut at.acceleration);
    }

    /// M⁻¹ x.
    pub fn accelerate(&self, x: &mut [f64]) {
        self.mass.solve_in_place(x);
    }

    /// ∫ ẊᵀCẊ dt over `duration` with the mean velocity v, J.
    pub fn damped(&self, mean_velocity: &[f64], duration: f64) -> f64 {
        if self.frame.is_damped() { duration * self.frame.matrices.damping.form(mean_velocity, mean_velocity) } else { 0.0 }
    }
}

/// x + factor · y.
fn mixed(x: &[f64], factor: f64, y: &[f64]) -> Vec<f64> {
    x.iter().zip(y).map(|(x, y)| x + factor * y).collect()
}

impl Course {
    /// Where a frame is at this moment, a degree of freedom an entry.
    pub fn at(moment: Moment) -> Self {
        Self {
            displacement: moment.displacement.to_vec(),
            velocity: moment.velocity.to_vec(),
            acceleration: moment.acceleration.to_vec(),
            force: moment.force.to_vec(),
        }
    }
}
