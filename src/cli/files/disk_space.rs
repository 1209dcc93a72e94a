//! The least free space of a disk before anything moves. In: the run folder and its free space. Out: nothing, or a
//! [`DiskSpaceFault`] with both amounts. It frees nothing.

use std::path::Path;

use crate::files::failure::{DiskSpaceFault, LEAST_FREE_BYTES};
use psd_rig::safety::failpoint::{Guarding, on};

/// Compares the free space of a disk \[bytes\] with [`LEAST_FREE_BYTES`].
///
/// # Errors
/// If `free` is less.
pub fn compare(folder: &Path, free: u64) -> Result<(), DiskSpaceFault> {
    if free >= LEAST_FREE_BYTES || !on(Guarding::DiskSpace) {
        Ok(())
    } else {
        Err(DiskSpaceFault {
            folder: folder.to_owned(),
            free,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::PlanSettings;
    use crate::files::failure::amount;
    use crate::files::{provenance, record_file};
    use psd::run::{Unwatched, replay};
    use psd_plan::ProcedureKind;
    use psd_rig::journal::{Durability, Journal, Storage};
    use psd_rig::safety::failpoint::without;
    use psd_rig::virtual_rig;
    use psd_testing::plans::{elastic_plan, ramp};
    use std::io;

    /// A disk with this free space \[bytes\].
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

    /// Whether the run was completed on such a disk, if it began.
    fn ran_on(free: u64) -> Result<bool, DiskSpaceFault> {
        let plan = elastic_plan(1e5, vec![ProcedureKind::StiffnessRamp(ramp(1e-4))]);
        compare(Path::new("runs/beam-1"), free)?;
        let disk = Small(usize::try_from(free).unwrap());
        let mut journal = Journal::create(Box::new(disk), Durability::EverySyncPoint);
        let mut rig = virtual_rig(&plan);
        let header = record_file::header(
            &plan,
            record_file::device(&*rig),
            &PlanSettings::default(),
            &provenance::of_this_run(&plan, None),
            record_file::Circumstances::default(),
        );
        replay::begin(&mut journal, &header, &["text".to_owned()]).unwrap();
        let recorded = replay::record(&plan, &mut *rig, &mut Unwatched, journal, Box::new(|| None));
        Ok(recorded.fault.is_none()
            && recorded.record.outcome == psd_plan::record::Outcome::Completed)
    }

    #[test]
    fn a_run_on_a_disk_that_is_nearly_full_does_not_begin_and_would_end_in_the_middle() {
        assert!(ran_on(1 << 30).unwrap());
        assert!(ran_on(3000).is_err());
        assert!(
            !without(Guarding::DiskSpace, || ran_on(3000)).unwrap(),
            "only the check of the free space refuses"
        );
    }

    #[test]
    fn a_disk_with_the_least_free_space_is_accepted_and_one_byte_less_is_not() {
        let folder = Path::new("runs/beam-1");
        assert_eq!(compare(folder, LEAST_FREE_BYTES), Ok(()));
        assert!(compare(folder, LEAST_FREE_BYTES - 1).is_err());
        let refused = compare(folder, 9_960_000).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "runs/beam-1: its disk has 10 MB of free space (a run requires at least 200 MB); nothing has moved"
        );
        assert!(
            refused.help().starts_with("free 190 MB, or name a folder"),
            "{}",
            refused.help()
        );
        assert_eq!(
            (amount(999), amount(999_600), amount(5_000_000_000_000)),
            ("1.0 kB".into(), "1.0 MB".into(), "5.0 TB".into())
        );
    }
}
