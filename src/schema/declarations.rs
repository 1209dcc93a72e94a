//! What is tested and what strikes it: `specimen` and `striker`.

use super::frames::{MASS_MATRIX, STIFFNESS_MATRIX, STOREYS};
use super::types::{BlockKind, Field, Kind, Naming, ResultKind, RigKind, Variant};
use crate::quantity::Dimension;

pub(super) const STIFFNESS: Field =
    Field::quantity("stiffness", Dimension::STIFFNESS, "force over displacement").required("stiffness: 300 kN/m").above_zero();

const ENDS: &[Variant] = &[
    Variant::word("cantilever", "one end built in, struck at the free one: 3EI/L³"),
    Variant::word("simply_supported", "struck at midspan: 48EI/L³"),
    Variant::word("built_in", "both ends built in, struck at midspan: 192EI/L³"),
    Variant::with(
        "partly_built_in",
        &[Field::quantity("rotational_stiffness", Dimension::ENERGY, "moment over rotation of each end, N*m/rad")
            .required("rotational_stiffness: 5 kN*m/rad")
            .at_least_zero()],
        "between simply supported and built in: (192EI/L³)(r+2)/(r+8)",
    ),
];

pub(super) const BEHAVIOURS: &[Variant] = &[
    Variant::with("elastic", &[STIFFNESS], "a linear spring"),
    Variant::with(
        "bilinear",
        &[
            STIFFNESS,
            Field::quantity("yield_force", Dimension::FORCE, "force at first yield").required("yield_force: 4 kN").above_zero(),
            Field::quantity("hardening", Dimension::NUMBER, "stiffness past yield over the initial one")
                .or(0.0, "")
                .within(0.0, 1.0),
        ],
        "elastic–plastic with kinematic hardening",
    ),
    Variant::with(
        "beam",
        &[
            Field::quantity("length", Dimension::LENGTH, "span").required("length: 1.4 m").above_zero(),
            Field::quantity("youngs_modulus", Dimension::PRESSURE, "modulus of elasticity")
                .required("youngs_modulus: 26 GPa")
                .above_zero(),
            Field::quantity("second_moment", Dimension::SECOND_MOMENT, "second moment of area")
                .required("second_moment: 12e4 mm^4")
                .above_zero(),
            Field::choice("ends", ENDS, "how the ends are held").required("ends: simply_supported"),
        ],
        "an elastic beam by its geometry",
    ),
    Variant::later("bouc_wen", "smooth hysteresis"),
    Variant::later("degrading", "stiffness that falls with the largest displacement"),
    Variant::later("table", "measured force–displacement points from a file"),
    Variant::later("portal", "portal frame by plastic hinges"),
];

pub(super) const SPECIMEN: BlockKind = BlockKind {
    kind: Kind::Specimen,
    keyword: &["specimen"],
    naming: Naming::Named,
    procedure: false,
    fields: &[
        Field::quantity("mass", Dimension::MASS, "equivalent mass at the struck section")
            .above_zero()
            .or_said("density * area * length / 2"),
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
    ],
    exports: &[
        ResultKind::new("mass", Dimension::MASS, "equivalent mass; of storeys, all floors together"),
        ResultKind::new("stiffness", Dimension::STIFFNESS, "stiffness of the behaviour at no displacement"),
    ],
    results: &[],
    example: "specimen beam {\n  mass = 0.73 kg\n  behaviour = elastic(stiffness: 300 kN/m)\n}",
    doc: "The structure on the rig",
};

pub(super) const STRIKER: BlockKind = BlockKind {
    kind: Kind::Striker,
    keyword: &["striker"],
    naming: Naming::Named,
    procedure: false,
    fields: &[
        Field::quantity("mass", Dimension::MASS, "mass of the striker").required("mass = 20 kg").above_zero(),
        Field::quantity("velocity", Dimension::VELOCITY, "velocity at the start, towards the structure; or `drop_height`")
            .above_zero()
            .or_said("sqrt(2 gn * drop_height)"),
        Field::quantity("drop_height", Dimension::LENGTH, "height of fall that gives the velocity").above_zero(),
        Field::quantity("gap", Dimension::LENGTH, "distance to the structure at the start").or(0.0, "mm").at_least_zero(),
    ],
    exports: &[
        ResultKind::new("mass", Dimension::MASS, "mass of the striker"),
        ResultKind::new("velocity", Dimension::VELOCITY, "velocity at the start"),
        ResultKind::new("energy", Dimension::ENERGY, "kinetic energy at the start, ½ m v²"),
        ResultKind::new("drop_height", Dimension::LENGTH, "height of fall, v² / (2 gn)"),
        ResultKind::new("gap", Dimension::LENGTH, "distance to the structure at the start"),
    ],
    results: &[],
    example: "striker pendulum {\n  mass = 20 kg\n  velocity = 1 m/s\n}",
    doc: "A computed body that strikes the structure",
};
