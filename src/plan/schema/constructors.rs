//! Constructors of the entries of the schema, to be chained: `Field::quantity(…).above_zero().required(…)`.

use super::types::{
    Field, FieldType, Kind, Peak, Possible, Presence, Printed, Range, ResultKind, RigKind, Variant,
};
use psd_text::units::Dimension;

impl Field {
    const fn new(name: &'static str, ty: FieldType, doc: &'static str) -> Self {
        Self {
            name,
            ty,
            presence: Presence::Optional,
            range: Range::ANY,
            example: "",
            doc,
            real_rig_only: false,
            of_frames: false,
            advanced: false,
        }
    }

    pub const fn of_type(name: &'static str, ty: FieldType, doc: &'static str) -> Self {
        Self::new(name, ty, doc)
    }

    pub const fn text(name: &'static str, doc: &'static str) -> Self {
        Self::new(name, FieldType::Text, doc)
    }

    pub const fn texts(name: &'static str, doc: &'static str) -> Self {
        Self::new(name, FieldType::Texts, doc)
    }

    pub const fn inner(name: &'static str, doc: &'static str) -> Self {
        Self::new(name, FieldType::Inner, doc)
    }

    pub const fn inners(name: &'static str, doc: &'static str) -> Self {
        Self::new(name, FieldType::Inners, doc)
    }

    pub const fn quantity(name: &'static str, dimension: Dimension, doc: &'static str) -> Self {
        Self::new(name, FieldType::Quantity(dimension), doc)
    }

    pub const fn quantity_or(
        name: &'static str,
        dimension: Dimension,
        variants: &'static [Variant],
        doc: &'static str,
    ) -> Self {
        Self::new(name, FieldType::QuantityOr(dimension, variants), doc)
    }

    pub const fn quantities(name: &'static str, dimension: Dimension, doc: &'static str) -> Self {
        Self::new(name, FieldType::Quantities(dimension), doc)
    }

    pub const fn bounds(
        name: &'static str,
        dimension: Dimension,
        symmetric: bool,
        doc: &'static str,
    ) -> Self {
        Self::new(
            name,
            FieldType::Bounds {
                dimension,
                symmetric,
            },
            doc,
        )
    }

    pub const fn interval(name: &'static str, dimension: Dimension, doc: &'static str) -> Self {
        Self::new(name, FieldType::Interval(dimension), doc)
    }

    pub const fn count(name: &'static str, low: f64, high: f64, doc: &'static str) -> Self {
        let mut field = Self::new(name, FieldType::Count, doc);
        field.range = Range {
            low,
            above: false,
            high,
        };
        field
    }

    pub const fn choice(
        name: &'static str,
        variants: &'static [Variant],
        doc: &'static str,
    ) -> Self {
        Self::new(name, FieldType::Choice(variants), doc)
    }

    pub const fn choices(
        name: &'static str,
        variants: &'static [Variant],
        doc: &'static str,
    ) -> Self {
        Self::new(name, FieldType::Choices(variants), doc)
    }

    pub const fn reference(name: &'static str, kind: Kind, doc: &'static str) -> Self {
        Self::new(name, FieldType::Reference(kind), doc)
    }

    pub const fn figures(name: &'static str, doc: &'static str) -> Self {
        Self::new(name, FieldType::Figures, doc)
    }

    pub const fn condition(name: &'static str, doc: &'static str) -> Self {
        Self::new(name, FieldType::Condition, doc)
    }

    /// The same field with another description, of a block that shares it.
    pub const fn described(mut self, doc: &'static str) -> Self {
        self.doc = doc;
        self
    }

    /// The field is required; the example is a valid line.
    pub const fn required(mut self, example: &'static str) -> Self {
        self.presence = Presence::Required;
        self.example = example;
        self
    }

    /// The field is required on a rig of this kind; `otherwise` describes the default on the other.
    pub const fn required_on(
        mut self,
        rig: RigKind,
        example: &'static str,
        otherwise: &'static str,
    ) -> Self {
        self.presence = Presence::RequiredOn(rig, otherwise);
        self.example = example;
        self
    }

    pub const fn of_real_rigs(mut self) -> Self {
        self.real_rig_only = true;
        self
    }

    pub const fn of_frames(mut self) -> Self {
        self.of_frames = true;
        self
    }

    /// Few plans set it.
    pub const fn advanced(mut self) -> Self {
        self.advanced = true;
        self
    }

    pub const fn or(mut self, number: f64, unit: &'static str) -> Self {
        self.presence = Presence::Default { number, unit };
        self
    }

    pub const fn default_in_words(mut self, words: &'static str) -> Self {
        self.presence = Presence::DefaultInWords(words);
        self
    }

    pub const fn above_zero(mut self) -> Self {
        self.range = Range {
            low: 0.0,
            above: true,
            high: f64::INFINITY,
        };
        self
    }

    pub const fn at_least_zero(mut self) -> Self {
        self.range = Range {
            low: 0.0,
            above: false,
            high: f64::INFINITY,
        };
        self
    }

    /// Above 0 and at most `high`.
    pub const fn above_zero_up_to(mut self, high: f64) -> Self {
        self.range = Range {
            low: 0.0,
            above: true,
            high,
        };
        self
    }

    pub const fn within(mut self, low: f64, high: f64) -> Self {
        self.range = Range {
            low,
            above: false,
            high,
        };
        self
    }
}

impl Variant {
    pub const fn word(name: &'static str, doc: &'static str) -> Self {
        Self {
            name,
            arguments: &[],
            doc,
        }
    }

    pub const fn with(name: &'static str, arguments: &'static [Field], doc: &'static str) -> Self {
        Self {
            name,
            arguments,
            doc,
        }
    }
}

impl ResultKind {
    pub const fn new(name: &'static str, dimension: Dimension, doc: &'static str) -> Self {
        Self {
            name,
            dimension,
            measured: false,
            count: false,
            list: false,
            printed: Printed::InUnits,
            of_storey: false,
            of_each_member: false,
            of_elements: false,
            decided_by_condition: false,
            grows_as_inverse_step: false,
            peak: None,
            fitted_to_dwells: false,
            made_of: None,
            possible: Possible::Any,
            doc,
        }
    }

    /// Its values are among these.
    pub const fn within(self, possible: Possible) -> Self {
        Self { possible, ..self }
    }

    /// A fraction is printed in percent.
    pub const fn in_percent(self) -> Self {
        Self {
            printed: Printed::InPercent,
            ..self
        }
    }

    /// A number just below 1 is printed to its nines.
    pub const fn near_one(self) -> Self {
        Self {
            printed: Printed::NearOne,
            ..self
        }
    }

    /// An impact has it on a storey only.
    pub const fn of_storey(self) -> Self {
        Self {
            of_storey: true,
            ..self
        }
    }

    /// Of a frame of matrices with elements, an entry for each element.
    pub const fn of_each_member(self) -> Self {
        Self {
            of_each_member: true,
            ..self
        }
    }

    /// Only a frame of matrices with elements has it.
    pub const fn of_elements(self) -> Self {
        Self {
            of_elements: true,
            ..self
        }
    }

    /// The condition of a series of impacts decides it.
    pub const fn decided_by_condition(self) -> Self {
        Self {
            decided_by_condition: true,
            ..self
        }
    }

    /// It grows as 1/Δt where the contact force is that of an impulse over one step.
    pub const fn grows_as_inverse_step(self) -> Self {
        Self {
            grows_as_inverse_step: true,
            ..self
        }
    }

    /// It is final only after this peak.
    pub const fn final_after(self, peak: Peak) -> Self {
        Self {
            peak: Some(peak),
            ..self
        }
    }

    /// It is fitted to the readings in dwells.
    pub const fn fitted_to_dwells(self) -> Self {
        Self {
            fitted_to_dwells: true,
            ..self
        }
    }

    /// It is made of this result of each impact of a series.
    pub const fn made_of(self, of_impact: &'static Self) -> Self {
        Self {
            made_of: Some(of_impact),
            ..self
        }
    }

    pub const fn measured(name: &'static str, dimension: Dimension, doc: &'static str) -> Self {
        Self {
            measured: true,
            ..Self::new(name, dimension, doc)
        }
    }

    pub const fn count(name: &'static str, doc: &'static str) -> Self {
        Self {
            count: true,
            possible: Possible::NotNegative,
            ..Self::new(name, Dimension::NUMBER, doc)
        }
    }

    /// Several numbers of one dimension.
    pub const fn list(name: &'static str, dimension: Dimension, doc: &'static str) -> Self {
        Self {
            list: true,
            ..Self::new(name, dimension, doc)
        }
    }

    /// The same, each with its standard uncertainty.
    pub const fn measured_list(
        name: &'static str,
        dimension: Dimension,
        doc: &'static str,
    ) -> Self {
        Self {
            measured: true,
            ..Self::list(name, dimension, doc)
        }
    }
}
