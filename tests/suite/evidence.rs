//! Evidence as made and checked from a shell: keys, signatures, verification of a whole folder, amendments. A report is identical on
//! every machine.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::PathBuf;
use std::sync::LazyLock;

use super::workspace::{Workspace, every_file};

const PLAN: &str = r#"plan "Evidence" {
  customer = "Somebody Ltd"
  date     = "2026-05-31"
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
  duration  = 400 ms
}

require "stays in travel" hit.max_displacement < 0.16 m

report {
  figures = [displacement(hit)]
  formats = [html, csv, parquet, pdf]
  sign    = ["Test engineer", "Quality"]
}
"#;

/// Files by their paths, with their bytes.
type Files = Vec<(PathBuf, Vec<u8>)>;

/// A folder with a run in `run`, as a page and as tables.
fn with_run() -> Workspace {
    static RUN: LazyLock<Files> = LazyLock::new(|| {
        made(&PLAN.replace(
            "formats = [html, csv, parquet, pdf]",
            "formats = [html, csv, parquet]",
        ))
    });
    with(&RUN)
}

/// The same with a PDF, which takes longer.
fn with_paper() -> Workspace {
    static RUN: LazyLock<Files> = LazyLock::new(|| made(PLAN));
    with(&RUN)
}

fn with(files: &Files) -> Workspace {
    let workspace = Workspace::new(&[]);
    for (name, bytes) in files {
        workspace.write(name, bytes);
    }
    workspace
}

/// Output of a run of the plan, with the plan.
fn made(plan: &str) -> Files {
    let workspace = Workspace::new(&[("plan.psd", plan)]);
    workspace.ends(0, &["run", "plan.psd", "--out", "run"]);
    every_file(workspace.folder())
}

#[test]
fn a_folder_is_signed_in_each_role_once_and_proven_with_the_keys() {
    let workspace = with_paper();
    workspace.ends(0, &["keygen", "mine", "--no-password"]);
    assert!(
        workspace
            .ends(0, &["keygen", "yours", "--no-password"])
            .contains("has no password")
    );
    assert_eq!(
        fs::metadata(workspace.path("mine"))
            .unwrap()
            .permissions()
            .mode()
            & 0o777,
        0o600
    );
    assert!(
        workspace
            .ends(3, &["keygen", "mine", "--no-password"])
            .contains("mine"),
        "no key is overwritten"
    );
    fs::remove_file(workspace.path("mine.pub")).unwrap();
    workspace.ends(3, &["keygen", "mine", "--no-password"]);
    assert!(
        !workspace.path("mine.pub").exists(),
        "no public key without its secret one"
    );
    fs::remove_file(workspace.path("mine")).unwrap();
    assert!(
        !workspace
            .ends(0, &["keygen", "mine", "--no-password"])
            .contains("chmod")
    );
    fs::set_permissions(workspace.path("mine"), fs::Permissions::from_mode(0o644)).unwrap();

    assert!(workspace.ends(0, &["verify", "run"]).contains("unsigned"));
    workspace.ends(3, &["verify", "run", "--key", "mine.pub"]);
    assert!(
        workspace
            .ends(2, &["sign", "run", "--key", "mine"])
            .contains("`Test engineer`, `Quality`")
    );
    assert!(
        workspace
            .ends(2, &["sign", "run", "--key", "mine", "--role", "Cook"])
            .contains("the plan has no role")
    );
    let signed = workspace.ends(
        0,
        &[
            "sign",
            "run",
            "--key",
            "mine",
            "--role",
            "Quality",
            "--name",
            "A. Engineer",
        ],
    );
    assert!(
        signed.contains("run/manifest.sha256.quality.minisig"),
        "{signed}"
    );
    assert!(signed.contains("`chmod 600` prevents this"), "{signed}");
    assert!(
        workspace
            .ends(3, &["sign", "run", "--key", "yours", "--role", "Quality"])
            .contains("never overwritten")
    );
    workspace.ends(
        0,
        &["sign", "run", "--key", "yours", "--role", "Test engineer"],
    );

    let output = workspace.ends(
        0,
        &["verify", "run", "--key", "mine.pub", "--key", "yours.pub"],
    );
    assert!(
        output.contains("good by A. Engineer, Quality, key") && output.contains("of `yours.pub`"),
        "{output}"
    );
    workspace.ends(0, &["verify", "run"]);
    let output = workspace.ends(3, &["verify", "run", "--key", "mine.pub"]);
    assert!(output.contains("not one of the named keys"), "{output}");
    fs::remove_file(workspace.path("run/manifest.sha256.quality.minisig")).unwrap();
    workspace.ends(
        3,
        &["verify", "run", "--key", "mine.pub", "--key", "yours.pub"],
    );
}

#[test]
fn a_key_has_its_password_and_never_lies_in_the_folder() {
    let workspace = with_run();
    fs::write(workspace.path("password"), "correct horse\n").unwrap();
    fs::write(workspace.path("wrong"), "battery staple\n").unwrap();
    workspace.ends(0, &["keygen", "key", "--password-file", "password"]);
    let sign = |more: &[&str], code| {
        workspace.ends(
            code,
            &[&["sign", "run", "--role", "Quality"], more].concat(),
        )
    };
    assert!(
        sign(&["--key", "key"], 2).contains("--password-file"),
        "nobody can be asked here"
    );
    assert!(sign(&["--key", "key", "--password-file", "wrong"], 3).contains("Wrong password"));
    sign(&["--key", "key", "--password-file", "password"], 0);

    assert!(
        workspace
            .ends(3, &["keygen", "run/key", "--no-password"])
            .contains("must not lie in the run folder")
    );
    assert!(
        workspace
            .ends(3, &["keygen", "run/tables/key", "--no-password"])
            .contains("must not lie in the run folder")
    );
    fs::rename(workspace.path("key"), workspace.path("run/key")).unwrap();
    assert!(
        sign(&["--key", "run/key", "--password-file", "password"], 3)
            .contains("must not lie in the run folder")
    );
}

#[test]
fn what_does_not_verify_is_neither_signed_nor_amended_and_the_part_is_named() {
    let workspace = with_run();
    workspace.ends(0, &["keygen", "key", "--no-password"]);
    for (file, part) in [
        ("summary.json", "results"),
        ("tables/hit.csv", "results"),
        ("figures/hit_displacement.png", "figures"),
        ("report.html", "report"),
        ("plan/plan.psd", "plan"),
        ("manifest.sha256", "manifest"),
        ("journal.psdj", "record"),
    ] {
        let path = workspace.path("run").join(file);
        let own = fs::read(&path).unwrap();
        let mut changed = own.clone();
        changed[own.len() / 2] ^= 1;
        fs::write(&path, changed).unwrap();
        let output = workspace.ends(3, &["verify", "run"]);
        let wrong: Vec<&str> = output
            .lines()
            .filter(|line| line.contains("WRONG"))
            .collect();
        assert!(
            wrong.iter().any(|line| line.trim().starts_with(part)),
            "{file}:\n{output}"
        );
        if file == "tables/hit.csv" {
            let output = workspace.ends(3, &["sign", "run", "--key", "key", "--role", "Quality"]);
            assert!(output.contains("does not verify"), "{output}");
            let amend = [
                "report",
                "run",
                "--amend",
                "--by",
                "A",
                "--date",
                "2027-01-01",
                "--reason",
                "r",
                "--set-particular",
                "customer=B",
            ];
            assert!(workspace.ends(3, &amend).contains("does not verify"));
        }
        fs::write(&path, own).unwrap();
    }
    fs::write(workspace.path("run/more.txt"), "").unwrap();
    assert!(
        workspace
            .ends(3, &["verify", "run"])
            .contains("`more.txt` is not in the manifest")
    );
    fs::remove_file(workspace.path("run/more.txt")).unwrap();
    fs::remove_file(workspace.path("run/manifest.sha256")).unwrap();
    assert!(
        workspace
            .ends(3, &["verify", "run"])
            .contains("there are results, but no manifest")
    );
}

#[test]
fn a_report_is_the_same_in_any_folder_and_at_any_time() {
    let workspace = with_paper();
    let own = every_file(&workspace.path("run"));
    fs::create_dir(workspace.path("elsewhere")).unwrap();
    let run = workspace.path("run").canonicalize().unwrap();
    for (at, (zone, language)) in [
        ("Pacific/Kiritimati", "de_DE.UTF-8"),
        ("America/St_Johns", "C"),
        ("", "tr_TR"),
    ]
    .iter()
    .enumerate()
    {
        let out = format!("again-{at}");
        let mut command = workspace.command(&[
            "report",
            run.to_str().unwrap(),
            "--out",
            &format!("../{out}"),
        ]);
        command
            .current_dir(workspace.path("elsewhere"))
            .env("TZ", zone)
            .env("LANG", language)
            .env("LC_ALL", language);
        let ended = command
            .env("HOME", "/nonexistent")
            .env("COLUMNS", "40")
            .output()
            .unwrap();
        assert_eq!(
            ended.status.code(),
            Some(0),
            "{}",
            String::from_utf8_lossy(&ended.stderr)
        );
        let again = every_file(&workspace.path(&out));
        assert!(again == own, "{zone} {language}");
    }
}

#[test]
fn an_amendment_is_a_report_of_its_own_and_both_are_kept() {
    let workspace = with_run();
    let before = every_file(&workspace.path("run"));
    let amend = |run: &str, particular: &str, code| {
        let by = [
            "report",
            run,
            "--amend",
            "--by",
            "B. Editor",
            "--date",
            "2026-06-12",
            "--reason",
            "the name was wrong",
        ];
        workspace.ends(code, &[&by[..], &["--set-particular", particular]].concat())
    };
    let output = amend("run", "customer=Somebody & Sons", 0);
    assert!(
        output.contains("run-amended-1") && output.contains("replaces report"),
        "{output}"
    );
    assert!(
        every_file(&workspace.path("run")) == before,
        "the report that is replaced stays as it is"
    );
    let page = fs::read_to_string(workspace.path("run-amended-1/report.html")).unwrap();
    for expected in [
        "Amendment to report",
        "B. Editor on 2026-06-12",
        "the name was wrong",
        "Somebody &amp; Sons",
        "Somebody Ltd",
    ] {
        assert!(page.contains(expected), "{expected}");
    }
    let json = |path: &str| -> serde_json::Value {
        serde_json::from_slice(&fs::read(workspace.path(path)).unwrap()).unwrap()
    };
    let (own, amended) = (json("run/summary.json"), json("run-amended-1/summary.json"));
    assert_eq!(amended["issues"]["issues"][0]["replaces"], own["run_id"]);
    assert_ne!(amended["issues"]["report_id"], own["run_id"]);
    assert!(
        own.get("issues").is_none()
            && own["procedures"] == amended["procedures"]
            && own["run_id"] == amended["run_id"]
    );
    for same in [
        "journal.psdj",
        "tables/hit.csv",
        "tables/hit.parquet",
        "figures/hit_displacement.png",
        "plan/plan.psd",
    ] {
        assert!(
            fs::read(workspace.path("run").join(same)).unwrap()
                == fs::read(workspace.path("run-amended-1").join(same)).unwrap()
        );
    }
    assert!(
        workspace
            .ends(0, &["verify", "run-amended-1"])
            .contains("amends report")
    );
    // Each report is replaced by exactly one other report.
    assert!(amend("run", "customer=Third Ltd", 3).contains("has already been replaced"));
    assert!(!workspace.path("run-amended-2").exists());

    // An amendment may be amended; the chain of reports is stated.
    amend("run-amended-1", "customer=", 0);
    let last = json("run-amended-2/summary.json");
    assert_eq!(
        last["issues"]["issues"][1]["replaces"],
        amended["issues"]["report_id"]
    );
    workspace.ends(0, &["verify", "run-amended-2"]);
    workspace.ends(0, &["keygen", "key", "--no-password"]);
    workspace.ends(
        0,
        &["sign", "run-amended-2", "--key", "key", "--role", "Quality"],
    );
    assert!(
        workspace
            .ends(0, &["verify", "run-amended-2"])
            .contains("Test engineer has not signed")
    );
    assert!(
        workspace
            .ends(3, &["verify", "run-amended-2", "--key", "key.pub"])
            .contains("Test engineer has not signed")
    );
    workspace.ends(
        0,
        &[
            "sign",
            "run-amended-2",
            "--key",
            "key",
            "--role",
            "Test engineer",
        ],
    );
    workspace.ends(0, &["verify", "run-amended-2", "--key", "key.pub"]);
    let signature =
        fs::read(workspace.path("run-amended-2/manifest.sha256.quality.minisig")).unwrap();
    fs::write(
        workspace.path("run/manifest.sha256.quality.minisig"),
        signature,
    )
    .unwrap();
    workspace.ends(3, &["verify", "run", "--key", "key.pub"]);

    // The measured data and their dates are not particulars.
    for (particular, expected) in [
        ("date=2020-01-01", "logged date"),
        ("custumer=X", "did you mean `customer`?"),
        ("title=X", "not a particular"),
    ] {
        let output = amend("run-amended-2", particular, 2);
        assert!(output.contains(expected), "{output}");
    }
    let file = workspace.path("run-amended-2/issue.json");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("the name was wrong", "no reason")).unwrap();
    workspace.ends(3, &["verify", "run-amended-2"]);
}

#[test]
fn an_issue_states_what_is_known_after_the_test_and_is_no_amendment() {
    let workspace = with_run();
    let before = every_file(&workspace.path("run"));
    let issue = |run: &str, date: &str, more: &[&str], code| {
        workspace.ends(
            code,
            &[
                &["issue", run, "--authorised-by", "Q. Head", "--date", date],
                more,
            ]
            .concat(),
        )
    };
    assert!(issue("run", "2026-05-29", &[], 2).contains("the test ended on 2026-05-31"));
    assert!(
        issue(
            "run",
            "2026-06-02",
            &["--set-particular", "issued=2026-06-03"],
            2
        )
        .contains("--date")
    );
    assert!(issue("run", "2026-02-30", &[], 2).contains("not a date"));
    let output = issue(
        "run",
        "2026-06-02",
        &[
            "--set-particular",
            "temperature=21 °C",
            "--set-particular",
            "deviations=None",
        ],
        0,
    );
    assert!(
        output.contains("run-issued") && output.contains("issues report"),
        "{output}"
    );
    assert!(
        every_file(&workspace.path("run")) == before,
        "the run stays as it is"
    );

    let page = fs::read_to_string(workspace.path("run-issued/report.html")).unwrap();
    for stated in [
        "2026-06-02",
        "Q. Head",
        "21 °C",
        "stated after the test: temperature (was not given",
    ] {
        assert!(page.contains(stated), "{stated}");
    }
    assert!(
        !page.contains("Amendment") && !page.contains("no longer valid"),
        "a first issue amends nothing"
    );
    let json = |path: &str| -> serde_json::Value {
        serde_json::from_slice(&fs::read(workspace.path(path)).unwrap()).unwrap()
    };
    let (own, issued) = (json("run/summary.json"), json("run-issued/summary.json"));
    assert_eq!(issued["issues"]["issues"][0]["kind"], "issue");
    assert!(own["procedures"] == issued["procedures"] && own["run_id"] == issued["run_id"]);
    assert!(
        workspace
            .ends(0, &["verify", "run-issued"])
            .contains("issued on 2026-06-02 by Q. Head from report")
    );

    // It is issued once. After that there are amendments, and each states its date.
    assert!(
        issue("run", "2026-06-02", &["--out", "again"], 3).contains("has already been replaced")
    );
    assert!(issue("run-issued", "2026-06-03", &[], 2).contains("was issued on 2026-06-02"));
    let amend = |date: &str, code| {
        let by = [
            "report",
            "run-issued",
            "--amend",
            "--by",
            "B. Editor",
            "--reason",
            "a wrong name",
        ];
        workspace.ends(
            code,
            &[
                &by[..],
                &["--set-particular", "customer=Other", "--date", date],
            ]
            .concat(),
        )
    };
    assert!(amend("2026-06-01", 2).contains("issued on 2026-06-02"));
    amend("2026-06-12", 0);
    let page = fs::read_to_string(workspace.path("run-amended-1/report.html")).unwrap();
    assert!(
        page.contains("Amendment to report")
            && page.contains("issued (was “2026-06-02”, is “2026-06-12”)"),
        "{page}"
    );
    workspace.ends(0, &["keygen", "key", "--no-password"]);
    for run in ["run-issued", "run-amended-1"] {
        for role in ["Quality", "Test engineer"] {
            workspace.ends(0, &["sign", run, "--key", "key", "--role", role]);
        }
        workspace.ends(0, &["verify", run, "--key", "key.pub"]);
    }
    let file = workspace.path("run-issued/issue.json");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("21 °C", "20 °C")).unwrap();
    workspace.ends(3, &["verify", "run-issued"]);
}
