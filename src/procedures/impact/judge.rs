//! The judgement of a blow once striker and specimen are known: its time step, its end, whether the striker arrives. In: a blow and
//! what the plan declares. Out: faults and warnings.

use super::{arrival, check, storey_check};
use crate::language::check::checker::Checker;
use crate::language::check::declared::Declared;
use crate::plan::{Impact, StoreyImpact, Striker};

/// The slowest striker must arrive, the fastest be followed.
pub(crate) struct Strikers<'a> {
    pub slowest: &'a Striker,
    pub fastest: &'a Striker,
}

/// Of one degree of freedom.
pub(crate) fn on_specimen(
    checker: &mut Checker,
    block: usize,
    impact: &Impact,
    strikers: &Strikers<'_>,
    declared: &Declared<'_>,
) {
    let specimen = declared.specimen(impact.specimen);
    check::judge(checker, block, impact, strikers.fastest, specimen);
    arrival::hold(checker, block, strikers.slowest, impact.duration.constant());
}

/// Of a storey.
pub(crate) fn on_storey(
    checker: &mut Checker,
    block: usize,
    impact: &StoreyImpact,
    strikers: &Strikers<'_>,
    declared: &Declared<'_>,
) {
    if let Some(frame) = declared.frame(impact.specimen) {
        storey_check::judge(checker, block, impact, frame, strikers.fastest);
        arrival::hold(checker, block, strikers.slowest, impact.duration.constant());
    }
}
