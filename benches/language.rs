//! Parse and check throughput: a small plan, and one of 2,000 lines.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use psd::check::{Options, ParsedPlan, check, no_files};
use psd_text::units::{Dimension, Quantity};

fn main() {
    divan::main();
}

/// A plan with parameters.
const CANTILEVER: &str = include_str!("../plans/02_units_and_parameters.psd");

const SMALL: &str = include_str!("../plans/01_first_blow.psd");

/// The small plan with many more impacts and requirements, about `lines` lines long.
fn long_plan(lines: usize) -> String {
    let mut text = SMALL.to_owned();
    for index in 0..lines / 9 {
        let _ = write!(
            text,
            "\nimpact hit_{index} {{\n  striker = hammer\n  mass = 1 kg * (1 + 0.5)\n  time_step = critical / 20\n  duration = 1 s\n}}\n\n\
             require \"stays {index}\" abs(hit_{index}.max_displacement) < 20 cm\n"
        );
    }
    text
}

#[divan::bench]
fn small_plan() -> bool {
    check(
        "plan.psd",
        divan::black_box(SMALL),
        &no_files,
        &Options::default(),
    )
    .plan
    .is_some()
}

/// Ten times the lines take ten times the time.
#[divan::bench(args = [2000, 20_000], sample_count = 10)]
fn many_lines(bencher: divan::Bencher, lines: usize) {
    let text = long_plan(lines);
    bencher
        .counter(divan::counter::BytesCount::new(text.len()))
        .bench(|| {
            check(
                "plan.psd",
                divan::black_box(&text),
                &no_files,
                &Options::default(),
            )
            .plan
            .is_some()
        });
}

#[divan::bench]
fn format_two_thousand_lines(bencher: divan::Bencher) {
    let mut sources = psd_text::source::Sources::default();
    let text = long_plan(2000);
    let file = sources.add("plan.psd", text.clone());
    let (ast, _) = psd_language::syntax::parse(&sources, file);
    bencher.bench(|| psd_language::syntax::format(divan::black_box(&ast), &text));
}

/// The work of a study for each of its runs: other values of the parameters, without parsing.
#[divan::bench]
fn bind_parameters_of_a_small_plan(bencher: divan::Bencher) {
    let mut parsed = ParsedPlan::parse("plan.psd", CANTILEVER, &no_files, &Options::default());
    assert!(parsed.check(&no_files).plan.is_some());
    let drop = Quantity::new(0.08, Dimension::LENGTH);
    let values = BTreeMap::from([("drop".to_owned(), drop)]);
    bencher.bench(|| parsed.bind(divan::black_box(&values)).is_ok());
}

/// The same plan from its text, with the value as given by `--set`.
#[divan::bench]
fn check_the_same_plan_from_its_text(bencher: divan::Bencher) {
    let options = Options {
        settings: vec![("drop".to_owned(), "80 mm".to_owned())],
        ..Options::default()
    };
    bencher.bench(|| {
        check(
            "plan.psd",
            divan::black_box(CANTILEVER),
            &no_files,
            &options,
        )
        .plan
        .is_some()
    });
}
