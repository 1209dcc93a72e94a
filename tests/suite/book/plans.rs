//! The plans of the book. The words after a fence describe its block. `psd` alone marks a whole plan, `psd plans/NAME.psd` an excerpt of
//! that file. `psd E301` marks a plan with that error, `psd fragment` a part that is not checked. Any other word names a whole plan; the
//! console blocks find it under a file name: `psd rod.psd`.

use std::fs;
use std::path::Path;

use crate::source_text::files_in;
use psd::check::{Options, check};
use psd_text::diagnostic::render::{Appearance, render_all};

/// The rig to select for a plan that has only real rigs.
fn real_rig(plan: &str) -> Option<String> {
    let real = plan.contains("serial(") || plan.contains("tcp(");
    let name = plan.split("\nrig ").nth(1)?.split_whitespace().next()?;
    (real && !plan.contains("virtual(") && !plan.contains("behaviour")).then(|| name.to_owned())
}

fn codes(page: &Path, plan: &str) -> (Vec<String>, String) {
    let folder = super::docs()
        .join(page)
        .parent()
        .expect("a folder")
        .to_owned();
    // The files beside the page; a ground motion is always there.
    let files = files_in(&folder);
    let ground = "time_s,acceleration_m_per_s2\n0,0\n0.1,1\n0.2,0\n";
    let beside = |path: &str| match files(path) {
        Err(_) if path == "ground.csv" => Ok(ground.to_owned()),
        found => found,
    };
    let options = Options {
        rig: real_rig(plan),
        ..Options::default()
    };
    let checked = check("plan.psd", plan, &beside, &options);
    let output = render_all(&checked.diagnostics, &checked.sources, &Appearance::plain());
    let codes = checked
        .diagnostics
        .iter()
        .map(|diagnostic| diagnostic.code.to_string())
        .collect();
    (codes, output)
}

#[test]
fn every_plan_checks_or_has_the_errors_beside_it() {
    let mut whole = 0;
    for page in super::pages() {
        for block in super::blocks(&super::text(&page)) {
            let Some(words) = block.info.strip_prefix("psd") else {
                continue;
            };
            let words = words.trim();
            let is_code = |word: &str| {
                word.starts_with(['E', 'W'])
                    && word[1..].chars().all(|digit| digit.is_ascii_digit())
            };
            if words == "fragment" || block.body.starts_with("rig ") {
                continue;
            }
            if words.starts_with("plans/") {
                let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(words);
                let plan = fs::read_to_string(file).expect("a plan of the repository");
                assert!(
                    plan.contains(&block.body),
                    "{}: {words} has no such lines:\n{}",
                    page.display(),
                    block.body
                );
                continue;
            }
            let wanted: Vec<&str> = words
                .split_whitespace()
                .filter(|word| is_code(word))
                .collect();
            let (codes, output) = codes(&page, &block.body);
            assert_eq!(
                codes,
                wanted,
                "{}:\n{}\n{output}",
                page.display(),
                block.body
            );
            whole += 1;
        }
    }
    assert!(whole >= 25, "{whole} whole plans");
}
