//! A rig that stands there for program after program and remembers its moves, as a real one does. In: targets. Out: the
//! readings of a virtual rig, and what was carried out.

use std::cell::RefCell;
use std::rc::Rc;

use crate::plan::Plan;
use crate::rig::{DeclaredNoise, EachReading, Identity, LastMove, Offer, Reading, Rig, RigFault, Tally, VirtualRig};

/// The same rig for program after program: it remembers its moves, as a real one does. What it mended each program counts.
#[derive(Clone)]
pub(super) struct Standing(pub(super) Rc<RefCell<Stand>>, pub(super) u64);

pub(super) struct Stand {
    pub(super) rig: VirtualRig,
    pub(super) offered: Option<f64>,
    pub(super) last: LastMove,
    /// Every target that was carried out, m.
    pub(super) carried_out: Vec<f64>,
}

impl Standing {
    pub(super) fn new(plan: &Plan) -> Self {
        let last = LastMove { id: 0, target: 0.0 };
        Self(Rc::new(RefCell::new(Stand { rig: VirtualRig::of_plan(plan), offered: None, last, carried_out: Vec::new() })), 0)
    }
}

impl Rig for Standing {
    fn identity(&self) -> Identity {
        self.0.borrow().rig.identity()
    }
    fn degrees_of_freedom(&self) -> usize {
        1
    }
    fn time(&self) -> f64 {
        self.0.borrow().rig.time()
    }
    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<Offer, RigFault> {
        let mut stand = self.0.borrow_mut();
        stand.offered = Some(targets[0]);
        let id = stand.last.id + 1;
        Ok(Offer { move_id: Some(id), ..stand.rig.propose(targets, speed)? })
    }
    fn execute(&mut self) -> Result<(), RigFault> {
        let mut stand = self.0.borrow_mut();
        let target = stand.offered.take().unwrap();
        stand.carried_out.push(target);
        stand.last = LastMove { id: stand.last.id + 1, target };
        stand.rig.execute()
    }
    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        self.0.borrow_mut().rig.pause(seconds)
    }
    fn read(&mut self) -> Result<Reading, RigFault> {
        self.1 += 1;
        self.0.borrow_mut().rig.read()
    }
    fn traverse(&mut self, targets: &[f64], velocity: f64, samples: usize, each: EachReading<'_>) -> Result<(), RigFault> {
        // It cannot keep up: every fifth reading is late.
        let mut due = 0_usize;
        self.0.borrow_mut().rig.traverse(targets, velocity, samples, &mut |reading| {
            due += 1;
            if due.is_multiple_of(5) { Ok(()) } else { each(reading) }
        })
    }
    fn hold(&mut self) {
        self.0.borrow_mut().rig.hold();
    }
    fn declared_noise(&self) -> DeclaredNoise {
        DeclaredNoise::default()
    }
    fn last_move(&self) -> Option<LastMove> {
        Some(self.0.borrow().last)
    }
    fn tally(&self) -> Tally {
        Tally { reread: self.1 / 20, ..Tally::default() }
    }
}
