//! The specimen behind the guard, as a client of one degree of freedom sees it. In: targets. Out: the reading after each,
//! and what the session asked of the specimen in all. It knows no protocol.

use crate::rig::{Guard, RigFault};

/// What a session asked of the specimen, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Driven {
    /// Moves carried out.
    pub targets: u64,
    /// Targets that a limit stood in the way of.
    pub refused: u64,
    /// Largest |displacement| read, m.
    pub displacement: f64,
    /// Largest |force| read, N.
    pub force: f64,
}

/// Displacement (m) and force (N), settled and inside the limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Felt {
    pub displacement: f64,
    pub force: f64,
}

/// One degree of freedom behind its guard.
pub struct Specimen<'session, 'rig> {
    guard: &'session mut Guard<'rig>,
    felt: Felt,
    driven: Driven,
}

impl<'session, 'rig> Specimen<'session, 'rig> {
    /// Reads where it stands.
    ///
    /// # Errors
    /// It cannot be read, stands outside a limit, or has more than one degree of freedom.
    pub fn new(guard: &'session mut Guard<'rig>) -> Result<Self, RigFault> {
        let degrees = guard.commanded().len();
        if degrees != 1 {
            let reason = format!("a client can drive one degree of freedom, and this rig has {degrees}");
            return Err(RigFault::Device(reason));
        }
        let nothing = Felt { displacement: 0.0, force: 0.0 };
        let mut specimen = Self { guard, felt: nothing, driven: Driven::default() };
        specimen.read()?;
        Ok(specimen)
    }

    /// What was read last.
    pub const fn felt(&self) -> Felt {
        self.felt
    }

    pub const fn driven(&self) -> Driven {
        self.driven
    }

    /// The last target carried out, m.
    pub fn commanded(&self) -> f64 {
        self.guard.commanded()[0]
    }

    /// Rig time, s.
    pub fn time(&self) -> f64 {
        self.guard.time()
    }

    /// Checks a target (m) and makes it ready; nothing moves.
    ///
    /// # Errors
    /// A limit stands in the way, or the rig refuses.
    pub fn propose(&mut self, target: f64) -> Result<(), RigFault> {
        let proposed = self.guard.propose(&[target], None);
        if matches!(proposed, Err(RigFault::LimitBreached { .. })) {
            self.driven.refused += 1;
        }
        proposed
    }

    /// Carries out what was proposed, settles and reads.
    ///
    /// # Errors
    /// The rig fails, or the reading lies outside a limit.
    pub fn execute(&mut self) -> Result<(), RigFault> {
        self.guard.execute()?;
        self.driven.targets += 1;
        self.read()
    }

    /// Reads anew.
    ///
    /// # Errors
    /// The rig fails, or the reading lies outside a limit.
    pub fn read(&mut self) -> Result<(), RigFault> {
        let reading = self.guard.read()?;
        self.felt = Felt { displacement: reading.displacement[0], force: reading.force[0] };
        self.driven.displacement = self.driven.displacement.max(self.felt.displacement.abs());
        self.driven.force = self.driven.force.max(self.felt.force.abs());
        Ok(())
    }

    /// Forgets what was proposed, stops all motion and keeps the load.
    pub fn hold(&mut self) {
        self.guard.hold();
    }
}
