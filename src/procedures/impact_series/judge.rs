//! The judgement of a row of blows once striker and specimen are known: every blow is as likely to fail as its slowest or fastest.
//! In: a row and what the plan declares. Out: faults and warnings.

use crate::language::check::checker::Checker;
use crate::language::check::declared::Declared;
use crate::plan::{Between, BlowOn, Escalate};
use crate::procedures::facts::Motion;
use crate::procedures::impact::judge::{Strikers, on_specimen, on_storey};
use crate::procedures::impact::left::PEAK;

/// Judges the blows.
pub(crate) fn judge(
    checker: &mut Checker,
    block: usize,
    escalate: &Escalate,
    declared: &Declared<'_>,
) {
    let Some(striker) = declared.striker(escalate.striker()) else {
        return;
    };
    let strikers = Strikers {
        slowest: &escalate.slowest(striker),
        fastest: &escalate.fastest(striker),
    };
    match &escalate.blow {
        BlowOn::Specimen(blow) => on_specimen(checker, block, blow, &strikers, declared),
        BlowOn::Storey(blow) => on_storey(checker, block, blow, &strikers, declared),
    }
}

/// How the row leaves the specimen to what comes next.
pub(crate) fn left(escalate: &Escalate) -> Motion<'static> {
    Motion {
        what: "row of blows",
        ends: PEAK,
        help: "write `between = unload`, or `unload rest { }` in between",
        rests: escalate.between != Between::Stay,
    }
}
