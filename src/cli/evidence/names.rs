//! Names of the files of a run folder: the manifest, its signatures, sidecars, issued reports. It reads no file.

/// Name of the manifest; it does not list itself.
pub const MANIFEST: &str = "manifest.sha256";

/// Name of the file of issues in an issued folder.
pub const ISSUE: &str = "issue.json";

/// Ending of the file of a signature.
pub const SUFFIX: &str = ".minisig";

/// Whether a file of this name is a signature over the manifest.
pub fn is_signature(name: &str) -> bool {
    let Some(role) = name
        .strip_prefix(MANIFEST)
        .and_then(|rest| rest.strip_suffix(SUFFIX))
    else {
        return false;
    };
    let is_plain = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-';
    role.is_empty()
        || role
            .strip_prefix('.')
            .is_some_and(|role| !role.is_empty() && role.bytes().all(is_plain))
}

/// A second copy of the PDF report, with a seal at its end, can be in the same folder.
pub use psd::report::PAPER;

/// Kinds of sidecars.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SidecarKind {
    /// `FILE.tsr`, `FILE.tst`
    Token,
    /// `FILE.ots`
    Proof,
    /// `report….pdf`
    SealedPaper,
}

/// Whether a file may be a sidecar by its name: its bytes are then read.
pub fn is_sidecar(name: &str) -> bool {
    sidecar(name).is_some()
}

/// The kind of a sidecar of this name, and the file that it belongs to.
pub fn sidecar(name: &str) -> Option<(SidecarKind, &str)> {
    let kinds = [
        (".tsr", SidecarKind::Token),
        (".tst", SidecarKind::Token),
        (".ots", SidecarKind::Proof),
    ];
    let of = kinds
        .into_iter()
        .find_map(|(ending, kind)| Some((kind, name.strip_suffix(ending)?)));
    let sealed = || {
        let own = name
            .strip_prefix(PAPER.strip_suffix(".pdf")?)?
            .strip_suffix(".pdf")?;
        (!own.is_empty() && !own.contains('/')).then_some((SidecarKind::SealedPaper, PAPER))
    };
    of.or_else(sealed)
}
