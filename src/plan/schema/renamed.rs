//! Names of version 0.1 with their present names. The check of a plan, the reader of older run logs and the reader of older
//! summaries use this one table. It knows no syntax.

use super::types::Kind;
use crate::ProcedureBlock;

/// Where a name appears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NameRole {
    /// A field of such a block.
    Field(Kind),
    /// A named argument of these variants.
    Argument(&'static [&'static str]),
    /// A word or variant as the value of these fields.
    Word(&'static [&'static str]),
    /// A result of these procedures.
    Result(&'static [Kind]),
}

/// One name of version 0.1.
#[derive(Clone, Copy, Debug)]
pub struct Renamed {
    pub role: NameRole,
    pub old: &'static str,
    /// The present name. A result may have become the uncertainty of another: `breaks.u`.
    pub new: &'static str,
    /// Whether a new plan may still use the old name.
    pub alias: bool,
}

const fn renamed(role: NameRole, old: &'static str, new: &'static str) -> Renamed {
    Renamed {
        role,
        old,
        new,
        alias: false,
    }
}

const YIELDING: NameRole = NameRole::Argument(&["bilinear", "bouc_wen", "pinching"]);
const AXIS: NameRole = NameRole::Argument(&["axis"]);
const RIG: NameRole = NameRole::Field(Kind::Rig);
const RAMP: NameRole = NameRole::Result(&[Kind::Procedure(ProcedureBlock::StiffnessRamp)]);
const FITTED: NameRole = NameRole::Result(&[
    Kind::Procedure(ProcedureBlock::StiffnessRamp),
    Kind::Procedure(ProcedureBlock::Cycle),
]);

/// Every name that has changed since version 0.1.
pub const RENAMED: &[Renamed] = &[
    renamed(YIELDING, "hardening", "post_yield_ratio"),
    renamed(FITTED, "hardening", "post_yield_ratio"),
    renamed(FITTED, "hardened_stiffness", "post_yield_stiffness"),
    renamed(FITTED, "break_uncertainties", "breaks.u"),
    renamed(FITTED, "break_force_uncertainties", "break_forces.u"),
    renamed(
        FITTED,
        "curve_stiffness_uncertainties",
        "curve_stiffnesses.u",
    ),
    renamed(RAMP, "needed_pause", "required_pause"),
    renamed(RIG, "zero_count", "zero_offset"),
    renamed(AXIS, "zero_count", "zero_offset"),
    renamed(RIG, "gate", "pretest_check"),
    renamed(AXIS, "gate", "pretest_check"),
    renamed(RIG, "sign", "polarity"),
    renamed(AXIS, "sign", "polarity"),
    renamed(RIG, "drift", "zero_drift"),
    renamed(NameRole::Argument(&["virtual"]), "drift", "zero_drift"),
    renamed(NameRole::Field(Kind::Ground), "record", "file"),
    renamed(
        NameRole::Result(&[Kind::Procedure(ProcedureBlock::Escalate)]),
        "blows",
        "impacts",
    ),
    renamed(NameRole::Word(&["figures"]), "blows", "impacts"),
    renamed(NameRole::Word(&["results", "columns"]), "near", "tolerance"),
    Renamed {
        alias: true,
        ..renamed(NameRole::Word(&["mode"]), "step_and_pause", "ramp_and_hold")
    },
];

/// The row of a name at a position that `at` accepts.
#[must_use]
pub fn renamed_at(name: &str, at: impl Fn(NameRole) -> bool) -> Option<&'static Renamed> {
    RENAMED.iter().find(|row| row.old == name && at(row.role))
}

/// The row of a result of a procedure of this kind.
#[must_use]
pub fn renamed_result(kind: Kind, name: &str) -> Option<&'static Renamed> {
    renamed_at(
        name,
        |role| matches!(role, NameRole::Result(kinds) if kinds.contains(&kind)),
    )
}
