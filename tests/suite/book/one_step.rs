//! The picture of one step on the page of the pseudo-dynamic test. Its numbers are those of `plans/01_first_blow.psd`.

use std::fs;
use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

const PICTURE: &str = include_str!("one_step.svg");

/// The step of the picture: the structure moves freely after a contact.
const STEP: usize = 64;

/// Columns of the table of the impact, each as its numbers.
fn columns(names: &[&str]) -> Vec<Vec<f64>> {
    let folder = TempDir::new().expect("a folder can be made");
    let plan = Path::new(env!("CARGO_MANIFEST_DIR")).join("plans/01_first_blow.psd");
    let status = Command::new(env!("CARGO_BIN_EXE_psd"))
        .args(["run", "--screen", "never", "--out", "run"])
        .arg(plan)
        .current_dir(folder.path())
        .output()
        .expect("psd starts")
        .status;
    assert!(status.success());
    let table = fs::read_to_string(folder.path().join("run/tables/hit.csv")).expect("the table");
    let rows: Vec<Vec<&str>> = table.lines().map(|row| row.split(',').collect()).collect();
    let column = |name: &&str| {
        let at = rows[0].iter().position(|title| title == name);
        let at = at.expect("a column of the table");
        let cells = rows[1..].iter().map(|row| row[at].parse());
        cells.collect::<Result<_, _>>().expect("numbers")
    };
    names.iter().map(column).collect()
}

#[test]
fn the_picture_of_one_step_has_the_numbers_of_a_run() {
    let names = [
        "time_s",
        "wall_time_s",
        "displacement_m",
        "restoring_force_n",
    ];
    let [time, wall, displacement, force] =
        <[Vec<f64>; 4]>::try_from(columns(&names)).expect("four columns");
    let last = time.len() - 1;
    let millis = |value: f64| value * 1e3;
    let numbers = [
        ("step", STEP.to_string()),
        ("steps", last.to_string()),
        ("from", format!("{:.1}", millis(time[STEP - 1]))),
        ("to", format!("{:.1}", millis(time[STEP]))),
        (
            "simulated",
            format!("{:.3}", millis(time[STEP] - time[STEP - 1])),
        ),
        ("laboratory", format!("{:.2}", wall[STEP] - wall[STEP - 1])),
        (
            "move",
            format!("{:.3}", millis(displacement[STEP] - displacement[STEP - 1])),
        ),
        ("target", format!("{:.2}", millis(displacement[STEP]))),
        ("next", format!("{:.2}", millis(displacement[STEP + 1]))),
        ("force", format!("{:.2}", force[STEP])),
        ("all_simulated", format!("{:.4}", time[last])),
        ("all_laboratory", format!("{:.1}", wall[last])),
    ];
    let mut picture = PICTURE.to_owned();
    for (name, number) in numbers {
        picture = picture.replace(&format!("{{{name}}}"), &number);
    }
    assert!(!picture.contains('{'), "every number is filled in");
    let file = super::docs().join("one-step.svg");
    if super::accepts_output() {
        fs::write(&file, &picture).expect("the picture can be written");
    }
    assert!(
        fs::read_to_string(&file).unwrap_or_default() == picture,
        "docs/one-step.svg: cargo xtask generate book"
    );
}
