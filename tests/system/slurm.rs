//! A cluster of one node on the loopback: munged, slurmctld and slurmd, as the user of the test, without a service of the machine. In: a
//! study. Out: a job array of 8 shards that loses three of them, and then has the bytes of a study that one process ran.

use std::fs;
use std::net::{Ipv4Addr, TcpListener};
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use psd::study::collection::merge;
use rustix::process::{Pid, Signal, kill_process};
use tempfile::TempDir;

use crate::needs;
use crate::stage::PSD;
use crate::study::PLAN;

/// Longest wait for anything.
const PATIENCE: Duration = Duration::from_mins(3);
/// Some seconds of one processor.
const RUNS: &str = "30000";

/// The three services, and the folder with their configuration.
struct Cluster {
    folder: TempDir,
    services: Vec<Child>,
}

fn free_port() -> u16 {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    listener.local_addr().unwrap().port()
}

fn printed(output: &Output) -> String {
    let [out, err] =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    out + &err
}

fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    let began = Instant::now();
    while !is_so() {
        assert!(began.elapsed() < PATIENCE, "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

impl Cluster {
    fn start() -> Self {
        let folder = tempfile::tempdir().unwrap();
        // munged wants a folder that all users may enter, and a key that only its own reads.
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
        let mut cluster = Self {
            folder,
            services: Vec::new(),
        };
        let key: Vec<u8> = (0..=255).cycle().take(1024).collect();
        fs::write(cluster.path("munge.key"), key).unwrap();
        fs::set_permissions(cluster.path("munge.key"), fs::Permissions::from_mode(0o600)).unwrap();
        let user = String::from_utf8(Command::new("id").arg("-un").output().unwrap().stdout);
        let here = cluster.folder.path().display().to_string();
        for name in ["state", "spool"] {
            fs::create_dir(cluster.path(name)).unwrap();
        }
        // A task that is put back waits for the end of its credential. More processors than the machine has: all tasks run at a time.
        let configuration = format!(
            "ClusterName=psd\n\
             SlurmctldHost=localhost(127.0.0.1)\n\
             SlurmUser={user}\nSlurmdUser={user}\n\
             SlurmctldPort={}\nSlurmdPort={}\n\
             AuthType=auth/munge\nCredType=cred/munge\nAuthInfo=socket={here}/munge.socket,cred_expire=5\n\
             StateSaveLocation={here}/state\nSlurmdSpoolDir={here}/spool\n\
             SlurmctldPidFile={here}/slurmctld.pid\nSlurmdPidFile={here}/slurmd.pid\n\
             SlurmctldLogFile={here}/slurmctld.log\nSlurmdLogFile={here}/slurmd.log\n\
             ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\n\
             SelectType=select/cons_tres\nSelectTypeParameters=CR_Core\n\
             SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1\n\
             AccountingStorageType=accounting_storage/none\nJobAcctGatherType=jobacct_gather/none\n\
             MpiDefault=none\nSwitchType=switch/none\nMaxArraySize=9\n\
             SlurmdParameters=config_overrides\n\
             NodeName=localhost NodeAddr=127.0.0.1 CPUs=8 State=UNKNOWN\n\
             PartitionName=all Nodes=localhost Default=YES State=UP\n",
            free_port(),
            free_port(),
            user = user.unwrap().trim(),
        );
        fs::write(cluster.path("slurm.conf"), configuration).unwrap();
        let file = |option: &str, name: &str| format!("--{option}={here}/{name}");
        cluster.serve(
            "munged",
            &[
                "--foreground",
                &file("key-file", "munge.key"),
                &file("socket", "munge.socket"),
                &file("log-file", "munged.log"),
                &file("pid-file", "munged.pid"),
                &file("seed-file", "munged.seed"),
            ],
        );
        let socket = cluster.path("munge.socket");
        until("munged", || socket.exists());
        cluster.serve("slurmctld", &["-D"]);
        cluster.serve("slurmd", &["-D", "-N", "localhost"]);
        until("an idle node", || {
            let output = cluster.command("sinfo").args(["-h", "-o", "%T"]).output();
            printed(&output.unwrap()).trim() == "idle"
        });
        cluster
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.path("slurm.conf"));
        command.env("PATH", needs::search_path());
        command
    }

    fn serve(&mut self, program: &str, arguments: &[&str]) {
        let log = fs::File::create(self.path(&format!("{program}.out"))).unwrap();
        let mut command = self.command(program);
        command.args(arguments).stdin(Stdio::null());
        command.stdout(log.try_clone().unwrap()).stderr(log);
        self.services.push(command.spawn().unwrap());
    }

    /// Tasks and jobs that wait or run.
    fn queue(&self) -> Vec<String> {
        let mut squeue = self.command("squeue");
        let output = squeue.args(["-h", "-r", "-o", "%i"]).output();
        let text = printed(&output.unwrap());
        text.lines().map(str::to_owned).collect()
    }

    fn is_idle(&self) -> bool {
        self.queue().is_empty()
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        if !self.is_idle() {
            let _ = self.command("scancel").args(["--me", "--full"]).status();
            let began = Instant::now();
            while !self.is_idle() && began.elapsed() < Duration::from_secs(10) {
                std::thread::sleep(Duration::from_millis(50));
            }
        }
        for service in self.services.iter_mut().rev() {
            let _ = kill_process(Pid::from_child(service), Signal::TERM);
            let began = Instant::now();
            while matches!(service.try_wait(), Ok(None)) {
                if began.elapsed() > Duration::from_secs(10) {
                    let _ = service.kill();
                }
                std::thread::sleep(Duration::from_millis(20));
            }
        }
    }
}

/// The psd of the task of a shard.
fn task(shard: u32) -> Option<Pid> {
    let index = format!("SLURM_ARRAY_TASK_ID={shard}");
    let has = |path: PathBuf, word: &[u8]| {
        let bytes = fs::read(path).unwrap_or_default();
        bytes.split(|byte| *byte == 0).any(|found| found == word)
    };
    fs::read_dir("/proc").unwrap().flatten().find_map(|entry| {
        let id = entry.file_name().to_str()?.parse().ok()?;
        let is_it = has(entry.path().join("cmdline"), b"env/8")
            && has(entry.path().join("environ"), index.as_bytes());
        is_it.then(|| Pid::from_raw(id))?
    })
}

/// Whether the runs of a shard are simulated now.
fn is_simulated(work: &Path, shard: u32) -> bool {
    let start = format!("shard-{shard:03}-of-008.piece");
    let files = fs::read_dir(work.join("shards")).unwrap().flatten();
    let mut paths = files.map(|file| file.path());
    paths.any(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(&start) && path.extension().is_some_and(|end| end == "part")
    })
}

#[test]
fn an_array_that_loses_shards_has_the_bytes_of_one_process() {
    if !needs::slurm() {
        return;
    }
    let cluster = Cluster::start();
    let work = cluster.path("work");
    fs::create_dir(&work).unwrap();
    fs::write(work.join("plan.psd"), PLAN.replace("10 ms", "0.2 ms")).unwrap();
    let psd = |arguments: &[&str]| {
        let mut command = cluster.command(PSD);
        command.arg("study").args(arguments).current_dir(&work);
        command.output().unwrap()
    };
    let shard = |number: u32| work.join(format!("shards/shard-{number:03}-of-008.parquet"));

    // MaxArraySize of this cluster admits eight tasks.
    let submit = [
        "submit", "plan.psd", "--slurm", "--shards", "20", "--runs", RUNS, "--out", "shards",
        "--submit",
    ];
    let output = psd(&submit);
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    let text = printed(&output);
    assert!(text.contains("8 shards instead of 20"), "{text}");
    assert!(!text.contains("not checked"), "{text}");
    let job = String::from_utf8(output.stdout).unwrap().trim().to_owned();

    // One process runs the same study meanwhile.
    let mut whole = cluster.command(PSD);
    whole.args(["study", "run", "plan.psd", "--runs", RUNS, "--out", "whole"]);
    whole.current_dir(&work).stderr(Stdio::null());
    let mut whole = whole.stdout(Stdio::null()).spawn().unwrap();

    // The notice of the time limit, TERM and KILL: each for a shard whose runs are simulated, as soon as there is one.
    let mut hit: Vec<u32> = Vec::new();
    for signal in ["USR1", "TERM", "KILL"] {
        until("the runs of a shard", || {
            let found = (1..=8)
                .filter(|number| !hit.contains(number) && is_simulated(&work, *number))
                .find(|number| {
                    if signal == "KILL" {
                        return task(*number)
                            .is_some_and(|id| kill_process(id, Signal::KILL).is_ok());
                    }
                    let mut cancel = cluster.command("scancel");
                    cancel.args([format!("--signal={signal}"), "--batch".to_owned()]);
                    let output = cancel.arg(format!("{job}_{number}")).output().unwrap();
                    output.status.success()
                });
            hit.extend(found);
            found.is_some()
        });
    }
    let [back, terminated, killed] = hit[..] else {
        unreachable!("three signals")
    };
    // The runs of the task that was terminated are durable.
    let mut text = String::new();
    until("durable runs", || {
        let status = psd(&["status", "shards"]);
        text = printed(&status);
        status.status.code() == Some(75)
    });
    assert!(text.contains("in the queue of Slurm: "), "{text}");
    until("the array", || cluster.is_idle());

    // The merge that waited for the array names what is missing. The first shard was put back, and has gone on.
    let log = |name: &str| fs::read_to_string(work.join("shards").join(name)).unwrap();
    assert!(log(&format!("{job}_{back}.log")).contains("STOPPED"));
    assert!(log(&format!("{job}_{terminated}.log")).contains("STOPPED"));
    // Its number depends on how many tasks had begun before it was submitted.
    let of_merge = |name: &String| {
        let job = name.strip_suffix(".log");
        job.is_some_and(|job| job.bytes().all(|byte| byte.is_ascii_digit()))
    };
    let mut names = fs::read_dir(work.join("shards"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let text = log(&names.find(of_merge).expect("a log of the merge"));
    let mut missing = vec![terminated, killed];
    missing.sort_unstable();
    let listed = format!("2 of 8 shards are missing: {}", merge::listed(&missing));
    assert!(text.contains(&listed), "{text}");

    // One more is lost.
    let mut others = (1..=8).filter(|number| !hit.contains(number));
    let (lost, damaged) = (others.next().unwrap(), others.next().unwrap());
    fs::remove_file(shard(lost)).unwrap();
    missing.push(lost);
    missing.sort_unstable();
    let merge = psd(&["merge", "shards"]);
    assert_eq!(merge.status.code(), Some(3), "{}", printed(&merge));
    let text = printed(&merge);
    let numbers = merge::listed(&missing);
    let array = format!("sbatch --parsable --array={numbers} shards/array.sbatch");
    let line = format!("sbatch --dependency=afterany:$({array}) shards/merge.sbatch");
    assert!(text.contains(&line), "{text}");
    let status = psd(&["status", "shards"]);
    assert!(
        printed(&status).contains(&format!("submit again: {line}")),
        "{}",
        printed(&status)
    );
    let without_runs = printed(&status).lines().find_map(|line| {
        line.trim()
            .strip_prefix("shards without runs: ")
            .map(str::to_owned)
    });
    assert!(
        without_runs
            .is_some_and(|listed| listed.split([',', '-']).any(|it| it == lost.to_string())),
        "{}",
        printed(&status)
    );
    let again = cluster
        .command("sh")
        .args(["-c", &line])
        .current_dir(&work)
        .output();
    let again = again.unwrap();
    assert!(again.status.success(), "{}", printed(&again));
    until("the shards that were lost", || cluster.is_idle());

    // One is damaged.
    let sound = fs::read(shard(damaged)).unwrap();
    let mut bytes = sound.clone();
    bytes[sound.len() / 2] ^= 1;
    fs::write(shard(damaged), bytes).unwrap();
    let merge = psd(&["merge", "shards"]);
    assert_eq!(merge.status.code(), Some(3), "{}", printed(&merge));
    let text = printed(&merge);
    assert!(
        text.contains(&format!("shard-{damaged:03}-of-008.parquet")),
        "{text}"
    );
    fs::write(shard(damaged), sound).unwrap();
    let merge = psd(&["merge", "shards"]);
    assert_eq!(merge.status.code(), Some(0), "{}", printed(&merge));

    assert!(whole.wait().unwrap().success());
    let file = |folder: &str| fs::read(work.join(folder).join("study.parquet")).unwrap();
    assert!(file("shards") == file("whole"), "the bytes differ");
    assert!(work.join("shards/summary.json").exists());
}
