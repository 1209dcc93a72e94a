//! A model whose parameters are numbers, as its own file declares it: its word in a plan, the name, unit and range of each parameter, and
//! the way from these numbers to a [`Behaviour`] and back. In: constants. Out: a [`Declaration`], from which a language makes its
//! vocabulary, its reader and its descriptions. It knows no plan.

use super::Behaviour;

/// A model whose parameters are numbers.
#[derive(Debug)]
pub struct Declaration {
    /// Its word in a plan.
    pub word: &'static str,
    pub parameters: &'static [Parameter],
    /// One line for the reference.
    pub about: &'static str,
    /// The model of these numbers; None without one that it requires.
    pub model: fn(Stated<'_>) -> Option<Behaviour>,
    /// The numbers of the model; None for another model, and for one that has a description of its own.
    pub numbers: fn(&Behaviour) -> Option<Numbers>,
}

/// Numbers of a model, each by its name in a plan.
pub type Numbers = Vec<(&'static str, f64)>;

/// The numbers that a plan states, in SI, with the defaults of those that it leaves out.
#[derive(Clone, Copy)]
pub struct Stated<'a>(pub &'a dyn Fn(&str) -> Option<f64>);

impl Stated<'_> {
    /// None if it is left out and has no default.
    #[must_use]
    pub fn number(self, parameter: Parameter) -> Option<f64> {
        (self.0)(parameter.name)
    }
}

/// One number of a model.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    pub name: &'static str,
    pub unit: Unit,
    /// One line for the reference.
    pub about: &'static str,
    pub presence: Presence,
    /// The smallest number in SI, and whether that itself is excluded.
    pub low: f64,
    pub above_low: bool,
    /// The largest number in SI.
    pub high: f64,
    /// Whether few plans state it.
    pub advanced: bool,
}

/// Whether a plan must state a number.
#[derive(Clone, Copy, Debug)]
pub enum Presence {
    /// It must; an example.
    Required(&'static str),
    /// This number in this unit is the default; no unit: a plain number.
    Default(f64, &'static str),
    /// Without it the model has no such effect; the default in words.
    Optional(&'static str),
}

/// A product of powers of the SI base units of mechanics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    pub metre: i16,
    pub kilogram: i16,
    pub second: i16,
}

impl Unit {
    pub const ONE: Self = Self::new(0, 0, 0);
    pub const METRE: Self = Self::new(1, 0, 0);
    pub const NEWTON: Self = Self::new(1, 1, -2);
    pub const NEWTON_PER_METRE: Self = Self::new(0, 1, -2);

    #[must_use]
    pub const fn new(metre: i16, kilogram: i16, second: i16) -> Self {
        Self {
            metre,
            kilogram,
            second,
        }
    }
}

impl Parameter {
    /// An optional number of any size.
    #[must_use]
    pub const fn new(name: &'static str, unit: Unit, about: &'static str) -> Self {
        Self {
            name,
            unit,
            about,
            presence: Presence::Optional(""),
            low: f64::NEG_INFINITY,
            above_low: false,
            high: f64::INFINITY,
            advanced: false,
        }
    }

    /// A plan must state it; the example is a valid argument.
    #[must_use]
    pub const fn required(mut self, example: &'static str) -> Self {
        self.presence = Presence::Required(example);
        self
    }

    /// The default.
    #[must_use]
    pub const fn or(mut self, number: f64, unit: &'static str) -> Self {
        self.presence = Presence::Default(number, unit);
        self
    }

    /// The model without it, in words.
    #[must_use]
    pub const fn default_in_words(mut self, words: &'static str) -> Self {
        self.presence = Presence::Optional(words);
        self
    }

    #[must_use]
    pub const fn above_zero(mut self) -> Self {
        (self.low, self.above_low) = (0.0, true);
        self
    }

    #[must_use]
    pub const fn at_least_zero(mut self) -> Self {
        self.low = 0.0;
        self
    }

    #[must_use]
    pub const fn within(mut self, low: f64, high: f64) -> Self {
        (self.low, self.high) = (low, high);
        self
    }

    /// At most `high`.
    #[must_use]
    pub const fn up_to(mut self, high: f64) -> Self {
        self.high = high;
        self
    }

    #[must_use]
    pub const fn advanced(mut self) -> Self {
        self.advanced = true;
        self
    }
}

/// K
pub const STIFFNESS: Parameter =
    Parameter::new("stiffness", Unit::NEWTON_PER_METRE, "initial stiffness")
        .required("stiffness: 300 kN/m")
        .above_zero();

/// `F_y`
pub const YIELD_FORCE: Parameter =
    Parameter::new("yield_force", Unit::NEWTON, "force at first yield")
        .required("yield_force: 4 kN")
        .above_zero();

/// `K_p/K`
pub const POST_YIELD_RATIO: Parameter = Parameter::new(
    "post_yield_ratio",
    Unit::ONE,
    "post-yield stiffness over initial stiffness",
)
.or(0.0, "")
.within(0.0, 1.0);

/// The declaration of a model of which every number is one field of its variant of [`Behaviour`].
macro_rules! declaration {
    ($word:literal, $about:literal, $variant:ident { $($field:ident: $parameter:expr),* $(,)? }) => {
        Declaration {
            word: $word,
            parameters: &[$($parameter),*],
            about: $about,
            model: |stated| Some(Behaviour::$variant { $($field: stated.number($parameter)?),* }),
            numbers: |model| match model {
                Behaviour::$variant { $($field),* } => Some(vec![$(($parameter.name, *$field)),*]),
                _ => None,
            },
        }
    };
    ($word:literal, $about:literal, $variant:ident($inner:ident { $($field:ident: $parameter:expr),* $(,)? })) => {
        Declaration {
            word: $word,
            parameters: &[$($parameter),*],
            about: $about,
            model: |stated| {
                Some(Behaviour::$variant($inner { $($field: stated.number($parameter)?),* }))
            },
            numbers: |model| match model {
                Behaviour::$variant($inner { $($field),* }) => {
                    Some(vec![$(($parameter.name, *$field)),*])
                }
                _ => None,
            },
        }
    };
}
pub(super) use declaration;
