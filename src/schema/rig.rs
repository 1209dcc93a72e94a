//! `rig NAME { … }`: what moves the specimen.

use super::types::{BlockKind, Field, Kind, Naming, Variant};
use crate::quantity::Dimension;

const LINKS: &[Variant] = &[
    Variant::with(
        "virtual",
        &[
            Field::quantity("noise", Dimension::FORCE, "standard deviation of the load cell").or(0.0, "N").at_least_zero(),
            Field::quantity("resolution", Dimension::LENGTH, "quantum of the displacement reading").or(0.0, "mm").at_least_zero(),
            Field::quantity("force_resolution", Dimension::FORCE, "quantum of the force reading").or(0.0, "N").at_least_zero(),
            Field::quantity("lag", Dimension::TIME, "first-order time constant of the actuator").or(0.0, "s").at_least_zero(),
            Field::quantity("tracking", Dimension::NUMBER, "fraction of each increment not reached")
                .or(0.0, "")
                .within(-1.0, 1.0),
            Field::quantity("drift", Dimension::FORCE_RATE, "drift of the load cell").or(0.0, "N/s"),
            Field::count("seed", 0.0, 9_007_199_254_740_992.0, "seed of the noise").or(0.0, ""),
        ],
        "no hardware: bends the specimen's behaviour",
    ),
    Variant::later("serial", "a controller on a serial port"),
    Variant::later("tcp", "a controller on the network"),
];

pub(super) const RIG: BlockKind = BlockKind {
    kind: Kind::Rig,
    keyword: &["rig"],
    naming: Naming::Named,
    procedure: false,
    fields: &[
        Field::choice("link", LINKS, "how the rig is reached").required("link = virtual(noise: 2 N, seed: 7)"),
        Field::choice(
            "settle",
            &[Variant::with(
                "within",
                &[
                    Field::quantity("displacement", Dimension::LENGTH, "displacement stays this near its target")
                        .required("0.01 mm")
                        .at_least_zero(),
                    Field::quantity("force_rate", Dimension::FORCE_RATE, "the force changes no faster than this")
                        .required("5 N/s")
                        .at_least_zero(),
                    Field::quantity("for", Dimension::TIME, "for this long").or(0.0, "s").at_least_zero(),
                    Field::quantity("timeout", Dimension::TIME, "longest wait").or(10.0, "s").above_zero(),
                ],
                "a reading counts when it stayed within these bounds",
            )],
            "when a reading counts",
        )
        .or_said("at once"),
        Field::text("calibration", "reference of the calibration"),
        Field::choice(
            "sign",
            &[
                Variant::word("positive", "the rig's positive direction is the striker's"),
                Variant::word("negative", "the rig's positive direction is against the striker's"),
            ],
            "direction of the rig's displacement and force",
        )
        .or_said("positive"),
        Field::reference("limits", Kind::Limits, "a named `limits` block that holds whenever this rig moves"),
        Field::later("actuator", "the link of the actuator alone"),
        Field::later("load_cell", "the link of the load cell alone"),
        Field::later("safe_state", "what a real rig does when the run ends early: `hold` or `unload`"),
    ],
    exports: &[],
    results: &[],
    example: "rig rehearsal { link = virtual(noise: 2 N, seed: 7) }",
    doc: "What moves the specimen",
};
