//! What the procedures on a frame share: its floors, storeys and elements in tables, figures and texts, whatever moves them. In: the steps of
//! a frame. Out: columns, charts, blocks of a report. It knows no striker and no ground motion.

pub(crate) mod captions;
pub(crate) mod charts;
pub(crate) mod predicted;
pub(crate) mod report;
pub(crate) mod results;
pub(crate) mod tables;
