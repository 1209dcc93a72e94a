//! `psd rig serve` as started from a shell: it reports when it listens, serves one client, and ends with its code.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

const PLAN: &str = "\
specimen spring {
  mass      = 20 kg
  behaviour = elastic(stiffness: 300 kN/m)
}

limits {
  displacement = -20 mm .. 20 mm
}
";

/// The program, waiting for one client.
struct Server {
    folder: tempfile::TempDir,
    program: Child,
    stdout: BufReader<std::process::ChildStdout>,
    address: String,
}

impl Server {
    fn start(protocol: &str) -> Self {
        Self::start_on(PLAN, protocol)
    }

    fn start_on(plan: &str, protocol: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("spring.psd"), plan).unwrap();
        let mut program = Command::new(env!("CARGO_BIN_EXE_psd"))
            .args([
                "rig",
                "serve",
                "spring.psd",
                "--protocol",
                protocol,
                "--listen",
                "127.0.0.1:0",
                "--once",
            ])
            .current_dir(folder.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut stdout = BufReader::new(program.stdout.take().unwrap());
        let mut ready = String::new();
        stdout.read_line(&mut ready).unwrap();
        let address = ready
            .trim_end()
            .strip_prefix(&format!("ready: {protocol} on "))
            .expect("it is ready")
            .to_owned();
        Self {
            folder,
            program,
            stdout,
            address,
        }
    }

    fn connect(&self) -> TcpStream {
        TcpStream::connect(&self.address).unwrap()
    }

    /// Output of `psd verify` on its run folder, and the exit code.
    fn verified(&self) -> (String, i32) {
        let run = self.folder.path().join("runs/spring-1");
        let ended = Command::new(env!("CARGO_BIN_EXE_psd"))
            .arg("verify")
            .arg(run)
            .output()
            .unwrap();
        (
            String::from_utf8(ended.stdout).unwrap(),
            ended.status.code().unwrap(),
        )
    }

    /// Its printed output, and its exit code.
    fn end(&mut self) -> (String, i32) {
        let mut printed = String::new();
        self.stdout.read_to_string(&mut printed).unwrap();
        (printed, self.program.wait().unwrap().code().unwrap())
    }
}

fn words(words: &[f64]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

fn generic_client(server: &Server) -> TcpStream {
    let mut stream = server.connect();
    let header = [1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2_i32].map(i32::to_le_bytes);
    stream.write_all(header.as_flattened()).unwrap();
    stream
}

#[test]
fn a_generic_client_gets_its_force_and_the_session_is_summed_up() {
    let mut server = Server::start("generic-client");
    let mut client = generic_client(&server);
    client.write_all(&words(&[3.0, -0.002, 10.0, 0.0])).unwrap();
    let mut answer = [0; 16];
    client.read_exact(&mut answer).unwrap();
    assert_eq!(answer[..], words(&[-600.0, 0.0]));
    client.write_all(&words(&[99.0, 0.0])).unwrap();
    let (printed, code) = server.end();
    assert_eq!(
        printed,
        "session: closed by the client\ntargets: 1\nlargest |x|: 2.000 mm\nlargest |F|: 600.0 N\n"
    );
    assert_eq!(code, 0);
}

#[test]
fn a_limit_ends_the_session_with_its_own_code() {
    let mut server = Server::start("generic-client");
    let mut client = generic_client(&server);
    client.write_all(&words(&[3.0, 0.0201])).unwrap();
    let (printed, code) = server.end();
    assert!(
        printed.starts_with("session: target displacement 20.1 mm is outside its limit"),
        "{printed}"
    );
    assert_eq!(code, 4);
}

#[test]
fn a_refused_proposal_leaves_the_session_to_the_coordinator_but_not_the_code() {
    let mut server = Server::start("nees");
    let mut client = server.connect();
    client
        .write_all(
            b"open-session\tc\npropose\tt1\tMDL-00-01\tx\tdisplacement\t0.0201\nclose-session\tc\n",
        )
        .unwrap();
    let mut answers = String::new();
    client.read_to_string(&mut answers).unwrap();
    let firsts: Vec<&str> = answers
        .lines()
        .filter_map(|line| line.split('\t').next())
        .collect();
    assert_eq!(firsts, ["OK", "NOT OK", "OK"]);
    let (printed, code) = server.end();
    assert!(
        printed.contains("targets: 0, 1 refused by a limit"),
        "{printed}"
    );
    assert_eq!(code, 4);
}

#[test]
fn a_client_that_goes_away_is_a_fault() {
    let mut server = Server::start("nees");
    drop(server.connect());
    let (printed, code) = server.end();
    assert!(
        printed.starts_with("session: the client left without closing\n"),
        "{printed}"
    );
    assert_eq!(code, 3);
}

#[test]
fn a_session_is_on_record_and_its_targets_come_out_again() {
    let mut server = Server::start("nees");
    let mut client = server.connect();
    client
        .write_all(
            b"open-session\tc\npropose\tt1\tMDL-1\tx\tdisplacement\t0.001\nexecute\tt1\nget-control-point\tt1\tMDL-1\n\
            propose\tt2\tMDL-1\tx\tdisplacement\t0.05\npropose\tt3\tMDL-1\tx\tdisplacement\t-0.001\ncancel\tt3\nclose-session\tc\n",
        )
        .unwrap();
    client.read_to_string(&mut String::new()).unwrap();
    server.end();
    let (output, code) = server.verified();
    assert_eq!(code, 0, "{output}");
    // The cancelled step is in the run log and was never sent.
    assert!(
        output.contains("all 2 recomputed, bit-identical, and 1 steps"),
        "{output}"
    );
    let run = server.folder.path().join("runs/spring-1");
    let table = std::fs::read_to_string(run.join("tables/served.csv")).unwrap();
    assert!(
        table.starts_with(
            "step,wall_time_s,command_m,displacement_m,restoring_force_n\n1,1.0,0.001,0.001,300.0"
        ),
        "{table}"
    );
    let record = std::fs::read_to_string(run.join("journal.psdj")).unwrap();
    assert!(
        record.contains("target displacement 50 mm is outside its limit"),
        "{record}"
    );
}

/// Two floors, each with its own actuator: the client's vectors move both simultaneously.
const FRAME: &str = "\
specimen frame {
  storeys = [storey(mass: 2 t, stiffness: 3 MN/m), storey(mass: 1.5 t, stiffness: 2 MN/m)]
}

limits {
  displacement = -20 mm .. 20 mm
}
";

#[test]
fn a_session_on_a_frame_is_on_record_floor_by_floor() {
    let mut server = Server::start_on(FRAME, "generic-client");
    let mut client = server.connect();
    let header = [2, 0, 0, 0, 0, 0, 0, 0, 2, 0, 4_i32].map(i32::to_le_bytes);
    client.write_all(header.as_flattened()).unwrap();
    let mut ask = |asked: [f64; 4]| {
        client
            .write_all(&words(&[asked, [10.0, 0.0, 0.0, 0.0]].concat()))
            .unwrap();
        let mut answer = [0; 32];
        client.read_exact(&mut answer).unwrap();
        answer
    };
    assert_eq!(
        ask([3.0, 0.001, 0.003, 0.0])[..],
        words(&[-1000.0, 4000.0, 0.0, 0.0])
    );
    let refused = ask([3.0, 0.001, f64::NAN, 0.0]);
    assert!(f64::from_le_bytes(refused[..8].try_into().unwrap()).is_nan());
    client.write_all(&words(&[99.0, 0.0, 0.0, 0.0])).unwrap();
    let (printed, code) = server.end();
    assert!(
        printed.contains("targets: 1, 1 refused by a limit\nlargest |x|: 3.000 mm\n"),
        "{printed}"
    );
    assert_eq!(code, 4);
    let (output, code) = server.verified();
    assert_eq!(code, 0, "{output}");
    let run = server.folder.path().join("runs/spring-1");
    let table = std::fs::read_to_string(run.join("tables/served.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(
        rows[0],
        "step,storey,wall_time_s,command_m,displacement_m,restoring_force_n"
    );
    assert!(
        rows[1].starts_with("1,1,3.0,0.001,0.001,-1000.0"),
        "{table}"
    );
    assert!(rows[2].starts_with("1,2,3.0,0.003,0.003,4000.0"), "{table}");
    assert_eq!(rows.len(), 3);
}

/// One of two equal parts at half scale has a quarter of the stiffness of its storey.
#[test]
fn a_specimen_at_a_scale_is_served_in_numbers_of_the_rig() {
    let scaled = FRAME.replace("MN/m)", "MN/m, part: tested(scale: 1 / 2, represents: 2))");
    let mut server = Server::start_on(&scaled, "generic-client");
    let mut client = server.connect();
    let header = [2, 0, 0, 0, 0, 0, 0, 0, 2, 0, 4_i32].map(i32::to_le_bytes);
    client.write_all(header.as_flattened()).unwrap();
    let mut ask = |asked: [f64; 4], then: f64| {
        let asked = [asked, [then, 0.0, 0.0, 0.0]].concat();
        client.write_all(&words(&asked)).unwrap();
        let mut answer = [0; 32];
        client.read_exact(&mut answer).unwrap();
        answer
    };
    let (force, stiffness) = (10.0, 12.0);
    let trial = [3.0, 0.001, 0.003, 0.0];
    assert_eq!(ask(trial, force)[..], words(&[-250.0, 1000.0, 0.0, 0.0]));
    assert_eq!(
        ask(trial, stiffness)[..],
        words(&[1.25e6, -0.5e6, -0.5e6, 0.5e6])
    );
    client.write_all(&words(&[99.0, 0.0, 0.0, 0.0])).unwrap();
    assert_eq!(server.end().1, 0);
    let mut said = String::new();
    let stderr = server.program.stderr.as_mut().unwrap();
    stderr.read_to_string(&mut said).unwrap();
    let of_rig = "displacements, forces and stiffness are numbers of the rig: storeys 1, 2 at scale 0.5, one of 2 equal parts";
    assert!(said.contains(of_rig), "{said}");
}

#[test]
fn a_coordinator_drives_the_floors_of_a_frame() {
    let mut server = Server::start_on(FRAME, "nees");
    let mut client = server.connect();
    let messages = "open-session\tc\npropose\tt1\tMDL-00-02\tx\tdisplacement\t0.003\tMDL-00-01\tx\tdisplacement\t0.001\n\
        execute\tt1\nget-control-point\tt1\tMDL-00-01\nget-control-point\tt1\tMDL-00-02\nclose-session\tc\n";
    client.write_all(messages.as_bytes()).unwrap();
    let mut answers = String::new();
    client.read_to_string(&mut answers).unwrap();
    // V₂ = 2 MN/m · 2 mm, V₁ = 3 MN/m · 1 mm.
    for floor in [
        "1.0000000000E-03\tx\tforce\t-1.0000000000E+03",
        "3.0000000000E-03\tx\tforce\t4.0000000000E+03",
    ] {
        assert!(answers.contains(floor), "{answers}");
    }
    let (printed, code) = server.end();
    assert!(code == 0 && printed.contains("targets: 1\n"), "{printed}");
    let (output, code) = server.verified();
    assert_eq!(code, 0, "{output}");
}

#[test]
fn settings_of_an_init_file_are_used_and_noted() {
    let mut server = Server::start("generic-client");
    let mut client = generic_client(&server);
    let mut setting = vec![0; 16_385];
    setting[..8].copy_from_slice(b"\x02rate 1\n");
    client.write_all(&setting).unwrap();
    client.write_all(&words(&[3.0, -0.002, 10.0, 0.0])).unwrap();
    let mut answer = [0; 16];
    client.read_exact(&mut answer).unwrap();
    assert_eq!(answer[..], words(&[-600.0, 0.0]));
    client.write_all(&words(&[99.0, 0.0])).unwrap();
    assert_eq!(server.end().1, 0);
    let record =
        std::fs::read_to_string(server.folder.path().join("runs/spring-1/journal.psdj")).unwrap();
    assert!(record.contains("not for this rig: rate 1"), "{record}");
}

/// No client could apply the load that the plan holds.
#[test]
fn a_rig_with_an_axial_axis_is_not_served() {
    let plan = concat!(env!("CARGO_MANIFEST_DIR"), "/plans/column_axial_load.psd");
    let served = Command::new(env!("CARGO_BIN_EXE_psd"))
        .args(["rig", "serve", plan, "--protocol", "generic-client"])
        .args(["--listen", "127.0.0.1:0", "--once"])
        .output()
        .unwrap();
    assert!(!served.status.success());
    let said = String::from_utf8_lossy(&served.stderr);
    assert!(
        said.contains("axial axis, whose load no client applies"),
        "{said}"
    );
}
