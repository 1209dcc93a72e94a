//! Many degrees of freedom: the storeys of a frame, and its matrices.

use super::behaviours::{BEHAVIOURS, STIFFNESS};
use crate::schema::types::{Field, Variant};
use crate::units::Dimension;

const STOREY: &[Variant] = &[Variant::with(
    "storey",
    &[
        Field::quantity("mass", Dimension::MASS, "mass of the floor")
            .required("mass: 2 t")
            .above_zero(),
        Field {
            example: "stiffness: 3 MN/m",
            ..STIFFNESS.or_said("that of the behaviour, or 2 `column_stiffness`")
        },
        Field::quantity(
            "column_stiffness",
            Dimension::STIFFNESS,
            "stiffness of one of its two columns",
        )
        .above_zero(),
        Field::quantity(
            "mass_uncertainty",
            Dimension::MASS,
            "standard uncertainty of the mass",
        )
        .or(0.0, "kg")
        .at_least_zero(),
        Field::quantity(
            "stiffness_uncertainty",
            Dimension::STIFFNESS,
            "standard uncertainty of the stiffness of the storey",
        )
        .or(0.0, "N/m")
        .at_least_zero(),
        Field::quantity("height", Dimension::LENGTH, "height of the storey").above_zero(),
        Field::choice(
            "behaviour",
            BEHAVIOURS,
            "storey shear against drift, what a virtual rig bends",
        )
        .or_said("elastic, of its stiffness"),
        Field::quantity(
            "damping",
            Dimension::DAMPING,
            "viscous, c times the velocity of the drift, on a virtual rig's load cells",
        )
        .or(0.0, "N*s/m")
        .at_least_zero(),
        Field::quantity(
            "coulomb",
            Dimension::FORCE,
            "friction against the drift, on a virtual rig's load cells",
        )
        .or(0.0, "N")
        .at_least_zero(),
    ],
    "a floor on its columns",
)];

pub(crate) const STOREYS: Field = Field::choices(
    "storeys",
    STOREY,
    "storeys from the ground up, in place of mass and behaviour",
);

pub(crate) const MASS_MATRIX: Field = Field::text(
    "mass_matrix",
    "file of M in kg, a row a line, in place of mass and behaviour; with `stiffness_matrix`",
);

pub(crate) const STIFFNESS_MATRIX: Field = Field::text(
    "stiffness_matrix",
    "file of K in N/m, a row a line; with `mass_matrix`",
);

pub(crate) const MASS_MATRIX_UNCERTAINTY: Field = Field::quantity(
    "mass_matrix_uncertainty",
    Dimension::NUMBER,
    "standard uncertainty of M, of it: one factor on all its entries, which keep their ratios",
)
.or(0.0, "%")
.within(0.0, 0.2);

pub(crate) const STIFFNESS_MATRIX_UNCERTAINTY: Field = Field::quantity(
    "stiffness_matrix_uncertainty",
    Dimension::NUMBER,
    "standard uncertainty of K, of it, in the same way",
)
.or(0.0, "%")
.within(0.0, 0.2);

pub(crate) const DAMPING_UNCERTAINTY: Field = Field::quantity(
    "damping_ratio_uncertainty",
    Dimension::NUMBER,
    "standard uncertainty of the damping ratio of a frame; of a list, of each by itself",
)
.or(0.0, "%")
.within(0.0, 0.2);
