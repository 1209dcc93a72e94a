//! `limits { … }`: the limits that no command may exceed.

use crate::plan::declaration::fields;
pub(crate) use crate::plan::rig::limits::NAMES;
use crate::plan::rig::limits::limits_fields;
use crate::schema::types::{BlockKind, Field, Kind, Naming};
use crate::units::Dimension;

pub(crate) const LIMITS: BlockKind = BlockKind {
    kind: Kind::Limits,
    keyword: &["limits"],
    naming: Naming::MaybeNamed,
    fields: limits_fields!(fields),
    exports: &[],
    results: &[],
    example: "limits { displacement = -2 mm .. 25 mm }",
    doc: "Safety limits: of the plan, or, if named, of the rigs that refer to it",
};
