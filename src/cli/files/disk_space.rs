//! Disk space for a run, checked before anything moves. In: a plan, and the free space of the file system. Out: nothing, or
//! [`NoRoom`] with both numbers. It deletes nothing.

use std::path::Path;

use crate::cli::output::print_message;
use crate::files::failure::{Failure, NoRoom, amount};
use crate::plan::Plan;
use crate::procedures::storage_bound;
use crate::record::journal::{FileStorage, MOST_BYTES};
use crate::rig::safety::failpoint::{Guarding, on};
use crate::text::diagnostic::excerpt::escape;

/// Asks the disk of a record that is about to be written, of which `written` bytes are there already.
///
/// # Errors
/// Too little space, or the file system does not report it.
pub fn enough(
    folder: &Path,
    storage: &FileStorage,
    plan: &Plan,
    written: u64,
) -> Result<(), Failure> {
    let need = storage_bound::of(plan);
    can_be_read(folder, need.record)?;
    fits(folder, need.bytes.saturating_sub(written), storage.room()?)?;
    if !need.unknown.is_empty() {
        let names: Vec<String> = need.unknown.iter().map(|name| escape(name)).collect();
        print_message(&format!(
            "  not reckoned: the room on the disk that {} may take hangs on what is measured before\n",
            names.join(", ")
        ));
    }
    Ok(())
}

/// A record that is too long to be read back cannot be verified, and its run cannot be resumed.
fn can_be_read(folder: &Path, record: u64) -> Result<(), Failure> {
    if record <= MOST_BYTES {
        return Ok(());
    }
    let (record, most) = (amount(record), amount(MOST_BYTES));
    let told = format!(
        "the record of the run may take {record}, and none of more than {most} is read back; nothing has moved"
    );
    Err(Failure::file(folder, told)
        .help("a shorter `duration` or a longer `time_step` makes it shorter; `psd limits` tells every bound"))
}

fn fits(folder: &Path, need: u64, room: u64) -> Result<(), NoRoom> {
    if need <= room || !on(Guarding::Room) {
        Ok(())
    } else {
        Err(NoRoom {
            folder: folder.to_owned(),
            need,
            room,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::ProcedureKind;
    use crate::record::journal::{Durability, Journal, Storage};
    use crate::rig::safety::failpoint::without;
    use crate::rig::virtual_rig;
    use crate::run::{Unwatched, replay};
    use crate::tests::testing::{elastic_plan, ramp};
    use std::io;

    /// A disk with this many free bytes.
    struct Small(usize);

    impl Storage for Small {
        fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
            self.0 = self
                .0
                .checked_sub(bytes.len())
                .ok_or(io::ErrorKind::StorageFull)?;
            Ok(())
        }

        fn sync(&mut self) -> io::Result<()> {
            Ok(())
        }

        fn cut(&mut self, _: u64) -> io::Result<()> {
            Ok(())
        }
    }

    /// Whether the run completed on such a disk.
    fn ran_on(room: u64) -> Result<bool, NoRoom> {
        let plan = elastic_plan(1e5, vec![ProcedureKind::StiffnessRamp(ramp(1e-4))]);
        fits(
            Path::new("runs/beam-1"),
            storage_bound::of(&plan).bytes,
            room,
        )?;
        let disk = Small(usize::try_from(room).unwrap());
        let mut journal = Journal::create(Box::new(disk), Durability::EveryPromise);
        replay::begin(
            &mut journal,
            &crate::tests::testing::header(),
            &["text".to_owned()],
        )
        .unwrap();
        let recorded = replay::record(
            &plan,
            virtual_rig(&plan).as_mut(),
            &mut Unwatched,
            journal,
            Box::new(|| None),
        );
        Ok(
            recorded.fault.is_none()
                && recorded.record.outcome == crate::record::Outcome::Completed,
        )
    }

    #[test]
    fn a_run_whose_record_would_not_fit_does_not_begin_and_would_end_in_the_middle() {
        assert!(ran_on(1 << 30).unwrap());
        assert!(ran_on(3000).is_err());
        assert!(
            !without(Guarding::Room, || ran_on(3000)).unwrap(),
            "it is the look at the room that refuses"
        );
    }

    #[test]
    fn what_fits_to_the_byte_fits_and_one_less_does_not() {
        let folder = Path::new("runs/beam-1");
        assert_eq!(fits(folder, 1_500_000, 1_500_000), Ok(()));
        let refused = fits(folder, 12_400_000, 9_960_000).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "runs/beam-1: the run may write 12 MB, and its disk has 10 MB left; nothing has moved"
        );
        assert!(
            refused.help().starts_with("free 2.4 MB, or name a folder"),
            "{}",
            refused.help()
        );
        assert!(fits(folder, 1, 0).is_err());
        assert!(can_be_read(folder, MOST_BYTES).is_ok());
        let refused = can_be_read(folder, MOST_BYTES + 1).unwrap_err().to_string();
        assert!(
            refused.contains("may take 4.3 GB, and none of more than 4.3 GB is read back"),
            "{refused}"
        );
        assert_eq!(
            (amount(999), amount(999_600), amount(5_000_000_000_000)),
            ("1.0 kB".into(), "1.0 MB".into(), "5.0 TB".into())
        );
    }
}
