//! The page of specimen models: every plan on it runs and passes. Its loop equals the figure beside it, drawn by the program, and every
//! model of the schema has one. `cargo xtask generate specimens` draws the figures again.

use std::fs;
use std::path::{Path, PathBuf};

use super::source_text::files_in;
use psd::check::{Options, check};
use psd::report::{Provenance, Run, vectors};
use psd::run::{Unwatched, run};
use psd::verdict::{Verdict, assess};
use psd_language::syntax::{format, parse};
use psd_plan::FigureKind;
use psd_plan::schema::{BLOCKS, FieldType, Kind};
use psd_rig::VirtualRig;
use psd_text::diagnostic::render::{Appearance, render_all};
use psd_text::source::Sources;

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// Name and text of each plan of the page.
fn plans() -> Vec<(String, String)> {
    let page = fs::read_to_string(docs().join("specimens.md")).expect("the page is there");
    let plans = page
        .split("```psd ")
        .skip(1)
        .filter(|after| !after.starts_with("fragment"));
    let fences = plans.map(|after| {
        let (name, rest) = after.split_once('\n').expect("a fence is a line");
        (
            name.to_owned(),
            rest.split("```").next().unwrap_or_default().to_owned(),
        )
    });
    fences.collect()
}

/// The loop of a plan: its run must pass.
fn drawn(name: &str, text: &str) -> Vec<u8> {
    let checked = check(
        &format!("{name}.psd"),
        text,
        &files_in(&docs()),
        &Options::default(),
    );
    let output = render_all(&checked.diagnostics, &checked.sources, &Appearance::plain());
    let mut plan = checked
        .plan
        .filter(|_| checked.diagnostics.is_empty())
        .unwrap_or_else(|| panic!("{output}"));
    plan.report
        .figures
        .retain(|figure| figure.kind == FigureKind::ForceDisplacement);
    let mut rig = VirtualRig::of_plan(&plan);
    let record = run(&plan, &mut rig, &mut Unwatched);
    let assessment = assess(&plan, &record);
    assert_eq!(
        assessment.verdict,
        Verdict::Pass,
        "{name}: {:?}",
        assessment.requirements
    );
    let provenance = Provenance {
        run_id: name.to_owned(),
        psd_version: String::new(),
        plan_sha256: String::new(),
        ..Provenance::default()
    };
    let files = vectors(&Run {
        plan: &plan,
        record: &record,
        assessment: &assessment,
        provenance: &provenance,
    });
    let is_loop =
        |path: &str| path.starts_with("figures/") && path.ends_with("_force_displacement.svg");
    files
        .into_iter()
        .find(|file| is_loop(&file.path))
        .expect("a cycle has its loop")
        .bytes
}

#[test]
fn every_plan_of_the_page_passes_and_its_loop_is_the_figure() {
    let accepts_output = std::env::var_os("PSD_BLESS").is_some();
    for (name, text) in plans() {
        let mut sources = Sources::default();
        let file = sources.add("specimens.psd", &text);
        assert_eq!(
            format(&parse(&sources, file).0, &text),
            text,
            "psd fmt would change `{name}`"
        );
        let svg = drawn(&name, &text);
        let path = docs().join("specimens").join(format!("{name}.svg"));
        if accepts_output {
            fs::write(&path, &svg).expect("the figure can be written");
        }
        assert!(svg.len() <= 60_000, "{name}: {} bytes", svg.len());
        let kept = fs::read(&path).unwrap_or_default();
        assert!(
            kept == svg,
            "docs/specimens/{name}.svg is not what the plan draws: cargo xtask generate specimens"
        );
    }
}

#[test]
fn every_behaviour_has_its_section_on_the_page() {
    let page = fs::read_to_string(docs().join("specimens.md")).expect("the page is there");
    let specimen = BLOCKS
        .iter()
        .find(|block| block.kind == Kind::Specimen)
        .expect("there is a block for it");
    let FieldType::Choice(behaviours) = specimen.field("behaviour").expect("it has a behaviour").ty
    else {
        panic!("a choice")
    };
    for behaviour in behaviours {
        assert!(
            page.contains(&format!("## `{}`", behaviour.name)),
            "{} has no section",
            behaviour.name
        );
        assert!(
            plans().iter().any(|(name, _)| name == behaviour.name),
            "{} has no plan",
            behaviour.name
        );
        assert!(
            page.contains(&format!("(specimens/{}.svg)", behaviour.name)),
            "{} has no figure",
            behaviour.name
        );
    }
}
