//! The numbers of a step: one number, or several side by side in a vector of the processor. In: nothing. Out: arithmetic, comparisons and
//! selections, so that an equation is written once for both. It knows no equation.

#![allow(
    clippy::inline_always,
    reason = "a part of its caller, which is compiled for several vector units"
)]

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Not, Sub};

/// One number, or several side by side. The same operations give each of several numbers the bits that it has alone, except in what is
/// not a number.
pub trait Number:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
{
    type Answer: Answer;

    /// `number`, as often as there are numbers in `self`.
    #[must_use]
    fn same(self, number: f64) -> Self;
    #[must_use]
    fn abs(self) -> Self;
    fn gt(self, other: Self) -> Self::Answer;
    fn ge(self, other: Self) -> Self::Answer;
    fn le(self, other: Self) -> Self::Answer;
    /// `other` where it is larger.
    #[must_use]
    fn larger(self, other: Self) -> Self;
    /// `other` where it is smaller.
    #[must_use]
    fn smaller(self, other: Self) -> Self;
    /// Work that one number hardly ever needs: a branch leads to it.
    fn rarely<T>(work: impl FnOnce() -> T) -> T;
    /// `yes` where the answer is yes, `no` elsewhere. Of several numbers both are computed.
    fn choose(answer: Self::Answer, yes: impl FnOnce() -> Self, no: impl FnOnce() -> Self) -> Self;
}

/// Whether something is so: of one number, or of each of several.
pub trait Answer: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Whether the work for a yes can be left out. Of several numbers it is always done.
    fn is_surely_no(self) -> bool;
    /// Whether the work for a no can be left out. Of several numbers it is always done.
    fn is_surely_yes(self) -> bool;
}

impl Answer for bool {
    #[inline(always)]
    fn is_surely_no(self) -> bool {
        !self
    }

    #[inline(always)]
    fn is_surely_yes(self) -> bool {
        self
    }
}

impl Number for f64 {
    type Answer = bool;

    #[inline(always)]
    fn same(self, number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }

    #[inline(always)]
    fn gt(self, other: Self) -> bool {
        self > other
    }

    #[inline(always)]
    fn ge(self, other: Self) -> bool {
        self >= other
    }

    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    #[cold]
    #[inline(never)]
    fn rarely<T>(work: impl FnOnce() -> T) -> T {
        work()
    }

    #[inline(always)]
    fn choose(answer: bool, yes: impl FnOnce() -> Self, no: impl FnOnce() -> Self) -> Self {
        if answer { yes() } else { no() }
    }
}

/// Declares numbers that belong together, of one impact or of several side by side.
macro_rules! numbers {
    ($(#[$about:meta])* $vis:vis struct $name:ident { $($(#[$doc:meta])* $field:ident,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        $vis struct $name<N = f64> { $($(#[$doc])* pub $field: N,)* }

        #[allow(clippy::inline_always, dead_code, reason = "a part of its caller, which is compiled for several vector units")]
        impl<N> $name<N> {
            /// Each number by itself.
            #[inline(always)]
            pub(crate) fn map<M>(&self, mut each: impl FnMut(&N) -> M) -> $name<M> {
                $name { $($field: each(&self.$field),)* }
            }

            /// Each number with the same one of `others`.
            #[inline(always)]
            pub(crate) fn each<M>(&mut self, others: $name<M>, mut each: impl FnMut(&mut N, M)) {
                $(each(&mut self.$field, others.$field);)*
            }
        }
    };
}
pub(crate) use numbers;
