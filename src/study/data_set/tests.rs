//! Tests of data sets: bits that come back, equal bytes for equal rows, and files that are cut, changed or foreign.

use std::path::{Path, PathBuf};

use crate::report::parquet::{Encoding, ParquetFile, read_metadata, row_group};
use polars::prelude::{Column as FrameColumn, DataFrame};
use tempfile::TempDir;

use super::testing::{metadata, row};
use super::*;

/// A little more than two row groups, from the middle of one on.
const FIRST: u64 = GROUP_RUNS - 1000;
const RUNS: u64 = GROUP_RUNS + 1500;

fn written(path: &Path, first: u64, runs: u64) -> Metadata {
    let mut writer = Writer::create(path, &metadata(first)).unwrap();
    for run in first..first + runs {
        writer.push(&row(run)).unwrap();
    }
    writer.finish().unwrap()
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn small(folder: &TempDir) -> PathBuf {
    let path = folder.path().join("small.parquet");
    written(&path, 5, 200);
    path
}

/// Bits of every number: 0 and −0 are not the same.
fn bits(row: &StudyRow) -> Vec<Option<u64>> {
    let inputs = row.inputs.iter().map(|value| Some(value.to_bits()));
    inputs
        .chain(row.results.iter().map(|value| value.map(f64::to_bits)))
        .collect()
}

fn fault(path: &Path) -> String {
    let opened =
        Reader::open(path).and_then(|reader| reader.rows().collect::<Result<Vec<StudyRow>, _>>());
    opened.unwrap_err().to_string()
}

#[test]
fn rows_come_back_bit_for_bit_across_row_groups() {
    let folder = folder();
    let path = folder.path().join("runs.parquet");
    let end = written(&path, FIRST, RUNS).end;
    assert!(!folder.path().join("runs.parquet.part").exists());
    let reader = Reader::open(&path).unwrap();
    let expected = Metadata {
        end,
        ..metadata(FIRST)
    };
    assert_eq!((reader.metadata(), end), (&expected, FIRST + RUNS));
    // Row groups end at multiples of absolute run numbers.
    let ends: Vec<u64> = reader.blocks().map(|block| block.unwrap().end()).collect();
    assert_eq!(ends, [GROUP_RUNS, 2 * GROUP_RUNS, FIRST + RUNS]);
    let mut run = FIRST;
    for read in reader.rows() {
        let (read, expected) = (read.unwrap(), row(run));
        assert_eq!(read, expected);
        assert_eq!(bits(&read), bits(&expected));
        run += 1;
    }
    assert_eq!(run, FIRST + RUNS);
}

/// Written as a whole, or read and written again from two files: the bytes are the same.
#[test]
fn equal_rows_give_equal_bytes() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    written(&path("whole"), 0, RUNS);
    written(&path("first"), 0, 70_001);
    written(&path("second"), 70_001, RUNS - 70_001);
    let mut merged = Writer::create(&path("merged"), &metadata(0)).unwrap();
    for part in ["first", "second"] {
        let part = Reader::open(&path(part)).unwrap();
        assert!(part.metadata().belongs_to(&metadata(3)));
        part.rows()
            .for_each(|row| merged.push(&row.unwrap()).unwrap());
    }
    merged.finish().unwrap();
    let bytes = |name: &str| std::fs::read(path(name)).unwrap();
    assert!(bytes("whole") == bytes("merged"));
}

#[test]
fn rows_that_do_not_belong_are_refused() {
    let folder = folder();
    let mut writer = Writer::create(&folder.path().join("a"), &metadata(7)).unwrap();
    let mut refused = |row: StudyRow| writer.push(&row).unwrap_err().reason;
    assert_eq!(refused(row(8)), "run 7 is next, not run 8");
    let narrow = StudyRow {
        inputs: vec![1.0],
        ..row(7)
    };
    assert!(refused(narrow).contains("[1, 2, 2]"));
    let infinite = StudyRow {
        results: vec![Some(f64::NAN), None],
        ..row(7)
    };
    assert_eq!(refused(infinite), "run 7 has the value NaN");
    let mut twice = metadata(0);
    twice.inputs[1] = twice.inputs[0].clone();
    assert!(Writer::create(&folder.path().join("b"), &twice).is_err());
}

/// Two files of another plan, seed or build do not belong together; those of other runs do.
#[test]
fn files_of_one_study_differ_in_their_runs_alone() {
    let other = Metadata {
        seed: 2,
        ..metadata(0)
    };
    assert!(metadata(0).belongs_to(&metadata(10)) && !metadata(0).belongs_to(&other));
}

#[test]
fn a_study_without_runs_is_an_empty_data_set() {
    let folder = folder();
    let path = folder.path().join("none");
    assert_eq!(written(&path, 4, 0).runs(), 0);
    assert_eq!(Reader::open(&path).unwrap().rows().count(), 0);
}

/// Cut anywhere, a file has no footer; nothing of it is taken for a shorter study.
#[test]
fn a_cut_file_is_incomplete() {
    let folder = folder();
    let path = small(&folder);
    let bytes = std::fs::read(&path).unwrap();
    for length in [
        0,
        3,
        11,
        12,
        bytes.len() / 2,
        bytes.len() - 9,
        bytes.len() - 1,
    ] {
        let cut = folder.path().join("cut");
        std::fs::write(&cut, &bytes[..length]).unwrap();
        let fault = fault(&cut);
        assert!(fault.contains("is incomplete"), "{length}: {fault}");
    }
}

/// One changed bit among the rows is found with the runs that it concerns.
#[test]
fn a_changed_byte_is_found_with_its_runs() {
    let folder = folder();
    let path = small(&folder);
    let bytes = std::fs::read(&path).unwrap();
    for at in [0, 4, 100, 700] {
        let mut changed = bytes.clone();
        changed[at] ^= 4;
        std::fs::write(&path, &changed).unwrap();
        let fault = fault(&path);
        assert!(fault.contains("runs 5 to 204: damaged"), "{at}: {fault}");
    }
}

/// A changed byte of the footer is found before the footer is parsed; one of the tail, or of its digest, as well.
#[test]
fn a_changed_footer_is_found() {
    let folder = folder();
    let path = small(&folder);
    let bytes = std::fs::read(&path).unwrap();
    let tail = bytes.len() - 8;
    let length = u32::from_le_bytes(bytes[tail..tail + 4].try_into().unwrap());
    let footer = tail - usize::try_from(length).unwrap();
    for at in (footer - 40..bytes.len()).step_by(3) {
        let mut changed = bytes.clone();
        changed[at] ^= 1;
        std::fs::write(&path, &changed).unwrap();
        let fault = fault(&path);
        let found = ["damaged footer", "is incomplete", "not a data set"];
        assert!(
            found.iter().any(|part| fault.contains(part)),
            "{at}: {fault}"
        );
    }
}

/// The digest lies before the footer, where no reader of Parquet looks.
#[test]
fn other_programs_read_a_data_set() {
    let folder = folder();
    let bytes = std::fs::read(small(&folder)).unwrap();
    let footer = read_metadata(&mut std::io::Cursor::new(&bytes)).unwrap();
    let frame = row_group(&bytes, 0, &footer, 0).unwrap();
    assert_eq!((frame.height(), frame.width()), (200, 8));
}

#[test]
fn a_file_of_another_program_is_foreign() {
    let folder = folder();
    let path = folder.path().join("foreign.parquet");
    let numbers = FrameColumn::new("run".into(), [1_u64, 2]);
    let frame = DataFrame::new(2, vec![numbers]).unwrap();
    let file = std::fs::File::create(&path).unwrap();
    let mut file = ParquetFile::new(file, &frame, vec![Encoding::Plain]).unwrap();
    file.write(&frame).unwrap();
    file.finish(&[]).unwrap();
    assert!(fault(&path).ends_with("is a Parquet file, but not a data set of a study"));
    std::fs::write(&path, "run,speed\n0,1.0\n1,2.0\n").unwrap();
    assert!(fault(&path).contains("not a Parquet file"));
    assert!(fault(&folder.path().join("none")).contains("No such file"));
}
