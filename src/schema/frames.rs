//! Many degrees of freedom: storeys, `ground` and `shake`.

use super::behaviours::{BEHAVIOURS, STIFFNESS};
use super::procedures::{INSPECT_TRIGGERS, SPECIMEN};
use super::types::{BlockKind, Field, Kind, Naming, Variant};
use super::{methods, results};
use crate::quantity::Dimension;

const STOREY: &[Variant] = &[Variant::with(
    "storey",
    &[
        Field::quantity("mass", Dimension::MASS, "mass of the floor").required("mass: 2 t").above_zero(),
        Field { example: "stiffness: 3 MN/m", ..STIFFNESS.or_said("that of the behaviour, or 2 `column_stiffness`") },
        Field::quantity("column_stiffness", Dimension::STIFFNESS, "stiffness of one of its two columns").above_zero(),
        Field::quantity("mass_uncertainty", Dimension::MASS, "standard uncertainty of the mass").or(0.0, "kg").at_least_zero(),
        Field::quantity("stiffness_uncertainty", Dimension::STIFFNESS, "standard uncertainty of the stiffness of the storey")
            .or(0.0, "N/m")
            .at_least_zero(),
        Field::quantity("height", Dimension::LENGTH, "height of the storey").above_zero(),
        Field::choice("behaviour", BEHAVIOURS, "storey shear against drift, what a virtual rig bends")
            .or_said("elastic, of its stiffness"),
        Field::quantity(
            "damping",
            Dimension::DAMPING,
            "viscous, c times the velocity of the drift, on a virtual rig's load cells",
        )
        .or(0.0, "N*s/m")
        .at_least_zero(),
        Field::quantity("coulomb", Dimension::FORCE, "friction against the drift, on a virtual rig's load cells")
            .or(0.0, "N")
            .at_least_zero(),
    ],
    "a floor on its columns",
)];

pub(super) const STOREYS: Field = Field::choices("storeys", STOREY, "storeys from the ground up, in place of mass and behaviour");

pub(super) const MASS_MATRIX: Field =
    Field::text("mass_matrix", "file of M in kg, a row a line, in place of mass and behaviour; with `stiffness_matrix`");

pub(super) const STIFFNESS_MATRIX: Field = Field::text("stiffness_matrix", "file of K in N/m, a row a line; with `mass_matrix`");

pub(super) const MASS_MATRIX_UNCERTAINTY: Field = Field::quantity(
    "mass_matrix_uncertainty",
    Dimension::NUMBER,
    "standard uncertainty of M, of it: one factor on all its entries, which keep their ratios",
)
.or(0.0, "%")
.within(0.0, 0.2);

pub(super) const STIFFNESS_MATRIX_UNCERTAINTY: Field =
    Field::quantity("stiffness_matrix_uncertainty", Dimension::NUMBER, "standard uncertainty of K, of it, in the same way")
        .or(0.0, "%")
        .within(0.0, 0.2);

pub(super) const DAMPING_UNCERTAINTY: Field = Field::quantity(
    "damping_ratio_uncertainty",
    Dimension::NUMBER,
    "standard uncertainty of the damping ratio of a frame; of a list, of each by itself",
)
.or(0.0, "%")
.within(0.0, 0.2);

pub(super) const GROUND: BlockKind = BlockKind {
    kind: Kind::Ground,
    keyword: &["ground"],
    naming: Naming::Named,
    procedure: false,
    fields: &[
        Field::text(
            "record",
            "file: a table with the header `time_s,acceleration_m_per_s2`, or an `.AT2` file of the PEER database",
        )
        .required("record = \"ground.csv\""),
        Field::quantity("scale", Dimension::NUMBER, "factor on the record").or(1.0, ""),
        Field::quantity("scale_uncertainty", Dimension::NUMBER, "standard uncertainty of the accelerations, of them")
            .or(0.0, "%")
            .within(0.0, 0.2),
        Field::quantity("unit", Dimension::ACCELERATION, "what 1 in the record is worth, where its header does not say")
            .above_zero()
            .or_said("as its header says"),
    ],
    exports: &[],
    results: &[],
    example: "ground quake { record = \"ground.csv\" }",
    doc: "The motion of the ground, from a file",
};

pub(super) const SHAKE: BlockKind = BlockKind {
    kind: Kind::Shake,
    keyword: &["shake"],
    naming: Naming::Named,
    procedure: true,
    fields: &[
        Field::reference("ground", Kind::Ground, "what moves below").required("ground = sine"),
        SPECIMEN,
        Field::quantities(
            "damping_ratio",
            Dimension::NUMBER,
            "one: Rayleigh damping with this ratio in the first two modes; a list: each mode its own",
        )
        .within(0.0, 1.0)
        .or(0.0, ""),
        DAMPING_UNCERTAINTY,
        methods::INTEGRATOR,
        methods::ALLOW_UNSTABLE,
        methods::I_MODIFICATION,
        methods::MODE,
        Field::quantity("time_step", Dimension::TIME, "Δt; may read `critical`, a tenth of the shortest period")
            .above_zero()
            .or_said("critical / 5"),
        Field::quantity("scale", Dimension::NUMBER, "factor on the record").or(1.0, ""),
        Field::quantity("duration", Dimension::TIME, "virtual time; past its record the ground rests")
            .above_zero()
            .or_said("to the end of the record"),
        Field::quantity("pause", Dimension::TIME, "wait at every step").or(0.0, "s").at_least_zero(),
        Field::quantity("max_tangent_ratio", Dimension::NUMBER, "the tangent stiffness stays in 0 .. this times K")
            .or(2.0, "")
            .above_zero(),
        Field::choices("inspect", INSPECT_TRIGGERS, "when a person is asked to look"),
    ],
    exports: &[],
    results: results::SHAKE,
    example: "shake quake {\n  ground = sine\n  damping_ratio = 2 %\n}",
    doc: "A frame on moving ground: an actuator and a load cell for each storey",
};
