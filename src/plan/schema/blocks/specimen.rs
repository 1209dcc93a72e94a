//! The block `specimen`: mass, restoring-force model, storeys and matrices. Its reader, `language::check::declarations::specimen`, names the
//! fields by these constants.

use super::behaviours::BEHAVIOURS;
pub use super::frames::{
    ELEMENTS, MASS_MATRIX, MASS_MATRIX_UNCERTAINTY, STIFFNESS_MATRIX, STIFFNESS_MATRIX_UNCERTAINTY,
    STOREYS,
};
use crate::schema::types::{BlockKind, Field, Kind, Naming, ResultKind, RigKind};
use psd_text::units::Dimension;

pub const MASS: Field = Field::quantity(
    "mass",
    Dimension::MASS,
    "equivalent mass at the struck section",
)
.above_zero()
.default_in_words(
    "density * area * length / 2, or the elastic mass of a `portal`; must be given for a `beam`",
);

pub const MASS_UNCERTAINTY: Field = Field::quantity(
    "mass_uncertainty",
    Dimension::MASS,
    "standard uncertainty of the mass",
)
.or(0.0, "kg")
.at_least_zero();

pub const LENGTH: Field =
    Field::quantity("length", Dimension::LENGTH, "length of the beam").above_zero();

pub const AREA: Field =
    Field::quantity("area", Dimension::AREA, "area of the cross-section").above_zero();

pub const DENSITY: Field =
    Field::quantity("density", Dimension::DENSITY, "density of the material").above_zero();

pub const BEHAVIOUR: Field = Field::choice(
    "behaviour",
    BEHAVIOURS,
    "restoring-force model of a virtual rig",
)
.required_on(
    RigKind::Virtual,
    "behaviour = elastic(stiffness: 300 kN/m)",
    "",
);

pub const DAMPING: Field = Field::quantity(
    "damping",
    Dimension::DAMPING,
    "c of the force c·v that a virtual rig adds during motion",
)
.or(0.0, "N*s/m")
.at_least_zero();

pub const COULOMB: Field = Field::quantity(
    "coulomb",
    Dimension::FORCE,
    "friction that a virtual rig adds to the force",
)
.or(0.0, "N")
.at_least_zero();

pub const SPECIMEN: BlockKind = BlockKind {
    kind: Kind::Specimen,
    keyword: &["specimen"],
    naming: Naming::Named,
    fields: &[
        MASS,
        MASS_UNCERTAINTY,
        LENGTH,
        AREA,
        DENSITY,
        BEHAVIOUR,
        DAMPING,
        COULOMB,
        STOREYS,
        MASS_MATRIX,
        STIFFNESS_MATRIX,
        ELEMENTS,
        MASS_MATRIX_UNCERTAINTY,
        STIFFNESS_MATRIX_UNCERTAINTY,
    ],
    exports: &[
        ResultKind::new(
            MASS.name,
            Dimension::MASS,
            "equivalent mass; with storeys, total mass of the floors",
        ),
        ResultKind::new(
            "stiffness",
            Dimension::STIFFNESS,
            "initial stiffness of the behaviour",
        ),
        ResultKind::new(
            "capacity",
            Dimension::FORCE,
            "largest force of a behaviour that is bounded",
        ),
        ResultKind::new(
            "elastic_mass",
            Dimension::MASS,
            "mass of a beam or portal, from the elastic deflected shape",
        ),
        ResultKind::new(
            "plastic_mass",
            Dimension::MASS,
            "mass of a portal, from the governing mechanism",
        ),
        ResultKind::new(
            "lumped_mass",
            Dimension::MASS,
            "mass of a beam or portal, half of each member at each of its ends",
        ),
        ResultKind::new(
            "beam_collapse_load",
            Dimension::FORCE,
            "W + H of the beam mechanism of a portal",
        ),
        ResultKind::new(
            "sway_collapse_load",
            Dimension::FORCE,
            "W + H of the sway mechanism of a portal",
        ),
        ResultKind::new(
            "combined_collapse_load",
            Dimension::FORCE,
            "W + H of the combined mechanism of a portal",
        ),
        ResultKind::new(
            "mechanism_limit",
            Dimension::FORCE,
            "largest load of a portal under one load for which the mechanism is valid",
        ),
    ],
    results: &[],
    example: "specimen beam {\n  mass = 0.73 kg\n  behaviour = elastic(stiffness: 300 kN/m)\n}",
    doc: "Structure on the rig",
};
