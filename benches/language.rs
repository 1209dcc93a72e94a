//! Parse and check throughput: a small plan, and one of 2,000 lines.

use std::fmt::Write as _;

use psd::language::check::{LoadFault, Loader, Options, check};

fn main() {
    divan::main();
}

struct NoFiles;

impl Loader for NoFiles {
    fn load(&self, _: &str) -> Result<String, LoadFault> {
        Err(LoadFault::NotFound)
    }
}

const SMALL: &str = include_str!("../plans/01_first_blow.psd");

/// The small plan with many more blows and requirements, about `lines` long.
fn long_plan(lines: usize) -> String {
    let mut text = SMALL.to_owned();
    for blow in 0..lines / 9 {
        let _ = write!(
            text,
            "\nimpact hit_{blow} {{\n  striker = hammer\n  mass = 1 kg * (1 + 0.5)\n  time_step = critical / 20\n  duration = 1 s\n}}\n\n\
             require \"stays {blow}\" abs(hit_{blow}.max_displacement) < 20 cm\n"
        );
    }
    text
}

#[divan::bench]
fn small_plan() -> bool {
    check(
        "plan.psd",
        divan::black_box(SMALL),
        &NoFiles,
        &Options::default(),
    )
    .plan
    .is_some()
}

#[divan::bench]
fn two_thousand_lines(bencher: divan::Bencher) {
    let text = long_plan(2000);
    bencher
        .counter(divan::counter::BytesCount::new(text.len()))
        .bench(|| {
            check(
                "plan.psd",
                divan::black_box(&text),
                &NoFiles,
                &Options::default(),
            )
            .plan
            .is_some()
        });
}

#[divan::bench]
fn format_two_thousand_lines(bencher: divan::Bencher) {
    let mut sources = psd::text::source::Sources::default();
    let text = long_plan(2000);
    let file = sources.add("plan.psd", text.clone());
    let (ast, _) = psd::language::syntax::parse(&sources, file);
    bencher.bench(|| psd::language::syntax::format(divan::black_box(&ast), &text));
}
