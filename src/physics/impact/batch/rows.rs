//! The numbers of many impacts, side by side: in rows in memory, and some of them in a vector of the processor. In: nothing. Out: rows. It
//! steps nothing.

#![allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]

use std::fmt::{self, Debug, Formatter};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Not, Sub};

use fearless_simd::prelude::*;

use crate::contact::Touching;
use crate::number::{Answer, Number};

/// Impacts side by side: with fewer, vector units wait for the divisions before them.
pub const LANES: usize = 32;

/// A number of every lane.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))] // No vector lies in two lines of the cache.
pub(super) struct LaneRow([f64; LANES]);

impl LaneRow {
    pub const ZERO: Self = Self([0.0; LANES]);

    pub const fn lane(&self, lane: usize) -> f64 {
        self.0[lane]
    }

    pub const fn set_lane(&mut self, lane: usize, number: f64) {
        self.0[lane] = number;
    }

    pub fn any(&self, is: impl Fn(f64) -> bool) -> bool {
        self.0.iter().any(|number| is(*number))
    }
}

/// Some lanes, as many as a vector of the processor has.
#[derive(Clone, Copy)]
pub(super) struct LanePart<S> {
    simd: S,
    first: usize,
}

impl<S: Simd> LanePart<S> {
    #[inline(always)]
    pub fn all(simd: S) -> impl Iterator<Item = Self> {
        (0..LANES)
            .step_by(S::f64s::LEN)
            .map(move |first| Self { simd, first })
    }

    #[inline(always)]
    pub fn get(self, row: &LaneRow) -> Side<S> {
        Side(S::f64s::from_slice(
            self.simd,
            &row.0[self.first..self.first + S::f64s::LEN],
        ))
    }

    #[inline(always)]
    pub fn set(self, row: &mut LaneRow, numbers: Side<S>) {
        numbers
            .0
            .store_slice(&mut row.0[self.first..self.first + S::f64s::LEN]);
    }

    #[inline(always)]
    pub fn number(self, number: f64) -> Side<S> {
        Side(S::f64s::splat(self.simd, number))
    }

    /// Lanes of this part as lanes of all.
    #[inline(always)]
    pub fn bits(self, lanes: SideAnswer<S>) -> u64 {
        lanes.0.to_bitmask() << self.first
    }
}

/// Numbers side by side in a vector of the processor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<S: Simd>(S::f64s);

/// Whether something is so of each of them.
#[derive(Clone, Copy)]
pub(super) struct SideAnswer<S: Simd>(S::mask64s);

/// An operation of two of these types.
macro_rules! operation {
    ($trait:ident, $function:ident, $for:ident, $other:ty, $operand:expr) => {
        impl<S: Simd> $trait<$other> for $for<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: $other) -> Self {
                Self($trait::$function(self.0, $operand(other)))
            }
        }
    };
}
operation!(Add, add, Side, Self, |other: Self| other.0);
operation!(Sub, sub, Side, Self, |other: Self| other.0);
operation!(Mul, mul, Side, Self, |other: Self| other.0);
operation!(Mul, mul, Side, f64, |other: f64| other);
operation!(Div, div, Side, Self, |other: Self| other.0);
operation!(BitAnd, bitand, SideAnswer, Self, |other: Self| other.0);
operation!(BitOr, bitor, SideAnswer, Self, |other: Self| other.0);

impl<S: Simd> Debug for SideAnswer<S> {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        write!(to, "{:b}", self.0.to_bitmask())
    }
}

impl<S: Simd> Not for SideAnswer<S> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl<S: Simd> Answer for SideAnswer<S> {
    #[inline(always)]
    fn is_surely_no(self) -> bool {
        false
    }

    #[inline(always)]
    fn is_surely_yes(self) -> bool {
        false
    }
}

// `a.max(b)` is `if a > b { a } else { b }` and `a.min(b)` is `if a < b { a } else { b }` here: a lane that is not a number runs again alone.
impl<S: Simd> Number for Side<S> {
    type Answer = SideAnswer<S>;

    #[inline(always)]
    fn same(self, number: f64) -> Self {
        Self(S::f64s::splat(self.0.token(), number))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn gt(self, other: Self) -> SideAnswer<S> {
        SideAnswer(self.0.simd_gt(other.0))
    }

    #[inline(always)]
    fn ge(self, other: Self) -> SideAnswer<S> {
        SideAnswer(self.0.simd_ge(other.0))
    }

    #[inline(always)]
    fn le(self, other: Self) -> SideAnswer<S> {
        SideAnswer(self.0.simd_le(other.0))
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self(other.0.max(self.0))
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self(other.0.min(self.0))
    }

    #[inline(always)]
    fn rarely<T>(work: impl FnOnce() -> T) -> T {
        work()
    }

    #[inline(always)]
    fn choose(
        answer: SideAnswer<S>,
        yes: impl FnOnce() -> Self,
        no: impl FnOnce() -> Self,
    ) -> Self {
        Self(answer.0.select(yes().0, no().0))
    }
}

/// The state of the contact of each of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct SideState<S: Simd> {
    pub at_limit: SideAnswer<S>,
    pub in_contact: SideAnswer<S>,
}

impl<S: Simd> Touching for Side<S> {
    type State = SideState<S>;

    #[inline(always)]
    fn state(at_limit: SideAnswer<S>, in_contact: SideAnswer<S>) -> SideState<S> {
        SideState {
            at_limit,
            in_contact,
        }
    }

    #[inline(always)]
    fn of_state(
        state: SideState<S>,
        free: impl FnOnce() -> Self,
        contact: impl FnOnce() -> Self,
        limit: impl FnOnce() -> Self,
    ) -> Self {
        let touching = || Self::choose(state.in_contact, contact, free);
        Self::choose(state.at_limit, limit, touching)
    }
}
