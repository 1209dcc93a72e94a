//! The file of a run log: locks, reserve, modes, torn ends, partial writes.

use std::fs;
use std::io::{self, ErrorKind, Write};
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::path::{Path, PathBuf};

use serde_json::json;
use tempfile::TempDir;

use super::super::{Durability, EntryKind, Journal, Storage};
use super::{FileFault, FileStorage, MOST_BYTES, ballast, write_whole};
use crate::testing::journal::recover;
use psd_plan::record::failpoint::{Guarding, without};

fn new_journal() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("journal");
    (folder, path)
}

fn begun(path: &Path) -> Journal {
    let storage = FileStorage::create(path).unwrap();
    let mut journal = Journal::create(Box::new(storage), Durability::EverySyncPoint);
    journal.append(EntryKind::Header, &json!({})).unwrap();
    journal
}

fn names(folder: &TempDir) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_run_leaves_one_private_file() {
    let (folder, path) = new_journal();
    let mut journal = begun(&path);
    journal.sync_point().unwrap();
    assert_eq!(names(&folder), ["journal", "journal.reserve"]);
    assert_eq!(fs::metadata(ballast::path(&path)).unwrap().len(), 1 << 20);
    for name in names(&folder) {
        assert_eq!(
            fs::metadata(folder.path().join(name))
                .unwrap()
                .permissions()
                .mode()
                & 0o777,
            0o600
        );
    }
    journal.end(&json!({})).unwrap();
    assert_eq!(names(&folder), ["journal"]);
    assert!(recover(&fs::read(&path).unwrap()).unwrap().ended);
}

#[test]
fn the_second_on_one_path_is_refused() {
    let (_folder, path) = new_journal();
    let first = FileStorage::create(&path).unwrap();
    let refused = FileStorage::open_existing(&path).unwrap_err();
    assert_eq!(
        refused.to_string(),
        format!("another psd uses the run log {}", path.display())
    );
    assert!(
        without(Guarding::Lock, || FileStorage::open_existing(&path)).is_ok(),
        "it is the lock that refuses"
    );
    drop(first);
    let second = FileStorage::open_existing(&path).unwrap();
    assert!(matches!(
        FileStorage::open_existing(&path),
        Err(FileFault::InUse { .. })
    ));
    drop(second);
}

#[test]
fn nothing_is_written_over_and_nothing_but_a_file_is_opened() {
    let (folder, path) = new_journal();
    fs::write(&path, "a letter").unwrap();
    assert!(
        matches!(FileStorage::create(&path), Err(FileFault::System { error, .. }) if error.kind() == ErrorKind::AlreadyExists)
    );
    assert_eq!(
        (
            fs::read_to_string(&path).unwrap().as_str(),
            names(&folder).len()
        ),
        ("a letter", 1)
    );

    let link = folder.path().join("link");
    symlink(&path, &link).unwrap();
    assert!(
        matches!(
            FileStorage::open_existing(&link),
            Err(FileFault::System { .. })
        ),
        "not through a link"
    );
    assert!(FileStorage::create(&link).is_err());
    assert!(matches!(
        FileStorage::open_existing(Path::new("/dev/full")),
        Err(FileFault::NotAFile { .. })
    ));
    assert!(FileStorage::open_existing(folder.path()).is_err());
    assert!(FileStorage::open_existing(&folder.path().join("none")).is_err());
}

#[test]
fn a_torn_end_is_put_aside_and_the_journal_goes_on() {
    let (folder, path) = new_journal();
    drop(begun(&path));
    for round in 1..3 {
        let whole = fs::read(&path).unwrap();
        fs::write(&path, [&whole, &b"2 SAMP\0\0"[..]].concat()).unwrap();
        let mut storage = FileStorage::open_existing(&path).unwrap();
        let found = super::super::recover(&storage.text().unwrap()).unwrap();
        assert_eq!(found.whole, whole.len() as u64);
        let aside = storage
            .truncate_to(found.whole)
            .unwrap()
            .expect("something is torn");
        assert_eq!(aside, folder.path().join(format!("journal.torn-{round}")));
        assert_eq!(fs::read(&aside).unwrap(), b"2 SAMP\0\0");
        assert_eq!(contents(&storage), whole);
        assert_eq!(
            storage.truncate_to(found.whole).unwrap(),
            None,
            "nothing more to cut"
        );
        let mut journal = Journal::reopen(Box::new(storage), Durability::EverySyncPoint, &found);
        journal
            .append(EntryKind::Recover, &json!({"aside": "journal.torn"}))
            .unwrap();
    }
    let found = recover(&fs::read(&path).unwrap()).unwrap();
    assert_eq!((found.lines.len(), found.torn), (3, None));
}

#[test]
fn the_reserve_is_there_while_the_journal_is_open_whatever_a_killed_run_left() {
    let (folder, path) = new_journal();
    drop(begun(&path));
    assert_eq!(names(&folder), ["journal"]);
    let reserve = ballast::path(&path);
    for left in [None, Some(10), Some(ballast::RESERVE_BYTES)] {
        if let Some(bytes) = left {
            fs::write(&reserve, vec![1; bytes]).unwrap();
        }
        let mut storage = FileStorage::open_existing(&path).unwrap();
        assert_eq!(fs::metadata(&reserve).unwrap().len(), 1 << 20);
        assert!(FileStorage::open_existing(&path).is_err());
        assert!(
            reserve.exists(),
            "one that is refused does not take it away"
        );
        storage.release_reserve();
        assert_eq!(names(&folder), ["journal"]);
        storage.release_reserve();
    }
}

#[test]
fn a_create_without_room_for_the_reserve_leaves_nothing() {
    let (folder, path) = new_journal();
    // A folder instead of the reserve file; it is not removed as a file would be.
    fs::create_dir(ballast::path(&path)).unwrap();
    assert!(matches!(
        FileStorage::create(&path),
        Err(FileFault::System { .. })
    ));
    assert_eq!(names(&folder), ["journal.reserve"]);
}

#[test]
fn reading_does_not_move_where_it_writes() {
    let (_folder, path) = new_journal();
    let mut storage = FileStorage::create(&path).unwrap();
    storage.append(b"0123456789").unwrap();
    assert_eq!(contents(&storage), b"0123456789");
    storage.append(b"!").unwrap();
    assert_eq!(contents(&storage), b"0123456789!");
    assert!(storage.free_space().unwrap() > 0);
}

#[test]
fn a_file_larger_than_any_run_log_is_refused() {
    let (_folder, path) = new_journal();
    let storage = FileStorage::create(&path).unwrap();
    storage.file.set_len(MOST_BYTES).unwrap();
    assert_eq!(storage.text().unwrap().length(), MOST_BYTES);
    storage.file.set_len(MOST_BYTES + 1).unwrap();
    assert!(matches!(
        storage.text(),
        Err(FileFault::TooLarge {
            most: MOST_BYTES,
            ..
        })
    ));
}

fn contents(storage: &FileStorage) -> Vec<u8> {
    storage
        .text()
        .unwrap()
        .read(0..u64::MAX, <[u8]>::to_vec)
        .unwrap()
}

#[test]
fn a_cut_never_makes_the_file_longer() {
    let (_folder, path) = new_journal();
    let mut storage = FileStorage::create(&path).unwrap();
    storage.append(b"0123456789").unwrap();
    storage.cut(4).unwrap();
    storage.append(b"x").unwrap();
    assert_eq!(contents(&storage), b"0123x");
    assert!(storage.cut(6).is_err(), "zeros are no records");
    assert_eq!(contents(&storage), b"0123x");
}

/// Accepts a few bytes at a time, is interrupted before each part, and accepts none at the end.
struct Reluctant {
    written: Vec<u8>,
    calls: usize,
    most: usize,
}

impl Write for Reluctant {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.calls += 1;
        if !self.calls.is_multiple_of(3) {
            return Err(ErrorKind::Interrupted.into());
        }
        let written = bytes
            .len()
            .min(1 + self.calls % 5)
            .min(self.most - self.written.len());
        self.written.extend_from_slice(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn short_and_interrupted_writes_lose_and_double_nothing() {
    let bytes: Vec<u8> = (0..=255).cycle().take(1000).collect();
    let mut out = Reluctant {
        written: Vec::new(),
        calls: 0,
        most: usize::MAX,
    };
    write_whole(&mut out, &bytes).unwrap();
    assert_eq!(out.written, bytes);
    let mut full = Reluctant {
        written: Vec::new(),
        calls: 0,
        most: 500,
    };
    assert_eq!(
        write_whole(&mut full, &bytes).unwrap_err().kind(),
        ErrorKind::WriteZero
    );
    assert_eq!(full.written, bytes[..500]);
}

#[test]
fn a_run_log_that_another_program_changed_is_not_continued() {
    type Change = fn(&Path);
    let changes: [(Change, &str); 4] = [
        (
            |path| fs::rename(path, path.with_extension("moved")).unwrap(),
            "its file was moved or replaced",
        ),
        (
            |path| {
                let text = fs::read(path).unwrap();
                fs::rename(path, path.with_extension("moved")).unwrap();
                fs::write(path, text).unwrap();
            },
            "its file was moved or replaced",
        ),
        (
            |path| {
                let mut file = fs::OpenOptions::new().append(true).open(path).unwrap();
                file.write_all(b"more").unwrap();
            },
            "another program changed the length of its file",
        ),
        (
            |path| {
                let file = fs::OpenOptions::new().write(true).open(path).unwrap();
                file.set_len(10).unwrap();
            },
            "another program changed the length of its file",
        ),
    ];
    for (change, reason) in changes {
        let goes_on = || {
            let (_folder, path) = new_journal();
            let mut journal = begun(&path);
            journal.sync_point().unwrap();
            change(&path);
            journal.append(EntryKind::Event, &json!({})).unwrap();
            journal.sync_point()
        };
        let fault = goes_on().unwrap_err();
        assert_eq!(
            fault.to_string(),
            format!("the run log cannot be trusted: {reason}")
        );
        assert!(
            without(Guarding::SameFile, goes_on).is_ok(),
            "nothing else sees it"
        );
    }
}
