//! Known keywords that this version does not implement.

use super::types::{BlockKind, Kind, Naming};

const fn later(
    keyword: &'static [&'static str],
    naming: Naming,
    procedure: bool,
    doc: &'static str,
) -> BlockKind {
    BlockKind {
        kind: Kind::Later,
        keyword,
        naming,
        procedure,
        fields: &[],
        exports: &[],
        results: &[],
        example: "",
        doc,
    }
}

pub(super) const STUDY: BlockKind =
    later(&["study"], Naming::Named, false, "Many runs of one plan");
