//! Sinks for the files of a run: a folder, memory, or none. In: a path, and a function that writes the bytes in chunks, so
//! that no long table is held in memory. Out: path and SHA-256 of each file. It opens no file itself.

use std::io::{self, Write};

use sha2::{Digest as _, Sha256};

use super::file::OutputFile;
use psd_text::digest::hex;

/// Path and SHA-256 (hex) of a file that was put into a sink.
pub type FileDigest = (String, String);

/// Receives the files of a run.
pub trait OutputSink {
    /// Receives one file; `write` writes its bytes.
    ///
    /// # Errors
    /// The file cannot be kept, or `write` failed.
    fn put(
        &mut self,
        path: &str,
        write: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()>;

    /// Called before each piece is made, which may need some time.
    fn begin(&mut self, _: &OutputPiece) {}
}

/// A table, a figure or a format of the report, to show progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutputPiece {
    pub part: OutputPart,
    /// Counted from 1.
    pub number: usize,
    pub total: usize,
}

/// The group that a piece belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputPart {
    /// Tables and summary.
    Tables,
    Figures,
    Report,
}

impl OutputPart {
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tables => "tables",
            Self::Figures => "figures",
            Self::Report => "report",
        }
    }
}

/// Keeps the files in memory.
impl OutputSink for Vec<OutputFile> {
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

/// Keeps no file: only the digests are needed.
pub struct NullSink;

impl OutputSink for NullSink {
    fn put(
        &mut self,
        _: &str,
        write: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        write(&mut io::sink())
    }
}

/// Puts a file that is written in chunks.
pub(in crate::report) fn put_chunks(
    sink: &mut dyn OutputSink,
    path: &str,
    mut write: impl FnMut(&mut dyn Write) -> io::Result<()>,
) -> io::Result<FileDigest> {
    let mut digest = Sha256::new();
    sink.put(path, &mut |out| {
        write(&mut Digesting {
            out,
            digest: &mut digest,
        })
    })?;
    Ok((path.to_owned(), hex(&digest.finalize())))
}

/// Puts a file that is in memory.
pub(super) fn put(sink: &mut dyn OutputSink, file: &OutputFile) -> io::Result<FileDigest> {
    put_chunks(sink, &file.path, |out| out.write_all(&file.bytes))
}

/// Forwards bytes and digests them.
struct Digesting<'a> {
    out: &'a mut dyn Write,
    digest: &'a mut Sha256,
}

impl Write for Digesting<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.digest.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_text::digest::sha256;

    #[test]
    fn a_file_in_chunks_has_the_digest_of_the_whole_in_every_sink() {
        let chunks =
            |out: &mut dyn Write| (0..3).try_for_each(|piece| writeln!(out, "piece {piece}"));
        let mut kept: Vec<OutputFile> = Vec::new();
        let digest = put_chunks(&mut kept, "tables/a.csv", chunks).unwrap();
        assert_eq!(
            digest,
            (
                "tables/a.csv".to_owned(),
                sha256(b"piece 0\npiece 1\npiece 2\n")
            )
        );
        assert_eq!(
            (
                sha256(&kept[0].bytes),
                put(&mut NullSink, &kept[0]).unwrap()
            ),
            (digest.1.clone(), digest)
        );
    }

    /// Accepts three bytes per call and twelve in total.
    struct Narrow(Vec<u8>);

    impl Write for Narrow {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let accepted = bytes.len().min(3).min(12 - self.0.len());
            self.0.extend(&bytes[..accepted]);
            Ok(accepted)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn only_accepted_bytes_are_digested_and_a_full_sink_is_an_error() {
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
