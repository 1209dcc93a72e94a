//! `inspect`: a person looks at the specimen while the rig stays where it is. What was said is an event of the record.

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
