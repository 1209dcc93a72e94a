//! Sidecars: files from other programs beside the files of a run, which no manifest lists. They are time-stamp tokens (RFC 3161),
//! OpenTimestamps proofs, and the report in a sealed PDF. In: a folder. Out: findings, one per sidecar. A sidecar refers to a file of the
//! folder and replaces none. It is wrong if it does not match that file in its present state.

use sha2::{Digest as _, Sha384, Sha512};

use super::finding::Finding;
use super::folder::{Content, Folder};
use super::names::{SidecarKind, sidecar};
use psd_text::digest::unhex;

/// The first bytes of an OpenTimestamps proof.
const OPEN_TIMESTAMPS: &[u8] =
    b"\x00OpenTimestamps\x00\x00Proof\x00\xbf\x89\xe2\xe8\x84\xe8\x92\x94";

/// Whether a file is a sidecar of another file in this folder.
pub fn is_one(folder: &Folder, name: &str) -> bool {
    sidecar(name).is_some_and(|(_, of)| folder.files.contains_key(of))
}

/// The finding of one sidecar about its file.
pub fn examine(folder: &Folder, name: &str) -> Option<Finding> {
    let (kind, of) = sidecar(name)?;
    let bytes = folder.bytes(name).unwrap_or_default();
    let statement = match kind {
        SidecarKind::Token if !is_der(bytes) => Err("is not a time-stamp token".to_owned()),
        SidecarKind::Proof if !bytes.starts_with(OPEN_TIMESTAMPS) => {
            Err("is not a proof of OpenTimestamps".to_owned())
        }
        SidecarKind::Token | SidecarKind::Proof if !names(folder, bytes, of) => {
            Err(format!("does not name the present `{of}`"))
        }
        SidecarKind::Token => Ok(format!(
            "is a time-stamp token that names `{of}`; `openssl ts -verify` verifies its issuer and time"
        )),
        SidecarKind::Proof => Ok(format!(
            "is a proof that names `{of}`; `ots verify` verifies its date"
        )),
        SidecarKind::SealedPaper => {
            let own = folder
                .bytes(of)
                .filter(|own| bytes.len() > own.len() && bytes.starts_with(own));
            own.map(|_| format!("is `{of}` with data appended; a reader of sealed PDFs verifies its signatory and time"))
                .ok_or_else(|| format!("does not begin with `{of}`, byte for byte"))
        }
    };
    Some(match statement {
        Ok(statement) => Finding::sound("sidecar", format!("`{name}` {statement}")),
        Err(fault) => Finding::wrong("sidecar", format!("`{name}` {fault}")),
    })
}

/// Whether the bytes contain a digest of a file. For a file that is not in memory, only its SHA-256 is searched.
fn names(folder: &Folder, bytes: &[u8], of: &str) -> bool {
    let Some(held) = folder.files.get(of) else {
        return false;
    };
    let contains = |digest: &[u8]| {
        !digest.is_empty() && bytes.windows(digest.len()).any(|window| window == digest)
    };
    let has_longer = || match &held.content {
        Content::None => false,
        Content::Bytes(own) => contains(&Sha384::digest(own)) || contains(&Sha512::digest(own)),
        Content::RunLog(text) => {
            let (mut short, mut long) = (Sha384::new(), Sha512::new());
            let read = text.read_blocks(|block| {
                short.update(block);
                long.update(block);
            });
            read.is_ok() && (contains(&short.finalize()) || contains(&long.finalize()))
        }
    };
    contains(&unhex(&held.digest).unwrap_or_default()) || has_longer()
}

/// Whether the bytes are one DER sequence and nothing else.
fn is_der(bytes: &[u8]) -> bool {
    let [0x30, first, rest @ ..] = bytes else {
        return false;
    };
    if *first < 0x80 {
        return rest.len() == usize::from(*first);
    }
    let count = usize::from(*first & 0x7f);
    let Some((length, content)) = rest
        .split_at_checked(count)
        .filter(|_| (1..=4).contains(&count))
    else {
        return false;
    };
    length
        .iter()
        .fold(0, |length, byte| length << 8 | usize::from(*byte))
        == content.len()
}
