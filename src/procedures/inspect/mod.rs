//! `inspect`: the rig holds while the operator examines the specimen. In: its block and a note.
//! Out: an event with the operator's answer. It commands no motion.

pub(crate) mod check;
pub(crate) mod run;
