//! Several blows on one specimen: `escalate`, and `unload` between blows.

use super::methods::TRUTH;
use super::procedures::IMPACT;
use super::types::{BlockKind, Field, Kind, Naming, ResultKind, RigKind, Variant};
use crate::quantity::Dimension;

pub(super) const UNLOAD: BlockKind = BlockKind {
    kind: Kind::Unload,
    keyword: &["unload"],
    naming: Naming::Named,
    procedure: true,
    fields: &[
        Field::reference("specimen", Kind::Specimen, "what is unloaded").or_said("the only one declared"),
        Field::quantity(
            "stiffness",
            Dimension::STIFFNESS,
            "with which the force is expected to fall; the storeys of a frame have their own",
        )
        .above_zero()
        .required_on(RigKind::Real, "stiffness = k0.stiffness", "the behaviour's initial stiffness"),
        Field::quantity("within", Dimension::FORCE, "largest force, of a frame that of a floor, that counts as none")
            .above_zero()
            .or_said("a thousandth of the force at the start, or what noise and resolution can tell"),
        Field::quantity("speed", Dimension::VELOCITY, "actuator speed").above_zero().or_said("the rig's own"),
    ],
    exports: &[],
    results: &[
        ResultKind::measured(
            "residual_displacement",
            Dimension::LENGTH,
            "where the specimen rests; of a frame, the floor that rests farthest out",
        ),
        ResultKind::measured(
            "residual_force",
            Dimension::FORCE,
            "what it still carries there; of a frame, the floor that carries most",
        ),
        ResultKind::measured_list("floor_displacement", Dimension::LENGTH, "where each floor rests").of_storey(),
        ResultKind::measured_list("residual_drift", Dimension::LENGTH, "each storey's drift there").of_storey(),
        ResultKind::measured_list("residual_shear", Dimension::FORCE, "what each storey still carries there").of_storey(),
    ],
    example: "unload rest { }",
    doc: "Takes the load off: moves to where the restoring force is none, of a frame all floors together",
};

/// What an `escalate` has besides the fields of an impact.
const OWN: [Field; 6] = [
    Field::quantities("speeds", Dimension::VELOCITY, "velocity of the striker in each blow; or `drop_heights`, or `energies`")
        .above_zero()
        .or_said("what the heights or energies give"),
    Field::quantities("drop_heights", Dimension::LENGTH, "height of fall of each blow").above_zero(),
    Field::quantities("energies", Dimension::ENERGY, "energy of each blow").above_zero(),
    Field::condition("while", "what must hold of the results of a blow, by their own names, for the next to follow")
        .required("while = max_displacement < 20 mm"),
    Field::choice(
        "between",
        &[
            Variant::word("unload", "to where the restoring force is none"),
            Variant::word("home", "back to where the first blow began"),
            Variant::word("stay", "nowhere: the next blow begins where this one ended, under its load"),
        ],
        "where the specimen is brought between two blows, and after the last",
    )
    .or_said("unload"),
    Field::choice("inspect_between", TRUTH, "whether a person looks at the specimen between two blows").or_said("false"),
];

const FIELDS: [Field; OWN.len() + IMPACT.fields.len()] = {
    let mut all = [OWN[0]; OWN.len() + IMPACT.fields.len()];
    let mut at = 0;
    while at < all.len() {
        all[at] = if at < OWN.len() { OWN[at] } else { IMPACT.fields[at - OWN.len()] };
        at += 1;
    }
    all
};

pub(super) const ESCALATE: BlockKind = BlockKind {
    kind: Kind::Escalate,
    keyword: &["escalate"],
    naming: Naming::Named,
    procedure: true,
    fields: &FIELDS,
    exports: &[],
    results: &[
        ResultKind::count("blows", "number of blows, the one that failed, or that decided nothing, among them"),
        ResultKind::count("passed", "number of blows after which the condition held"),
        ResultKind::measured(
            "last_passed_energy",
            Dimension::ENERGY,
            "energy of the last blow after which it held; 0 where it did not hold after the first",
        ),
        ResultKind::measured("first_failed_energy", Dimension::ENERGY, "energy of the blow after which it no longer held"),
        ResultKind::measured("max_displacement", Dimension::LENGTH, "largest displacement over all blows"),
        ResultKind::measured(
            "residual_displacement",
            Dimension::LENGTH,
            "where the specimen rests after the last blow, if unloaded",
        ),
        ResultKind::measured(
            "final_displacement",
            Dimension::LENGTH,
            "where the specimen was left after the last blow, with `between = home` or `stay`",
        ),
        ResultKind::measured(
            "absorbed_energy",
            Dimension::ENERGY,
            "sum over the blows of what each absorbed up to its largest displacement",
        ),
        ResultKind::measured_list("velocities", Dimension::VELOCITY, "velocity of the striker in each blow"),
        ResultKind::measured_list("blow_energies", Dimension::ENERGY, "energy of the striker in each blow"),
        ResultKind::measured_list("max_displacements", Dimension::LENGTH, "largest displacement of each blow"),
        ResultKind::measured_list(
            "residual_displacements",
            Dimension::LENGTH,
            "where the specimen rests after each blow, if unloaded",
        ),
        ResultKind::measured_list(
            "final_displacements",
            Dimension::LENGTH,
            "where the specimen was left after each blow, with `between = home` or `stay`",
        ),
        ResultKind::measured_list(
            "absorbed_energies",
            Dimension::ENERGY,
            "what each blow put into the specimen up to its largest displacement",
        ),
        ResultKind::measured_list("impulses", Dimension::IMPULSE, "impulse of each blow"),
        ResultKind::list("energy_errors", Dimension::NUMBER, "what the energy balance of each blow misses, over its input"),
        ResultKind::measured_list("max_drift", Dimension::LENGTH, "largest size of each storey's drift over all blows")
            .of_storey(),
        ResultKind::measured_list(
            "residual_drift",
            Dimension::LENGTH,
            "each storey's drift where it rests after the last blow, if unloaded",
        )
        .of_storey(),
        ResultKind::measured_list(
            "final_drift",
            Dimension::LENGTH,
            "each storey's drift where it was left after the last blow, with `between = home` or `stay`",
        )
        .of_storey(),
        ResultKind::measured_list(
            "storey_energy",
            Dimension::ENERGY,
            "what each storey took in all blows, its shear over its drift",
        )
        .of_storey(),
    ],
    example: "escalate rising {\n  striker  = pendulum\n  speeds   = [0.5, 1, 1.5] m/s\n  while    = max_displacement < 20 mm\n  duration = 50 ms\n}",
    doc: "Blows of rising energy on one specimen, or on one storey of a frame, until a condition on the last blow no longer holds or the list ends",
};
