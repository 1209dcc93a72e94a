//! The pages of `psd explain`, read from their folder, and the plans that their cases share.

use std::fs;
use std::path::{Path, PathBuf};

use psd::check::Options;
use psd_text::diagnostic::Code;
use psd_text::diagnostic::page::{Page, PagePlan};

/// The folder of the pages in the repository.
pub const FOLDER: &str = "src/text/diagnostic/explain";

/// The file of a page.
pub fn page_path(code: Code) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("{FOLDER}/{code}.md"))
}

/// The page of a code with its cases.
pub fn page_text(code: Code) -> String {
    fs::read_to_string(page_path(code)).unwrap_or_else(|error| panic!("{code}: {error}"))
}

/// The text above the cases of a page.
pub fn shown_text(code: Code) -> String {
    let text = page_text(code);
    Page::read(&text).shown.to_owned()
}

/// The text of the page with the plans that cases share.
pub fn shared_text() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(FOLDER);
    fs::read_to_string(path.join("README.md")).expect("the shared plans are there")
}

/// The command line of a plan: `set="speed=2 m/s"` and `rig="name"` are options, with `unattended="yes"` a run begins without an
/// operator, and with `run="dry"` the plan is also run.
pub fn options_of(plan: &PagePlan<'_>) -> Options {
    let set = plan.option("set").and_then(|set| set.split_once('='));
    Options {
        rig: plan.option("rig").map(str::to_owned),
        settings: set
            .into_iter()
            .map(|(name, value)| (name.to_owned(), value.to_owned()))
            .collect(),
        unattended: plan.option("unattended").is_some(),
        dry_run: plan.option("run").is_some(),
        ..Options::default()
    }
}
