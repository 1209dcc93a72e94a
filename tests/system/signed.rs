//! Checks of a signed run without psd: `sha256sum` and minisign's own program accept it, and refuse it once a byte is
//! different. Conversely, psd accepts the signatures of minisign.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::needs;
use crate::stage::PSD;

const PLAN: &str = r#"plan "Signed" {
  customer = "Jörg Ltd"
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
  figures = []
  sign    = ["Prüfer", "Quality"]
}
"#;

/// Whether a program ended with 0 in a folder.
fn accepts(folder: &Path, program: &str, arguments: &[&str]) -> bool {
    let mut command = Command::new(program);
    command
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().unwrap().success()
}

fn flip(path: &Path, at: usize) {
    let mut bytes = fs::read(path).unwrap();
    bytes[at] ^= 1;
    fs::write(path, bytes).unwrap();
}

#[test]
fn who_has_no_psd_proves_the_folder_too() {
    if !needs::minisign() {
        return;
    }
    let root = crate::stage::folder();
    let (workspace, run) = (root.path(), root.path().join("run"));
    fs::write(workspace.join("plan.psd"), PLAN).unwrap();
    fs::write(workspace.join("password"), "correct horse\n").unwrap();
    assert!(accepts(
        workspace,
        PSD,
        &["run", "plan.psd", "--out", "run"]
    ));
    assert!(accepts(
        workspace,
        PSD,
        &["keygen", "psd.key", "--password-file", "password"]
    ));
    let by_psd = [
        "sign",
        "run",
        "--key",
        "psd.key",
        "--password-file",
        "password",
        "--role",
    ];
    assert!(accepts(
        workspace,
        PSD,
        &[&by_psd[..], &["Prüfer", "--name", "Jörg Ä."]].concat()
    ));
    assert!(accepts(
        workspace,
        PSD,
        &[&by_psd[..], &["Quality"]].concat()
    ));

    let minisign = |signature: &str| {
        accepts(
            &run,
            "minisign",
            &[
                "-Vm",
                "manifest.sha256",
                "-x",
                signature,
                "-p",
                "../psd.key.pub",
            ],
        )
    };
    let sums = || {
        accepts(
            &run,
            "sha256sum",
            &["--check", "--strict", "manifest.sha256"],
        )
    };
    for signature in [
        "manifest.sha256.pr-fer.minisig",
        "manifest.sha256.quality.minisig",
    ] {
        assert!(minisign(signature), "{signature}");
        let own = fs::read(run.join(signature)).unwrap();
        for line in 1..4 {
            let start: usize = own
                .split_inclusive(|byte| *byte == b'\n')
                .take(line)
                .map(<[u8]>::len)
                .sum();
            flip(&run.join(signature), start + 30);
            assert!(!minisign(signature), "{signature}, line {}", line + 1);
            fs::write(run.join(signature), &own).unwrap();
        }
    }
    assert!(sums());
    flip(&run.join("journal.psdj"), 100);
    assert!(!sums());
    flip(&run.join("journal.psdj"), 100);
    flip(&run.join("manifest.sha256"), 0);
    assert!(!minisign("manifest.sha256.quality.minisig"));
}

#[test]
fn what_minisign_signs_with_its_own_key_psd_takes() {
    if !needs::minisign() {
        return;
    }
    let root = crate::stage::folder();
    let workspace = root.path();
    fs::write(workspace.join("plan.psd"), PLAN).unwrap();
    assert!(accepts(
        workspace,
        PSD,
        &["run", "plan.psd", "--out", "run"]
    ));
    assert!(accepts(
        workspace,
        "minisign",
        &["-G", "-W", "-p", "own.pub", "-s", "own.key"]
    ));
    assert!(accepts(
        workspace,
        "minisign",
        &["-Sm", "run/manifest.sha256", "-s", "own.key"]
    ));
    assert!(accepts(workspace, PSD, &["verify", "run"]));
    // Valid, but for none of the roles that the plan names.
    assert!(!accepts(
        workspace,
        PSD,
        &["verify", "run", "--key", "own.pub"]
    ));
    for role in ["Quality", "Prüfer"] {
        assert!(accepts(
            workspace,
            PSD,
            &["sign", "run", "--key", "own.key", "--role", role]
        ));
    }
    assert!(accepts(
        workspace,
        PSD,
        &["verify", "run", "--key", "own.pub"]
    ));
    flip(&workspace.join("run/manifest.sha256.minisig"), 100);
    assert!(!accepts(
        workspace,
        PSD,
        &["verify", "run", "--key", "own.pub"]
    ));
}
