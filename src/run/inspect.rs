//! `inspect`: a person looks at the specimen while the rig stays where it is. What was said is an event of the record.

use super::Performed;
use super::session::Session;
use crate::record::History;

pub(super) fn perform(note: &str, session: &mut Session<'_>) -> Performed {
    Performed { history: History::Inspect, results: Vec::new(), stop: session.inspect(note).err() }
}
