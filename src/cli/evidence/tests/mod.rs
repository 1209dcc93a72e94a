//! Every changed byte of a run folder is detected: flipped, cut, swapped or added. This includes a forger who regenerates the manifest.

mod build;
mod compact;
mod damaged;
mod header;
mod sidecar;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;

use minisign::{KeyPair, SecretKey};
use rayon::prelude::*;

use super::check::examine;
use super::finding::Finding;
use super::folder::{Folder, Held};
use super::keys::KnownKey;
use super::names::MANIFEST;
use super::rebuilt::Rebuilt;
use super::signature::{self, Statement};
use crate::commands::prediction::prediction;
use crate::exit::Exit;
use crate::files::recorded_run::JOURNAL;
use psd::report::manifest_with;

/// A few steps, and every kind of file.
const PLAN: &str = r#"plan "A few steps" {
  customer = "Somebody"
}

specimen beam {
  mass      = 1 kg
  behaviour = elastic(stiffness: 327.65 N/m)
}

striker hammer {
  mass     = 10 kg
  velocity = 1 m/s
}

impact hit {
  striker   = hammer
  time_step = 10 ms
  duration  = 30 ms
}

report {
  figures = [displacement(hit)]
  sign    = ["Test engineer", "Quality"]
}
"#;

fn psd(arguments: &[&str]) -> Exit {
    crate::run_command_line(["psd"].iter().chain(arguments).map(Into::into))
}

pub(super) type Bytes = BTreeMap<String, Vec<u8>>;

/// The files of one run with a full run log, made once.
pub(super) fn run() -> &'static Bytes {
    static RUN: OnceLock<Bytes> = OnceLock::new();
    RUN.get_or_init(|| made("full"))
}

/// The files of the same run with a compact run log, made once.
fn compact_run() -> &'static Bytes {
    static RUN: OnceLock<Bytes> = OnceLock::new();
    RUN.get_or_init(|| made("compact"))
}

fn made(log: &str) -> Bytes {
    let root = tempfile::tempdir().unwrap();
    let (plan, out) = (root.path().join("few.psd"), root.path().join("run"));
    std::fs::write(&plan, PLAN).unwrap();
    let (plan, out_path) = (plan.to_str().unwrap(), out.to_str().unwrap());
    let ran = psd(&["run", plan, "--out", out_path, "--log", log]);
    assert_eq!(ran, Exit::Met);
    files_of(&out)
}

fn files_of(run: &Path) -> Bytes {
    let read = |name: &String| (name.clone(), std::fs::read(run.join(name)).unwrap());
    Folder::read(run).unwrap().files.keys().map(read).collect()
}

pub(super) fn folder(files: &Bytes) -> Folder {
    let held = files
        .iter()
        .map(|(name, bytes)| (name.clone(), Held::of(name, bytes.clone())));
    Folder {
        files: held.collect(),
        odd: Vec::new(),
    }
}

/// The bytes of its run log.
pub(super) fn run_log(folder: &Folder) -> Vec<u8> {
    let mut bytes = Vec::new();
    if let Some(text) = folder.run_log() {
        text.read_blocks(|block| bytes.extend_from_slice(block))
            .unwrap();
    }
    bytes
}

/// The same folder with one file of different bytes; None: without it.
pub(super) fn with(folder: &Folder, name: &str, bytes: Option<Vec<u8>>) -> Folder {
    let mut changed = folder.clone();
    match bytes {
        Some(bytes) => changed.files.insert(name.to_owned(), Held::of(name, bytes)),
        None => changed.files.remove(name),
    };
    changed
}

/// Keys and a folder that both roles have signed.
struct Signed {
    folder: Folder,
    rebuilt: Rebuilt,
    keys: Vec<KnownKey>,
}

fn statement(rebuilt: &Rebuilt, role: &str) -> Statement {
    let report = rebuilt.report.as_ref().unwrap();
    let (run, report) = (report.run_id.clone(), report.id.clone());
    Statement {
        run,
        report,
        status: "simulation".to_owned(),
        issued: None,
        role: Some(role.to_owned()),
        name: Some("A. Engineer".to_owned()),
        key: None,
    }
}

fn signed_as(folder: &mut Folder, rebuilt: &Rebuilt, role: &str, key: &SecretKey) -> String {
    let text = signature::sign(
        folder.bytes(MANIFEST).unwrap(),
        key,
        &statement(rebuilt, role),
    )
    .unwrap();
    let name = signature::file_name(Some(role), &rebuilt.report.as_ref().unwrap().roles);
    folder
        .files
        .insert(name.clone(), Held::of(&name, text.into_bytes()));
    name
}

fn signed() -> Signed {
    let mut folder = folder(run());
    let rebuilt = Rebuilt::of(&folder, &prediction);
    let keys = ["Test engineer", "Quality"].map(|role| {
        let KeyPair { pk, sk } = KeyPair::generate_unencrypted_keypair().unwrap();
        signed_as(&mut folder, &rebuilt, role, &sk);
        KnownKey {
            name: role.to_owned(),
            key: pk,
        }
    });
    Signed {
        folder,
        rebuilt,
        keys: keys.to_vec(),
    }
}

pub(super) fn faults(findings: &[Finding]) -> Vec<&'static str> {
    findings
        .iter()
        .filter(|finding| !finding.is_sound())
        .map(|finding| finding.part)
        .collect()
}

/// The errors of a folder whose run log may have been changed. A run log that is the same up to its last complete line is not replayed
/// again.
fn judged(folder: &Folder, signed: &Signed) -> Vec<&'static str> {
    let (own, bytes) = (run_log(&signed.folder), run_log(folder));
    let head = |bytes: &[u8]| {
        psd_testing::journal::recover(bytes)
            .ok()
            .map(|found| found.head().to_owned())
    };
    let same = bytes == own || head(&bytes).is_some_and(|now| Some(now) == head(&own));
    let rebuilt = (!same).then(|| Rebuilt::of(folder, &prediction));
    faults(&examine(
        folder,
        rebuilt.as_ref().unwrap_or(&signed.rebuilt),
        &signed.keys,
    ))
}

/// Every byte of a small file; for a large one regularly spaced bytes and its ends.
fn offsets(length: usize) -> Vec<usize> {
    let stride = if length <= 8192 { 1 } else { length / 500 };
    (0..length).step_by(stride).chain([length - 1]).collect()
}

#[test]
fn a_sound_folder_is_sound_and_names_its_parts() {
    let signed = signed();
    let findings = examine(&signed.folder, &signed.rebuilt, &signed.keys);
    assert!(findings.iter().all(Finding::is_sound), "{findings:#?}");
    let parts: Vec<&str> = findings.iter().map(|finding| finding.part).collect();
    assert_eq!(
        parts,
        [
            "record",
            "targets",
            "results",
            "plan",
            "report",
            "figures",
            "manifest",
            "signature",
            "signature"
        ]
    );
    let unsigned = folder(run());
    let findings = examine(&unsigned, &signed.rebuilt, &[]);
    assert!(
        findings.iter().all(Finding::is_sound)
            && findings.last().unwrap().statement.contains("unsigned")
    );
    assert_eq!(
        faults(&examine(&unsigned, &signed.rebuilt, &signed.keys)),
        ["signature", "signature"]
    );
}

#[test]
fn a_missing_signature_is_reported_and_with_a_key_is_an_error() {
    let signed = signed();
    let quality = "manifest.sha256.quality.minisig";
    let half = with(&signed.folder, quality, None);
    let findings = examine(&half, &signed.rebuilt, &[]);
    assert!(
        findings.iter().all(Finding::is_sound)
            && findings.last().unwrap().statement == "Quality has not signed",
        "{findings:#?}"
    );
    assert_eq!(
        faults(&examine(&half, &signed.rebuilt, &signed.keys[..1])),
        ["signature"]
    );
}

#[test]
fn a_foreign_file_is_found_also_if_no_manifest_lists_it() {
    let signed = signed();
    let reserve = "journal.psdj.reserve";
    for (bytes, sound) in [
        (Vec::new(), true),
        (b"smuggled".to_vec(), false),
        (vec![0; 1 << 20], false),
    ] {
        let found = judged(&with(&signed.folder, reserve, Some(bytes)), &signed);
        assert_eq!(found.is_empty(), sound, "{found:?}");
    }
    // A complete run has results.
    let only = folder(&BTreeMap::from([(
        JOURNAL.to_owned(),
        run()[JOURNAL].clone(),
    )]));
    assert_eq!(
        faults(&examine(&only, &Rebuilt::of(&only, &prediction), &[])),
        ["results"]
    );
}

#[test]
fn a_flipped_byte_of_any_file_is_found() {
    let signed = signed();
    let mut bytes = run().clone();
    bytes.extend(
        signed
            .folder
            .signatures()
            .map(|(name, bytes)| (name.to_owned(), bytes.to_vec())),
    );
    let mut flipped = 0;
    for (name, own) in &bytes {
        let offsets = offsets(own.len());
        flipped += offsets.len();
        let missed: Vec<(usize, u8)> = offsets
            .into_par_iter()
            // Its lowest bit or its highest, alternately.
            .map(|at| (at, if at % 2 == 0 { 0x01_u8 } else { 0x80 }))
            .filter(|(at, bit)| {
                let mut changed = own.clone();
                changed[*at] ^= bit;
                judged(&with(&signed.folder, name, Some(changed)), &signed).is_empty()
            })
            .collect();
        assert_eq!(missed, [], "{name}");
    }
    assert!(flipped > 8_000, "{flipped} bytes were tried");
}

#[test]
fn without_a_known_key_a_signature_still_holds_against_the_key_it_names() {
    let signed = signed();
    for (name, own) in signed.folder.signatures() {
        for at in 0..own.len() {
            let mut changed = own.to_vec();
            changed[at] ^= 1;
            let changed = with(&signed.folder, name, Some(changed));
            assert_eq!(
                faults(&examine(&changed, &signed.rebuilt, &[])),
                ["signature"],
                "{name} at {at}"
            );
        }
    }
    let findings = examine(&signed.folder, &signed.rebuilt, &[]);
    assert!(
        findings.iter().all(Finding::is_sound)
            && findings
                .last()
                .unwrap()
                .statement
                .contains("only `--key` verifies")
    );
}

#[test]
fn cut_lengthened_swapped_missing_and_foreign_files_are_found() {
    let signed = signed();
    let names: Vec<&String> = run().keys().collect();
    for name in &names {
        let own = &run()[*name];
        let cut = own[..own.len() - 1].to_vec();
        let longer = [own.as_slice(), b"\n"].concat();
        for changed in [Some(cut), Some(longer), Some(Vec::new()), None] {
            assert!(
                !judged(&with(&signed.folder, name, changed), &signed).is_empty(),
                "{name}"
            );
        }
        for other in &names {
            let swapped = with(
                &with(&signed.folder, name, Some(run()[*other].clone())),
                other,
                Some(own.clone()),
            );
            assert!(
                name == other || !judged(&swapped, &signed).is_empty(),
                "{name} and {other}"
            );
        }
    }
    for foreign in [
        "figures/more.png",
        "x",
        "journal.psdj.torn-1",
        "before-resume-1/x",
        "manifest.sha256.other.minisig",
    ] {
        assert!(
            !judged(&with(&signed.folder, foreign, Some(b"x".to_vec())), &signed).is_empty(),
            "{foreign}"
        );
    }
    let (mine, yours): (Vec<_>, Vec<_>) = signed
        .folder
        .signatures()
        .map(|(name, own)| (name.to_owned(), own.to_vec()))
        .unzip();
    let swapped = with(
        &with(&signed.folder, &mine[0], Some(yours[1].clone())),
        &mine[1],
        Some(yours[0].clone()),
    );
    let found = examine(&swapped, &signed.rebuilt, &[]);
    assert_eq!(faults(&found), ["signature", "signature"], "{found:#?}");
}

/// Anyone who can write the folder can write its manifest. The run log then shows the change, and the signature shows that there was one.
#[test]
fn a_rewritten_manifest_hides_nothing() {
    let signed = signed();
    let unsigned = folder(run());
    for name in run().keys().filter(|name| *name != MANIFEST) {
        let own = &run()[name];
        let stride = (own.len() / 60).max(1);
        for at in (0..own.len()).step_by(stride) {
            let mut changed = own.clone();
            changed[at] ^= 1;
            let forged = forged(&with(&unsigned, name, Some(changed)));
            let found = judged(&forged, &signed);
            assert!(found.contains(&"signature"), "{name}");
            let unsigned_found = faults(&examine(&forged, &rebuilt_of(&forged, &signed), &[]));
            assert!(
                unsigned_found.iter().any(|part| *part != "manifest"),
                "{name} at {at}: {unsigned_found:?}"
            );
        }
    }
}

fn rebuilt_of(folder: &Folder, signed: &Signed) -> Rebuilt {
    if run_log(folder) == run_log(&signed.folder) {
        signed.rebuilt.clone()
    } else {
        Rebuilt::of(folder, &prediction)
    }
}

fn forged(folder: &Folder) -> Folder {
    let all: Vec<(String, String)> = folder
        .listed()
        .map(|(name, held)| (name.clone(), held.digest.clone()))
        .collect();
    with(folder, MANIFEST, Some(manifest_with(&[], &all).bytes))
}

#[test]
fn another_key_is_no_key() {
    let mut signed = signed();
    let KeyPair { pk, sk } = KeyPair::generate_unencrypted_keypair().unwrap();
    let stranger = KnownKey {
        name: "stranger".to_owned(),
        key: pk,
    };
    assert_eq!(
        faults(&examine(
            &signed.folder,
            &signed.rebuilt,
            std::slice::from_ref(&stranger)
        )),
        ["signature"; 3]
    );
    // The stranger signs in the role of another: this is valid only for a reader who its key cannot be read.
    signed_as(&mut signed.folder, &signed.rebuilt, "Quality", &sk);
    assert_eq!(
        faults(&examine(&signed.folder, &signed.rebuilt, &[])),
        [""; 0]
    );
    // No signature by the given keys, none by the key of quality, and therefore none for quality.
    assert_eq!(
        faults(&examine(&signed.folder, &signed.rebuilt, &signed.keys)),
        ["signature"; 3]
    );
}
