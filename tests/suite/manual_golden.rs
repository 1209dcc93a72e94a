//! Checks of the page of golden tests: its commands and options exist, its plan runs and gives the results of the page.

use std::fs;
use std::path::Path;
use std::process::Command;

use psd::check::{Options, check, no_files};
use psd::procedures::columns;
use psd_plan::schema;

fn page() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/golden.md"))
        .expect("the page is there")
}

fn blocks(language: &str) -> Vec<String> {
    let page = page();
    let fence = format!("```{language}\n");
    page.split(&fence)
        .skip(1)
        .map(|after| after.split("```").next().unwrap_or_default().to_owned())
        .collect()
}

fn help(command: &str) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_psd"))
        .args([command, "--help"])
        .output()
        .expect("psd starts");
    assert!(output.status.success(), "psd {command} is no command");
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[test]
fn every_command_of_the_page_is_one_with_these_options() {
    let lines: Vec<String> = [blocks("sh"), blocks("yaml")]
        .concat()
        .iter()
        .flat_map(|block| block.lines().map(str::to_owned).collect::<Vec<_>>())
        .collect();
    let commands: Vec<&str> = lines
        .iter()
        .filter_map(|line| {
            line.trim()
                .trim_start_matches("- run: ")
                .strip_prefix("psd ")
        })
        .collect();
    assert!(commands.len() >= 7, "{commands:?}");
    for command in commands {
        let command = command.split('#').next().unwrap_or_default();
        let (name, words) = command.split_once(' ').expect("a command and its words");
        let help = help(name);
        for option in words
            .split_whitespace()
            .filter(|word| word.starts_with("--"))
        {
            assert!(help.contains(option), "psd {name} has no {option}");
        }
    }
    let page = page();
    let help = help("test");
    let table = page
        .split("## Options")
        .nth(1)
        .and_then(|after| after.split("Exit codes").next())
        .expect("the options");
    let listed: Vec<&str> = table
        .lines()
        .filter_map(|line| line.strip_prefix("| `"))
        .map(|line| line.split([' ', '`']).next().unwrap())
        .collect();
    for option in &listed {
        assert!(help.contains(option), "psd test has no {option}");
    }
    let known = [
        "--golden",
        "--accept",
        "--filter",
        "--list",
        "--jobs",
        "--fail-fast",
        "--out",
        "--junit",
        "--tap",
        "--format",
    ];
    assert_eq!(listed, known, "every option of psd test is on the page");
    assert!(help.matches("\n      --").count() >= known.len());
}

#[test]
fn the_plan_of_the_page_checks_and_its_tolerances_are_read() {
    let [plan] = &blocks("psd")[..] else {
        panic!("one plan")
    };
    let checked = check("golden.psd", plan, &no_files, &Options::default());
    assert!(checked.diagnostics.is_empty(), "{:?}", checked.diagnostics);
    let golden = checked.plan.expect("it checks").golden;
    assert_eq!(
        (golden.tolerance, golden.results.len(), golden.columns.len()),
        (1e-9, 2, 2)
    );
}

/// Every table of an accepted report has the columns of the schema, and all number columns are present.
#[test]
fn the_columns_of_the_tables_are_those_of_the_schema() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut seen = 0;
    for plan in fs::read_dir(root.join("plans"))
        .expect("plans/")
        .map(|entry| entry.expect("readable").path())
    {
        let (Some(name), Some("psd")) =
            (plan.file_stem(), plan.extension().and_then(|e| e.to_str()))
        else {
            continue;
        };
        let folder = root.join("reports").join(name).join("tables");
        let Ok(tables) = fs::read_dir(folder) else {
            continue;
        };
        let summary: serde_json::Value = serde_json::from_str(
            &fs::read_to_string(root.join("reports").join(name).join("summary.json"))
                .expect("a summary"),
        )
        .expect("JSON");
        for table in tables.map(|entry| entry.expect("readable").path()) {
            let stem = table.file_stem().unwrap().to_string_lossy().into_owned();
            let procedures = summary["procedures"].as_object().expect("procedures");
            let owner = procedures.iter().find(|(name, _)| {
                stem == **name
                    || stem
                        .strip_prefix(name.as_str())
                        .is_some_and(|rest| rest.starts_with('_'))
            });
            let Some((_, owner)) = owner else {
                // The zero readings of the rig do not belong to a procedure.
                assert!(
                    stem == "zero_drift" && summary["zero_drift"].is_object(),
                    "{}: a table has its procedure",
                    table.display()
                );
                continue;
            };
            // The readings of the axial axes have one table, beside that of any procedure.
            let own = owner["kind"].as_str().expect("a kind");
            let kind = if stem.ends_with("_axial") {
                "preload"
            } else {
                own
            };
            let words: Vec<&str> = kind.split(' ').collect();
            let known: Vec<_> =
                columns(schema::block_of_words(&words).expect("a block").kind).collect();
            let text = fs::read_to_string(&table).expect("readable");
            let mut lines = text.lines();
            let names: Vec<&str> = lines.next().expect("a head").split(',').collect();
            let cells: Vec<&str> = lines.next().expect("a row").split(',').collect();
            for (name, cell) in names
                .iter()
                .zip(cells)
                .filter(|(_, cell)| cell.parse::<f64>().is_ok())
            {
                assert!(
                    known.iter().any(|column| column.name == *name),
                    "{}: `{name}` ({cell}) is in no list of columns of src/procedures",
                    table.display()
                );
                seen += 1;
            }
        }
    }
    assert!(seen > 50, "the reports have tables");
}
