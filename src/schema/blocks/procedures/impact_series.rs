//! `escalate`: its block and its results.

use super::impact;
use crate::schema::blocks::methods::TRUTH;
use crate::schema::types::{BlockKind, Field, Kind, Naming, ResultKind, Variant};
use crate::units::Dimension;

/// What an `escalate` has besides the fields of an impact.
const OWN: [Field; 6] = [
    Field::quantities(
        "speeds",
        Dimension::VELOCITY,
        "velocity of the striker in each blow; or `drop_heights`, or `energies`",
    )
    .above_zero()
    .or_said("what the heights or energies give"),
    Field::quantities(
        "drop_heights",
        Dimension::LENGTH,
        "height of fall of each blow",
    )
    .above_zero(),
    Field::quantities("energies", Dimension::ENERGY, "energy of each blow").above_zero(),
    Field::condition(
        "while",
        "what must hold of the results of a blow, by their own names, for the next to follow",
    )
    .required("while = max_displacement < 20 mm"),
    Field::choice(
        "between",
        &[
            Variant::word("unload", "to where the restoring force is none"),
            Variant::word("home", "back to where the first blow began"),
            Variant::word(
                "stay",
                "nowhere: the next blow begins where this one ended, under its load",
            ),
        ],
        "where the specimen is brought between two blows, and after the last",
    )
    .or_said("unload"),
    Field::choice(
        "inspect_between",
        TRUTH,
        "whether a person looks at the specimen between two blows",
    )
    .or_said("false"),
];

const FIELDS: [Field; OWN.len() + impact::BLOCK.fields.len()] = {
    let mut all = [OWN[0]; OWN.len() + impact::BLOCK.fields.len()];
    let mut at = 0;
    while at < all.len() {
        all[at] = if at < OWN.len() {
            OWN[at]
        } else {
            impact::BLOCK.fields[at - OWN.len()]
        };
        at += 1;
    }
    all
};

pub(crate) const BLOWS: ResultKind = ResultKind::count(
    "blows",
    "number of blows, the one that failed, or that decided nothing, among them",
);

pub(crate) const PASSED: ResultKind =
    ResultKind::count("passed", "number of blows after which the condition held");

pub(crate) const LAST_PASSED_ENERGY: ResultKind = ResultKind::measured(
    "last_passed_energy",
    Dimension::ENERGY,
    "energy of the last blow after which it held; 0 where it did not hold after the first",
);

pub(crate) const FIRST_FAILED_ENERGY: ResultKind = ResultKind::measured(
    "first_failed_energy",
    Dimension::ENERGY,
    "energy of the blow after which it no longer held",
);

pub(crate) const MAX_DISPLACEMENT: ResultKind = ResultKind::measured(
    "max_displacement",
    Dimension::LENGTH,
    "largest displacement over all blows",
);

pub(crate) const RESIDUAL_DISPLACEMENT: ResultKind = ResultKind::measured(
    "residual_displacement",
    Dimension::LENGTH,
    "where the specimen rests after the last blow, if unloaded",
);

pub(crate) const FINAL_DISPLACEMENT: ResultKind = ResultKind::measured(
    "final_displacement",
    Dimension::LENGTH,
    "where the specimen was left after the last blow, with `between = home` or `stay`",
);

pub(crate) const ABSORBED_ENERGY: ResultKind = ResultKind::measured(
    "absorbed_energy",
    Dimension::ENERGY,
    "sum over the blows of what each absorbed up to its largest displacement",
);

pub(crate) const VELOCITIES: ResultKind = ResultKind::measured_list(
    "velocities",
    Dimension::VELOCITY,
    "velocity of the striker in each blow",
);

pub(crate) const BLOW_ENERGIES: ResultKind = ResultKind::measured_list(
    "blow_energies",
    Dimension::ENERGY,
    "energy of the striker in each blow",
);

pub(crate) const MAX_DISPLACEMENTS: ResultKind = ResultKind::measured_list(
    "max_displacements",
    Dimension::LENGTH,
    "largest displacement of each blow",
);

pub(crate) const RESIDUAL_DISPLACEMENTS: ResultKind = ResultKind::measured_list(
    "residual_displacements",
    Dimension::LENGTH,
    "where the specimen rests after each blow, if unloaded",
);

pub(crate) const FINAL_DISPLACEMENTS: ResultKind = ResultKind::measured_list(
    "final_displacements",
    Dimension::LENGTH,
    "where the specimen was left after each blow, with `between = home` or `stay`",
);

pub(crate) const ABSORBED_ENERGIES: ResultKind = ResultKind::measured_list(
    "absorbed_energies",
    Dimension::ENERGY,
    "what each blow put into the specimen up to its largest displacement",
);

pub(crate) const IMPULSES: ResultKind =
    ResultKind::measured_list("impulses", Dimension::IMPULSE, "impulse of each blow");

pub(crate) const ENERGY_ERRORS: ResultKind = ResultKind::list(
    "energy_errors",
    Dimension::NUMBER,
    "what the energy balance of each blow misses, over its input",
);

pub(crate) const MAX_DRIFT: ResultKind = ResultKind::measured_list(
    "max_drift",
    Dimension::LENGTH,
    "largest size of each storey's drift over all blows",
)
.of_storey();

pub(crate) const RESIDUAL_DRIFT: ResultKind = ResultKind::measured_list(
    "residual_drift",
    Dimension::LENGTH,
    "each storey's drift where it rests after the last blow, if unloaded",
)
.of_storey();

pub(crate) const FINAL_DRIFT: ResultKind = ResultKind::measured_list(
    "final_drift",
    Dimension::LENGTH,
    "each storey's drift where it was left after the last blow, with `between = home` or `stay`",
)
.of_storey();

pub(crate) const STOREY_ENERGY: ResultKind = ResultKind::measured_list(
    "storey_energy",
    Dimension::ENERGY,
    "what each storey took in all blows, its shear over its drift",
)
.of_storey();

/// What it leaves, in the order of the tables and of `summary.json`.
pub(crate) const RESULTS: &[ResultKind] = &[
    BLOWS,
    PASSED,
    LAST_PASSED_ENERGY,
    FIRST_FAILED_ENERGY,
    MAX_DISPLACEMENT,
    RESIDUAL_DISPLACEMENT,
    FINAL_DISPLACEMENT,
    ABSORBED_ENERGY,
    VELOCITIES,
    BLOW_ENERGIES,
    MAX_DISPLACEMENTS,
    RESIDUAL_DISPLACEMENTS,
    FINAL_DISPLACEMENTS,
    ABSORBED_ENERGIES,
    IMPULSES,
    ENERGY_ERRORS,
    MAX_DRIFT,
    RESIDUAL_DRIFT,
    FINAL_DRIFT,
    STOREY_ENERGY,
];

pub(crate) const BLOCK: BlockKind = BlockKind {
    kind: Kind::Escalate,
    keyword: &["escalate"],
    naming: Naming::Named,
    procedure: true,
    fields: &FIELDS,
    exports: &[],
    results: RESULTS,
    example: "escalate rising {\n  striker  = pendulum\n  speeds   = [0.5, 1, 1.5] m/s\n  while    = max_displacement < 20 mm\n  duration = 50 ms\n}",
    doc: "Blows of rising energy on one specimen, or on one storey of a frame, until a condition on the last blow no longer holds or the list ends",
};
