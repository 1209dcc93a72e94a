//! Accepted results that are compared with new ones: tables, the summary, the figures.

use std::fs;
use std::path::Path;

use psd::golden::{Table, Tolerances, Truth, compare};

use super::attack;

/// The name of a file in the results of a plan, and its text.
fn results() -> Vec<(&'static str, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("reports/beam");
    let names = ["summary.json", "figures.json", "tables/hit.csv"];
    names
        .map(|name| {
            (
                name,
                fs::read_to_string(folder.join(name)).expect("accepted results"),
            )
        })
        .into()
}

#[test]
fn accepted_results() {
    let accepted = results();
    let truth = |files: &[(&str, String)]| {
        Truth::of(
            files
                .iter()
                .map(|(name, text)| ((*name).to_owned(), text.clone())),
        )
    };
    let right = truth(&accepted);
    // The first byte of an input is the number of its file.
    let seeds = (0_u8..)
        .zip(&accepted)
        .map(|(number, (_, text))| [&[number], text.as_bytes()].concat());
    attack("accepted results", &seeds.collect::<Vec<_>>(), |bytes| {
        let [number, bytes @ ..] = bytes else { return };
        let mut files = accepted.clone();
        let at = usize::from(*number) % files.len();
        files[at].1 = String::from_utf8_lossy(bytes).into_owned();
        let hostile = truth(&files);
        for (was, is) in [(&right, &hostile), (&hostile, &right)] {
            let found = compare(was, is, &Tolerances::default());
            assert!(found.is_empty() || was != is);
        }
    });
}

#[test]
fn a_table() {
    let (_, table) = results().pop().expect("a table");
    attack(
        "table",
        &[table.into_bytes(), b"a,b\n1,2\n\"x,\"\"y\",3\n".to_vec()],
        |bytes| {
            let table = Table::read(&String::from_utf8_lossy(bytes));
            for name in ["time_s", "a", "b", ""] {
                let numbers = table.numbers(name);
                assert!(numbers.is_none_or(|numbers| numbers.len() <= table.rows()));
            }
        },
    );
}
