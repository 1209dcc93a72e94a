//! Several plans, folders and standard input on one command line.

use std::io::Write as _;
use std::process::Stdio;

use super::workspace::{Ended, Workspace};

/// A plan that passes, without pictures.
const SOUND: &str = r#"specimen beam {
  mass      = 1 kg
  behaviour = elastic(stiffness: 327.65 N/m)
}

striker hammer {
  mass     = 10 kg
  velocity = 1 m/s
}

limits {
  displacement = -0.1 m .. 0.2 m
}

impact hit {
  striker   = hammer
  time_step = 10 ms
  duration  = 1 s
}

require "stays in travel" hit.max_displacement < 0.16 m

report {
  figures = []
  formats = [csv]
}
"#;

fn changed(from: &str, to: &str) -> String {
    assert!(SOUND.contains(from));
    SOUND.replace(from, to)
}

impl Workspace {
    /// Runs the program with this text on standard input.
    fn fed(&self, arguments: &[&str], text: &str) -> Ended {
        let mut command = self.command(arguments);
        command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut stdin = child.stdin.take().unwrap();
        // A command that refuses its arguments ends without reading.
        let _ = stdin.write_all(text.as_bytes());
        drop(stdin);
        child.wait_with_output().unwrap().into()
    }
}

#[test]
fn a_plan_from_standard_input_is_a_plan() {
    let workspace = Workspace::new(&[("lib/hammer.psd", "striker hammer { mass = 1 kg }\n")]);
    let untidy = changed("  mass      = 1 kg", "      mass=1 kg");
    assert_eq!(workspace.fed(&["fmt", "-"], &untidy).with(0).stdout, SOUND);
    let difference = workspace.fed(&["fmt", "--check", "-"], &untidy).with(1);
    assert!(difference.stdout.contains("+  mass      = 1 kg"));
    let wrong = workspace.fed(&["check", "-"], "let a = b\n").with(2).stderr;
    assert!(wrong.contains("stdin.psd:1:9"), "{wrong}");
    let folder = workspace.fed(&["run", "-"], SOUND).with(0).stdout;
    assert_eq!(folder, "runs/stdin-1\n");
    let verified = workspace.fed(&["verify", "-"], &folder).with(0).stdout;
    assert!(verified.ends_with("VERIFIED  runs/stdin-1\n"), "{verified}");
    let used = "use \"lib/hammer.psd\"\n".to_owned() + &changed("striker hammer", "striker other");
    workspace.fed(&["check", "-"], &used).with(2);
    let accepted = workspace.fed(&["test", "-"], SOUND).with(2).stderr;
    assert!(accepted.contains("has no accepted results"), "{accepted}");
}

#[test]
fn check_takes_a_folder_with_its_libraries() {
    let hammer = "striker hammer {\n  mass     = 10 kg\n  velocity = 1 m/s\n}\n";
    let using = format!("use \"lib/hammer.psd\"\n\n{}", SOUND.replace(hammer, ""));
    let workspace = Workspace::new(&[
        ("plans/a.psd", &using),
        ("plans/b.psd", SOUND),
        ("plans/lib/hammer.psd", hammer),
    ]);
    let found = workspace.psd(&["check", "plans"]).with(0).stderr;
    assert_eq!(
        found,
        "plans/a.psd: no errors found in the plan\nplans/b.psd: no errors found in the plan\n",
        "a library is a part of the plan that uses it"
    );
    let named = workspace.psd(&["check", "plans/lib/hammer.psd", "--deny-warnings"]);
    assert!(named.with(2).stderr.contains("W705"));
    workspace
        .psd(&["check", "plans", "--deny-warnings"])
        .with(0);
    std::fs::create_dir(workspace.path("empty")).unwrap();
    let none = workspace.psd(&["check", "empty"]).with(2).stderr;
    assert!(none.contains("no plan in empty"), "{none}");
}

#[test]
fn check_runs_the_plan_and_tries_every_rig() {
    let stops = changed(".. 0.2 m", ".. 0.1 m");
    let rig = r#"
rig bench {
  link          = serial(port: "/dev/ttyUSB0", dialect: native)
  settle        = within(0.01 mm, 5 N/s, for: 0.3 s, timeout: 10 s)
  safe_state    = hold
  pretest_check = probe(2 mm, stiffness: 300 N/m .. 350 N/m, zero: 0.5 N)
  resolution    = 1 um
}
"#;
    let bench = SOUND.to_owned() + rig;
    let workspace = Workspace::new(&[("stops.psd", &stops), ("bench.psd", &bench)]);
    let stops = workspace.psd(&["check", "stops.psd"]).with(0).stderr;
    assert!(
        stops.contains("W740") && stops.contains("would be stopped in `hit`, step"),
        "{stops}"
    );
    let json = workspace.psd(&["check", "--format", "json", "--explain", "stops.psd"]);
    let json = json.with(4).json();
    let predicted = &json["predictions"][0];
    assert_eq!(
        (&json["warnings"], &predicted["plan"]),
        (&1.into(), &"stops.psd".into())
    );
    assert_eq!(predicted["prediction"]["procedures"][0]["name"], "hit");
    let bench = workspace.psd(&["check", "bench.psd"]).with(2).stderr;
    assert!(
        bench.contains("on a real rig (with `--rig bench`)"),
        "{bench}"
    );
    workspace
        .psd(&["check", "bench.psd", "--rig", "ideal"])
        .with(0);
    workspace.psd(&["run", "bench.psd"]).with(0);
}

#[test]
fn several_plans_run_one_after_the_other_or_together() {
    let misses = changed("< 0.16 m", "< 0.1 m");
    let wrong = changed("10 kg", "10 mm");
    let workspace = Workspace::new(&[
        ("plans/1.psd", SOUND),
        ("plans/2.psd", &misses),
        ("plans/3.psd", &wrong),
        ("plans/lib/4.psd", "let a = 1\n"),
    ]);
    let table = "
  PASS                        plans/1.psd  runs/1-1
  FAIL                        plans/2.psd  runs/2-1
  not run: error in the plan  plans/3.psd
1 of 3 plans meet all requirements
";
    let one = workspace.psd(&["run", "plans"]).with(2);
    assert_eq!(one.stdout, "runs/1-1\nruns/2-1\n");
    assert!(one.stderr.ends_with(table), "{}", one.stderr);
    let together = workspace.psd(&["run", "plans", "--jobs", "3"]).with(2);
    let table = table.replace("/1-1", "/1-2").replace("/2-1", "/2-2");
    assert!(together.stderr.ends_with(&table), "{}", together.stderr);
    workspace.psd(&["run", "plans", "--out", "here"]).with(2);
    let rig = ["run", "plans", "--jobs", "2", "--rig", "ideal"];
    assert!(workspace.psd(&rig).with(2).stderr.contains("--rig"));

    let verified = workspace.psd(&["verify", "runs"]).with(0).stdout;
    assert_eq!(verified.matches("\nVERIFIED  runs/").count(), 4);
    workspace.write("runs/1-1/plan.psd", "");
    let altered = workspace.psd(&["verify", "runs/1-1", "runs/2-1"]).with(3);
    assert!(
        altered.stdout.contains("\nNOT VERIFIED  runs/1-1\n")
            && altered.stdout.ends_with("\nVERIFIED  runs/2-1\n"),
        "{}",
        altered.stdout
    );
}
