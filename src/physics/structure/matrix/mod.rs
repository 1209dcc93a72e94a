//! Numbers of a structure: for one degree of freedom a number with numbers as matrices, for many a vector with symmetric bands. In: the
//! operations of an integrator. Out: the same arithmetic for both; for one degree of freedom it compiles to plain floating-point code. It
//! knows no equation of motion.

mod band;
mod factor;
pub(crate) mod one_degree;
mod tridiagonal;

use std::fmt::Debug;

pub use band::{RowsError, SymmetricBand};
pub use factor::{BandFactor, NotPositiveDefinite};

/// One quantity of every degree of freedom.
pub trait Vector: Clone + Debug + Default + PartialEq + 'static {
    type Matrix: Matrix<Vector = Self>;
    /// The form in which callers pass it: a number, or a slice.
    type View<'a>: Copy + Debug
    where
        Self: 'a;

    #[must_use]
    fn zero(order: usize) -> Self;

    #[must_use]
    fn view(&self) -> Self::View<'_>;

    #[must_use]
    fn order_of(view: Self::View<'_>) -> usize;

    /// One entry per degree of freedom, from the form of callers.
    #[must_use]
    fn slice_of<'a>(view: &'a Self::View<'_>) -> &'a [f64];

    /// One entry per degree of freedom, in the form of callers.
    #[must_use]
    fn view_of(slice: &[f64]) -> Self::View<'_>;

    /// Becomes a copy of `view`, in its own memory.
    fn set(&mut self, view: Self::View<'_>);

    /// Takes over the value of `other`, which is any afterwards.
    fn take_over(&mut self, other: &mut Self);

    /// One entry per degree of freedom.
    #[must_use]
    fn as_slice(&self) -> &[f64];

    #[must_use]
    fn as_mut_slice(&mut self) -> &mut [f64];

    /// Each entry becomes the value of `entry` for it and for the same entries of the others.
    fn update<const N: usize>(&mut self, others: [&Self; N], entry: impl Fn(f64, [f64; N]) -> f64);

    /// xᵀ y.
    #[must_use]
    fn dot(&self, other: &Self) -> f64;

    /// (x₀ + x₁)ᵀ (y₁ ± y₀), with the sign from `join`.
    #[must_use]
    fn trapezoid(x: [&Self; 2], y: [&Self; 2], join: impl Fn(f64, f64) -> f64) -> f64;

    /// F₁ − R − (C + Δt`K_t`)Ẋ + MẌ into `push`: M̂ times the sum of the accelerations at both ends of a step.
    #[inline]
    fn set_out(step: &SetOut<Self>, push: &mut Self) {
        set_out_by_products(step, push);
    }

    /// Eqs. (2c) and (2d): Ẋ₁ = Ẋ + ½Δt(Ẍ + Ẍ₁), X₁ = X + ½Δt(Ẋ + Ẋ₁); from (X, Ẋ, Ẍ). `acceleration` is Ẍ + Ẍ₁ and becomes Ẍ₁.
    fn travel(
        time_step: f64,
        from: [&Self; 3],
        acceleration: &mut Self,
        velocity: &mut Self,
        displacement: &mut Self,
    );
}

/// The start of a step in tangent form.
#[derive(Clone, Copy, Debug)]
pub struct SetOut<'a, V: Vector> {
    /// Ẋ \[m/s\] and Ẍ \[m/s²\].
    pub velocity: &'a V,
    pub acceleration: &'a V,
    /// R \[N\].
    pub force: &'a V,
    /// F₁ \[N\].
    pub load_end: &'a V,
    pub mass: &'a V::Matrix,
    /// C + Δt`K_t` \[N·s/m\]
    pub drag: &'a V::Matrix,
}

/// [`Vector::set_out`] for matrices of any band.
#[inline]
pub(crate) fn set_out_by_products<V: Vector>(step: &SetOut<V>, push: &mut V) {
    push.update([step.load_end, step.force], |_, [load, force]| load - force);
    step.drag.mul_add(-1.0, step.velocity, push);
    step.mass.mul_add(1.0, step.acceleration, push);
}

/// A symmetric matrix over the degrees of freedom.
pub trait Matrix: Clone + Debug + PartialEq {
    type Vector: Vector<Matrix = Self>;
    type Factor: Factor<Matrix = Self>;

    #[must_use]
    fn zero_of(order: usize) -> Self;
    #[must_use]
    fn rows(&self) -> usize;
    /// (row, column), from 0.
    #[must_use]
    fn at(&self, row: usize, column: usize) -> f64;
    /// Adds to a diagonal entry.
    fn add_at(&mut self, index: usize, value: f64);
    fn become_copy(&mut self, other: &Self);
    fn multiply(&mut self, factor: f64);
    /// Adds `factor` times the other.
    fn add_scaled(&mut self, other: &Self, factor: f64);
    #[must_use]
    fn vanishes(&self) -> bool;
    /// y = A x.
    fn product(&self, x: &Self::Vector, y: &mut Self::Vector);
    /// y ← y + factor · A x.
    fn mul_add(&self, factor: f64, x: &Self::Vector, y: &mut Self::Vector);
    /// xᵀ A x; `scratch` is a vector of the same order.
    #[must_use]
    fn quadratic(&self, x: &Self::Vector, scratch: &mut Self::Vector) -> f64;
    /// xᵀ A x of a sum x = x₀ + x₁; `scratch` is two vectors of the same order.
    #[must_use]
    fn quadratic_of_sum(&self, x: [&Self::Vector; 2], scratch: [&mut Self::Vector; 2]) -> f64;
}

/// A factor that solves A x = b.
pub trait Factor: Clone + Debug {
    type Matrix: Matrix<Factor = Self>;

    /// # Errors
    /// If the matrix is not positive definite.
    fn of(matrix: &Self::Matrix) -> Result<Self, NotPositiveDefinite>;

    /// The factor of a different matrix with the same band, in the same memory.
    ///
    /// # Errors
    /// If the matrix is not positive definite.
    fn replace(&mut self, matrix: &Self::Matrix) -> Result<(), NotPositiveDefinite>;

    /// x ← A⁻¹ x.
    fn solve(&self, x: &mut <Self::Matrix as Matrix>::Vector);
}

/// The matrix of one degree of freedom as its own factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pivot(f64);

impl Vector for f64 {
    type Matrix = f64;
    type View<'a> = f64;

    #[inline]
    fn zero(_: usize) -> Self {
        0.0
    }

    #[inline]
    fn view(&self) -> f64 {
        *self
    }

    #[inline]
    fn order_of(_: f64) -> usize {
        1
    }

    #[inline]
    fn slice_of(view: &f64) -> &[f64] {
        std::slice::from_ref(view)
    }

    #[inline]
    fn view_of(slice: &[f64]) -> f64 {
        slice[0]
    }

    #[inline]
    fn set(&mut self, view: f64) {
        *self = view;
    }

    #[inline]
    fn take_over(&mut self, other: &mut Self) {
        *self = *other;
    }

    #[inline]
    fn as_slice(&self) -> &[f64] {
        std::slice::from_ref(self)
    }

    #[inline]
    fn as_mut_slice(&mut self) -> &mut [f64] {
        std::slice::from_mut(self)
    }

    #[inline]
    fn update<const N: usize>(&mut self, others: [&Self; N], entry: impl Fn(f64, [f64; N]) -> f64) {
        *self = entry(*self, others.map(|other| *other));
    }

    #[inline]
    fn dot(&self, other: &Self) -> f64 {
        self * other
    }

    #[inline]
    fn trapezoid(x: [&Self; 2], y: [&Self; 2], join: impl Fn(f64, f64) -> f64) -> f64 {
        (x[0] + x[1]) * join(*y[1], *y[0])
    }

    #[inline]
    fn travel(
        time_step: f64,
        from: [&Self; 3],
        acceleration: &mut Self,
        velocity: &mut Self,
        displacement: &mut Self,
    ) {
        let half = 0.5 * time_step;
        *velocity = from[1] + half * *acceleration;
        *displacement = from[0] + half * (from[1] + *velocity);
        *acceleration -= from[2];
    }
}

impl Matrix for f64 {
    type Vector = f64;
    type Factor = Pivot;

    #[inline]
    fn zero_of(_: usize) -> Self {
        0.0
    }

    #[inline]
    fn rows(&self) -> usize {
        1
    }

    #[inline]
    fn at(&self, _: usize, _: usize) -> f64 {
        *self
    }

    #[inline]
    fn add_at(&mut self, _: usize, value: f64) {
        *self += value;
    }

    #[inline]
    fn become_copy(&mut self, other: &Self) {
        *self = *other;
    }

    #[inline]
    fn multiply(&mut self, factor: f64) {
        *self *= factor;
    }

    #[inline]
    fn add_scaled(&mut self, other: &Self, factor: f64) {
        *self += factor * other;
    }

    #[inline]
    fn vanishes(&self) -> bool {
        *self == 0.0
    }

    #[inline]
    fn product(&self, x: &f64, y: &mut f64) {
        *y = self * x;
    }

    #[inline]
    fn mul_add(&self, factor: f64, x: &f64, y: &mut f64) {
        *y += factor * (self * x);
    }

    #[inline]
    fn quadratic(&self, x: &f64, _: &mut f64) -> f64 {
        self * x * x
    }

    #[inline]
    fn quadratic_of_sum(&self, x: [&f64; 2], _: [&mut f64; 2]) -> f64 {
        let x = x[0] + x[1];
        self * x * x
    }
}

impl Factor for Pivot {
    type Matrix = f64;

    #[inline]
    fn of(matrix: &f64) -> Result<Self, NotPositiveDefinite> {
        let mut factor = Self(1.0);
        factor.replace(matrix)?;
        Ok(factor)
    }

    #[inline]
    fn replace(&mut self, matrix: &f64) -> Result<(), NotPositiveDefinite> {
        self.0 = *matrix;
        if *matrix > 0.0 && *matrix <= f64::MAX {
            Ok(())
        } else {
            Err(NotPositiveDefinite { row: 0 })
        }
    }

    #[inline]
    fn solve(&self, x: &mut f64) {
        *x /= self.0;
    }
}

/// Copies the numbers of floors or axes, as many as there are. For the few of most tests a call would take longer than the copy.
///
/// # Panics
/// The numbers of the two differ.
#[inline]
pub fn copy(from: &[f64], to: &mut [f64]) {
    match (from, &mut *to) {
        ([first], [to]) => *to = *first,
        ([first, second], [to, after]) => (*to, *after) = (*first, *second),
        _ => to.copy_from_slice(from),
    }
}

impl Vector for Vec<f64> {
    type Matrix = SymmetricBand;
    type View<'a> = &'a [f64];

    fn zero(order: usize) -> Self {
        vec![0.0; order]
    }

    #[inline]
    fn view(&self) -> &[f64] {
        self
    }

    fn order_of(view: &[f64]) -> usize {
        view.len()
    }

    fn slice_of<'a>(view: &'a &[f64]) -> &'a [f64] {
        view
    }

    fn view_of(slice: &[f64]) -> &[f64] {
        slice
    }

    #[inline]
    fn set(&mut self, view: &[f64]) {
        if self.len() == view.len() {
            copy(view, self);
        } else {
            view.clone_into(self);
        }
    }

    #[inline]
    fn take_over(&mut self, other: &mut Self) {
        std::mem::swap(self, other);
    }

    #[inline]
    fn as_slice(&self) -> &[f64] {
        self
    }

    #[inline]
    fn as_mut_slice(&mut self) -> &mut [f64] {
        self
    }

    #[inline]
    fn update<const N: usize>(&mut self, others: [&Self; N], entry: impl Fn(f64, [f64; N]) -> f64) {
        tridiagonal::update(self, others.map(Vec::as_slice), entry);
    }

    fn dot(&self, other: &Self) -> f64 {
        tridiagonal::dot(self, other)
    }

    fn trapezoid(x: [&Self; 2], y: [&Self; 2], join: impl Fn(f64, f64) -> f64) -> f64 {
        tridiagonal::trapezoid(x.map(Vec::as_slice), y.map(Vec::as_slice), join)
    }

    fn set_out(step: &SetOut<Self>, push: &mut Self) {
        if step.mass.half_bandwidth() == 0 && step.drag.half_bandwidth() == 1 {
            tridiagonal::set_out_tridiagonal(step, push);
        } else {
            set_out_by_products(step, push);
        }
    }

    fn travel(
        time_step: f64,
        from: [&Self; 3],
        acceleration: &mut Self,
        velocity: &mut Self,
        displacement: &mut Self,
    ) {
        tridiagonal::travel(
            time_step,
            from.map(Vec::as_slice),
            acceleration,
            velocity,
            displacement,
        );
    }
}

impl Matrix for SymmetricBand {
    type Vector = Vec<f64>;
    type Factor = BandFactor;

    fn zero_of(order: usize) -> Self {
        Self::zero(order, 0)
    }

    fn rows(&self) -> usize {
        self.order()
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.entry(row, column)
    }

    fn add_at(&mut self, index: usize, value: f64) {
        self.band_mut(0)[index] += value;
    }

    fn become_copy(&mut self, other: &Self) {
        self.copy_from(other);
    }

    fn multiply(&mut self, factor: f64) {
        self.scale(factor);
    }

    fn add_scaled(&mut self, other: &Self, factor: f64) {
        self.add(other, factor);
    }

    fn vanishes(&self) -> bool {
        self.is_zero()
    }

    fn product(&self, x: &Vec<f64>, y: &mut Vec<f64>) {
        self.mul_into(x, y);
    }

    fn mul_add(&self, factor: f64, x: &Vec<f64>, y: &mut Vec<f64>) {
        Self::mul_add(self, factor, x, y);
    }

    fn quadratic(&self, x: &Vec<f64>, scratch: &mut Vec<f64>) -> f64 {
        if self.half_bandwidth() == 0 {
            return tridiagonal::weighted(x, self.band(0));
        }
        self.mul_into(x, scratch);
        tridiagonal::dot(scratch, x)
    }

    fn quadratic_of_sum(&self, x: [&Vec<f64>; 2], [sum, product]: [&mut Vec<f64>; 2]) -> f64 {
        if self.half_bandwidth() == 1 {
            return tridiagonal::quadratic_of_sum(
                [self.band(0), self.band(1)],
                x.map(Vec::as_slice),
            );
        }
        sum.update(x, |_, [before, after]| before + after);
        self.quadratic(sum, product)
    }
}

impl Factor for BandFactor {
    type Matrix = SymmetricBand;

    fn of(matrix: &SymmetricBand) -> Result<Self, NotPositiveDefinite> {
        Self::new(matrix)
    }

    fn replace(&mut self, matrix: &SymmetricBand) -> Result<(), NotPositiveDefinite> {
        self.renew(matrix)
    }

    fn solve(&self, x: &mut Vec<f64>) {
        self.solve_in_place(x);
    }
}
