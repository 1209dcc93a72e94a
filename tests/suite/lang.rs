//! The language by example. A case of a check is on the page of its diagnostic (`page_cases`). Every plan of `tests/lang/STAGE/`
//! reaches the stage of its folder; the snapshot contains the plan and the output of psd. Such a case is one file. `# options: --set
//! "speed=2 m/s"` or `--rig NAME` in its first line is its command line.

mod annotated;
mod page_cases;

use psd::codes::E629;
use psd_language::codes::E504;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use super::source_text::files_in;
use page_cases::PAGE_CASES;
use psd::check::{Checked, Options, check};
use psd::run::{Unwatched, run};
use psd::verdict::{Assessment, Verdict, assess};
use psd_plan::record::{Outcome, Record};
use psd_plan::schema::{BLOCKS, Field, Kind, Presence, RigKind, Variant};
use psd_rig::virtual_rig;
use psd_text::diagnostic::render::{Appearance, render_all};
use psd_text::diagnostic::{Code, Diagnostic, Severity};
use psd_text::units::display::readable;

/// The stage at which a plan ends, and its exit code.
const STAGES: &[(&str, u8)] = &[
    ("ok", 0),
    ("syntax_error", 2),
    ("check_error", 2),
    ("blocked", 1),
    ("aborted", 4),
    ("fail", 1),
    ("faulted", 3),
];

/// Codes without a separate case, with the reason.
const WITHOUT_CASE: &[(Code, &str)] = &[
    (
        E504,
        "needs 64 files; the page of `psd explain` has the plan",
    ),
    (
        E629,
        "is of the machine; tests/system/disk.rs has a disk that is too small",
    ),
];

struct Case {
    stage: String,
    name: String,
    /// The name of the file: `name.psd`, or `name.md`.
    file: String,
    text: String,
    folder: PathBuf,
}

impl Case {
    fn read(path: &Path) -> Self {
        let folder = path
            .parent()
            .expect("a case lies in a folder")
            .to_path_buf();
        Self {
            stage: folder
                .file_name()
                .expect("the folder has a name")
                .to_string_lossy()
                .into_owned(),
            file: path
                .file_name()
                .expect("the case has a name")
                .to_string_lossy()
                .into_owned(),
            name: path
                .file_stem()
                .expect("the case has a name")
                .to_string_lossy()
                .into_owned(),
            text: fs::read_to_string(path).expect("the case is text"),
            folder,
        }
    }

    fn options(&self) -> Options {
        let mut options = Options::default();
        let given = self
            .text
            .lines()
            .next()
            .and_then(|line| line.strip_prefix("# options: --"))
            .unwrap_or_default();
        for given in given.split(" --").filter(|given| !given.is_empty()) {
            let (option, value) = given.split_once(' ').unwrap_or((given, ""));
            let value = value.trim().trim_matches('"');
            match option {
                "set" => {
                    let (name, value) = value
                        .split_once('=')
                        .expect("`--set` has a name and a value");
                    options.settings.push((name.to_owned(), value.to_owned()));
                }
                "rig" => options.rig = Some(value.to_owned()),
                // A run without an operator: `--yes`, and no `--operator`.
                "unattended" => options.unattended = true,
                other => panic!("{}: unknown option `{other}`", self.name),
            }
        }
        options
    }

    fn check(&self) -> Checked {
        check(
            &self.file,
            &self.text,
            &files_in(&self.folder),
            &self.options(),
        )
    }

    /// The code in the case's name: `e202_unknown_field`.
    fn code(&self) -> Option<Code> {
        let id = self.name.split('_').next()?.to_uppercase();
        psd::codes::all().into_iter().find(|code| code.id() == id)
    }
}

fn cases() -> Vec<Case> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lang");
    let mut found = Vec::new();
    for (stage, _) in STAGES {
        for entry in fs::read_dir(root.join(stage)).expect("every stage has its folder") {
            let path = entry.expect("the entry can be read").path();
            if path
                .extension()
                .is_some_and(|ending| ending == "psd" || ending == "md")
            {
                found.push(Case::read(&path));
            }
        }
    }
    found.sort_by(|a, b| (&a.stage, &a.name).cmp(&(&b.stage, &b.name)));
    found
}

/// How a run ended, and its verdict.
fn play(checked: &Checked) -> Option<(Record, Assessment)> {
    let plan = checked.plan.as_ref()?;
    let mut rig = virtual_rig(plan);
    let record = run(plan, rig.as_mut(), &mut Unwatched);
    let assessment = assess(plan, &record);
    Some((record, assessment))
}

fn exit_code(played: Option<&(Record, Assessment)>) -> u8 {
    match played.map(|(_, assessment)| assessment.verdict) {
        None => 2,
        Some(Verdict::Completed | Verdict::Pass) => 0,
        Some(Verdict::Fail | Verdict::Inconclusive) => 1,
        Some(Verdict::Error) => 3,
        Some(Verdict::Aborted) => 4,
    }
}

/// The events for the snapshot: the end of the run, then each condition with its actual value.
fn verdict_lines(record: &Record, assessment: &Assessment) -> String {
    let mut text = match &record.outcome {
        Outcome::Completed => "the run completed\n".to_owned(),
        Outcome::Aborted { reason } => format!("the run was aborted: {reason}\n"),
        Outcome::NotReleased { reason } => format!("the rig was not released: {reason}\n"),
        Outcome::Blocked { reason } => format!("the run could not go on: {reason}\n"),
        Outcome::Faulted { reason } => format!("the run failed: {reason}\n"),
    };
    for requirement in &assessment.requirements {
        let _ = writeln!(
            text,
            "{}: {}",
            requirement.verdict.name(),
            requirement.label
        );
        for condition in &requirement.conditions {
            let value = condition.value.map_or_else(
                || "none".to_owned(),
                |value| readable(value, condition.dimension),
            );
            let _ = write!(
                text,
                "  {}: {} = {value}",
                condition.verdict.name(),
                condition.text
            );
            let _ = writeln!(
                text,
                "{}",
                condition
                    .reason
                    .as_ref()
                    .map(|reason| format!(" ({reason})"))
                    .unwrap_or_default()
            );
        }
    }
    for compared in &assessment.reproductions {
        let difference = compared.difference().map_or_else(
            || "none".to_owned(),
            |difference| readable(difference, compared.compared.dimension),
        );
        let (statement, name) = (compared.statement(), &compared.name);
        let _ = writeln!(text, "{statement}: {name}, difference {difference}");
    }
    text
}

#[test]
fn cases_end_at_the_stage_of_their_folder_with_a_reason() {
    insta::glob!("../lang", "*/*.{psd,md}", |path| {
        let case = Case::read(path);
        let checked = case.check();
        let played = play(&checked);
        let mut text = format!("{}\n----\n", case.text.replace("\r\n", "\n").trim_end());
        text.push_str(&render_all(
            &checked.diagnostics,
            &checked.sources,
            &Appearance::plain(),
        ));
        if let Some((record, assessment)) = &played {
            text.push_str(&verdict_lines(record, assessment));
        }
        let exit = exit_code(played.as_ref());
        let _ = writeln!(text, "exit {exit}");
        insta::with_settings!({ omit_expression => true }, { insta::assert_snapshot!(text) });
        let (_, expected) = STAGES
            .iter()
            .find(|(stage, _)| *stage == case.stage)
            .expect("the folder is a stage");
        assert_eq!(exit, *expected, "{}/{}", case.stage, case.name);
    });
}

#[test]
fn a_case_named_after_a_code_gives_that_code_and_nothing_that_follows_from_it() {
    let mut faults = Vec::new();
    for case in cases() {
        let Some(code) = case.code() else { continue };
        let checked = case.check();
        let relevant = checked
            .diagnostics
            .iter()
            .filter(|it| code.severity() != Severity::Error || it.is_error());
        let given: Vec<Code> = relevant.map(|diagnostic| diagnostic.code).collect();
        if given != [code] {
            faults.push(format!("{}/{}: {given:?}", case.stage, case.name));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn syntax_faults_lie_in_their_folder_and_sound_plans_are_silent() {
    for case in cases() {
        let codes: Vec<Code> = case
            .check()
            .diagnostics
            .iter()
            .map(|diagnostic| diagnostic.code)
            .collect();
        let of_the_text = codes.iter().any(|code| code.id().starts_with("E1"));
        assert_eq!(
            of_the_text,
            case.stage == "syntax_error",
            "{}/{}: {codes:?}",
            case.stage,
            case.name
        );
        if case.stage == "ok" && case.code().is_none() {
            assert!(codes.is_empty(), "ok/{}: {codes:?}", case.name);
        }
    }
}

#[test]
fn every_code_has_a_case() {
    let cases = cases();
    for code in psd::codes::all() {
        let listed = WITHOUT_CASE.iter().any(|(without, _)| *without == code);
        let found = PAGE_CASES.iter().any(|case| case.code == code)
            || cases.iter().any(|case| case.code() == Some(code));
        assert!(
            found != listed,
            "{code}: {}",
            if found {
                "listed as without a case"
            } else {
                "no case on its page, and none in tests/lang"
            }
        );
    }
}

#[test]
fn line_ends_of_other_systems_are_tested() {
    let crlf = |case: &&Case| case.name == "crlf" && case.text.contains("\r\n");
    assert_eq!(
        cases().iter().filter(crlf).count(),
        3,
        "the line ends of tests/lang/*/crlf.psd were changed"
    );
}

/// The names of the cases without a required argument, including those of nested options.
fn argument_cases(field: &Field) -> Vec<String> {
    let of_variant = |variant: &'static Variant| {
        let required = variant
            .arguments
            .iter()
            .filter(|argument| argument.presence == Presence::Required);
        let own = required.map(|argument| format!("e213_{}_{}", variant.name, argument.name));
        own.chain(variant.arguments.iter().flat_map(argument_cases))
            .collect::<Vec<_>>()
    };
    field.ty.variants().iter().flat_map(of_variant).collect()
}

#[test]
fn every_required_field_and_argument_has_a_case() {
    let of_pages = PAGE_CASES.iter().map(|case| {
        let name = case.name.replace(' ', "_");
        format!("{}_{name}", case.code.id().to_lowercase())
    });
    let names: Vec<String> = cases()
        .into_iter()
        .map(|case| case.name)
        .chain(of_pages)
        .collect();
    let mut wanted = Vec::new();
    for block in BLOCKS {
        for field in block.fields {
            let words = block.words().replace(' ', "_");
            match field.presence {
                Presence::Required | Presence::RequiredOn(RigKind::Virtual, _) => {
                    wanted.push(format!("e209_{words}_{}", field.name));
                }
                Presence::RequiredOn(RigKind::Real, _) if block.kind == Kind::Rig => {
                    wanted.push(format!("e606_{words}_{}", field.name));
                }
                Presence::RequiredOn(RigKind::Real, _) => {
                    wanted.push(format!("e209_{words}_{}_on_a_real_rig", field.name));
                }
                Presence::Optional | Presence::Default { .. } | Presence::DefaultInWords(_) => {}
            }
            wanted.extend(argument_cases(field));
        }
    }
    assert!(wanted.len() > 25, "the schema has required fields");
    wanted.retain(|name| !names.contains(name));
    assert!(
        wanted.is_empty(),
        "no case, on the page of the code or in tests/lang, for: {}",
        wanted.join(", ")
    );
}

/// The real rigs of `plans/lib` are complete: a plan on each of them has no error. The plan of the beam moves its rig only if it is
/// named.
#[test]
fn the_rigs_of_the_library_are_sound() {
    let plans = Path::new(env!("CARGO_MANIFEST_DIR")).join("plans");
    let on = |text: &str, rig: Option<&str>| {
        let options = Options {
            rig: rig.map(str::to_owned),
            ..Options::default()
        };
        let checked = check("plan.psd", text, &files_in(&plans), &options);
        assert!(
            !checked.diagnostics.iter().any(Diagnostic::is_error),
            "{rig:?}: {:?}",
            checked.diagnostics
        );
        checked.plan.expect("no error stands").rig
    };
    let text = "use \"lib/bench_rig.psd\"\nspecimen beam { mass = 1 kg }\nmove out { to = 1 mm }\n";
    for (rig, dialects) in [
        ("native_frame", ("native", None)),
        ("stepper_frame", ("grbl", Some("hx711"))),
        ("laboratory_frame", ("nees", None)),
    ] {
        let chosen = on(text, Some(rig));
        let link = chosen.link.as_real().expect("a real rig");
        let cell = link.load_cell.as_ref().map(|cell| cell.dialect.name());
        assert_eq!((link.actuator.dialect.name(), cell), dialects);
    }
    let beam = fs::read_to_string(plans.join("beam.psd")).expect("the plan is there");
    assert_eq!(on(&beam, None).name, "simulated");
    assert_eq!(
        on(&beam, Some("bench"))
            .link
            .as_real()
            .map(|link| link.actuator.port.to_string()),
        Some("/tmp/psd-bench".to_owned())
    );
}

#[test]
fn every_block_has_a_case_that_is_right() {
    let cases = cases();
    for block in BLOCKS {
        let head = format!("{} ", block.words());
        let found = cases.iter().any(|case| {
            case.stage == "ok" && case.text.lines().any(|line| line.starts_with(&head))
        });
        assert!(
            found,
            "no case in tests/lang/ok has a `{}` block",
            block.words()
        );
    }
}
