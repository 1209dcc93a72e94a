//! A loss of power at any moment: synced entries are there, or the damage is after them.

use proptest::prelude::*;
use serde_json::json;

use super::super::{Durability, EntryKind};
use super::{begun, records};
use crate::testing::journal::recover;

proptest! {
    #[test]
    fn what_was_promised_survives(
        steps in prop::collection::vec((any::<bool>(), 0..300_usize), 0..30),
        length in 0..10_000_usize,
        kept in prop::collection::vec(any::<bool>(), 32),
    ) {
        let (disk, mut journal) = begun(Durability::EverySyncPoint);
        journal.sync_point().unwrap();
        for (promised, bytes) in steps {
            journal.append(EntryKind::Sample, &json!({"raw": "x".repeat(bytes)})).unwrap();
            if promised {
                journal.sync_point().unwrap();
            }
        }
        let safe = disk.synced();
        let promised = records(&recover(&safe).unwrap());
        let written = records(&recover(&disk.written()).unwrap());
        match recover(&disk.after_loss(length, |sector| kept[sector % kept.len()])) {
            Ok(found) => {
                prop_assert!(found.lines.len() >= promised.len());
                prop_assert_eq!(&records(&found)[..], &written[..found.lines.len()]);
            }
            Err(damage) => prop_assert!(damage.offset >= safe.len() as u64, "{}", damage),
        }
        prop_assert_eq!(records(&recover(&disk.after_loss(0, |_| true)).unwrap()), promised);
    }

    #[test]
    fn a_prefix_of_what_was_written_is_never_damage(bytes in prop::collection::vec(0..300_usize, 0..20), length in 0..5_000_usize) {
        let (disk, mut journal) = begun(Durability::EverySyncPoint);
        for bytes in bytes {
            journal.append(EntryKind::Sample, &json!({"raw": "x".repeat(bytes)})).unwrap();
        }
        prop_assert!(recover(&disk.after_loss(length, |_| true)).is_ok());
    }
}
