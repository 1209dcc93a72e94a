//! A run folder as it is on disk: every file by its name, with its digest, and entries that are not allowed there. In: a path. Out:
//! [`Folder`]. It follows no link and does not interpret the files.

use std::collections::BTreeMap;
use std::fs::OpenOptions;
use std::io::Read as _;
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};

use rustix::fs::OFlags;
use sha2::{Digest as _, Sha256};

use crate::files::failure::Failure;
use crate::files::failure::plain;
use crate::files::recorded_run::JOURNAL;
use psd_rig::journal::{LogText, MOST_BYTES, is_part_of_a_reserve};
use psd_text::digest::{hex, sha256};

use super::names::{ISSUE, MANIFEST, PAPER, is_sidecar, is_signature};

/// The largest file of a run folder that is read \[bytes\]: the run log is the largest.
const LISTED_BYTES: u64 = MOST_BYTES;
/// The largest sidecar whose bytes are kept in memory.
const SIDECAR_BYTES: u64 = 64 << 20;

/// Maximum depth of files in a run folder.
const DEEPEST: usize = 64;

/// The files of a run folder, by their names with `/`.
#[derive(Clone, Debug, Default)]
pub struct Folder {
    pub files: BTreeMap<String, Held>,
    /// Entries that are not regular files, with the reason.
    pub odd: Vec<(String, String)>,
}

/// One file.
#[derive(Clone, Debug)]
pub struct Held {
    /// SHA-256, hex.
    pub digest: String,
    pub content: Content,
}

/// What is kept of a file.
#[derive(Clone, Debug)]
pub enum Content {
    /// Only its digest.
    None,
    /// Files that are read: the manifest, the issue, signatures, the PDF report, sidecars.
    Bytes(Vec<u8>),
    RunLog(LogText),
}

impl Held {
    /// A file of these bytes.
    pub fn of(name: &str, bytes: Vec<u8>) -> Self {
        Self {
            digest: sha256(&bytes),
            content: match name {
                JOURNAL => Content::RunLog(bytes.into()),
                _ if is_read(name) => Content::Bytes(bytes),
                _ => Content::None,
            },
        }
    }
}

impl Held {
    /// Its bytes, if it is read.
    pub fn bytes(&self) -> Option<&[u8]> {
        match &self.content {
            Content::Bytes(bytes) => Some(bytes),
            Content::None | Content::RunLog(_) => None,
        }
    }
}

impl Folder {
    /// Reads the whole folder.
    pub fn read(run: &Path) -> Result<Self, Failure> {
        let mut folder = Self::default();
        folder.walk(run, is_read, "", 0)?;
        Ok(folder)
    }

    /// The same with names and digests only.
    pub fn digests(run: &Path) -> Result<Self, Failure> {
        let mut folder = Self::default();
        folder.walk(run, |_| false, "", 0)?;
        Ok(folder)
    }

    /// The bytes of a file that is read; the run log is not.
    pub fn bytes(&self, name: &str) -> Option<&[u8]> {
        self.files.get(name)?.bytes()
    }

    /// The run log.
    pub fn run_log(&self) -> Option<&LogText> {
        match &self.files.get(JOURNAL)?.content {
            Content::RunLog(text) => Some(text),
            Content::None | Content::Bytes(_) => None,
        }
    }

    /// The files that psd keeps in a run folder independently of the results: the run log, its incomplete ends, the results before a
    /// resumption, and the file of issues. Names and digests.
    pub fn kept(&self) -> Vec<(String, String)> {
        let kept = self.files.iter().filter(|(name, _)| is_kept(name));
        kept.map(|(name, held)| (name.clone(), held.digest.clone()))
            .collect()
    }

    /// The files that a manifest lists: all except itself, its signatures, and the reserve file of a run that was killed.
    pub fn listed(&self) -> impl Iterator<Item = (&String, &Held)> {
        self.files
            .iter()
            .filter(|(name, _)| *name != MANIFEST && !is_signature(name) && !is_reserve(name))
    }

    /// Whether the reserve file of a run that was killed contains only the bytes that psd writes there; None if there is no such file.
    pub fn reserve_is_ours(&self) -> Option<bool> {
        let (_, reserve) = self.files.iter().find(|(name, _)| is_reserve(name))?;
        Some(reserve.bytes().is_some_and(is_part_of_a_reserve))
    }

    /// The signatures, by name.
    pub fn signatures(&self) -> impl Iterator<Item = (&str, &[u8])> {
        let named = self.files.iter().filter(|(name, _)| is_signature(name));
        named.map(|(name, held)| (name.as_str(), held.bytes().unwrap_or_default()))
    }

    fn walk(
        &mut self,
        folder: &Path,
        is_read: fn(&str) -> bool,
        prefix: &str,
        depth: usize,
    ) -> Result<(), Failure> {
        let failed = |error: std::io::Error| Failure::file(folder, plain(&error));
        for entry in std::fs::read_dir(folder).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let path = entry.path();
            let Ok(own) = entry.file_name().into_string() else {
                self.odd.push((
                    path.display().to_string(),
                    "has a name that is not text".to_owned(),
                ));
                continue;
            };
            let name = format!("{prefix}{own}");
            let kind = entry.file_type().map_err(failed)?;
            if kind.is_dir() && depth < DEEPEST {
                let before = self.files.len() + self.odd.len();
                self.walk(&path, is_read, &format!("{name}/"), depth + 1)?;
                if self.files.len() + self.odd.len() == before {
                    self.odd.push((name, "is an empty folder".to_owned()));
                }
                continue;
            }
            match held(&path, &name, is_read(&name)) {
                Ok(held) => drop(self.files.insert(name, held)),
                Err(reason) => self.odd.push((name, reason)),
            }
        }
        Ok(())
    }
}

/// Reads one file: a regular one, not through a link.
fn held(path: &PathBuf, name: &str, is_read: bool) -> Result<Held, String> {
    let plain_error = |error: std::io::Error| plain(&error);
    let metadata = path.symlink_metadata().map_err(plain_error)?;
    if metadata.is_symlink() {
        return Err("is a link".to_owned());
    }
    if !metadata.is_file() {
        return Err("is not a file".to_owned());
    }
    if metadata.len() > LISTED_BYTES {
        return Err("is larger than any file of a run".to_owned());
    }
    // An entry that has become a link or a pipe is not followed and not waited for.
    let flags = (OFlags::NOFOLLOW | OFlags::NONBLOCK).bits();
    let file = OpenOptions::new()
        .read(true)
        .custom_flags(flags.cast_signed())
        .open(path)
        .map_err(plain_error)?;
    let mut limited = (&file).take(LISTED_BYTES);
    if is_read && (metadata.len() <= SIDECAR_BYTES || !is_sidecar(name)) {
        let mut bytes = Vec::new();
        limited.read_to_end(&mut bytes).map_err(plain_error)?;
        return Ok(Held::of(name, bytes));
    }
    let mut digest = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        match limited.read(&mut buffer).map_err(plain_error)? {
            0 => break,
            count => digest.update(&buffer[..count]),
        }
    }
    let content = match name {
        JOURNAL => Content::RunLog(LogText::of_file(file).map_err(plain_error)?),
        _ => Content::None,
    };
    Ok(Held {
        digest: hex(&digest.finalize()),
        content,
    })
}

fn is_read(name: &str) -> bool {
    let own = matches!(name, MANIFEST | ISSUE | PAPER) || is_signature(name) || is_reserve(name);
    own || is_sidecar(name)
}

fn is_kept(name: &str) -> bool {
    matches!(name, JOURNAL | ISSUE)
        || is_torn_end(name)
        || name
            .split_once('/')
            .is_some_and(|(folder, _)| is_numbered(folder, "before-resume-"))
}

fn is_torn_end(name: &str) -> bool {
    name.strip_prefix(JOURNAL)
        .is_some_and(|rest| is_numbered(rest, ".torn-"))
}

fn is_numbered(name: &str, prefix: &str) -> bool {
    name.strip_prefix(prefix).is_some_and(|number| {
        !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
    })
}

fn is_reserve(name: &str) -> bool {
    name.strip_prefix(JOURNAL) == Some(".reserve")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_folder_is_odd_also_inside_another() {
        let run = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(run.path().join("tables/more")).unwrap();
        std::fs::create_dir_all(run.path().join("notes")).unwrap();
        std::fs::write(run.path().join("tables/k.csv"), "x").unwrap();
        let mut odd = Folder::read(run.path()).unwrap().odd;
        odd.sort();
        assert_eq!(
            odd,
            ["notes", "tables/more"].map(|name| (name.to_owned(), "is an empty folder".to_owned()))
        );
    }

    #[test]
    fn a_folder_is_its_files_and_a_link_leads_nowhere() {
        let root = tempfile::tempdir().unwrap();
        let run = root.path().join("run");
        std::fs::create_dir_all(run.join("before-resume-1/tables")).unwrap();
        std::fs::write(root.path().join("secret"), "x").unwrap();
        for name in [
            "own",
            JOURNAL,
            "journal.psdj.torn-1",
            "journal.psdj.reserve",
            "before-resume-1/tables/k.csv",
            MANIFEST,
        ] {
            std::fs::write(run.join(name), "abc").unwrap();
        }
        std::os::unix::fs::symlink(root.path().join("secret"), run.join("link")).unwrap();
        let folder = Folder::read(&run).unwrap();
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert!(
            folder.files.len() == 6 && folder.files.values().all(|held| held.digest == abc),
            "{folder:?}"
        );
        assert_eq!(folder.odd, [("link".to_owned(), "is a link".to_owned())]);
        let kept: Vec<String> = folder.kept().into_iter().map(|(name, _)| name).collect();
        assert_eq!(
            kept,
            [
                "before-resume-1/tables/k.csv",
                "journal.psdj",
                "journal.psdj.torn-1"
            ]
        );
        let listed: Vec<&String> = folder.listed().map(|(name, _)| name).collect();
        assert_eq!(
            listed,
            [
                "before-resume-1/tables/k.csv",
                "journal.psdj",
                "journal.psdj.torn-1",
                "own"
            ]
        );
        assert_eq!(folder.reserve_is_ours(), Some(false));
        assert_eq!(
            (folder.bytes(MANIFEST), folder.bytes("own")),
            (Some(b"abc".as_slice()), None)
        );
        assert_eq!(folder.run_log().unwrap().length(), 3);
        let alone = Folder::digests(&run).unwrap();
        assert_eq!((alone.kept(), alone.bytes(MANIFEST)), (folder.kept(), None));
    }
}
