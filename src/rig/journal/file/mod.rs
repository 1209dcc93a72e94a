//! A run log in a file: created new, locked while open, with a reserve file that is released when
//! the disk is full. In: a path. Out: a storage. It does not know what the entries mean.

mod ballast;
mod fault;
mod torn;

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::os::unix::fs::{MetadataExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};

use rustix::fs::OFlags;

use super::{LogText, Storage};
pub use ballast::is_part_of_one as is_part_of_a_reserve;
pub use fault::FileFault;
use psd_plan::record::failpoint::{Guarding, on};

/// Largest run log that is read back \[bytes\].
pub const MOST_BYTES: u64 = 4 << 30;

/// Only the operator may read and write the file.
const MODE: u32 = 0o600;

/// The file of a run log. No other psd writes it during its lifetime.
#[derive(Debug)]
pub struct FileStorage {
    file: File,
    path: PathBuf,
    /// Number of its bytes, if no other program has written it.
    length: u64,
}

/// A run log that is not written during its lifetime.
#[derive(Debug)]
pub struct Still {
    _file: File,
}

impl FileStorage {
    /// A new, empty run log with its reserve beside it, both durable.
    ///
    /// # Errors
    /// A file with this name exists, or the disk has no space for the reserve; then no file remains.
    pub fn create(path: &Path) -> Result<Self, FileFault> {
        let file = new_file(path).map_err(FileFault::cannot_be("created", path))?;
        let storage = Self::locked(file, path)?;
        // The storage removes the reserve when it is dropped.
        storage
            .settle()
            .inspect_err(|_| drop(std::fs::remove_file(path)))?;
        Ok(storage)
    }

    /// The run log of an earlier run, to be read and continued. It is locked before anything is read.
    ///
    /// # Errors
    /// There is none, another psd has it, or the disk has no space for the reserve.
    pub fn open_existing(path: &Path) -> Result<Self, FileFault> {
        // The open does not follow a link, and does not wait for the other end of a pipe.
        let flags = (OFlags::NOFOLLOW | OFlags::NONBLOCK).bits();
        let mut options = OpenOptions::new();
        options
            .read(true)
            .append(true)
            .custom_flags(flags.cast_signed());
        let file = options
            .open(path)
            .map_err(FileFault::cannot_be("opened", path))?;
        if !file
            .metadata()
            .map_err(FileFault::cannot_be("opened", path))?
            .is_file()
        {
            return Err(FileFault::NotAFile {
                path: path.to_owned(),
            });
        }
        let storage = Self::locked(file, path)?;
        storage.settle()?;
        Ok(storage)
    }

    /// Holds the lock of a run log that is only read, so that it is not written meanwhile. Read permission is sufficient.
    ///
    /// # Errors
    /// There is none, or another psd writes it.
    pub fn keep_still(path: &Path) -> Result<Still, FileFault> {
        let flags = (OFlags::NOFOLLOW | OFlags::NONBLOCK).bits();
        let file = OpenOptions::new()
            .read(true)
            .custom_flags(flags.cast_signed())
            .open(path);
        let file = file.map_err(FileFault::cannot_be("opened", path))?;
        if on(Guarding::Lock) {
            file.try_lock_shared().map_err(|refused| match refused {
                TryLockError::WouldBlock => FileFault::InUse {
                    path: path.to_owned(),
                },
                TryLockError::Error(error) => FileFault::cannot_be("locked", path)(error),
            })?;
        }
        Ok(Still { _file: file })
    }

    /// The bytes that it has now.
    ///
    /// # Errors
    /// They cannot be read, or are more than any run writes.
    pub fn text(&self) -> Result<LogText, FileFault> {
        // Through the descriptor with the lock: the path may meanwhile lead to a different file.
        let text = self.file.try_clone().and_then(LogText::of_file);
        let text = text.map_err(FileFault::cannot_be("read", &self.path))?;
        if text.length() > MOST_BYTES {
            return Err(FileFault::TooLarge {
                path: self.path.clone(),
                most: MOST_BYTES,
            });
        }
        Ok(text)
    }

    /// Moves the bytes after the first `whole` bytes, if there are any, into a new file `….torn-1`, `….torn-2`, … beside
    /// the run log, and gives its path; both are durable. The caller logs it.
    ///
    /// # Errors
    /// The run log is unchanged, or already cut; then the file beside it is complete.
    pub fn truncate_to(&mut self, whole: u64) -> Result<Option<PathBuf>, FileFault> {
        torn::put_aside(&self.file, &self.path, whole)
            .and_then(|aside| {
                if aside.is_some() {
                    self.cut(whole)?;
                    self.file.sync_all()?;
                }
                Ok(aside)
            })
            .map_err(FileFault::cannot_be("truncated", &self.path))
    }

    /// Free space of the disk, bytes.
    ///
    /// # Errors
    /// The file system does not report it.
    pub fn free_space(&self) -> Result<u64, FileFault> {
        let statistics = rustix::fs::fstatvfs(&self.file).map_err(io::Error::from);
        let statistics = statistics.map_err(FileFault::cannot_be(
            "asked about the free space of its disk",
            &self.path,
        ))?;
        Ok(statistics.f_bavail.saturating_mul(statistics.f_frsize))
    }

    /// It is created only with the lock, so the reserve that it removes when dropped belongs to it.
    fn locked(file: File, path: &Path) -> Result<Self, FileFault> {
        if on(Guarding::Lock) {
            file.try_lock().map_err(|refused| match refused {
                TryLockError::WouldBlock => FileFault::InUse {
                    path: path.to_owned(),
                },
                TryLockError::Error(error) => FileFault::cannot_be("locked", path)(error),
            })?;
        }
        let length = file
            .metadata()
            .map_err(FileFault::cannot_be("opened", path))?
            .len();
        Ok(Self {
            file,
            path: path.to_owned(),
            length,
        })
    }

    /// Puts the reserve beside the file and makes file, reserve and their names durable.
    fn settle(&self) -> Result<(), FileFault> {
        let settled = ballast::lay(&self.path)
            .and_then(|()| self.file.sync_all())
            .and_then(|()| sync_folder(&self.path));
        settled.map_err(FileFault::cannot_be("given its reserve", &self.path))
    }
}

impl Storage for FileStorage {
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        write_whole(&mut self.file, bytes)?;
        self.length += bytes.len() as u64;
        Ok(())
    }

    fn sync(&mut self) -> io::Result<()> {
        self.file.sync_data()
    }

    /// Whether the path still leads to this file, and the file has exactly the bytes that were appended. Only `psd verify` finds bytes that
    /// were replaced.
    fn is_unchanged(&self) -> io::Result<()> {
        if !on(Guarding::SameFile) {
            return Ok(());
        }
        let open = self.file.metadata()?;
        let there = self.path.symlink_metadata();
        let same = there.is_ok_and(|there| (there.dev(), there.ino()) == (open.dev(), open.ino()));
        let changed = |reason| Err(io::Error::new(io::ErrorKind::InvalidData, reason));
        // A file without a name would be lost when it is closed.
        if open.nlink() == 0 {
            changed("its file was deleted")
        } else if !same {
            changed("its file was moved or replaced")
        } else if open.len() != self.length {
            changed("another program changed the length of its file")
        } else {
            Ok(())
        }
    }

    fn cut(&mut self, length: u64) -> io::Result<()> {
        if self.file.metadata()?.len() < length {
            return Err(io::Error::new(
                io::ErrorKind::InvalidData,
                "bytes that were written are missing",
            ));
        }
        self.file.set_len(length)?;
        self.length = length;
        Ok(())
    }

    fn release_reserve(&mut self) {
        ballast::release(&self.path);
    }
}

/// The reserve is needed only during writing; the next program that opens the run log creates it again.
impl Drop for FileStorage {
    fn drop(&mut self) {
        self.release_reserve();
    }
}

/// A file that did not exist before; all writes append.
fn new_file(path: &Path) -> io::Result<File> {
    OpenOptions::new()
        .read(true)
        .append(true)
        .create_new(true)
        .mode(MODE)
        .open(path)
}

/// Makes the names in the folder of a path durable.
fn sync_folder(path: &Path) -> io::Result<()> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    File::open(folder)?.sync_all()
}

/// The path with a suffix: `journal` and `.reserve` give `journal.reserve`.
fn beside(path: &Path, more: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(more);
    PathBuf::from(name)
}

/// Writes all the bytes, each once: a partial write is continued, an interrupted one is repeated.
fn write_whole(out: &mut impl Write, mut bytes: &[u8]) -> io::Result<()> {
    while !bytes.is_empty() {
        match out.write(bytes) {
            Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
            Ok(written) => bytes = &bytes[written..],
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
