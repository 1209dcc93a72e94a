//! The test report as a PDF: made from the same document as the page, without access to the clock.

use psd_plan::Format;
use rayon::prelude::*;

use super::fixture::finished;
use super::{bytes, files, hostile};

#[test]
fn a_run_has_one_paper_whatever_its_texts_want_to_be() {
    for mut finished in [finished(), hostile()] {
        finished.plan.report.formats = vec![Format::Pdf];
        let (first, second) = (files(&finished), files(&finished));
        let paper = bytes(&first, "report.pdf");
        assert!(paper.starts_with(b"%PDF-1.7") && paper == bytes(&second, "report.pdf"));
    }
}

#[test]
fn another_day_is_another_paper_and_an_impossible_day_is_none() {
    let dated = |date: &str| {
        let mut finished = finished();
        finished.provenance.date = Some(date.into());
        finished.plan.report.figures.clear();
        finished.plan.report.formats = vec![Format::Pdf];
        bytes(&files(&finished), "report.pdf").to_vec()
    };
    let archived = |paper: &[u8]| {
        paper
            .windows(14)
            .any(|window| window == b"pdfaid:part>3<".as_slice())
    };
    assert!(archived(&dated("2026-05-31")) && archived(&dated("2026-06-01T10:00:00Z")));
    assert!(!archived(&dated("2026-02-31")) && !archived(&dated("next week")));
    assert!(dated("2026-05-31") != dated("2026-06-01"));
}

/// A thread of a pool that waits for another pool begins the next report of its own on the same stack. This stack holds three reports, not
/// two hundred.
#[test]
fn reports_that_a_pool_makes_do_not_pile_up_on_its_stack() {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(2)
        .stack_size(1 << 20)
        .build()
        .unwrap();
    let report = |number: usize| {
        let mut finished = finished();
        finished.plan.report.figures.clear();
        finished.plan.report.formats = vec![Format::Csv, Format::Parquet];
        if number.is_multiple_of(50) {
            finished.plan.report.formats.push(Format::Pdf);
        }
        finished.provenance.date = Some(format!("{}-05-31", 2000 + number));
        files(&finished).len()
    };
    let made = pool.install(|| (0..200_usize).into_par_iter().map(report).min());
    assert!(made > Some(2));
}
