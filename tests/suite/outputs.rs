//! Outputs of a run: the bytes of every output, read back as its readers would read it.

mod fixture;
mod hostile;
mod paper;
mod real;

use std::io::Cursor;
use std::sync::LazyLock;

use fixture::{Finished, finished};
use psd::report::parquet::{read_metadata, row_group};
use psd::report::summary::Summary;
use psd::report::{OutputFile, console, manifest_with, put_everything};
use psd::verdict::{Bound, Verdict};
use psd_plan::record::{History, ImpactStep, Outcome, StiffnessRampHistory};
use psd_plan::{Comparison, Format};

const IMPACT_COLUMNS: &str = "step,time_s,wall_time_s,state,command_m,computed_m,displacement_m,velocity_m_per_s,acceleration_m_per_s2,\
restoring_force_n,contact_force_n,striker_displacement_m,striker_velocity_m_per_s,tangent_stiffness_n_per_m,indentation_m,\
striker_energy_j,structure_energy_j,restoring_energy_j,damping_energy_j,contact_loss_j,indentation_energy_j,weight_work_j,energy_error_j,\
tracking_energy_error_j,tracking_indicator_m2";

/// Every file of the run folder, the manifest last.
fn files(finished: &Finished) -> Vec<OutputFile> {
    let mut files = Vec::new();
    put_everything(&finished.run(), &mut files).expect("every output can be made");
    files.push(manifest_with(&files, &[]));
    files
}

/// The files of the unchanged run, made once.
fn made() -> &'static [OutputFile] {
    static MADE: LazyLock<Vec<OutputFile>> = LazyLock::new(|| files(&finished()));
    &MADE
}

fn text<'a>(files: &'a [OutputFile], path: &str) -> &'a str {
    std::str::from_utf8(bytes(files, path)).expect("text is UTF-8")
}

fn bytes<'a>(files: &'a [OutputFile], path: &str) -> &'a [u8] {
    &files
        .iter()
        .find(|file| file.path == path)
        .unwrap_or_else(|| panic!("{path} is missing"))
        .bytes
}

fn impact_steps(finished: &Finished) -> Vec<ImpactStep> {
    let History::Impact(history) = &finished.record.procedures[2].history else {
        panic!("an impact")
    };
    history.steps.iter().collect()
}

#[test]
fn the_same_run_gives_the_same_bytes_and_the_files_of_the_language() {
    let (first, second) = (made(), files(&finished()));
    assert_eq!(first, second);
    let mut paths: Vec<&str> = first.iter().map(|file| file.path.as_str()).collect();
    assert_eq!(paths.last(), Some(&"manifest.sha256"));
    paths.sort_unstable();
    assert_eq!(
        paths,
        [
            "figures/c_damping_fit.png",
            "figures/c_damping_fit.svg",
            "figures/hit_contact_force.png",
            "figures/hit_contact_force.svg",
            "figures/hit_displacement.png",
            "figures/hit_displacement.svg",
            "figures/hit_energy.png",
            "figures/hit_energy.svg",
            "figures/hit_force_displacement.png",
            "figures/hit_force_displacement.svg",
            "figures/hit_striker_velocity.png",
            "figures/hit_striker_velocity.svg",
            "figures/hit_velocity.png",
            "figures/hit_velocity.svg",
            "figures/k0_force_displacement.png",
            "figures/k0_force_displacement.svg",
            "manifest.sha256",
            "plan/beam.psd",
            "plan/lib/frame.psd",
            "report.html",
            "report.pdf",
            "summary.json",
            "tables/c.csv",
            "tables/c.parquet",
            "tables/hit.csv",
            "tables/hit.parquet",
            "tables/k0.csv",
            "tables/k0.parquet",
        ]
    );
    assert_eq!(
        text(first, "manifest.sha256").lines().count(),
        paths.len() - 1
    );
}

#[test]
fn csv_has_the_columns_of_the_language_and_reads_back_bit_for_bit() {
    let (finished, files) = (finished(), made());
    let mut lines = text(files, "tables/hit.csv").lines();
    assert_eq!(lines.next(), Some(IMPACT_COLUMNS));
    let steps = impact_steps(&finished);
    assert_eq!(lines.clone().count(), steps.len());
    for (line, step) in lines.zip(steps) {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(
            (cells[0], cells[3]),
            (step.step.to_string().as_str(), step.state.name())
        );
        let wanted = row(&step);
        let read: Vec<u64> = cells[1..]
            .iter()
            .enumerate()
            .filter(|(i, _)| *i != 2)
            .map(|(_, cell)| cell.parse::<f64>().unwrap().to_bits())
            .collect();
        assert_eq!(read, wanted.map(f64::to_bits));
    }
    let header = |path| text(files, path).lines().next().unwrap().to_owned();
    assert_eq!(
        header("tables/k0.csv"),
        "step,wall_time_s,command_m,displacement_m,restoring_force_n,force_scatter_n,relaxation_n,tangent_stiffness_n_per_m,returning"
    );
    assert_eq!(
        header("tables/c.csv"),
        "step,wall_time_s,velocity_m_per_s,displacement_m,restoring_force_n,damping_force_n,steady"
    );
}

/// The numbers of a row in the order of the columns, without step and state.
fn row(step: &ImpactStep) -> [f64; 23] {
    let e = step.energies;
    [
        step.time,
        step.wall_time,
        step.command,
        step.computed,
        step.displacement,
        step.velocity,
        step.acceleration,
        step.restoring_force,
        step.contact_force,
        step.striker_displacement,
        step.striker_velocity,
        step.tangent_stiffness,
        step.indentation,
        e.striker,
        e.structure,
        e.restoring,
        e.damping,
        e.contact_loss,
        e.indentation,
        e.weight,
        e.error,
        step.tracking.energy_error,
        step.tracking.indicator,
    ]
}

#[test]
fn parquet_reads_back_as_the_record() {
    let (finished, files) = (finished(), made());
    let bytes = bytes(files, "tables/hit.parquet");
    let footer = read_metadata(&mut Cursor::new(bytes)).unwrap();
    assert_eq!(footer.row_groups.len(), 1);
    let frame = row_group(bytes, 0, &footer, 0).unwrap();
    let names = frame.get_column_names().into_iter();
    let names: Vec<String> = names.map(ToString::to_string).collect();
    assert_eq!(names.join(","), IMPACT_COLUMNS);
    let column = frame.column("displacement_m").unwrap().f64().unwrap();
    let read: Vec<u64> = column.into_no_null_iter().map(f64::to_bits).collect();
    let wanted: Vec<u64> = impact_steps(&finished)
        .iter()
        .map(|step| step.displacement.to_bits())
        .collect();
    assert_eq!(read, wanted);
}

#[test]
fn the_committed_schema_is_the_generated_one_and_holds_for_a_summary() {
    let generated = Summary::json_schema();
    // If the types were changed intentionally, `cargo xtask generate schema` writes the file.
    snapbox::assert_data_eq!(
        generated.clone(),
        snapbox::file!["../../grammar/summary.schema.json": Text].raw()
    );
    let schema: serde_json::Value = serde_json::from_str(&generated).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let mut summary: serde_json::Value =
        serde_json::from_str(text(made(), "summary.json")).unwrap();
    let faults: Vec<String> = validator
        .iter_errors(&summary)
        .map(|error| error.to_string())
        .collect();
    assert_eq!(faults, [] as [String; 0]);
    summary["procedures"]["hit"]["results"]["contacts"]["value"] = "three".into();
    assert!(
        !validator.is_valid(&summary),
        "a wrong summary must not pass"
    );
}

#[test]
fn the_summary_has_every_result_of_the_language() {
    let summary: serde_json::Value = serde_json::from_str(text(made(), "summary.json")).unwrap();
    assert_eq!(summary["schema"], "psd.summary/2");
    assert_eq!(summary["verdict"], "pass");
    assert_eq!(summary["rig"]["simulated"], true);
    let hit = &summary["procedures"]["hit"];
    assert_eq!(hit["kind"], "impact");
    let largest = hit["results"]["max_displacement"]["value"]
        .as_f64()
        .unwrap();
    assert!(
        (largest - 0.157_353).abs() < 1e-6,
        "Example 1 at 1 ms: {largest}"
    );
    assert_eq!(hit["results"]["max_displacement"]["unit"], "m");
    assert_eq!(
        hit["results"]["restitution"]["value"],
        serde_json::Value::Null
    );
    assert_eq!(
        summary["procedures"]["k0"]["results"]["stiffness"]["u"],
        0.41
    );
    let requirement = &summary["requirements"][0];
    assert_eq!(requirement["name"], "stays in travel");
    assert_eq!(requirement["limit"], 0.17);
    assert_eq!(requirement["margin"].as_f64(), Some(0.17 - largest));
    let order: Vec<&String> = summary["procedures"].as_object().unwrap().keys().collect();
    assert_eq!(order, ["k0", "c", "hit"]);
}

#[test]
fn the_report_loads_and_runs_nothing_and_states_its_kind() {
    let finished = hostile();
    let files = files(&finished);
    let html = text(&files, "report.html");
    for forbidden in [
        "<script",
        "<img src=x",
        "<b>at</b>",
        "src=\"http",
        "href=",
        "@import",
        "url(",
        "ISO 17025 certified",
    ] {
        assert!(
            !html.contains(forbidden),
            "{forbidden} stands in the report"
        );
    }
    assert!(html.contains("default-src 'none'"));
    assert!(html.contains("&lt;script&gt;"));
    for wanted in [
        "SIMULATION: all 2 requirements met",
        "no physical specimen was tested",
        "not a test report",
        "e = Ms/(Ms + 2M) = 0.8333",
        "End of report <span class=\"id\">0123456789abcdef</span>",
    ] {
        assert!(html.contains(wanted), "{wanted} is missing");
    }
    let pictures = html.matches("data:image/svg+xml;base64,").count();
    assert_eq!(pictures, finished.plan.report.figures.len());
    assert_eq!(html.matches("<figcaption>").count(), pictures);
}

/// A run in which every text contains markup or control characters.
fn hostile() -> Finished {
    let mut finished = finished();
    let label = "</td><script>alert(1)</script><img src=x onerror=alert(1)>\u{1b}[31m";
    finished.plan.title = label.into();
    finished.plan.requirements[0].label = label.into();
    finished.assessment.requirements[0].label = label.into();
    finished.assessment.requirements[0].conditions[0].text = label.into();
    finished.plan.particulars.push(("customer", label.into()));
    finished.plan.files[0].name = "../../escape.psd".into();
    finished.record.rig.name = label.into();
    finished
}

#[test]
fn hostile_texts_stay_in_the_run_folder_and_off_the_terminal() {
    let finished = hostile();
    let files = files(&finished);
    assert!(
        files
            .iter()
            .all(|file| !file.path.contains("..") && !file.path.starts_with('/'))
    );
    assert_eq!(
        text(&files, "plan/escape.psd"),
        &*finished.plan.files[0].text
    );
    assert!(!console::verdict_text(&finished.run(), false).contains('\u{1b}'));
}

#[test]
fn the_console_aligns_requirements_and_colours_only_when_asked() {
    let finished = finished();
    let plain = console::verdict_text(&finished.run(), false).replace('\u{a0}', " ");
    insta::assert_snapshot!(plain, @r"
    PASS  Simply supported beam, midspan impact  (rig `simulated`: a simulation)
      pass  stays in travel  0.15735 ± 0.00040 m  ≤ 0.17 m  margin 0.0126 m
      pass  energy closes    0 %                  ≤ 1 %     margin 1.00 %, no U
      decision rule: simple acceptance; ± is U = 2u
      note: Parameter impact_speed was set to 1 m/s for this run.
      run 0123456789abcdef
    ");
    let coloured = console::verdict_text(&finished.run(), true);
    assert!(coloured.starts_with("\u{1b}[1;32mPASS\u{1b}[0m"));
}

#[test]
fn figures_are_pictures_at_192_dpi_with_something_on_them() {
    let figures: Vec<&OutputFile> = made()
        .iter()
        .filter(|file| file.bytes.starts_with(b"\x89PNG"))
        .collect();
    assert_eq!(figures.len(), 8);
    for figure in figures {
        let mut reader = png::Decoder::new(Cursor::new(&figure.bytes))
            .read_info()
            .unwrap();
        let size = reader.info().pixel_dims.unwrap();
        assert_eq!(
            (size.xppu, size.yppu, size.unit),
            (7559, 7559, png::Unit::Meter)
        );
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let inked = pixels
            .chunks_exact(3)
            .filter(|pixel| pixel.iter().any(|channel| *channel < 200))
            .count();
        let (least, most) = (pixels.len() / 3 / 200, pixels.len() / 3 / 5);
        assert!(
            (least..most).contains(&inked),
            "{}: {inked} pixels are inked",
            figure.path
        );
    }
}

#[test]
fn a_failed_requirement_is_named_with_its_distance_to_the_limit() {
    let mut finished = finished();
    let requirement = &mut finished.assessment.requirements[0];
    requirement.verdict = Verdict::Fail;
    let condition = &mut requirement.conditions[0];
    condition.verdict = Verdict::Fail;
    condition.bound = Some(Bound::Compare {
        comparison: Comparison::LessEqual,
        limit: 0.15,
    });
    condition.margin = condition.value.map(|value| 0.15 - value);
    finished.assessment.verdict = Verdict::Fail;
    let files = files(&finished);
    let html = text(&files, "report.html").replace('\u{a0}', " ");
    for words in [
        "SIMULATION: 1 of 2 requirements not met",
        "Not met: stays in travel.",
        // 0.15735 m − 0.15 m.
        "outside the limit by 0.0073",
    ] {
        assert!(html.contains(words), "{words}");
    }
}

#[test]
fn a_run_stopped_early_still_leaves_a_whole_folder() {
    let mut finished = finished();
    finished.record.procedures.truncate(3);
    let History::Impact(history) = &mut finished.record.procedures[2].history else {
        panic!("an impact")
    };
    history.steps = history.steps.range(0..1).collect();
    finished.record.procedures[2].complete = false;
    finished.record.procedures[2].results.clear();
    finished.record.procedures[0].history = History::StiffnessRamp(StiffnessRampHistory {
        before: Vec::new(),
        steps: Vec::new(),
        fit: None,
        bilinear: None,
        multilinear: None,
        holds: Vec::new(),
        relaxation: None,
        reached: None,
    });
    finished.record.outcome = Outcome::Aborted {
        reason: "force 12.1 kN is outside its limit -2 kN .. 12 kN".into(),
    };
    finished.assessment.verdict = Verdict::Aborted;
    finished.assessment.requirements[0].verdict = Verdict::Inconclusive;
    let condition = &mut finished.assessment.requirements[0].conditions[0];
    (condition.value, condition.bound, condition.margin) = (None, None, None);
    condition.reason = Some("the result `max_displacement` does not exist in this run".into());
    let files = files(&finished);
    let html = text(&files, "report.html");
    assert!(
        html.contains("SIMULATION: stopped before its end")
            && html.contains("Reason: force 12.1 kN, limit −2 kN … 12 kN.")
            && html.contains("The run was stopped.")
    );
    assert_eq!(
        html.matches("force 12.1 kN").count(),
        1,
        "the reason is printed once"
    );
    assert!(html.contains("Procedure hit did not run to its end."));
    assert!(html.contains("the result max displacement does not exist in this run"));
    assert!(
        !files
            .iter()
            .any(|file| file.path == "figures/k0_force_displacement.png"),
        "nothing was recorded to draw"
    );
    assert_eq!(text(&files, "tables/hit.csv").lines().count(), 2);
    let summary: serde_json::Value = serde_json::from_str(text(&files, "summary.json")).unwrap();
    assert_eq!(summary["outcome"]["kind"], "aborted");
    assert_eq!(summary["requirements"][0]["value"], serde_json::Value::Null);
    assert!(console::verdict_text(&finished.run(), false).contains("does not exist in this run"));

    finished.record.procedures.clear();
    let nothing = self::files(&finished);
    assert!(text(&nothing, "report.html").contains("No procedure was run."));
    assert!(
        !nothing
            .iter()
            .any(|file| file.path.starts_with("figures/") || file.path.starts_with("tables/"))
    );
}

#[test]
fn only_the_formats_asked_for_are_written() {
    let mut finished = finished();
    finished.plan.report.formats = vec![Format::Csv];
    finished.plan.report.figures.truncate(1);
    let written = files(&finished);
    let paths: Vec<&str> = written.iter().map(|file| file.path.as_str()).collect();
    assert_eq!(
        paths,
        [
            "summary.json",
            "tables/k0.csv",
            "tables/c.csv",
            "tables/hit.csv",
            "figures/k0_force_displacement.png",
            "figures/k0_force_displacement.svg",
            "plan/beam.psd",
            "plan/lib/frame.psd",
            "manifest.sha256"
        ]
    );
}

#[test]
fn a_run_of_which_nothing_is_required_is_completed_and_never_passed() {
    let mut finished = finished();
    finished.plan.requirements.clear();
    finished.assessment = psd::verdict::assess(&finished.plan, &finished.record);
    let files = files(&finished);
    let html = text(&files, "report.html");
    assert!(
        html.contains("<div class=\"verdict neutral\"><strong>SIMULATION: completed</strong>")
            && !html.contains("<strong>PASS")
    );
    assert!(html.contains("Nothing moved and no physical specimen was tested."));
    let summary: serde_json::Value = serde_json::from_str(text(&files, "summary.json")).unwrap();
    assert_eq!(summary["verdict"], "completed");
    let line = console::verdict_text(&finished.run(), true);
    assert!(
        line.starts_with("COMPLETED  Simply supported beam") && !line.contains("PASS"),
        "{line}"
    );
    assert!(
        bytes(&files, "report.pdf").starts_with(b"%PDF"),
        "paper knows the word too"
    );
    finished.record.outcome = Outcome::Aborted {
        reason: "a limit".into(),
    };
    assert_eq!(
        psd::verdict::assess(&finished.plan, &finished.record).verdict,
        Verdict::Aborted
    );
}
