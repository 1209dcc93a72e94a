//! Sidecars beside a run are recognised, listed, and matched with their file. A changed file is found as it is without sidecars.

use std::collections::BTreeMap;

use sha2::{Digest as _, Sha256, Sha512};

use super::{faults, folder, run, with};
use crate::commands::prediction::prediction;
use crate::evidence::check::examine;
use crate::evidence::folder::Folder;
use crate::evidence::names::MANIFEST;
use crate::evidence::rebuilt::Rebuilt;
use crate::files::recorded_run::JOURNAL;

/// A DER sequence that contains a digest, like a time-stamp token.
fn token(digest: &[u8]) -> Vec<u8> {
    let content = [
        &[0x04, u8::try_from(digest.len()).unwrap()],
        digest,
        &[0x05; 300],
    ]
    .concat();
    let length = u16::try_from(content.len()).unwrap().to_be_bytes();
    [&[0x30, 0x82], &length[..], &content].concat()
}

fn proof(digest: &[u8]) -> Vec<u8> {
    [
        b"\x00OpenTimestamps\x00\x00Proof\x00\xbf\x89\xe2\xe8\x84\xe8\x92\x94\x01\x08",
        digest,
        &[0xf0, 0x10],
    ]
    .concat()
}

fn sealed() -> Vec<u8> {
    [&run()["report.pdf"][..], b"\n12 0 obj /ByteRange"].concat()
}

/// The findings on the sidecars of a run with this one additional file, and the errors of the folder.
fn beside(name: &str, bytes: Vec<u8>) -> (Vec<String>, Vec<&'static str>) {
    let one_more = with(&folder(run()), name, Some(bytes));
    let found = examine(&one_more, rebuilt(), &[]);
    let statements = found
        .iter()
        .filter(|finding| finding.part == "sidecar")
        .map(|finding| finding.statement.clone())
        .collect();
    (statements, faults(&found))
}

fn rebuilt() -> &'static Rebuilt {
    static REBUILT: std::sync::OnceLock<Rebuilt> = std::sync::OnceLock::new();
    REBUILT.get_or_init(|| Rebuilt::of(&folder(run()), &prediction))
}

#[test]
fn a_valid_sidecar_is_reported_and_is_not_an_error() {
    let sha256 = |name: &str| Sha256::digest(&run()[name]).to_vec();
    let known = [
        (
            "manifest.sha256.tsr",
            token(&sha256(MANIFEST)),
            "time-stamp token that names `manifest.sha256`",
        ),
        (
            "manifest.sha256.tst",
            token(&Sha512::digest(&run()[MANIFEST])),
            "time-stamp token that names `manifest.sha256`",
        ),
        (
            "journal.psdj.tsr",
            token(&sha256(JOURNAL)),
            "names `journal.psdj`",
        ),
        (
            "tables/hit.csv.ots",
            proof(&sha256("tables/hit.csv")),
            "proof that names `tables/hit.csv`",
        ),
        (
            "report.sealed.pdf",
            sealed(),
            "`report.pdf` with data appended",
        ),
    ];
    for (name, bytes, wanted) in known {
        let (statements, wrong) = beside(name, bytes);
        assert!(
            wrong.is_empty() && statements.len() == 1 && statements[0].contains(wanted),
            "{name}: {statements:?} {wrong:?}"
        );
    }
}

#[test]
fn what_is_of_no_file_here_or_of_another_is_wrong() {
    let other = Sha256::digest(b"another").to_vec();
    let mut cut = token(&Sha256::digest(&run()[MANIFEST]));
    cut.pop();
    let mut changed = sealed();
    changed[100] ^= 1;
    let wrong = [
        ("manifest.sha256.tsr", token(&other)),
        ("manifest.sha256.tsr", cut),
        (
            "manifest.sha256.tsr",
            Sha256::digest(&run()[MANIFEST]).to_vec(),
        ),
        (
            "manifest.sha256.ots",
            token(&Sha256::digest(&run()[MANIFEST])),
        ),
        ("manifest.sha256.ots", proof(&other)),
        ("report.sealed.pdf", changed),
        ("report-2.pdf", run()["report.pdf"].clone()),
    ];
    for (name, bytes) in wrong {
        assert_eq!(beside(name, bytes).1, ["sidecar"], "{name}");
    }
    // A sidecar of a missing file is an extra file.
    assert_eq!(
        beside("more.csv.tsr", token(&other)).1,
        ["results", "manifest"]
    );
    assert_eq!(beside("notes.pdf", sealed()).1, ["results", "manifest"]);
}

#[test]
fn a_sidecar_hides_no_changed_missing_or_smuggled_file() {
    let named = |name: &str| token(&Sha256::digest(&run()[name]));
    let table = "tables/hit.csv";
    let sound = with(&folder(run()), "tables/hit.csv.tsr", Some(named(table)));
    let found = |folder: &Folder| faults(&examine(folder, rebuilt(), &[]));
    let altered = [run()[table].clone(), b"1".to_vec()].concat();
    assert_eq!(
        found(&with(&sound, table, Some(altered.clone()))),
        ["results", "manifest", "sidecar"]
    );
    let stamped = with(
        &sound,
        "tables/hit.csv.tsr",
        Some(token(&Sha256::digest(&altered))),
    );
    assert_eq!(
        found(&with(&stamped, table, Some(altered))),
        ["results", "manifest"]
    );
    assert!(found(&with(&sound, table, None)).contains(&"manifest"));
    // A seal inside the report changes the file. A sealed copy beside it does not replace it.
    let in_place = with(&folder(run()), "report.pdf", Some(sealed()));
    assert_eq!(found(&in_place), ["report", "manifest"]);
    let moved = with(
        &with(&folder(run()), "report.sealed.pdf", Some(sealed())),
        "report.pdf",
        None,
    );
    assert!(found(&moved).contains(&"report"));
    // A file of the run keeps this status, whatever its name.
    let manifest = [
        run()[MANIFEST].clone(),
        format!("{}  {table}.tsr\n", "0".repeat(64)).into_bytes(),
    ]
    .concat();
    assert!(found(&with(&sound, MANIFEST, Some(manifest))).contains(&"manifest"));
}

#[test]
fn a_record_alone_may_have_a_token_too() {
    let only = folder(&BTreeMap::from([(
        JOURNAL.to_owned(),
        run()[JOURNAL].clone(),
    )]));
    let stamped = with(
        &only,
        "journal.psdj.tsr",
        Some(token(&Sha256::digest(&run()[JOURNAL]))),
    );
    let alone = |folder: &Folder| faults(&examine(folder, rebuilt(), &[]));
    assert_eq!(
        (alone(&only), alone(&stamped)),
        (vec!["results"], vec!["results"])
    );
}
