//! The PDF of the test report, read by independent programs: `qpdf` checks the file, `pdftotext` extracts its text. The plans
//! run as a user runs them, on simulated rigs.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::needs;
use super::stage::PSD;

/// All characters of a string that could be read as markup, and letters that are in no font of the report.
const HOSTILE: &str = "#panic() $x$ *b* @a <l> [c] \\u{0} ~ // 試験";

fn plan(date: &str, limit: &str) -> String {
    format!(
        r#"plan "Paper" {{
  specimen_id   = "PAPER-1"
  customer      = "{}"
  decision_rule = guarded
  {date}
}}

rig simulated {{
  link = virtual(noise: 2 N, seed: 7)
}}

specimen bar {{
  mass      = 20 kg
  behaviour = elastic(stiffness: 300 kN/m)
}}

striker hammer {{
  mass     = 20 kg
  velocity = 1 m/s
}}

limits {{
  displacement = -5 mm .. {limit}
}}

stiffness ramp k0 {{
  displacements = 0.1 mm .. 1 mm step 0.1 mm
}}

impact hit {{
  striker   = hammer
  stiffness = k0.stiffness
  time_step = 0.5 ms
  duration  = 50 ms
}}

require "stiff enough"   k0.stiffness > 250 kN/m
require "stays in travel" hit.max_displacement < 20 mm
"#,
        HOSTILE.replace('\\', "\\\\")
    )
}

/// Runs a plan in its own folder and language; returns the bytes of its PDF.
fn paper(workspace: &Path, name: &str, text: &str, environment: &[(&str, &str)]) -> Vec<u8> {
    let file = workspace.join("paper.psd");
    fs::write(&file, text).unwrap();
    let out = workspace.join(name);
    let run = Command::new(PSD)
        .args([
            "run",
            file.to_str().unwrap(),
            "--yes",
            "--out",
            out.to_str().unwrap(),
        ])
        .envs(environment.iter().copied())
        .output()
        .unwrap();
    fs::read(out.join("report.pdf"))
        .unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&run.stderr)))
}

fn output(program: &str, arguments: &[&str], file: &Path) -> String {
    let done = Command::new(program)
        .args(arguments)
        .arg(file)
        .args((program == "pdftotext").then_some("-"))
        .output()
        .unwrap();
    let printed =
        String::from_utf8_lossy(&done.stdout).into_owned() + &String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{program}: {printed}");
    printed
}

#[test]
fn the_paper_is_sound_and_reads_back_with_its_id_and_number_on_every_page() {
    if !needs::paper() {
        return;
    }
    for (date, limit, verdict) in [
        (
            "date = \"2026-05-31\"",
            "20 mm",
            "SIMULATION: all 2 requirements met",
        ),
        ("", "2 mm", "SIMULATION: stopped before its end"),
    ] {
        let workspace = crate::stage::folder();
        paper(workspace.path(), "out", &plan(date, limit), &[]);
        let file = workspace.path().join("out/report.pdf");
        assert!(
            output("qpdf", &["--check"], &file).contains("No syntax or stream encoding errors")
        );
        assert!(output("qpdf", &["--list-attachments"], &file).contains("paper.psd"));
        let summary: serde_json::Value = serde_json::from_str(
            &fs::read_to_string(workspace.path().join("out/summary.json")).unwrap(),
        )
        .unwrap();
        let id = summary["run_id"].as_str().unwrap();
        let text = output("pdftotext", &["-layout"], &file).replace(['\u{a0}', '\u{200b}'], " ");
        let pages: Vec<&str> = text.split_terminator('\u{c}').collect();
        assert!(pages.len() >= 3, "{} pages", pages.len());
        for (index, page) in pages.iter().enumerate() {
            assert!(page.contains(id), "page {} has no id", index + 1);
            assert!(
                page.contains(&format!("Page {} of {}", index + 1, pages.len())),
                "page {} has no number",
                index + 1
            );
        }
        assert!(
            pages[0].contains(verdict) && pages[0].contains("PAPER-1"),
            "{}",
            pages[0]
        );
        assert!(pages[pages.len() - 1].contains(&format!("End of report {id}")));
        let flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
        for expected in [
            "[U+8A66][U+9A13]",
            "#panic() $x$ *b* @a",
            "decision rule: guarded acceptance",
            "guard band w = U = ",
            "stiff enough",
        ] {
            assert!(
                flat.to_lowercase().contains(&expected.to_lowercase()),
                "{expected} is not on the paper:\n{flat}"
            );
        }
        let stiffness = summary["procedures"]["k0"]["results"].as_object().unwrap();
        for name in stiffness
            .keys()
            .filter(|name| !stiffness[*name]["u"].is_null())
        {
            assert!(flat.contains(&name.replace('_', " ")), "{name}");
        }
    }
}

#[test]
fn the_paper_does_not_know_where_and_when_it_is_made() {
    let plan = plan("date = \"2026-05-31\"", "20 mm");
    let workspace = crate::stage::folder();
    let here = paper(
        workspace.path(),
        "here",
        &plan,
        &[("TZ", "UTC"), ("LANG", "C")],
    );
    let there = paper(
        workspace.path(),
        "there",
        &plan,
        &[
            ("TZ", "Pacific/Kiritimati"),
            ("LANG", "de_DE.UTF-8"),
            ("HOME", "/nowhere"),
            ("SOURCE_DATE_EPOCH", "1"),
        ],
    );
    assert!(here == there, "the same run has two papers");
    assert!(here.starts_with(b"%PDF-1.7"));
}
