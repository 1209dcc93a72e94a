//! The check of a series of impacts against striker and specimen: the slowest must arrive, the time step must follow the fastest. In: a
//! series and the declarations of the plan. Out: errors and warnings.

use crate::procedures::facts::Motion;
use crate::procedures::impact;
use crate::procedures::impact::check::declared::Strikers;
use crate::procedures::impact::facts::PEAK;
use psd_language::check::checker::Checker;
use psd_language::check::declared::Declared;
use psd_plan::{Between, Escalate};

pub(crate) fn check_declared(
    checker: &mut Checker,
    block: usize,
    series: &Escalate,
    declared: &Declared<'_>,
) {
    let Some(striker) = declared.striker(series.impact.striker) else {
        return;
    };
    let strikers = Strikers {
        slowest: &series.slowest(striker),
        fastest: &series.fastest(striker),
    };
    impact::check::declared::check_declared(checker, block, &series.impact, &strikers, declared);
}

/// The motion that the series leaves.
pub(crate) fn motion(series: &Escalate) -> Motion<'static> {
    Motion {
        what: "impact series",
        ends: PEAK,
        help: "write `between = unload`, or `unload rest { }` in between",
        rests: series.between != Between::Stay,
    }
}
