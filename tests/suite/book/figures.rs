//! The figures of the book. `figures/PLAN-FIGURE.svg` is the figure with that name that the plan draws on its virtual rig.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::source_text::files_in;
use psd::check::{Options, check};
use psd::report::{Provenance, Run, vectors};
use psd::run::{Unwatched, run};
use psd::verdict::assess;
use psd_rig::VirtualRig;

/// The pictures of a plan by their file name.
fn drawn(name: &str) -> BTreeMap<String, Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("plans");
    let text = fs::read_to_string(folder.join(format!("{name}.psd"))).expect("a plan");
    let checked = check(
        &format!("{name}.psd"),
        &text,
        &files_in(&folder),
        &Options::default(),
    );
    let plan = checked.plan.expect("the plan checks");
    let mut rig = VirtualRig::of_plan(&plan);
    let record = run(&plan, &mut rig, &mut Unwatched);
    let files = vectors(&Run {
        plan: &plan,
        record: &record,
        assessment: &assess(&plan, &record),
        provenance: &Provenance {
            run_id: name.to_owned(),
            psd_version: String::new(),
            plan_sha256: String::new(),
            ..Provenance::default()
        },
    });
    let picture = |path: &str| {
        path.strip_prefix("figures/")?
            .strip_suffix(".svg")
            .map(str::to_owned)
    };
    files
        .into_iter()
        .filter_map(|file| Some((picture(&file.path)?, file.bytes)))
        .collect()
}

#[test]
fn every_figure_is_what_its_plan_draws() {
    let mut wanted: BTreeMap<String, Vec<(String, PathBuf)>> = BTreeMap::new();
    for page in super::pages() {
        for target in super::links(&super::text(&page)) {
            let Some((_, figure)) = target.split_once("figures/") else {
                continue;
            };
            let stem = figure.strip_suffix(".svg").expect("a figure is an SVG");
            let (plan, picture) = stem.split_once('-').expect("PLAN-FIGURE.svg");
            let file = super::docs().join("figures").join(figure);
            let pictures = wanted.entry(plan.to_owned()).or_default();
            pictures.push((picture.to_owned(), file));
        }
    }
    assert!(wanted.len() >= 4, "figures of {} plans", wanted.len());
    for (plan, pictures) in wanted {
        let drawn = drawn(&plan);
        for (picture, file) in pictures {
            let svg = drawn
                .get(&picture)
                .unwrap_or_else(|| panic!("{plan} draws {:?}", drawn.keys()));
            if super::accepts_output() {
                fs::write(&file, svg).expect("the figure can be written");
            }
            assert!(
                svg.len() <= 80_000,
                "{}: {} bytes",
                file.display(),
                svg.len()
            );
            assert!(
                fs::read(&file).unwrap_or_default() == *svg,
                "{} is not what the plan draws: cargo xtask generate book",
                file.display()
            );
        }
    }
}
