//! Writing and reading the run log: a record to memory, to a file, and to a file with sync; reading a run log.

use std::io;

use divan::counter::{BytesCount, ItemsCount};
use psd_rig::journal::{Durability, EntryKind, FileStorage, Journal, LogText, Storage, recover};
use serde::Serialize;

fn main() {
    divan::main();
}

/// A sample whose line has about 160 bytes.
#[derive(Serialize)]
struct Sample {
    step: u64,
    x: f64,
    force: f64,
    text: &'static str,
}

const SAMPLE: Sample = Sample {
    step: 1234,
    x: 0.012_345_678_9,
    force: -1_234.567_891_2,
    text: "settled 3",
};

/// Accepts all bytes and stores none.
struct Nowhere;

impl Storage for Nowhere {
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        divan::black_box(bytes);
        Ok(())
    }

    fn sync(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn cut(&mut self, _: u64) -> io::Result<()> {
        Ok(())
    }
}

fn begun(storage: Box<dyn Storage>, durability: Durability) -> Journal {
    let mut journal = Journal::create(storage, durability);
    journal
        .append(EntryKind::Header, &serde_json::json!({}))
        .expect("the header is taken");
    journal
}

fn append(bencher: divan::Bencher, mut journal: Journal, sync_point: bool) {
    bencher.counter(ItemsCount::new(1_u8)).bench_local(|| {
        journal
            .append(EntryKind::Sample, divan::black_box(&SAMPLE))
            .expect("the record is taken");
        if sync_point {
            journal.sync_point().expect("the record is safe");
        }
    });
}

#[divan::bench(args = [Durability::Buffered, Durability::EverySyncPoint])]
fn append_to_memory(bencher: divan::Bencher, durability: Durability) {
    append(bencher, begun(Box::new(Nowhere), durability), false);
}

#[divan::bench(args = [Durability::Buffered, Durability::EverySyncPoint])]
fn append_to_a_file(bencher: divan::Bencher, durability: Durability) {
    let folder = tempfile::tempdir().expect("a folder");
    let storage = FileStorage::create(&folder.path().join("journal")).expect("a new file");
    append(bencher, begun(Box::new(storage), durability), false);
}

#[divan::bench]
fn append_and_promise_to_a_file(bencher: divan::Bencher) {
    let folder = tempfile::tempdir().expect("a folder");
    let storage = FileStorage::create(&folder.path().join("journal")).expect("a new file");
    append(
        bencher,
        begun(Box::new(storage), Durability::EverySyncPoint),
        true,
    );
}

#[divan::bench]
fn recover_ten_thousand_records(bencher: divan::Bencher) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("journal");
    let mut journal = begun(
        Box::new(FileStorage::create(&path).expect("a new file")),
        Durability::Buffered,
    );
    for _ in 0..10_000 {
        journal
            .append(EntryKind::Sample, &SAMPLE)
            .expect("the record is taken");
    }
    drop(journal);
    let text = LogText::from(std::fs::read(path).expect("the file is there"));
    let whole = |text: &LogText| recover(text).expect("it is whole").lines.len();
    assert_eq!(whole(&text), 10_001);
    bencher
        .counter(BytesCount::new(text.length()))
        .bench(|| whole(divan::black_box(&text)));
}
