//! `escalate`: its block and its results.

use crate::ProcedureBlock;
use crate::procedures::impact::block as impact;
use crate::schema::methods::TRUTH;
use crate::schema::{BlockKind, Field, Kind, Naming, Peak, Possible, ResultKind, Variant};
use psd_text::units::Dimension;

pub const SPEEDS: Field = Field::quantities(
    "speeds",
    Dimension::VELOCITY,
    "striker velocity of each impact; or `drop_heights`, or `energies`",
)
.above_zero()
.default_in_words("from heights or energies");

pub const DROP_HEIGHTS: Field = Field::quantities(
    "drop_heights",
    Dimension::LENGTH,
    "drop height of each impact",
)
.above_zero();

pub const ENERGIES: Field =
    Field::quantities("energies", Dimension::ENERGY, "energy of each impact").above_zero();

pub const WHILE: Field = Field::condition(
    "while",
    "the next impact follows while this condition on the results of the last one is met",
)
.required("while = max_displacement < 20 mm");

pub const BETWEEN: Field = Field::choice(
    "between",
    &[
        Variant::word("unload", "to zero restoring force"),
        Variant::word("home", "back to the start of the first impact"),
        Variant::word(
            "stay",
            "no repositioning; the next impact starts from the loaded position",
        ),
    ],
    "position of the specimen between impacts, and after the last",
)
.default_in_words("unload");

pub const INSPECT_BETWEEN: Field = Field::choice(
    "inspect_between",
    TRUTH,
    "asks the operator to inspect the specimen between impacts",
)
.default_in_words("false");

/// What an `escalate` has besides the fields of an impact.
const OWN: [Field; 6] = [
    SPEEDS,
    DROP_HEIGHTS,
    ENERGIES,
    WHILE,
    BETWEEN,
    INSPECT_BETWEEN,
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

pub const IMPACTS: ResultKind = ResultKind::count(
    "impacts",
    "number of impacts, including one that failed or was inconclusive",
)
.final_after(Peak::LastImpact);

pub const PASSED: ResultKind = ResultKind::count(
    "passed",
    "number of impacts after which the condition was true",
)
.decided_by_condition()
.final_after(Peak::LastImpact);

pub const LAST_PASSED_ENERGY: ResultKind = ResultKind::measured(
    "last_passed_energy",
    Dimension::ENERGY,
    "energy of the last impact after which the condition was true; 0 if false after the first",
)
.decided_by_condition()
.made_of(&impact::STRIKER_ENERGY)
.final_after(Peak::LastImpact);

pub const FIRST_FAILED_ENERGY: ResultKind = ResultKind::measured(
    "first_failed_energy",
    Dimension::ENERGY,
    "energy of the first impact after which the condition was false",
)
.decided_by_condition()
.made_of(&impact::STRIKER_ENERGY);

pub const MAX_DISPLACEMENT: ResultKind = ResultKind::measured(
    "max_displacement",
    Dimension::LENGTH,
    "largest displacement in all impacts",
)
.within(Possible::LargestDisplacement)
.made_of(&impact::MAX_DISPLACEMENT);

pub const RESIDUAL_DISPLACEMENT: ResultKind = ResultKind::measured(
    "residual_displacement",
    Dimension::LENGTH,
    "unloaded position after the last impact, with `between = unload`",
)
.final_after(Peak::PositionAfter);

pub const FINAL_DISPLACEMENT: ResultKind = ResultKind::measured(
    "final_displacement",
    Dimension::LENGTH,
    "position after the last impact, with `between = home` or `stay`",
)
.final_after(Peak::PositionAfter);

pub const ABSORBED_ENERGY: ResultKind = ResultKind::measured(
    "absorbed_energy",
    Dimension::ENERGY,
    "sum of the energies absorbed up to the largest displacement of each impact",
)
.made_of(&impact::ABSORBED_ENERGY);

pub const VELOCITIES: ResultKind = ResultKind::measured_list(
    "velocities",
    Dimension::VELOCITY,
    "striker velocity of each impact",
)
.made_of(&impact::STRIKER_ENERGY);

pub const IMPACT_ENERGIES: ResultKind = ResultKind::measured_list(
    "impact_energies",
    Dimension::ENERGY,
    "striker energy of each impact",
)
.made_of(&impact::STRIKER_ENERGY);

pub const MAX_DISPLACEMENTS: ResultKind = ResultKind::measured_list(
    "max_displacements",
    Dimension::LENGTH,
    "largest displacement of each impact",
)
.made_of(&impact::MAX_DISPLACEMENT);

pub const RESIDUAL_DISPLACEMENTS: ResultKind = ResultKind::measured_list(
    "residual_displacements",
    Dimension::LENGTH,
    "unloaded position after each impact, with `between = unload`",
)
.final_after(Peak::PositionAfter);

pub const FINAL_DISPLACEMENTS: ResultKind = ResultKind::measured_list(
    "final_displacements",
    Dimension::LENGTH,
    "position after each impact, with `between = home` or `stay`",
)
.final_after(Peak::PositionAfter);

pub const ABSORBED_ENERGIES: ResultKind = ResultKind::measured_list(
    "absorbed_energies",
    Dimension::ENERGY,
    "energy absorbed in each impact up to its largest displacement",
)
.made_of(&impact::ABSORBED_ENERGY);

pub const IMPULSES: ResultKind =
    ResultKind::measured_list("impulses", Dimension::IMPULSE, "impulse of each impact")
        .made_of(&impact::IMPULSE);

pub const ENERGY_ERRORS: ResultKind = ResultKind::list(
    "energy_errors",
    Dimension::NUMBER,
    "residual of the energy balance of each impact relative to its input energy",
)
.in_percent();

pub const MAX_DRIFT: ResultKind = ResultKind::measured_list(
    "max_drift",
    Dimension::LENGTH,
    "peak absolute drift of each storey in all impacts",
)
.within(Possible::NotNegative)
.of_storey()
.made_of(&impact::MAX_DRIFT);

pub const RESIDUAL_DRIFT: ResultKind = ResultKind::measured_list(
    "residual_drift",
    Dimension::LENGTH,
    "drift of each unloaded storey after the last impact, with `between = unload`",
)
.of_storey()
.final_after(Peak::DriftAfter);

pub const FINAL_DRIFT: ResultKind = ResultKind::measured_list(
    "final_drift",
    Dimension::LENGTH,
    "drift of each storey after the last impact, with `between = home` or `stay`",
)
.of_storey()
.final_after(Peak::DriftAfter);

pub const STOREY_ENERGY: ResultKind = ResultKind::measured_list(
    "storey_energy",
    Dimension::ENERGY,
    "energy absorbed by each storey in all impacts",
)
.of_storey()
.made_of(&impact::STOREY_ENERGY);

/// What it leaves, in the order of the tables and of `summary.json`.
pub const RESULTS: &[ResultKind] = &[
    IMPACTS,
    PASSED,
    LAST_PASSED_ENERGY,
    FIRST_FAILED_ENERGY,
    MAX_DISPLACEMENT,
    RESIDUAL_DISPLACEMENT,
    FINAL_DISPLACEMENT,
    ABSORBED_ENERGY,
    VELOCITIES,
    IMPACT_ENERGIES,
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

pub const BLOCK: BlockKind = BlockKind {
    kind: Kind::Procedure(ProcedureBlock::Escalate),
    keyword: &["escalate"],
    naming: Naming::Named,
    fields: &FIELDS,
    exports: &[],
    results: RESULTS,
    example: "escalate rising {\n  striker  = pendulum\n  speeds   = [0.5, 1, 1.5] m/s\n  while    = max_displacement < 20 mm\n  duration = 50 ms\n}",
    doc: "Impacts of increasing energy on one specimen or one storey of a frame, until `while` is false or the list ends",
};
