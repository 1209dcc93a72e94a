//! Dependencies between files of `src`, read from their paths: `use` trees and paths in the code, through re-exports to the defining
//! file. Tests beside the code are left out. This module contains no rule.

use std::collections::{BTreeMap, BTreeSet};

use super::source_text::SourceText;

/// Names of modules from the root of the crate, or of a path in the code.
type Path = Vec<String>;

/// The files of `src` that make up the product, by module, with the files that each uses.
pub struct ImportGraph {
    files: BTreeMap<Path, Module>,
    /// The modules whose file is a `lib.rs` or `main.rs`: every crate that lies in `src`.
    crate_roots: BTreeSet<Path>,
}

struct Module {
    /// Relative to `src`.
    file: String,
    /// Every path in the file, as written there.
    paths: BTreeSet<Path>,
    /// `use` of a module or a name: its local name, and its full path.
    imported: BTreeMap<String, Path>,
    /// The same for every `pub use`, which re-exports the name.
    given_on: BTreeMap<String, Path>,
    /// The modules whose names it all re-exports: `pub use names::*`.
    given_on_whole: Vec<Path>,
}

impl ImportGraph {
    /// The graph of these files, without test files.
    pub fn of(files: &[SourceText]) -> Self {
        let product = files.iter().filter(|file| !is_of_tests(&file.path));
        let modules = product.map(|file| (module_of(&file.path), read(file)));
        let roots = files.iter().filter(|file| is_crate_root(&file.path));
        Self {
            files: modules.collect(),
            crate_roots: roots.map(|file| module_of(&file.path)).collect(),
        }
    }

    /// Each file with the files it uses, without itself.
    pub fn uses(&self) -> BTreeMap<&str, BTreeSet<&str>> {
        let used = |(path, module): (&Path, &Module)| {
            let targets = module
                .paths
                .iter()
                .filter_map(|used| self.target(path, used));
            let targets = targets.filter(|target| target.file != module.file);
            targets.map(|target| target.file.as_str()).collect()
        };
        self.files
            .iter()
            .map(|each| (each.1.file.as_str(), used(each)))
            .collect()
    }

    /// The file that defines `written` in the module `here`; None for other crates and local names.
    fn target(&self, here: &[String], written: &[String]) -> Option<&Module> {
        let mut path = self.absolute(here, written)?;
        // A chain of re-exports is short; a circular glob would be endless.
        for _ in 0..8 {
            let depth = (0..=path.len())
                .rev()
                .find(|depth| self.files.contains_key(&path[..*depth]))?;
            let module = &self.files[&path[..depth]];
            let name = path.get(depth)?;
            let own = module
                .given_on
                .get(name)
                .map(|meant| (path[..depth].to_vec(), meant));
            let Some((from, meant)) = own.or_else(|| self.in_a_glob(&path[..depth], name)) else {
                return Some(module);
            };
            let Some(mut next) = self.absolute(&from, meant) else {
                return Some(module);
            };
            next.extend_from_slice(&path[depth + 1..]);
            path = next;
        }
        None
    }

    /// The name in one of the modules that the module `here` re-exports whole: the module of the file, and what the name means there.
    fn in_a_glob(&self, here: &[String], name: &str) -> Option<(Path, &Path)> {
        let mut globs = self.files.get(here)?.given_on_whole.iter();
        globs.find_map(|glob| {
            let mut from = self.absolute(here, glob)?;
            // A module inside of a file.
            while !self.files.contains_key(&from) {
                from.pop()?;
            }
            let meant = self.files[&from].given_on.get(name)?;
            Some((from, meant))
        })
    }

    /// What `crate` means in the module `here`: the root of its own crate.
    fn crate_root(&self, here: &[String]) -> Path {
        let depths = (0..=here.len()).rev();
        let mut around = depths.map(|depth| here[..depth].to_vec());
        around
            .find(|module| self.crate_roots.contains(module))
            .unwrap_or_default()
    }

    /// The same path from the folder `src`.
    fn absolute(&self, here: &[String], written: &[String]) -> Option<Path> {
        let (first, rest) = written.split_first()?;
        let mut from = here.to_vec();
        match first.as_str() {
            "crate" => from = self.crate_root(here),
            "self" => {}
            "super" => {
                from.pop()?;
                return match rest.first().map(String::as_str) {
                    Some("super") => self.absolute(&from, rest),
                    _ => Some([from, rest.to_vec()].concat()),
                };
            }
            child => {
                from.push(child.to_owned());
                if !self.files.contains_key(&from) {
                    let meant = self.files.get(here)?.imported.get(child)?;
                    let inside = ["crate", "self", "super"].contains(&meant[0].as_str());
                    from = inside.then(|| self.absolute(here, meant)).flatten()?;
                }
            }
        }
        from.extend_from_slice(rest);
        Some(from)
    }
}

/// Dependency cycles, each with more than one file. A `mod.rs`, `lib.rs` or `main.rs` and the files of its own folder count as one unit: its uses
/// of them are not counted.
pub fn cycles<'a>(uses: &BTreeMap<&'a str, BTreeSet<&'a str>>) -> Vec<BTreeSet<&'a str>> {
    let outside = |file: &'a str, used: &BTreeSet<&'a str>| {
        let folder = ["mod.rs", "lib.rs", "main.rs"]
            .iter()
            .find_map(|name| file.strip_suffix(name));
        let folder = folder.map(str::to_owned);
        let folder = folder.unwrap_or_else(|| file.replace(".rs", "/"));
        used.iter()
            .copied()
            .filter(|used| !used.starts_with(&folder))
            .collect()
    };
    let uses: BTreeMap<&str, BTreeSet<&str>> = uses
        .iter()
        .map(|(file, used)| (*file, outside(file, used)))
        .collect();
    let reached: BTreeMap<&str, BTreeSet<&str>> = uses
        .keys()
        .map(|file| (*file, reachable(file, &uses)))
        .collect();
    let mut found: BTreeSet<BTreeSet<&str>> = BTreeSet::new();
    for (file, far) in reached.iter().filter(|(file, far)| far.contains(*file)) {
        let back = |other: &&&str| reached[**other].contains(file);
        found.insert(far.iter().filter(back).copied().collect());
    }
    found.into_iter().collect()
}

/// Every file that can be reached from one; this includes the file itself in a dependency cycle.
fn reachable<'a>(file: &str, uses: &BTreeMap<&'a str, BTreeSet<&'a str>>) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<&str> = uses[file].iter().copied().collect();
    while let Some(next) = open.pop() {
        if reached.insert(next) {
            open.extend(&uses[next]);
        }
    }
    reached
}

/// Whether a file is built for tests only.
pub fn is_of_tests(path: &str) -> bool {
    path.trim_end_matches(".rs")
        .split('/')
        .any(|part| part == "tests" || part == "testing" || part.ends_with("_tests"))
}

fn is_crate_root(path: &str) -> bool {
    matches!(path.rsplit('/').next(), Some("lib.rs" | "main.rs"))
}

/// `run/mod.rs` is `run`, `lib.rs` the root and `physics/lib.rs` is `physics`.
fn module_of(path: &str) -> Path {
    let path = path.trim_end_matches(".rs");
    let parts = path
        .split('/')
        .filter(|part| !["mod", "lib", "main"].contains(part));
    parts.map(str::to_owned).collect()
}

fn read(file: &SourceText) -> Module {
    let code = without_comments_and_tests(&file.text);
    let mut module = Module {
        file: file.path.clone(),
        paths: BTreeSet::new(),
        imported: BTreeMap::new(),
        given_on: BTreeMap::new(),
        given_on_whole: Vec::new(),
    };
    let mut rest = String::new();
    for statement in code.split_inclusive(';') {
        let Some((before, tree)) = use_tree(statement) else {
            rest.push_str(statement);
            continue;
        };
        rest.push_str(before);
        let given_on = before.trim_end().ends_with("pub") || before.trim_end().ends_with(')');
        for (path, name) in leaves(tree) {
            if given_on && tree.trim_end().ends_with("::*") {
                module.given_on_whole.push(path.clone());
            } else if given_on {
                module.given_on.insert(name.clone(), path.clone());
            } else {
                module.paths.insert(path.clone());
            }
            module.imported.insert(name, path);
        }
    }
    module.paths.extend(written_paths(&rest));
    // Re-exported names may also be used here.
    let own = names_in(&rest);
    let used = module
        .given_on
        .iter()
        .filter(|(name, _)| own.contains(name.as_str()));
    module.paths.extend(used.map(|(_, path)| path.clone()));
    module
}

/// The code of a file that the product is built from.
pub fn without_comments_and_tests(text: &str) -> String {
    let end = ["\n#[cfg(test)]\nmod ", "\n#[cfg(test)]\npub mod "]
        .iter()
        .filter_map(|head| {
            let at = text.find(head)?;
            let line = text[at + head.len()..].lines().next()?;
            line.ends_with('{').then_some(at)
        })
        .min();
    text[..end.unwrap_or(text.len())]
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

/// The text before a `use` in a statement, and its tree.
fn use_tree(statement: &str) -> Option<(&str, &str)> {
    let at = statement
        .match_indices("use ")
        .map(|(at, _)| at)
        .find(|at| statement[..*at].ends_with([' ', '\n']) || *at == 0)?;
    let tree = statement[at + "use ".len()..].strip_suffix(';')?;
    Some((&statement[..at], tree))
}

/// Every path of a `use` tree, with its local name.
fn leaves(tree: &str) -> Vec<(Path, String)> {
    let tree = tree.trim();
    if let Some((head, group)) = tree.split_once('{') {
        let group = group.rsplit_once('}').map_or(group, |(group, _)| group);
        let head: Path = names(head);
        let inner = at_top_level(group).into_iter().flat_map(leaves);
        return inner
            .map(|(path, name)| {
                let path = path.into_iter().filter(|part| part != "self");
                let name = match head.last() {
                    Some(module) if name == "self" => module.clone(),
                    _ => name,
                };
                ([head.clone(), path.collect()].concat(), name)
            })
            .collect();
    }
    let (path, renamed) = tree
        .split_once(" as ")
        .map_or((tree, None), |(path, name)| {
            (path, Some(name.trim().to_owned()))
        });
    let path = names(path);
    let last = path.last().cloned();
    let name = renamed.or(last);
    name.map(|name| (path, name)).into_iter().collect()
}

/// The parts of a group, separated at its top-level commas.
fn at_top_level(group: &str) -> Vec<&str> {
    let (mut depth, mut start, mut parts) = (0, 0, Vec::new());
    for (at, letter) in group.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&group[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&group[start..]);
    parts.retain(|part| !part.trim().is_empty());
    parts
}

fn names(path: &str) -> Path {
    let parts = path.split("::").map(str::trim);
    parts
        .filter(|part| !part.is_empty() && *part != "*")
        .map(str::to_owned)
        .collect()
}

fn names_in(code: &str) -> BTreeSet<&str> {
    code.split(|letter: char| !letter.is_alphanumeric() && letter != '_')
        .collect()
}

/// Every path of at least two names in the code.
fn written_paths(code: &str) -> BTreeSet<Path> {
    let part_of_path = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ':';
    code.split(|letter| !part_of_path(letter))
        .filter(|word| word.contains("::"))
        .map(names)
        .collect()
}
