//! Evidence as made and checked from a shell: keys, signatures, verification of a whole folder, amendments. A report is identical on
//! every machine.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::sync::LazyLock;

use crate::cli::every_file;

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

struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    /// A folder with a run in `run`, as a page and as tables.
    fn new() -> Self {
        static RUN: LazyLock<Files> = LazyLock::new(|| {
            Bench::made(&PLAN.replace(
                "formats = [html, csv, parquet, pdf]",
                "formats = [html, csv, parquet]",
            ))
        });
        Self::of(&RUN)
    }

    /// The same with a PDF, which takes longer.
    fn with_paper() -> Self {
        static RUN: LazyLock<Files> = LazyLock::new(|| Bench::made(PLAN));
        Self::of(&RUN)
    }

    /// Output of a run of the plan, with the plan.
    fn made(plan: &str) -> Files {
        let bench = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        fs::write(bench.path("plan.psd"), plan).unwrap();
        bench.ends(0, &["run", "plan.psd", "--out", "run"]);
        every_file(bench.folder.path())
    }

    fn of(files: &Files) -> Self {
        let bench = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        for (name, bytes) in files {
            let path = bench.folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        }
        bench
    }

    fn path(&self, path: &str) -> PathBuf {
        self.folder.path().join(path)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_psd"));
        command
            .args(arguments)
            .current_dir(self.folder.path())
            .stdin(Stdio::null());
        command
    }

    /// All output of the program.
    #[track_caller]
    fn ends(&self, code: i32, arguments: &[&str]) -> String {
        let Output {
            status,
            stdout,
            stderr,
        } = self.command(arguments).output().unwrap();
        let said = String::from_utf8(stdout).unwrap() + &String::from_utf8(stderr).unwrap();
        assert_eq!(status.code(), Some(code), "{arguments:?}\n{said}");
        said
    }

    /// Every file of a folder but its manifest, and their names.
    fn files(&self, folder: &str) -> Vec<(String, Vec<u8>)> {
        let mut found = Vec::new();
        let mut open = vec![self.path(folder)];
        while let Some(next) = open.pop() {
            for entry in fs::read_dir(next).unwrap().map(Result::unwrap) {
                if entry.path().is_dir() {
                    open.push(entry.path());
                } else {
                    let name = entry
                        .path()
                        .strip_prefix(self.path(folder))
                        .unwrap()
                        .display()
                        .to_string();
                    found.push((name, fs::read(entry.path()).unwrap()));
                }
            }
        }
        found.sort();
        found
    }
}

#[test]
fn a_folder_is_signed_in_each_role_once_and_proven_with_the_keys() {
    let bench = Bench::with_paper();
    bench.ends(0, &["keygen", "mine", "--no-password"]);
    assert!(
        bench
            .ends(0, &["keygen", "yours", "--no-password"])
            .contains("has no password")
    );
    assert_eq!(
        fs::metadata(bench.path("mine"))
            .unwrap()
            .permissions()
            .mode()
            & 0o777,
        0o600
    );
    assert!(
        bench
            .ends(3, &["keygen", "mine", "--no-password"])
            .contains("mine"),
        "no key is overwritten"
    );
    fs::remove_file(bench.path("mine.pub")).unwrap();
    bench.ends(3, &["keygen", "mine", "--no-password"]);
    assert!(
        !bench.path("mine.pub").exists(),
        "no public key without its secret one"
    );
    fs::remove_file(bench.path("mine")).unwrap();
    assert!(
        !bench
            .ends(0, &["keygen", "mine", "--no-password"])
            .contains("chmod")
    );
    fs::set_permissions(bench.path("mine"), fs::Permissions::from_mode(0o644)).unwrap();

    assert!(bench.ends(0, &["verify", "run"]).contains("unsigned"));
    bench.ends(3, &["verify", "run", "--key", "mine.pub"]);
    assert!(
        bench
            .ends(2, &["sign", "run", "--key", "mine"])
            .contains("`Test engineer`, `Quality`")
    );
    assert!(
        bench
            .ends(2, &["sign", "run", "--key", "mine", "--role", "Cook"])
            .contains("the plan has no role")
    );
    let signed = bench.ends(
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
        bench
            .ends(3, &["sign", "run", "--key", "yours", "--role", "Quality"])
            .contains("never overwritten")
    );
    bench.ends(
        0,
        &["sign", "run", "--key", "yours", "--role", "Test engineer"],
    );

    let said = bench.ends(
        0,
        &["verify", "run", "--key", "mine.pub", "--key", "yours.pub"],
    );
    assert!(
        said.contains("good by A. Engineer, Quality, key") && said.contains("of `yours.pub`"),
        "{said}"
    );
    bench.ends(0, &["verify", "run"]);
    let said = bench.ends(3, &["verify", "run", "--key", "mine.pub"]);
    assert!(said.contains("not one of the named keys"), "{said}");
    fs::remove_file(bench.path("run/manifest.sha256.quality.minisig")).unwrap();
    bench.ends(
        3,
        &["verify", "run", "--key", "mine.pub", "--key", "yours.pub"],
    );
}

#[test]
fn a_key_has_its_password_and_never_lies_in_the_folder() {
    let bench = Bench::new();
    fs::write(bench.path("password"), "correct horse\n").unwrap();
    fs::write(bench.path("wrong"), "battery staple\n").unwrap();
    bench.ends(0, &["keygen", "key", "--password-file", "password"]);
    let sign = |more: &[&str], code| {
        bench.ends(
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
        bench
            .ends(3, &["keygen", "run/key", "--no-password"])
            .contains("must not lie in the run folder")
    );
    assert!(
        bench
            .ends(3, &["keygen", "run/tables/key", "--no-password"])
            .contains("must not lie in the run folder")
    );
    fs::rename(bench.path("key"), bench.path("run/key")).unwrap();
    assert!(
        sign(&["--key", "run/key", "--password-file", "password"], 3)
            .contains("must not lie in the run folder")
    );
}

#[test]
fn what_does_not_verify_is_neither_signed_nor_amended_and_the_part_is_named() {
    let bench = Bench::new();
    bench.ends(0, &["keygen", "key", "--no-password"]);
    for (file, part) in [
        ("summary.json", "results"),
        ("tables/hit.csv", "results"),
        ("figures/hit_displacement.png", "figures"),
        ("report.html", "report"),
        ("plan/plan.psd", "plan"),
        ("manifest.sha256", "manifest"),
        ("journal.psdj", "record"),
    ] {
        let path = bench.path("run").join(file);
        let own = fs::read(&path).unwrap();
        let mut changed = own.clone();
        changed[own.len() / 2] ^= 1;
        fs::write(&path, changed).unwrap();
        let said = bench.ends(3, &["verify", "run"]);
        let wrong: Vec<&str> = said.lines().filter(|line| line.contains("WRONG")).collect();
        assert!(
            wrong.iter().any(|line| line.trim().starts_with(part)),
            "{file}:\n{said}"
        );
        if file == "tables/hit.csv" {
            let said = bench.ends(3, &["sign", "run", "--key", "key", "--role", "Quality"]);
            assert!(said.contains("does not verify"), "{said}");
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
            assert!(bench.ends(3, &amend).contains("does not verify"));
        }
        fs::write(&path, own).unwrap();
    }
    fs::write(bench.path("run/more.txt"), "").unwrap();
    assert!(
        bench
            .ends(3, &["verify", "run"])
            .contains("`more.txt` is not in the manifest")
    );
    fs::remove_file(bench.path("run/more.txt")).unwrap();
    fs::remove_file(bench.path("run/manifest.sha256")).unwrap();
    assert!(
        bench
            .ends(3, &["verify", "run"])
            .contains("there are results, but no manifest")
    );
}

#[test]
fn a_report_is_the_same_at_any_place_and_time() {
    let bench = Bench::with_paper();
    let own = bench.files("run");
    fs::create_dir(bench.path("elsewhere")).unwrap();
    let run = bench.path("run").canonicalize().unwrap();
    for (at, (zone, language)) in [
        ("Pacific/Kiritimati", "de_DE.UTF-8"),
        ("America/St_Johns", "C"),
        ("", "tr_TR"),
    ]
    .iter()
    .enumerate()
    {
        let out = format!("again-{at}");
        let mut command = bench.command(&[
            "report",
            run.to_str().unwrap(),
            "--out",
            &format!("../{out}"),
        ]);
        command
            .current_dir(bench.path("elsewhere"))
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
        let again = bench.files(&out);
        assert!(again == own, "{zone} {language}");
    }
}

#[test]
fn an_amendment_is_a_report_of_its_own_and_both_are_kept() {
    let bench = Bench::new();
    let before = bench.files("run");
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
        bench.ends(code, &[&by[..], &["--set-particular", particular]].concat())
    };
    let said = amend("run", "customer=Somebody & Sons", 0);
    assert!(
        said.contains("run-amended-1") && said.contains("replaces report"),
        "{said}"
    );
    assert!(
        bench.files("run") == before,
        "the report that is replaced stays as it is"
    );
    let page = fs::read_to_string(bench.path("run-amended-1/report.html")).unwrap();
    for told in [
        "Amendment to report",
        "B. Editor on 2026-06-12",
        "the name was wrong",
        "Somebody &amp; Sons",
        "Somebody Ltd",
    ] {
        assert!(page.contains(told), "{told}");
    }
    let json = |path: &str| -> serde_json::Value {
        serde_json::from_slice(&fs::read(bench.path(path)).unwrap()).unwrap()
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
            fs::read(bench.path("run").join(same)).unwrap()
                == fs::read(bench.path("run-amended-1").join(same)).unwrap()
        );
    }
    assert!(
        bench
            .ends(0, &["verify", "run-amended-1"])
            .contains("amends report")
    );
    // Each report is replaced by exactly one other report.
    assert!(amend("run", "customer=Third Ltd", 3).contains("has already been replaced"));
    assert!(!bench.path("run-amended-2").exists());

    // An amendment may be amended; the chain of reports is stated.
    amend("run-amended-1", "customer=", 0);
    let last = json("run-amended-2/summary.json");
    assert_eq!(
        last["issues"]["issues"][1]["replaces"],
        amended["issues"]["report_id"]
    );
    bench.ends(0, &["verify", "run-amended-2"]);
    bench.ends(0, &["keygen", "key", "--no-password"]);
    bench.ends(
        0,
        &["sign", "run-amended-2", "--key", "key", "--role", "Quality"],
    );
    assert!(
        bench
            .ends(0, &["verify", "run-amended-2"])
            .contains("Test engineer has not signed")
    );
    assert!(
        bench
            .ends(3, &["verify", "run-amended-2", "--key", "key.pub"])
            .contains("Test engineer has not signed")
    );
    bench.ends(
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
    bench.ends(0, &["verify", "run-amended-2", "--key", "key.pub"]);
    let signature = fs::read(bench.path("run-amended-2/manifest.sha256.quality.minisig")).unwrap();
    fs::write(bench.path("run/manifest.sha256.quality.minisig"), signature).unwrap();
    bench.ends(3, &["verify", "run", "--key", "key.pub"]);

    // The measured data and their dates are not particulars.
    for (particular, told) in [
        ("date=2020-01-01", "logged date"),
        ("custumer=X", "did you mean `customer`?"),
        ("title=X", "not a particular"),
    ] {
        let said = amend("run-amended-2", particular, 2);
        assert!(said.contains(told), "{said}");
    }
    let file = bench.path("run-amended-2/issue.json");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("the name was wrong", "no reason")).unwrap();
    bench.ends(3, &["verify", "run-amended-2"]);
}

#[test]
fn an_issue_states_what_is_known_after_the_test_and_is_no_amendment() {
    let bench = Bench::new();
    let before = bench.files("run");
    let issue = |run: &str, date: &str, more: &[&str], code| {
        bench.ends(
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
    let said = issue(
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
        said.contains("run-issued") && said.contains("issues report"),
        "{said}"
    );
    assert!(bench.files("run") == before, "the run stays as it is");

    let page = fs::read_to_string(bench.path("run-issued/report.html")).unwrap();
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
        serde_json::from_slice(&fs::read(bench.path(path)).unwrap()).unwrap()
    };
    let (own, issued) = (json("run/summary.json"), json("run-issued/summary.json"));
    assert_eq!(issued["issues"]["issues"][0]["kind"], "issue");
    assert!(own["procedures"] == issued["procedures"] && own["run_id"] == issued["run_id"]);
    assert!(
        bench
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
        bench.ends(
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
    let page = fs::read_to_string(bench.path("run-amended-1/report.html")).unwrap();
    assert!(
        page.contains("Amendment to report")
            && page.contains("issued (was “2026-06-02”, is “2026-06-12”)"),
        "{page}"
    );
    bench.ends(0, &["keygen", "key", "--no-password"]);
    for run in ["run-issued", "run-amended-1"] {
        for role in ["Quality", "Test engineer"] {
            bench.ends(0, &["sign", run, "--key", "key", "--role", role]);
        }
        bench.ends(0, &["verify", run, "--key", "key.pub"]);
    }
    let file = bench.path("run-issued/issue.json");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("21 °C", "20 °C")).unwrap();
    bench.ends(3, &["verify", "run-issued"]);
}
