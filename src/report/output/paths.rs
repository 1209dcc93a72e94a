//! Paths of the files in a run folder, and the files of the plan there. In: names from a plan. Out: relative paths that stay inside the
//! folder and that every file system distinguishes.

use std::collections::BTreeSet;

use super::file::OutputFile;
use psd_plan::{Plan, PlanFile};
use psd_text::sanitize;

/// The texts of the plan and of the files it uses, under their names in the run folder.
pub(in crate::report) fn plan_files(plan: &Plan) -> Vec<OutputFile> {
    let file = |file: &PlanFile| OutputFile {
        path: format!("plan/{}", safe_path(&file.name)),
        bytes: file.bytes(),
    };
    let mut files: Vec<OutputFile> = plan.files.iter().map(file).collect();
    make_unique(files.iter_mut().map(|file| &mut file.path));
    files
}

/// A relative path inside the run folder; each of its parts is a valid name on every system.
fn safe_path(name: &str) -> String {
    let parts = name
        .split(['/', '\\'])
        .filter(|part| !matches!(*part, "" | "." | ".."));
    let parts: Vec<String> = parts.map(sanitize::file_part).collect();
    if parts.is_empty() {
        "plan.psd".to_owned()
    } else {
        parts.join("/")
    }
}

/// Numbers the later of two paths that differ only in upper and lower case: many systems treat them as one file.
pub(in crate::report) fn make_unique<'a>(paths: impl Iterator<Item = &'a mut String>) {
    let mut used = UsedPaths::default();
    paths.for_each(|path| used.make_unique(path));
}

/// The paths so far, in lower case.
#[derive(Default)]
pub(in crate::report) struct UsedPaths(BTreeSet<String>);

impl UsedPaths {
    /// Adds a number to a path that is in use.
    pub fn make_unique(&mut self, path: &mut String) {
        let original = path.clone();
        let (stem, ending) = match original.rsplit_once('.') {
            Some((stem, ending)) if !ending.contains('/') => (stem, format!(".{ending}")),
            _ => (original.as_str(), String::new()),
        };
        let mut number = 1;
        while !self.0.insert(path.to_lowercase()) {
            number += 1;
            *path = format!("{stem}-{number}{ending}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{make_unique, safe_path};

    #[test]
    fn a_path_stays_inside_the_run_folder() {
        assert_eq!(safe_path("lib/frame.psd"), "lib/frame.psd");
        assert_eq!(safe_path("../../etc/passwd"), "etc/passwd");
        assert_eq!(safe_path("C:\\plans\\a\n.psd"), "C_/plans/a_.psd");
        assert_eq!(safe_path(".."), "plan.psd");
    }

    #[test]
    fn paths_that_differ_only_in_case_are_numbered() {
        let mut paths = [
            "tables/hit.csv",
            "tables/Hit.csv",
            "tables/HIT-2.csv",
            "plan/a",
            "plan/A",
        ]
        .map(str::to_owned);
        make_unique(paths.iter_mut());
        assert_eq!(
            paths,
            [
                "tables/hit.csv",
                "tables/Hit-2.csv",
                "tables/HIT-2-2.csv",
                "plan/a",
                "plan/A-2"
            ]
        );
    }
}
