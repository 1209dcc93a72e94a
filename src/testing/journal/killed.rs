//! A disk whose program is killed. In: the bytes of a run log. Out: the bytes that were written before. The kill is a panic that is not a
//! fault: the code that catches it represents the next program.

use std::panic::resume_unwind;

use super::PowerLoss;
use psd_rig::journal::Storage;

/// Ends the program at its n-th call, as a kill does: before or after the bytes are written.
pub struct Killed {
    disk: PowerLoss,
    left: usize,
    after: bool,
    dead: bool,
}

impl Killed {
    /// Uses `disk`, and kills the program at call number `left`, counted from 0. `after`: the bytes of this call are written, else not.
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
        // A value that is dropped during the unwinding writes nothing more.
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
