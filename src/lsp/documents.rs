//! The documents of an editor and the plans of its folders. In: what the editor opens, changes and closes. Out: the text of each file of a
//! plan, the plans that a document belongs to, and their analyses. Files on disk are read by the program.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use gen_lsp_types as lsp;
use psd_language::check::LoadError;
use psd_text::markdown::{Document, is_document};

use crate::Program;
use crate::analysis::Analysis;
use crate::occurrences::used_path;
use crate::text::{Encoding, Text};
use crate::uri::{file_name, normal, path_of, uri_of};

/// A document that is open in the editor.
pub struct Open {
    /// As the editor writes it.
    pub uri: String,
    pub version: i32,
    pub text: Text,
}

/// The open documents by their keys, and the files on disk, at one moment.
#[derive(Clone)]
pub struct Snapshot {
    pub open: Arc<BTreeMap<String, Arc<Open>>>,
    pub program: Arc<dyn Program>,
}

impl Snapshot {
    /// The text of a document: as it is in the editor, else as it is on disk.
    pub fn text(&self, key: &str) -> Option<Arc<str>> {
        match self.open.get(key) {
            Some(open) => Some(open.text.shared()),
            None => Some(self.program.read(&path_of(key)?)?.into()),
        }
    }

    /// A file of a plan, as [`Self::text`]; `file` is relative to the plan's folder.
    pub fn load(&self, plan: &str, file: &str) -> Result<String, LoadError> {
        if let Some(open) = self.open.get(&beside(plan, file)) {
            return Ok(open.text.as_str().to_owned());
        }
        let path = path_of(plan).ok_or(LoadError::NotFound)?;
        self.program.load(&path, file)
    }

    /// The URI of a document in the spelling of the editor.
    pub fn uri(&self, key: &str) -> lsp::Uri {
        let open = self.open.get(key);
        lsp::Uri(open.map_or_else(|| key.to_owned(), |open| open.uri.clone()))
    }
}

/// The key of a file beside a plan.
pub fn beside(plan: &str, file: &str) -> String {
    match path_of(plan) {
        Some(path) => uri_of(&path.parent().unwrap_or(&path).join(file)),
        None => format!("{plan}/{file}"),
    }
}

/// All documents.
pub struct Documents {
    pub now: Snapshot,
    pub encoding: Encoding,
    folders: Vec<PathBuf>,
    /// The files that each file uses.
    uses: BTreeMap<String, Vec<String>>,
    /// Analyses since the last change.
    analyses: RefCell<BTreeMap<String, Rc<Analysis>>>,
}

impl Documents {
    pub fn new(program: Arc<dyn Program>, encoding: Encoding) -> Self {
        let open = Arc::default();
        Self {
            now: Snapshot { open, program },
            encoding,
            folders: Vec::new(),
            uses: BTreeMap::new(),
            analyses: RefCell::default(),
        }
    }

    /// Looks through a folder of the editor.
    pub fn add_folder(&mut self, folder: &Path) {
        for path in self.now.program.plans(folder) {
            self.read_uses(&uri_of(&path));
        }
        self.folders.push(folder.to_owned());
    }

    pub fn remove_folder(&mut self, folder: &Path) {
        self.folders.retain(|own| own != folder);
        let below = |key: &str| path_of(key).is_some_and(|path| path.starts_with(folder));
        self.uses.retain(|key, _| !below(key));
    }

    pub fn open(&mut self, uri: &str, version: i32, text: &str) {
        let key = normal(uri);
        // The plan that uses a file lies in its folder or above.
        if let Some(folder) = path_of(&key).as_deref().and_then(Path::parent)
            && !self.folders.iter().any(|known| folder.starts_with(known))
        {
            self.add_folder(folder);
        }
        self.set(&key, uri, version, text);
    }

    /// Applies changes to an open document.
    pub fn change(
        &mut self,
        uri: &str,
        version: i32,
        changes: Vec<lsp::TextDocumentContentChangeEvent>,
    ) {
        use lsp::TextDocumentContentChangeEvent as Change;
        let key = normal(uri);
        let Some(open) = self.now.open.get(&key).map(Arc::clone) else {
            return;
        };
        let mut text = open.text.clone();
        for change in changes {
            text = match change {
                Change::TextDocumentContentChangeWholeDocument(whole) => {
                    Text::new(whole.text, self.encoding)
                }
                Change::TextDocumentContentChangePartial(part) => {
                    let mut changed = text.as_str().to_owned();
                    changed.replace_range(text.bytes(part.range), &part.text);
                    Text::new(changed, self.encoding)
                }
            };
        }
        self.set(&key, &open.uri, version, text.as_str());
    }

    fn set(&mut self, key: &str, uri: &str, version: i32, text: &str) {
        let open = Open {
            uri: uri.to_owned(),
            version,
            text: Text::new(text, self.encoding),
        };
        Arc::make_mut(&mut self.now.open).insert(key.to_owned(), Arc::new(open));
        self.read_uses(key);
        self.analyses.borrow_mut().clear();
    }

    pub fn close(&mut self, uri: &str) {
        let key = normal(uri);
        Arc::make_mut(&mut self.now.open).remove(&key);
        self.read_uses(&key);
        self.analyses.borrow_mut().clear();
    }

    /// A file changed on disk.
    pub fn changed_on_disk(&mut self, uri: &str) {
        self.read_uses(&normal(uri));
        self.analyses.borrow_mut().clear();
    }

    fn read_uses(&mut self, key: &str) {
        let is_plan = is_document(key)
            || Path::new(key)
                .extension()
                .is_some_and(|ending| ending == "psd")
            || self.now.open.contains_key(key);
        let text = is_plan.then(|| self.now.text(key)).flatten();
        match text {
            Some(text) => self.uses.insert(key.to_owned(), uses(key, &text)),
            None => self.uses.remove(key),
        };
    }

    /// Every plan that uses a document, itself if none does.
    pub fn plans_of(&self, key: &str) -> Vec<String> {
        let mut seen = BTreeSet::from([key]);
        let mut next = vec![key];
        let mut found = BTreeSet::new();
        while let Some(file) = next.pop() {
            let users = self
                .uses
                .iter()
                .filter(|(_, used)| used.iter().any(|one| one == file));
            let users: Vec<&str> = users.map(|(user, _)| user.as_str()).collect();
            if users.is_empty() {
                found.insert(file);
            }
            next.extend(users.into_iter().filter(|user| seen.insert(user)));
        }
        if found.is_empty() {
            found.insert(key);
        }
        // A plan that is open comes first.
        let (mut open, closed): (Vec<&str>, Vec<&str>) = found
            .into_iter()
            .partition(|key| self.now.open.contains_key(*key));
        open.extend(closed);
        open.into_iter().map(str::to_owned).collect()
    }

    /// Every plan of the open documents.
    pub fn open_plans(&self) -> Vec<String> {
        let open = self.now.open.keys();
        let plans: BTreeSet<String> = open.flat_map(|key| self.plans_of(key)).collect();
        plans.into_iter().collect()
    }

    /// Every file that is known.
    pub fn known(&self) -> impl Iterator<Item = &str> {
        self.uses.keys().map(String::as_str)
    }

    /// The analysis of a plan; None if its file cannot be read.
    pub fn analysis(&self, plan: &str) -> Option<Rc<Analysis>> {
        if let Some(known) = self.analyses.borrow().get(plan) {
            return Some(Rc::clone(known));
        }
        let text = self.now.text(plan)?;
        let own = file_name(plan);
        let loader = |file: &str| self.now.load(plan, file);
        let document = |file: &str| {
            if file == own {
                plan.to_owned()
            } else {
                beside(plan, file)
            }
        };
        let analysis = Rc::new(Analysis::of(&own, &text, &loader, &document, self.encoding));
        let mut analyses = self.analyses.borrow_mut();
        analyses.insert(plan.to_owned(), Rc::clone(&analysis));
        Some(analysis)
    }
}

/// The keys of the files that a text uses. The plan need not be valid.
fn uses(key: &str, text: &str) -> Vec<String> {
    let blanked;
    let text = if is_document(key) {
        blanked = Document::read(text).blanked(text);
        &blanked
    } else {
        text
    };
    let written = text.lines().filter_map(|line| {
        let rest = line.trim_start().strip_prefix("use")?.trim_start();
        rest.strip_prefix('"')?.split('"').next()
    });
    written
        .filter_map(|written| used_path("", written))
        .map(|file| beside(key, &file))
        .collect()
}
