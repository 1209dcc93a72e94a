//! `inspect`: the operator examines the specimen while the rig holds its position. The answer is an event of the record.

use crate::record::History;
use crate::run::Performed;
use crate::run::session::Session;

pub(crate) fn perform(note: &str, session: &mut Session<'_>) -> Performed {
    Performed {
        history: History::Inspect,
        results: Vec::new(),
        stop: session.inspect(note).err(),
    }
}
