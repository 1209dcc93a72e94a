//! The torn end of a run log, put aside before it is cut off: no byte is discarded. In: the run log and its number of whole
//! bytes. Out: the path of the copy. It knows no entry.

use std::fs::File;
use std::io::{self, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use super::{beside, new_file, sync_folder};

/// A number of torn ends that no run reaches.
const MOST: u32 = 1000;

/// Copies the bytes after the first `whole` bytes into a new file beside the run log. None if there are none.
pub fn put_aside(mut from: &File, journal: &Path, whole: u64) -> io::Result<Option<PathBuf>> {
    if from.metadata()?.len() <= whole {
        return Ok(None);
    }
    from.seek(SeekFrom::Start(whole))?;
    let (mut to, path) = first_free(journal)?;
    io::copy(&mut from, &mut to)?;
    to.sync_all()?;
    sync_folder(&path)?;
    Ok(Some(path))
}

/// The first of `….torn-1`, `….torn-2`, … that does not exist, created.
fn first_free(journal: &Path) -> io::Result<(File, PathBuf)> {
    for number in 1..MOST {
        let path = beside(journal, &format!(".torn-{number}"));
        match new_file(&path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            created => return Ok((created?, path)),
        }
    }
    Err(io::Error::new(
        io::ErrorKind::AlreadyExists,
        "too many incomplete entries are kept beside it",
    ))
}
