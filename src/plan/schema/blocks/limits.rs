//! `limits { … }`: the limits that no command may exceed.

use crate::fields;
use crate::limits_fields;
pub use crate::rig::limits::NAMES;
use crate::schema::types::{BlockKind, Field, Kind, Naming};
use psd_text::units::Dimension;

pub const LIMITS: BlockKind = BlockKind {
    kind: Kind::Limits,
    keyword: &["limits"],
    naming: Naming::MaybeNamed,
    fields: limits_fields!(fields),
    exports: &[],
    results: &[],
    example: "limits { displacement = -2 mm .. 25 mm }",
    doc: "Safety limits: of the plan, or, if named, of the rigs that refer to it",
};
