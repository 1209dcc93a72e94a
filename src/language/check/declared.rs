//! What a plan declares beside its procedures, by place. In: checked blocks, None for each with a fault. Out: one of them.

use crate::plan::{Frame, Ground, Specimen, Striker};

/// The declarations that procedures are judged by.
pub struct Declared<'a> {
    pub specimens: &'a [Option<Specimen>],
    pub strikers: &'a [Option<Striker>],
    pub grounds: &'a [Option<Ground>],
}

impl Declared<'_> {
    /// The specimen at this place.
    pub fn specimen(&self, place: usize) -> Option<&Specimen> {
        self.specimens.get(place)?.as_ref()
    }

    /// The frame that the specimen at this place is.
    pub fn frame(&self, place: usize) -> Option<&Frame> {
        self.specimen(place)?.frame.as_ref()
    }

    /// The striker at this place.
    pub fn striker(&self, place: usize) -> Option<&Striker> {
        self.strikers.get(place)?.as_ref()
    }

    /// The ground motion at this place.
    pub fn ground(&self, place: usize) -> Option<&Ground> {
        self.grounds.get(place)?.as_ref()
    }
}
