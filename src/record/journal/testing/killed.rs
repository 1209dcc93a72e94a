//! A disk whose program is killed. In: the bytes of a run log. Out: those that were written before, and a panic that is not
//! a fault: the code that catches it is the next program.

use std::panic::resume_unwind;

use super::PowerLoss;
use crate::record::journal::Storage;

/// Ends the program at its n-th call, as a kill does: before or after the bytes are there.
pub struct Killed {
    disk: PowerLoss,
    left: usize,
    after: bool,
    dead: bool,
}

impl Killed {
    /// Over `disk`, dead at call number `left`, counted from 0; `after`: its bytes are there, else not.
    pub fn at(disk: &PowerLoss, left: usize, after: bool) -> Self {
        Self {
            disk: disk.clone(),
            left,
            after,
            dead: false,
        }
    }

    fn call(
        &mut self,
        call: impl FnOnce(&mut PowerLoss) -> std::io::Result<()>,
    ) -> std::io::Result<()> {
        // What is dropped on the way out writes nothing more.
        if self.dead {
            return Ok(());
        }
        let last = self.left == 0;
        self.dead = last;
        if !last || self.after {
            call(&mut self.disk)?;
        }
        if last {
            resume_unwind(Box::new("killed"));
        }
        self.left -= 1;
        Ok(())
    }
}

impl Storage for Killed {
    fn append(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.call(|disk| disk.append(bytes))
    }
    fn sync(&mut self) -> std::io::Result<()> {
        self.call(Storage::sync)
    }
    fn cut(&mut self, length: u64) -> std::io::Result<()> {
        self.disk.cut(length)
    }
}
