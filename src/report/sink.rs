//! Where the files of a run are put: a folder, memory, or nowhere at all. In: a path, and whoever writes the bytes piece by
//! piece, so that no long table is ever whole in memory. Out: path and SHA-256 of each file. It opens no file itself.

use std::io::{self, Write};

use sha2::{Digest as _, Sha256};

use super::OutputFile;
use crate::text::digest::hex;

/// Path and SHA-256 (hex) of a file that was put somewhere.
pub type Listed = (String, String);

/// Takes files.
pub trait Shelf {
    /// Takes one file, whose bytes `write` gives.
    ///
    /// # Errors
    /// It cannot be kept, or `write` failed.
    fn put(
        &mut self,
        path: &str,
        write: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()>;

    /// Hears what is made next: that may take a while.
    fn begin(&mut self, _: &Piece) {}
}

/// A piece of what a run leaves: a table, a figure, a form of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    pub part: Part,
    /// From 1.
    pub number: usize,
    pub of: usize,
}

/// What a piece is a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The summary too.
    Tables,
    Figures,
    Report,
}

impl Part {
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tables => "tables",
            Self::Figures => "figures",
            Self::Report => "report",
        }
    }
}

/// Keeps them in memory.
impl Shelf for Vec<OutputFile> {
    fn put(
        &mut self,
        path: &str,
        write: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let mut bytes = Vec::new();
        write(&mut bytes)?;
        self.push(OutputFile {
            path: path.to_owned(),
            bytes,
        });
        Ok(())
    }
}

/// Keeps nothing: only the digests are wanted.
pub struct Nowhere;

impl Shelf for Nowhere {
    fn put(
        &mut self,
        _: &str,
        write: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        write(&mut io::sink())
    }
}

/// Puts a file that is written piece by piece.
pub(super) fn put_written(
    shelf: &mut dyn Shelf,
    path: &str,
    mut write: impl FnMut(&mut dyn Write) -> io::Result<()>,
) -> io::Result<Listed> {
    let mut digest = Sha256::new();
    shelf.put(path, &mut |out| {
        write(&mut Digesting {
            out,
            digest: &mut digest,
        })
    })?;
    Ok((path.to_owned(), hex(&digest.finalize())))
}

/// Puts a file that is whole.
pub(super) fn put(shelf: &mut dyn Shelf, file: &OutputFile) -> io::Result<Listed> {
    put_written(shelf, &file.path, |out| out.write_all(&file.bytes))
}

/// Passes bytes on and digests them.
struct Digesting<'a> {
    out: &'a mut dyn Write,
    digest: &'a mut Sha256,
}

impl Write for Digesting<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = self.out.write(bytes)?;
        self.digest.update(&bytes[..taken]);
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::digest::sha256;

    #[test]
    fn a_file_in_pieces_has_the_digest_of_the_whole_wherever_it_goes() {
        let pieces =
            |out: &mut dyn Write| (0..3).try_for_each(|piece| writeln!(out, "piece {piece}"));
        let mut kept: Vec<OutputFile> = Vec::new();
        let listed = put_written(&mut kept, "tables/a.csv", pieces).unwrap();
        assert_eq!(
            listed,
            (
                "tables/a.csv".to_owned(),
                sha256(b"piece 0\npiece 1\npiece 2\n")
            )
        );
        assert_eq!(
            (sha256(&kept[0].bytes), put(&mut Nowhere, &kept[0]).unwrap()),
            (listed.1.clone(), listed)
        );
    }

    /// Takes no more than three bytes at once, and refuses more than twelve.
    struct Narrow(Vec<u8>);

    impl Write for Narrow {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let taken = bytes.len().min(3).min(12 - self.0.len());
            self.0.extend(&bytes[..taken]);
            Ok(taken)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn only_what_was_taken_is_digested_and_what_cannot_be_kept_is_told() {
        let (mut digest, mut out) = (Sha256::new(), Narrow(Vec::new()));
        let mut digesting = Digesting {
            out: &mut out,
            digest: &mut digest,
        };
        digesting.write_all(b"abcdefgh").unwrap();
        assert!(digesting.write_all(b"ijklmnop").is_err());
        assert_eq!(
            (hex(&digest.finalize()), out.0.as_slice()),
            (sha256(b"abcdefghijkl"), b"abcdefghijkl".as_slice())
        );
    }
}
