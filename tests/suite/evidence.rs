//! Evidence as made and checked from a shell: keys, signatures, verification of a whole folder, amendments. A report is identical on
//! every machine.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::PathBuf;
use std::process::Stdio;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

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

/// A test on a rig whose protocol cannot tell an emulator from the machine: for psd it is a test of a specimen.
const TEST: &str = r#"plan "Evidence" {
  laboratory  = "Test House"
  address     = "1 Mill Lane"
  customer    = "Somebody Ltd"
  contact     = "test@example.org"
  specimen_id = "B-17"
  standard    = "SOP 17"
}

limits {
  displacement = -1 mm .. 12 mm
  force        = 5 kN
  speed        = 50 mm/s
}

rig bench {
  link          = serial(port: "PORT", dialect: instron, reply_timeout: 30 s)
  force_range   = 15 kN
  settle        = within(2 um, 50 kN/s, timeout: 10 min)
  safe_state    = hold
  pretest_check = probe(0.1 mm, stiffness: 250 kN/m .. 350 kN/m, zero: 2 N)
  speed         = 50 mm/s
  watchdog      = 300 s
  rate          = 200 Hz
  samples       = 1
  resolution    = 1 um
  calibration   = "UKAS 4711"
  calibration_due                = "2099-12-31"
  force_calibration_range        = 0 N .. 15 kN
  displacement_calibration_range = 0 mm .. 25 mm
}

specimen beam {
  mass      = 1 kg
  behaviour = elastic(stiffness: 300 kN/m)
}

stiffness ramp k0 {
  displacements = 0.25 mm .. 1 mm step 0.25 mm
  pause         = 0 s
  samples       = 1
}

require "stiff enough" k0.stiffness > 100 kN/m

report {
  figures = [force_displacement(k0)]
  formats = [html, csv]
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

/// A folder with a test in `run`.
fn with_test() -> Workspace {
    static RUN: LazyLock<Files> = LazyLock::new(|| tested(TEST).0);
    with(&RUN)
}

/// Output of a test of the plan, and what psd said.
fn tested(plan: &str) -> (Files, String) {
    let workspace = Workspace::new(&[]);
    let port = workspace.path("rig");
    workspace.write("plan.psd", plan.replace("PORT", port.to_str().unwrap()));
    let mut emulator = workspace
        .command(&["rig", "simulate", "plan.psd", "--rig", "bench", "--once"])
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let until = Instant::now() + Duration::from_mins(2);
    while port.symlink_metadata().is_err() {
        assert!(Instant::now() < until, "the emulator does not start");
        std::thread::sleep(Duration::from_millis(20));
    }
    let said = workspace.ends(
        0,
        &[
            "run",
            "plan.psd",
            "--rig",
            "bench",
            "--yes",
            "--operator",
            "A. Tester",
            "--out",
            "run",
        ],
    );
    let _ = emulator.kill();
    emulator.wait().unwrap();
    let files = every_file(workspace.folder())
        .into_iter()
        .filter(|(name, _)| name.starts_with("run"))
        .collect();
    (files, said)
}

/// The day that is so many days after today, by the clock of this machine, as in the run log.
fn day(after: i64) -> String {
    let now = jiff::Timestamp::now() + jiff::SignedDuration::from_hours(24 * after);
    now.strftime("%Y-%m-%d").to_string()
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
    let workspace = with_test();
    let today = day(0);
    let before = every_file(&workspace.path("run"));
    let amend = |run: &str, particular: &str, code| {
        let by = [
            "report",
            run,
            "--amend",
            "--by",
            "B. Editor",
            "--date",
            &today,
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
        &format!("B. Editor on {today}"),
        "Authorised by</dt><dd>B. Editor",
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
    let replaced = amended["issues"]["issues"][0]["replaces"].as_str().unwrap();
    assert!(replaced.starts_with(own["run_id"].as_str().unwrap()));
    assert_ne!(amended["issues"]["report_id"], replaced);
    assert!(
        own.get("issues").is_none()
            && own["procedures"] == amended["procedures"]
            && own["run_id"] == amended["run_id"]
    );
    for same in [
        "journal.psdj",
        "tables/k0.csv",
        "figures/k0_force_displacement.png",
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
    amend("run-amended-1", "customer=Fourth Ltd", 0);
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
        ("authorised_by=X", "--by NAME"),
        ("customer=", "--set-particular customer="),
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
    let workspace = with_test();
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
    assert!(issue("run", &day(-3), &[], 2).contains("the test ended on"));
    assert!(
        issue(
            "run",
            &day(0),
            &["--set-particular", "issued=2026-06-03"],
            2
        )
        .contains("--date")
    );
    assert!(issue("run", "2026-02-30", &[], 2).contains("not a date"));
    for (particular, missing) in [
        ("customer=", "it lacks customer"),
        ("receipt_date=2199-01-01", "days in their order"),
    ] {
        let refused = issue("run", &day(0), &["--set-particular", particular], 2);
        assert!(
            refused.contains("cannot be issued") && refused.contains(missing),
            "{refused}"
        );
        assert!(!workspace.path("run-issued").exists(), "nothing is written");
    }
    let output = issue(
        "run",
        &day(0),
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
    let today = day(0);
    for stated in [
        today.as_str(),
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
            .contains(&format!("issued on {today} by Q. Head from report"))
    );

    // It is issued once. After that there are amendments, and each states its date.
    assert!(
        issue("run", &today, &["--out", "again"], 3).contains("delete its folder and issue again")
    );
    assert!(issue("run-issued", &day(1), &[], 2).contains(&format!("was issued on {today}")));
    // A day that is not there yet is taken with a remark.
    workspace.ends(0, &["keygen", "key", "--no-password"]);
    std::fs::rename(workspace.path("run-issued"), workspace.path("first")).unwrap();
    std::fs::remove_file(workspace.path("first/issue.json")).unwrap();
    assert!(issue("run", &day(400), &["--out", "late"], 0).contains("400 days after today"));
    std::fs::remove_dir_all(workspace.path("late")).unwrap();
    std::fs::remove_dir_all(workspace.path("first")).unwrap();
    issue("run", &today, &["--set-particular", "temperature=21 °C"], 0);
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
    assert!(amend(&day(-1), 2).contains(&format!("issued on {today}")));
    let tomorrow = day(1);
    amend(&tomorrow, 0);
    let page = fs::read_to_string(workspace.path("run-amended-1/report.html")).unwrap();
    assert!(
        page.contains("Amendment to report")
            && page.contains(&format!("issued (was “{today}”, is “{tomorrow}”)"))
            && page.contains("authorised by (was “Q. Head”, is “B. Editor”)"),
        "{page}"
    );
    for run in ["run-issued", "run-amended-1"] {
        for role in ["Quality", "Test engineer"] {
            workspace.ends(0, &["sign", run, "--key", "key", "--role", role]);
        }
        workspace.ends(0, &["verify", run, "--key", "key.pub"]);
    }
    let signature = workspace.read("run-issued/manifest.sha256.quality.minisig");
    assert!(
        signature.contains(&format!("\tstatus:issued\tissued:{today}\trole:Quality\t")),
        "{signature}"
    );
    let file = workspace.path("run-issued/issue.json");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("21 °C", "20 °C")).unwrap();
    workspace.ends(3, &["verify", "run-issued"]);
}

#[test]
fn what_is_no_test_report_is_not_issued() {
    let refused = |workspace: &Workspace, run: &str| {
        let issue = ["issue", run, "--authorised-by", "Q", "--date", &day(0)];
        let said = workspace.ends(2, &issue);
        assert!(
            said.contains(&format!("the report of {run} cannot be issued")),
            "{said}"
        );
        assert!(!workspace.path(format!("{run}-issued")).exists());
        said
    };
    assert!(refused(&with_run(), "run").contains("it is a simulation: no specimen was tested"));

    // Known before the test, shown after it, and not to be mended then; the customer can still be stated.
    let plan = TEST
        .replace("2099-12-31", "2020-01-31")
        .replace("  customer    = \"Somebody Ltd\"\n", "");
    let (files, said) = tested(&plan);
    assert!(
        said.contains("W707") && said.contains("its calibration was due on 2020-01-31"),
        "{said}"
    );
    assert!(
        said.contains("(NOT ISSUABLE: lacks a valid calibration (due 2020-01-31, test ended "),
        "{said}"
    );
    let workspace = with(&files);
    let page = workspace.read("run/report.html");
    assert!(page.contains("NOT ISSUABLE: requirement met") && !page.contains("\"verdict pass\""));
    let said = refused(&workspace, "run");
    assert!(
        said.contains("which cannot be added after the test; it lacks customer")
            && said.contains("--set-particular customer="),
        "{said}"
    );
}
