//! Many degrees of freedom: the storeys of a frame, and its matrices.

use super::behaviours::{BEHAVIOURS, STIFFNESS};
use super::methods::TRUTH;
use crate::schema::types::{Field, Variant};
use psd_text::units::Dimension;

/// The names of the arguments of a storey.
pub mod storey {
    pub const STIFFNESS: &str = super::STIFFNESS.name;
    pub const MASS: &str = "mass";
    pub const COLUMN_STIFFNESS: &str = "column_stiffness";
    pub const MASS_UNCERTAINTY: &str = "mass_uncertainty";
    pub const STIFFNESS_UNCERTAINTY: &str = "stiffness_uncertainty";
    pub const HEIGHT: &str = "height";
    pub const GRAVITY: &str = "gravity";
    pub const BEHAVIOUR: &str = "behaviour";
    pub const DAMPING: &str = "damping";
    pub const COULOMB: &str = "coulomb";
    pub const PART: &str = "part";
    pub const TESTED: &str = "tested";
    pub const COMPUTED: &str = "computed";
    pub const APART: &str = "apart";
    pub const SCALE: &str = "scale";
    pub const SCALE_OF_DISPLACEMENTS: &str = "displacement";
    pub const SCALE_OF_FORCES: &str = "force";
    pub const REPRESENTS: &str = "represents";
}

/// The names of the arguments of an element that a storey does not have.
pub mod element {
    pub const FROM: &str = "from";
    pub const TO: &str = "to";
}

/// Smallest scale of a specimen; the largest is its inverse.
const SMALLEST_SCALE: f64 = 0.01;

/// Equal parts of a storey, at most.
const MOST_PARTS: f64 = 1000.0;

/// A scale of displacements that is not that of lengths, or a scale of forces that is not its square.
const SCALES: &[Variant] = &[Variant::with(
    storey::SCALE,
    &[
        Field::quantity(
            storey::SCALE_OF_DISPLACEMENTS,
            Dimension::NUMBER,
            "displacement on the rig over that of the storey",
        )
        .within(SMALLEST_SCALE, 1.0 / SMALLEST_SCALE)
        .required("displacement: 0.5"),
        Field::quantity(
            storey::SCALE_OF_FORCES,
            Dimension::NUMBER,
            "force on the rig over that of the part of the storey that it represents",
        )
        .within(
            SMALLEST_SCALE * SMALLEST_SCALE,
            1.0 / (SMALLEST_SCALE * SMALLEST_SCALE),
        )
        .required("force: 0.3"),
    ],
    "two scales, if stresses are not those of the storey",
)];

/// The substructure that gives the shear of a storey.
const PARTS: &[Variant] = &[
    Variant::with(
        storey::TESTED,
        &[
            Field::choice(
                storey::APART,
                TRUTH,
                "whether it is a separate specimen, and not one with the tested storey below",
            )
            .default_in_words("false"),
            Field::quantity_or(
                storey::SCALE,
                Dimension::NUMBER,
                SCALES,
                "length on the rig over that of the storey; forces have its square",
            )
            .within(SMALLEST_SCALE, 1.0 / SMALLEST_SCALE)
            .or(1.0, ""),
            Field::count(
                storey::REPRESENTS,
                1.0,
                MOST_PARTS,
                "number of equal parts of the storey, of which one is on the rig",
            )
            .or(1.0, ""),
        ],
        "on the rig, with an axis; adjacent tested storeys are one specimen",
    ),
    Variant::word(storey::COMPUTED, "by its `behaviour`, without an axis"),
];

const STOREY: &[Variant] = &[Variant::with(
    "storey",
    &[
        Field::quantity(storey::MASS, Dimension::MASS, "mass of the floor")
            .required("mass: 2 t")
            .above_zero(),
        Field {
            example: "stiffness: 3 MN/m",
            ..STIFFNESS.default_in_words("from the behaviour, or 2 × `column_stiffness`")
        },
        Field::quantity(
            storey::COLUMN_STIFFNESS,
            Dimension::STIFFNESS,
            "stiffness of one of its two columns",
        )
        .above_zero(),
        Field::quantity(
            storey::MASS_UNCERTAINTY,
            Dimension::MASS,
            "standard uncertainty of the mass",
        )
        .or(0.0, "kg")
        .at_least_zero(),
        Field::quantity(
            storey::STIFFNESS_UNCERTAINTY,
            Dimension::STIFFNESS,
            "standard uncertainty of the stiffness of the storey",
        )
        .or(0.0, "N/m")
        .at_least_zero(),
        Field::quantity(storey::HEIGHT, Dimension::LENGTH, "height of the storey").above_zero(),
        Field::quantity(
            storey::GRAVITY,
            Dimension::FORCE,
            "weight of the floor, which gives P-Δ; this storey and those below require `height`",
        )
        .or(0.0, "N")
        .at_least_zero(),
        Field::choice(
            storey::BEHAVIOUR,
            BEHAVIOURS,
            "restoring-force model of a virtual rig or of a computed storey: storey shear against drift; in numbers of the rig if it is tested",
        )
        .default_in_words("elastic with `stiffness`"),
        Field::quantity(
            storey::DAMPING,
            Dimension::DAMPING,
            "viscous damping, c times drift velocity, in the force of a virtual rig",
        )
        .or(0.0, "N*s/m")
        .at_least_zero(),
        Field::quantity(
            storey::COULOMB,
            Dimension::FORCE,
            "friction against the drift, in the force of a virtual rig",
        )
        .or(0.0, "N")
        .at_least_zero(),
        Field::choice(
            storey::PART,
            PARTS,
            "substructure that gives the shear of the storey",
        )
        .default_in_words("tested"),
    ],
    "floor on its columns",
)];

pub const STOREYS: Field = Field::choices(
    "storeys",
    STOREY,
    "storeys from the ground up, instead of `mass` and `behaviour`",
);

const ELEMENT: &[Variant] = &[Variant::with(
    "element",
    &[
        Field::count(
            element::FROM,
            0.0,
            MOST_DEGREES,
            "degree of freedom at its first end; 0 is the ground",
        )
        .required("from: 0"),
        Field::count(
            element::TO,
            0.0,
            MOST_DEGREES,
            "degree of freedom at its second end; its deformation is the displacement there less that at `from`",
        )
        .required("to: 1"),
        Field {
            example: "stiffness: 3 MN/m",
            ..STIFFNESS.default_in_words("from the behaviour")
        },
        Field::quantity(
            storey::STIFFNESS_UNCERTAINTY,
            Dimension::STIFFNESS,
            "standard uncertainty of the stiffness of the element",
        )
        .or(0.0, "N/m")
        .at_least_zero(),
        Field::choice(
            storey::BEHAVIOUR,
            BEHAVIOURS,
            "restoring-force model of a virtual rig or of a computed element: force against deformation; in numbers of the rig if it is tested",
        )
        .default_in_words("elastic with `stiffness`"),
        Field::quantity(
            storey::DAMPING,
            Dimension::DAMPING,
            "viscous damping, c times velocity, in the force of a virtual rig",
        )
        .or(0.0, "N*s/m")
        .at_least_zero(),
        Field::quantity(
            storey::COULOMB,
            Dimension::FORCE,
            "friction against the motion, in the force of a virtual rig",
        )
        .or(0.0, "N")
        .at_least_zero(),
        Field::choice(
            storey::PART,
            PARTS,
            "substructure that gives the force of the element",
        )
        .default_in_words("tested"),
    ],
    "force between two degrees of freedom",
)];

/// Degrees of freedom of a frame, at most.
const MOST_DEGREES: f64 = 64.0;

pub const ELEMENTS: Field = Field::choices(
    "elements",
    ELEMENT,
    "elements beside the matrices, tested or computed; `stiffness_matrix` is then computed",
)
.advanced();

pub const MASS_MATRIX: Field = Field::text(
    "mass_matrix",
    "CSV file of M in kg, one row per line; requires `stiffness_matrix`",
)
.advanced();

pub const STIFFNESS_MATRIX: Field = Field::text(
    "stiffness_matrix",
    "CSV file of K in N/m, one row per line; requires `mass_matrix`",
)
.advanced();

pub const MASS_MATRIX_UNCERTAINTY: Field = Field::quantity(
    "mass_matrix_uncertainty",
    Dimension::NUMBER,
    "relative standard uncertainty of M (one factor for all entries)",
)
.or(0.0, "%")
.within(0.0, 0.2)
.advanced();

pub const STIFFNESS_MATRIX_UNCERTAINTY: Field = Field::quantity(
    "stiffness_matrix_uncertainty",
    Dimension::NUMBER,
    "relative standard uncertainty of K (one factor for all entries)",
)
.or(0.0, "%")
.within(0.0, 0.2)
.advanced();

/// The damping as a fraction of the critical one.
pub const DAMPING_RATIO: Field = Field::quantities(
    "damping_ratio",
    Dimension::NUMBER,
    "one value: Rayleigh damping with this ratio in the first two modes; a list: one ratio per mode",
)
.within(0.0, 1.0)
.or(0.0, "");

pub const DAMPING_UNCERTAINTY: Field = Field::quantity(
    "damping_ratio_uncertainty",
    Dimension::NUMBER,
    "standard uncertainty of the damping ratio of a frame; of each ratio separately if it is a list",
)
.or(0.0, "%")
.within(0.0, 0.2);
