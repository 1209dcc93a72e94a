//! Addresses of documents. In: a URI as an editor writes it. Out: a path, and one spelling for each document. It opens nothing.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The path of a `file:` URI; None of any other.
pub fn path_of(uri: &str) -> Option<PathBuf> {
    let rest = uri.strip_prefix("file://")?;
    let path = &rest[rest.find('/')?..];
    let path = decoded(path)?;
    // `/c:/plans` is a path with a drive.
    let drive = path.as_bytes().get(2) == Some(&b':') && cfg!(windows);
    Some(PathBuf::from(if drive { &path[1..] } else { &path[..] }))
}

/// The URI of an absolute path.
pub fn uri_of(path: &Path) -> String {
    let path = path.to_string_lossy().replace('\\', "/");
    let mut uri = String::from(if path.starts_with('/') {
        "file://"
    } else {
        "file:///"
    });
    for byte in path.bytes() {
        if byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            let _ = write!(uri, "%{byte:02X}");
        }
    }
    uri
}

/// One spelling for each document: editors differ in the characters that they encode.
pub fn normal(uri: &str) -> String {
    path_of(uri).map_or_else(|| uri.to_owned(), |path| uri_of(&path))
}

/// The last part of the path of a URI.
pub fn file_name(uri: &str) -> String {
    let last = uri.rsplit(['/', ':']).next().unwrap_or_default();
    decoded(last).unwrap_or_else(|| last.to_owned())
}

fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        rest = after;
        if *first == b'%' {
            let (digits, after) = after.split_at_checked(2)?;
            let digits = std::str::from_utf8(digits).ok()?;
            bytes.push(u8::from_str_radix(digits, 16).ok()?);
            rest = after;
        } else {
            bytes.push(*first);
        }
    }
    String::from_utf8(bytes)
        .ok()
        .filter(|text| !text.contains('\0'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_of_a_document_is_one() {
        let wanted = "file:///home/%C3%84%20b/%2B1.psd";
        for uri in [
            wanted,
            "file:///home/%c3%84%20b/+1.psd",
            "file:///home/Ä b/+1.psd",
            "file://localhost/home/Ä%20b/%2b1.psd",
        ] {
            assert_eq!(normal(uri), wanted, "{uri}");
        }
        assert_eq!(file_name(wanted), "+1.psd");
        assert_eq!(normal("untitled:Untitled-1"), "untitled:Untitled-1");
        assert_eq!(file_name("untitled:Untitled-1"), "Untitled-1");
    }

    #[test]
    fn what_names_no_file_has_no_path() {
        for uri in [
            "",
            "file:",
            "file://",
            "file:///%",
            "file:///%zz",
            "file:///%FF",
            "file:///a%00",
            "http://a/b",
        ] {
            assert_eq!(path_of(uri), None, "{uri}");
        }
    }
}
