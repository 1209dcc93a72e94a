//! The manifest: SHA-256 of every file, in the format that `sha256sum --check` reads. In: the files of a run folder.
//! Out: `manifest.sha256`, itself not listed.

use super::file::OutputFile;
use super::sink::FileDigest;
use psd_text::digest::sha256;

/// Name of the manifest, which does not list itself.
pub(super) const NAME: &str = "manifest.sha256";

/// The manifest of `files` and of others whose digests are known, in order of path.
pub(super) fn with_digests<'a>(
    files: impl Iterator<Item = &'a OutputFile>,
    others: &[FileDigest],
) -> OutputFile {
    let made = files.map(|file| (file.path.as_str(), sha256(&file.bytes)));
    let known = others
        .iter()
        .map(|(path, digest)| (path.as_str(), digest.clone()));
    let mut lines: Vec<(&str, String)> = made.chain(known).collect();
    lines.sort();
    let text = lines.into_iter().fold(String::new(), |text, (path, hash)| {
        text + &hash + "  " + path + "\n"
    });
    OutputFile {
        path: NAME.to_owned(),
        bytes: text.into_bytes(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_is_listed_by_path_with_its_digest() {
        let file = |path: &str| OutputFile {
            path: path.to_owned(),
            bytes: b"abc".to_vec(),
        };
        let files = [file("b"), file("a")];
        let text = String::from_utf8(with_digests(files.iter(), &[]).bytes).unwrap();
        let digest = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(text, format!("{digest}  a\n{digest}  b\n"));
    }
}
