//! The types of the schema's entries, and small look-ups in them.

use crate::ProcedureBlock;
use psd_text::units::{Dimension, display};

/// The kind of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Plan,
    Specimen,
    Striker,
    Limits,
    Rig,
    Ground,
    Report,
    Reproduces,
    Golden,
    Study,
    Fragility,
    Procedure(ProcedureBlock),
}

/// The part between the keyword and the brace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Naming {
    /// A name, always: `striker pendulum { … }`.
    Named,
    /// A title: `plan "Title" { … }`.
    Titled,
    /// Nothing: `report { … }`.
    Unnamed,
    /// A name or nothing: `limits { … }` applies to the plan, `limits frame_limits { … }` is for rigs to name.
    MaybeNamed,
}

/// One kind of block.
#[derive(Debug)]
pub struct BlockKind {
    pub kind: Kind,
    pub keyword: &'static [&'static str],
    pub naming: Naming,
    pub fields: &'static [Field],
    /// Values that other expressions may read besides the fields: `pendulum.energy`.
    pub exports: &'static [ResultKind],
    /// The results of a procedure: `hit.max_displacement`.
    pub results: &'static [ResultKind],
    /// Shown where a block is missing: a short valid one.
    pub example: &'static str,
    pub doc: &'static str,
}

/// One field of a block, or one argument of a variant (in positional order).
#[derive(Clone, Copy, Debug)]
pub struct Field {
    pub name: &'static str,
    pub ty: FieldType,
    pub presence: Presence,
    pub range: Range,
    pub example: &'static str,
    pub doc: &'static str,
    /// Whether it applies to a real rig only, so that it has no effect on a virtual one.
    pub real_rig_only: bool,
    /// Whether it applies to a frame only.
    pub of_frames: bool,
    /// Whether few plans set it: the reference lists it apart.
    pub advanced: bool,
}

/// The type of the value of a field.
#[derive(Clone, Copy, Debug)]
pub enum FieldType {
    Text,
    /// A list of strings.
    Texts,
    /// One of the variants of the list that contains the field: a model inside a model.
    Inner,
    /// Several of them, one after another or as a list; the only argument of its variant.
    Inners,
    /// One number with its unit.
    Quantity(Dimension),
    /// One number with its unit, or one of these variants.
    QuantityOr(Dimension, &'static [Variant]),
    /// A list, or a range with a step.
    Quantities(Dimension),
    /// A range, or a bound: `b` means −b .. b if `symmetric`, else 0 .. b.
    Bounds {
        dimension: Dimension,
        symmetric: bool,
    },
    /// A range without a step, both ends inside the field's own range.
    Interval(Dimension),
    /// A whole number.
    Count,
    /// One of these words or variants.
    Choice(&'static [Variant]),
    /// A list of these words or variants.
    Choices(&'static [Variant]),
    /// The name of a block of this kind.
    Reference(Kind),
    /// A list of `figure(procedure)`.
    Figures,
    /// A result of a procedure: `hit.stop_time`.
    ResultName,
    /// A list of results of procedures.
    ResultNames,
    /// A column of a table: `hit.displacement_m`, or `displacement_m` of every table.
    ColumnName,
    /// A tolerance: in the unit of the number, or in `%` of its absolute value.
    Tolerance,
    /// A number of any dimension, which may read results, as in `require`.
    Formula,
    /// Conditions on the results of an impact, as in `require`.
    Condition,
    /// A list of `INPUT ~ DISTRIBUTION`, with these distributions.
    Inputs(&'static [Variant]),
    /// `INPUT in VALUES`
    Intensity,
    /// The name of an input of the study.
    InputName,
    /// The name of a requirement of the plan.
    RequirementName,
    /// A value with the dimension of the input.
    OfInput,
    /// A range with the dimension of the input.
    RangeOfInput,
}

impl FieldType {
    /// Whether its value is allowed in a calculation: one number, or several.
    #[must_use]
    pub const fn is_numeric(self) -> bool {
        matches!(self, Self::Quantity(_) | Self::Quantities(_) | Self::Count)
    }

    /// The words or variants of a choice; none of another type.
    #[must_use]
    pub const fn variants(self) -> &'static [Variant] {
        match self {
            Self::Choice(variants)
            | Self::Choices(variants)
            | Self::Inputs(variants)
            | Self::QuantityOr(_, variants) => variants,
            _ => &[],
        }
    }
}

/// Whether a field is required, and its default where it is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Presence {
    Required,
    Optional,
    /// A number in a unit of the table; no unit: a plain number.
    Default {
        number: f64,
        unit: &'static str,
    },
    /// The default in the syntax of the language or in words: `rigid`, `critical / 20`, "the specimen's".
    DefaultInWords(&'static str),
    /// Required where the run is on a rig of this kind; the string describes the default on the other.
    RequiredOn(RigKind, &'static str),
}

/// The kind of a rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigKind {
    /// It moves numbers.
    Virtual,
    /// It moves a specimen.
    Real,
}

impl RigKind {
    /// The adjective in a message: `virtual`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Virtual => "virtual",
            Self::Real => "real",
        }
    }
}

/// Allowed values, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub low: f64,
    /// Whether `low` itself is excluded.
    pub above: bool,
    pub high: f64,
}

impl Range {
    pub const ANY: Self = Self {
        low: f64::NEG_INFINITY,
        above: false,
        high: f64::INFINITY,
    };

    /// Whether `value` is allowed; NaN never is.
    #[must_use]
    pub fn contains(self, value: f64) -> bool {
        (if self.above {
            value > self.low
        } else {
            value >= self.low
        }) && value <= self.high
    }

    /// Which values are allowed, in usual units: `greater than 0`, `between 1 mm and 1 m`.
    #[must_use]
    pub fn in_words(self, dimension: Dimension) -> String {
        let show = |value: f64| {
            if dimension == Dimension::NUMBER || value == 0.0 {
                ((value * 1e4).round() / 1e4).to_string()
            } else {
                display::plain(value, dimension, 4)
            }
        };
        let (low, high) = (show(self.low), show(self.high));
        match (self.low.is_finite(), self.above, self.high.is_finite()) {
            (true, true, false) => format!("greater than {low}"),
            (true, false, false) => format!("at least {low}"),
            (true, true, true) => format!("greater than {low} and at most {high}"),
            (true, false, true) => format!("between {low} and {high}"),
            _ => format!("at most {high}"),
        }
    }
}

/// A value that can be read from outside its block.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each says one thing of a result, and none follows from another"
)]
#[derive(Clone, Copy, Debug)]
pub struct ResultKind {
    pub name: &'static str,
    pub dimension: Dimension,
    /// Whether it has a standard uncertainty, read as `.u`.
    pub measured: bool,
    /// Whether it is a count: a whole number.
    pub count: bool,
    /// Whether it is a list of numbers of one dimension: `max(fatigue.energies)`.
    pub list: bool,
    pub printed: Printed,
    /// Whether an impact has it only on a storey of a frame.
    pub of_storey: bool,
    /// Whether a frame of matrices with elements has an entry for each element, not for each degree of freedom.
    pub of_each_member: bool,
    /// Whether only a frame of matrices with elements has it.
    pub of_elements: bool,
    /// Whether the condition decides it under which the next impact of a series follows.
    pub decided_by_condition: bool,
    /// Whether it grows as 1/Δt where the contact force is that of an impulse over one step.
    pub grows_as_inverse_step: bool,
    /// The peak of a motion on which it depends: it is not final if the motion ended before that peak.
    pub peak: Option<Peak>,
    /// Whether it is fitted to the readings in dwells, not to the steps.
    pub fitted_to_dwells: bool,
    /// The result of each impact of a series that it is made of.
    pub made_of: Option<&'static ResultKind>,
    /// The values that it can have.
    pub possible: Possible,
    pub doc: &'static str,
}

/// How the value of a result is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Printed {
    InUnits,
    /// A fraction, in percent.
    InPercent,
    /// A number just below 1, to six decimals: its nines count.
    NearOne,
}

/// A peak of an impact or of a ground-motion test, or that of the last impact of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Peak {
    /// The largest displacement of the structure.
    Displacement,
    /// The instant of the largest displacement of the structure: a time, or an energy up to it.
    InstantOfDisplacement,
    /// The peak velocity of the structure.
    Velocity,
    ContactForce,
    BaseShear,
    /// The peak displacement of each floor.
    FloorDisplacement,
    /// The peak drift of each storey, or deformation of each element.
    Drift,
    /// The peak force of each element.
    ElementForce,
    /// Of an impact in a series, the position in which it leaves the specimen.
    PositionAfter,
    /// Of an impact in a series, the drift in which it leaves each storey.
    DriftAfter,
    /// The last impact of a series, as far as it decides how many impacts passed.
    LastImpact,
}

/// The values that a result can have, whatever the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Possible {
    Any,
    /// 0 or more.
    NotNegative,
    /// The largest absolute displacement: 0 or more, and within the limits of the displacement.
    PeakDisplacement,
    /// The largest displacement of a motion: not below that of its start, and within the limits of the displacement.
    LargestDisplacement,
}

/// One variant of a choice, with its arguments.
#[derive(Clone, Copy, Debug)]
pub struct Variant {
    pub name: &'static str,
    pub arguments: &'static [Field],
    pub doc: &'static str,
}

impl BlockKind {
    /// The keyword as it is written: `stiffness ramp`.
    #[must_use]
    pub fn words(&self) -> String {
        self.keyword.join(" ")
    }

    /// Whether it is run, in the order of the plan.
    #[must_use]
    pub const fn is_procedure(&self) -> bool {
        matches!(self.kind, Kind::Procedure(_))
    }

    #[must_use]
    pub fn field(&self, name: &str) -> Option<&'static Field> {
        self.fields.iter().find(|field| field.name == name)
    }

    #[must_use]
    pub fn result(&self, name: &str) -> Option<&'static ResultKind> {
        self.results.iter().find(|result| result.name == name)
    }

    #[must_use]
    pub fn export(&self, name: &str) -> Option<&'static ResultKind> {
        self.exports.iter().find(|export| export.name == name)
    }
}

impl Field {
    /// The dimension of a field of numbers.
    #[must_use]
    pub const fn dimension(&self) -> Option<Dimension> {
        match self.ty {
            FieldType::Quantity(dimension)
            | FieldType::QuantityOr(dimension, _)
            | FieldType::Quantities(dimension)
            | FieldType::Bounds { dimension, .. }
            | FieldType::Interval(dimension) => Some(dimension),
            FieldType::Count => Some(Dimension::NUMBER),
            _ => None,
        }
    }

    /// The default number in SI.
    #[must_use]
    pub fn default_number(&self) -> Option<f64> {
        match self.presence {
            // Zero is zero in every unit.
            Presence::Default { number, unit } if number == 0.0 || unit.is_empty() => Some(number),
            Presence::Default { number, unit } => psd_text::units::unit::parse(unit)
                .ok()
                .map(|unit| number * unit.factor),
            _ => None,
        }
    }
}

impl Variant {
    #[must_use]
    pub fn argument(&self, name: &str) -> Option<&'static Field> {
        self.arguments.iter().find(|argument| argument.name == name)
    }
}
