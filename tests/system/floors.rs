//! Frames on real rigs of several axes, as processes. psd is the coordinator of control points over TCP, or the rig whose
//! floors a coordinator or a finite-element program drives. In: plans of two storeys. Out: the simulated run, or K·u.

use std::fs;
use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::path::Path;

use crate::served::{Coordinator, Served};
use crate::stage::{Stage, wait};

/// The text of the ground-motion plan, for two seconds, on a NEES rig at its own address.
fn over_tcp(address: &str) -> String {
    let sine = include_str!("../../plans/two_storeys_sine.psd");
    let library = include_str!("../../plans/lib/two_actuator_frame.psd");
    let (device, nees) = (
        "serial(port: \"/tmp/psd-frame\", dialect: native, serial_number: \"STAND-IN-2\")",
        format!(
            "tcp(address: \"{address}\", dialect: nees(\"MDL-00-01, MDL-00-02\"), reply_timeout: 2 s)"
        ),
    );
    let rig = library
        .replace(device, &nees)
        .replace("  noise           = 0.001 N\n", "");
    let rig = rig.replace("  safe_state ", "  watchdog        = 30 s\n  safe_state ");
    let (shared, step) = (
        "use \"lib/two_actuator_frame.psd\"\n",
        "  time_step     = 10 ms",
    );
    assert!(sine.contains(shared) && sine.contains(step) && rig.contains(&nees));
    sine.replace(shared, &rig)
        .replace(step, "  time_step     = 10 ms\n  duration      = 1 s")
}

/// The numbers in a column of a table.
fn column(path: &Path, name: &str) -> Vec<f64> {
    let text = fs::read_to_string(path).unwrap();
    let at = text
        .lines()
        .next()
        .unwrap()
        .split(',')
        .position(|column| column == name)
        .unwrap();
    text.lines()
        .skip(1)
        .map(|line| line.split(',').nth(at).unwrap().parse().unwrap())
        .collect()
}

#[test]
fn a_frame_over_control_points_is_the_virtual_run() {
    let address = TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap()
        .to_string();
    let ground = |folder: &Path| {
        fs::create_dir(folder.join("ground")).unwrap();
        fs::write(
            folder.join("ground/sine.csv"),
            include_str!("../../plans/ground/sine.csv"),
        )
        .unwrap();
    };
    let stage = Stage::laid_out(|_| over_tcp(&address), "", ground);
    let run = |rig: &str, out: &str| {
        let mut command = std::process::Command::new(crate::stage::PSD);
        command.arg("run").arg(stage.path("plan.psd")).args([
            "--rig",
            rig,
            "--yes",
            "--operator",
            "A. Tester",
            "--out",
        ]);
        wait(command.arg(stage.path(out)))
    };
    // The requirements apply to the steady motion. A second is too short for it.
    for (rig, out) in [("ideal", "virtual"), ("bench", "run")] {
        let ended = run(rig, out);
        assert_eq!(ended.code, Some(1), "{}", ended.output);
    }
    stage.proven();
    let table = |out: &str| stage.path(out).join("tables/steady.csv");
    for (name, near) in [
        ("command_m", 1e-7),
        ("displacement_m", 1e-7),
        ("restoring_force_n", 0.1),
    ] {
        let (ideal, real) = (column(&table("virtual"), name), column(&table("run"), name));
        assert!(
            ideal.len() == real.len() && ideal.len() >= 200,
            "{} and {} rows",
            ideal.len(),
            real.len()
        );
        let largest = ideal
            .iter()
            .fold(0.0_f64, |largest, value| largest.max(value.abs()));
        // The resolution of the rig is a nanometre; rounding errors accumulate over the steps.
        let differs = ideal
            .iter()
            .zip(&real)
            .fold(0.0_f64, |most, (ideal, real)| {
                most.max((ideal - real).abs())
            });
        assert!(
            differs < near && largest > 1e3 * near,
            "{name}: {differs} of {largest}"
        );
    }
    let proposals = stage
        .requests()
        .iter()
        .filter(|request| request.starts_with("propose"))
        .count();
    assert_eq!(
        proposals,
        stage.moves().len(),
        "one transaction a step, for both floors"
    );
}

/// K = [500, −200; −200, 200] kN/m, on a controller of two axes; the upper one has the opposite polarity.
const FRAME: &str = r#"
specimen frame {
  storeys = [
    storey(mass: 2 t, stiffness: 300 kN/m),
    storey(mass: 1.5 t, stiffness: 200 kN/m),
  ]
}

limits {
  displacement = -20 mm .. 20 mm
  force        = -20 kN .. 20 kN
  speed        = 500 mm/s
}

rig bench {
  link        = serial(port: "PORT", dialect: native, reply_timeout: 2 s)
  settle      = within(0.01 mm, 5 kN/s, for: 0.01 s, timeout: 20 s)
  safe_state  = hold
  watchdog    = 30 s
  rate        = 500 Hz
  samples     = 1
  speed       = 100 mm/s
  resolution  = 1 nm
  axes        = [
    axis(pretest_check: probe(0.05 mm, stiffness: 400 kN/m .. 600 kN/m, zero: 5 N), displacement: -10 mm .. 10 mm),
    axis(polarity: negative, pretest_check: probe(0.05 mm, stiffness: 150 kN/m .. 250 kN/m, zero: 5 N)),
  ]
}
"#;

fn frame() -> Stage {
    Stage::of(
        |plan| {
            let (_, port) = plan.split_once("port: \"").unwrap();
            FRAME.replace("PORT", port.split('"').next().unwrap())
        },
        "",
    )
}

/// Positions and forces as reported to a coordinator \[m, N\].
fn floor(client: &mut Coordinator, point: &str) -> (f64, f64) {
    let answer = client.ask(&format!("get-control-point\tdummy\t{point}"));
    let words: Vec<&str> = answer.split('\t').collect();
    assert_eq!((words[0], words[3]), ("OK", point), "{answer}");
    (words[6].parse().unwrap(), words[9].parse().unwrap())
}

fn is(found: (f64, f64), position: f64, force: f64) {
    assert!(
        (found.0 - position).abs() < 1e-8 && (found.1 - force).abs() < 1e-2,
        "{found:?} is not {position} m, {force} N"
    );
}

#[test]
fn a_coordinator_drives_the_floors_of_a_real_rig_together_and_one_by_one() {
    let mut served = Served::start_on(frame(), "nees", &["--once"]);
    let pretest_check = served.stage.moves().len();
    let mut client = Coordinator::come(&served);
    let both =
        "propose\tt1\tMDL-00-01\tx\tdisplacement\t1.0E-3\tMDL-00-02\tx\tdisplacement\t3.0E-3";
    assert_eq!(
        [client.ask(both), client.ask("execute\tt1")],
        ["OK\t0\tt1"; 2]
    );
    is(floor(&mut client, "MDL-00-01"), 1e-3, -100.0);
    is(floor(&mut client, "MDL-00-02:roof"), 3e-3, 400.0);
    // The proposal does not name the lower floor, which keeps its position.
    assert_eq!(
        [
            client.ask("propose\tt2\tMDL-00-02\tx\tdisplacement\t1.0E-3"),
            client.ask("execute\tt2")
        ],
        ["OK\t0\tt2"; 2]
    );
    is(floor(&mut client, "MDL-00-01"), 1e-3, 300.0);
    is(floor(&mut client, "MDL-00-02"), 1e-3, 0.0);
    let moved = served.stage.moves().len();
    assert_eq!(moved, pretest_check + 2);
    // The lower axis has its own limit. A refused target of one axis moves neither.
    for (demand, expected) in [
        (
            "MDL-00-01\tx\tdisplacement\t0.0101\tMDL-00-02\tx\tdisplacement\t0",
            "NOT OK\t1\tt3",
        ),
        (
            "MDL-00-01\tx\tdisplacement\t0\tMDL-00-02\tx\tdisplacement\t0.0201",
            "NOT OK\t1\tt3",
        ),
        (
            "MDL-00-03\tx\tdisplacement\t0",
            "NOT OK\t2\tt3\tno such control point",
        ),
        (
            "MDL-00-01\tx\tdisplacement\t0\tMDL-00-01:a\tx\tdisplacement\t0",
            "NOT OK\t2\tt3\ta control point is listed twice",
        ),
        (
            "MDL-00-01\tx\tdisplacement\t0\ty\tdisplacement\t0",
            "NOT OK\t2\tt3",
        ),
    ] {
        let refused = client.ask(&format!("propose\tt3\t{demand}"));
        assert!(refused.starts_with(expected), "{demand}: {refused}");
        assert!(
            client.ask("execute\tt3").starts_with("NOT OK\t3"),
            "{demand}"
        );
    }
    assert!(
        client
            .ask("get-control-point\tdummy\tMDL-00-03")
            .starts_with("NOT OK\t2")
    );
    is(floor(&mut client, "MDL-00-01"), 1e-3, 300.0);
    client.close();
    let (code, printed) = served.ended();
    assert!(
        code == Some(4) && printed.contains("targets: 2, 2 refused by a limit\n"),
        "{printed}"
    );
    assert_eq!(served.stage.moves().len(), moved);
    served.held();
    let table = fs::read_to_string(served.stage.path("run").join("tables/served.csv")).unwrap();
    assert_eq!(table.lines().count(), 5, "a row a step and storey: {table}");
}

#[test]
fn floors_have_the_names_that_they_are_given() {
    let stage = frame();
    for names in [
        "MDL-1",
        "MDL-1,MDL-1",
        "MDL-1,roof",
        "MDL-1,MDL-2,MDL-3",
        "",
    ] {
        let ended = wait(&mut stage.recorded_tool(
            "serve",
            &[
                "--protocol",
                "nees",
                "--listen",
                "127.0.0.1:0",
                "--yes",
                "--control-points",
                names,
            ],
        ));
        assert!(
            ended.code == Some(2) && ended.output.contains("MDL-00-01, MDL-00-02"),
            "{names}: {}",
            ended.output
        );
    }
    assert!(stage.requests().is_empty());
    let mut served = Served::start_on(
        stage,
        "nees",
        &["--once", "--control-points", "MDL-7:low, MDL-7:roof"],
    );
    let mut client = Coordinator::come(&served);
    let both =
        "propose\tt1\tMDL-7:roof\tx\tdisplacement\t3.0E-3\tMDL-7:low\tx\tdisplacement\t1.0E-3";
    assert_eq!(
        [client.ask(both), client.ask("execute\tt1")],
        ["OK\t0\tt1"; 2]
    );
    is(floor(&mut client, "MDL-7:low"), 1e-3, -100.0);
    is(floor(&mut client, "MDL-7:roof"), 3e-3, 400.0);
    client.close();
    assert_eq!(served.ended().0, Some(0));
}

#[test]
fn an_element_drives_the_floors_of_a_real_rig_by_vectors() {
    let mut served = Served::start_on(frame(), "generic-client", &["--once"]);
    let mut client = served.connect();
    let header = [2, 0, 0, 0, 0, 0, 0, 0, 2, 0, 4_i32].map(i32::to_le_bytes);
    client.write_all(header.as_flattened()).unwrap();
    let mut ask = |messages: &[[f64; 4]]| -> [f64; 4] {
        let bytes: Vec<u8> = messages
            .as_flattened()
            .iter()
            .flat_map(|word| word.to_le_bytes())
            .collect();
        client.write_all(&bytes).unwrap();
        let mut answer = [0; 32];
        client.read_exact(&mut answer).unwrap();
        std::array::from_fn(|at| f64::from_le_bytes(answer[8 * at..8 * at + 8].try_into().unwrap()))
    };
    let force = ask(&[[3.0, 1e-3, 3e-3, 0.0], [10.0, 0.0, 0.0, 0.0]]);
    assert!(
        (force[0] + 100.0).abs() < 1e-2 && (force[1] - 400.0).abs() < 1e-2,
        "{force:?}"
    );
    let stiffness = ask(&[[12.0, 0.0, 0.0, 0.0]]);
    assert_eq!(stiffness, [5e5, -2e5, -2e5, 2e5]);
    let moved = served.stage.moves().len();
    let refused = ask(&[[3.0, 1e-3, 20.1e-3, 0.0], [10.0, 0.0, 0.0, 0.0]]);
    assert!(refused[0].is_nan() && refused[1].is_nan());
    client
        .write_all(&[99.0_f64, 0.0, 0.0, 0.0].map(f64::to_le_bytes).concat())
        .unwrap();
    assert_eq!(served.ended().0, Some(4));
    assert_eq!(served.stage.moves().len(), moved);
    served.held();
}
