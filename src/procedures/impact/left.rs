//! How a blow leaves the specimen to what comes next. In: a blow. Out: where it ends, in words, and what helps.

use crate::plan::{StoreyImpact, Until};
use crate::procedures::facts::Motion;

/// Where a blow ends.
pub(crate) const PEAK: &str = "ends near its largest displacement";

/// Of one degree of freedom.
pub(crate) fn on_specimen() -> Motion<'static> {
    Motion {
        what: "blow",
        ends: PEAK,
        help: "take the load off in between: `unload rest { }`",
        rests: false,
    }
}

/// Of a storey, whose frame comes to rest by itself where the run goes on for long enough.
pub(crate) fn on_storey(blow: &StoreyImpact) -> Motion<'static> {
    Motion {
        what: "blow",
        ends: PEAK,
        help: "take the load off in between: `unload rest { }`, or let the first run on until the frame rests: \
    `until = duration`, with a `damping_ratio`",
        rests: blow.until == Until::Duration,
    }
}
