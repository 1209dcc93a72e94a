//! `inspect`: the operator examines the specimen while the rig holds its position. The answer is an event of the record.

use crate::run::Performed;
use crate::run::session::Session;
use psd_plan::record::History;

pub(crate) fn perform(note: &str, session: &mut Session<'_>) -> Performed {
    Performed {
        history: History::Inspect,
        results: Vec::new(),
        stop: session.inspect(note).err(),
    }
}
