//! The declarations of a plan beside its procedures, by index. In: checked blocks, None for each with an error. Out: one of them.

use psd_plan::{Frame, Ground, Specimen, Striker};

/// The declarations that the check of a procedure needs.
pub struct Declared<'a> {
    pub specimens: &'a [Option<Specimen>],
    pub strikers: &'a [Option<Striker>],
    pub grounds: &'a [Option<Ground>],
}

impl Declared<'_> {
    /// The specimen with this index.
    pub fn specimen(&self, index: usize) -> Option<&Specimen> {
        self.specimens.get(index)?.as_ref()
    }

    /// The frame of the specimen with this index.
    pub fn frame(&self, index: usize) -> Option<&Frame> {
        self.specimen(index)?.frame.as_ref()
    }

    /// The striker with this index.
    pub fn striker(&self, index: usize) -> Option<&Striker> {
        self.strikers.get(index)?.as_ref()
    }

    /// The ground motion with this index.
    pub fn ground(&self, index: usize) -> Option<&Ground> {
        self.grounds.get(index)?.as_ref()
    }
}
