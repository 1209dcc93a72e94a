//! What is tested and what strikes it: `specimen` and `striker`.

use super::behaviours::BEHAVIOURS;
use super::frames::{
    MASS_MATRIX, MASS_MATRIX_UNCERTAINTY, STIFFNESS_MATRIX, STIFFNESS_MATRIX_UNCERTAINTY, STOREYS,
};
use crate::schema::types::{BlockKind, Field, Kind, Naming, ResultKind, RigKind};
use crate::units::Dimension;

pub(crate) const SPECIMEN: BlockKind = BlockKind {
    kind: Kind::Specimen,
    keyword: &["specimen"],
    naming: Naming::Named,
    procedure: false,
    fields: &[
        Field::quantity("mass", Dimension::MASS, "equivalent mass at the struck section")
            .above_zero()
            .or_said("density * area * length / 2, or that of a `portal` as it deflects elastically; a `beam` says it"),
        Field::quantity("mass_uncertainty", Dimension::MASS, "standard uncertainty of the mass").or(0.0, "kg").at_least_zero(),
        Field::quantity("length", Dimension::LENGTH, "length of the beam").above_zero(),
        Field::quantity("area", Dimension::AREA, "area of the cross-section").above_zero(),
        Field::quantity("density", Dimension::DENSITY, "density of the material").above_zero(),
        Field::choice("behaviour", BEHAVIOURS, "what a virtual rig bends").required_on(
            RigKind::Virtual,
            "behaviour = elastic(stiffness: 300 kN/m)",
            "",
        ),
        Field::quantity("damping", Dimension::DAMPING, "c of c·v on the virtual load cell while the actuator moves")
            .or(0.0, "N*s/m")
            .at_least_zero(),
        Field::quantity("coulomb", Dimension::FORCE, "friction on the virtual load cell").or(0.0, "N").at_least_zero(),
        STOREYS,
        MASS_MATRIX,
        STIFFNESS_MATRIX,
        MASS_MATRIX_UNCERTAINTY,
        STIFFNESS_MATRIX_UNCERTAINTY,
    ],
    exports: &[
        ResultKind::new("mass", Dimension::MASS, "equivalent mass; of storeys, all floors together"),
        ResultKind::new("stiffness", Dimension::STIFFNESS, "stiffness of the behaviour at no displacement"),
        ResultKind::new("capacity", Dimension::FORCE, "largest force of a behaviour that has one"),
        ResultKind::new("elastic_mass", Dimension::MASS, "of a beam or portal, by its elastic deflection"),
        ResultKind::new("plastic_mass", Dimension::MASS, "of a portal, by the mechanism that governs"),
        ResultKind::new("lumped_mass", Dimension::MASS, "of a beam or portal, its members' halves at their ends"),
        ResultKind::new("beam_collapse_load", Dimension::FORCE, "of a portal, W + H of the beam mechanism"),
        ResultKind::new("sway_collapse_load", Dimension::FORCE, "of a portal, W + H of the sway mechanism"),
        ResultKind::new("combined_collapse_load", Dimension::FORCE, "of a portal, W + H of the combined mechanism"),
        ResultKind::new(
            "mechanism_limit",
            Dimension::FORCE,
            "of a portal under one load, the largest that its mechanism follows",
        ),
    ],
    results: &[],
    example: "specimen beam {\n  mass = 0.73 kg\n  behaviour = elastic(stiffness: 300 kN/m)\n}",
    doc: "The structure on the rig",
};

pub(crate) const STRIKER: BlockKind = BlockKind {
    kind: Kind::Striker,
    keyword: &["striker"],
    naming: Naming::Named,
    procedure: false,
    fields: &[
        Field::quantity("mass", Dimension::MASS, "mass of the striker")
            .required("mass = 20 kg")
            .above_zero(),
        Field::quantity(
            "mass_uncertainty",
            Dimension::MASS,
            "standard uncertainty of the mass",
        )
        .or(0.0, "kg")
        .at_least_zero(),
        Field::quantity(
            "velocity",
            Dimension::VELOCITY,
            "velocity at the start, towards the structure; or `drop_height`, or `arm` and `angle`",
        )
        .above_zero()
        .or_said("sqrt(2 gn * drop_height), or sqrt(2 gn * arm * (1 - cos(angle)))"),
        Field::quantity(
            "velocity_uncertainty",
            Dimension::VELOCITY,
            "standard uncertainty of the velocity, however it is given",
        )
        .or(0.0, "m/s")
        .at_least_zero(),
        Field::quantity(
            "drop_height",
            Dimension::LENGTH,
            "height of fall that gives the velocity",
        )
        .above_zero(),
        Field::quantity(
            "arm",
            Dimension::LENGTH,
            "length of a pendulum, to its centre of mass",
        )
        .above_zero(),
        Field::angle(
            "angle",
            "from which a pendulum is let go, measured from where it hangs",
        )
        .above_zero_up_to(std::f64::consts::PI),
        Field::quantity(
            "gravity",
            Dimension::ACCELERATION,
            "acceleration along its way: `1 gn` for a weight that falls",
        )
        .or(0.0, "m/s^2")
        .at_least_zero(),
        Field::quantity(
            "gap",
            Dimension::LENGTH,
            "distance to the structure at the start",
        )
        .or(0.0, "mm")
        .at_least_zero(),
    ],
    exports: &[
        ResultKind::new("mass", Dimension::MASS, "mass of the striker"),
        ResultKind::new("velocity", Dimension::VELOCITY, "velocity at the start"),
        ResultKind::new(
            "energy",
            Dimension::ENERGY,
            "kinetic energy at the start, ½ m v²",
        ),
        ResultKind::new(
            "drop_height",
            Dimension::LENGTH,
            "height of fall, v² / (2 gn)",
        ),
        ResultKind::new(
            "gap",
            Dimension::LENGTH,
            "distance to the structure at the start",
        ),
    ],
    results: &[],
    example: "striker pendulum {\n  mass = 20 kg\n  velocity = 1 m/s\n}",
    doc: "A computed body that strikes the structure",
};
