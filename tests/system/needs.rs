//! The system requirements of a test. In: a program and an action that it must be able to do here. Out: whether it can. If not,
//! the test reports that it is skipped. With `PSD_REQUIRE_SYSTEM=1` it fails, both for a missing program and for an action that
//! the machine does not permit.

use std::process::{Command, Stdio};

/// Whether `strace` is installed and can trace.
pub fn strace() -> bool {
    able(
        "strace",
        "trace",
        Command::new("strace").args(["-f", "-o", "/dev/null", "true"]),
    )
}

/// Whether a private file system can be mounted.
pub fn own_mounts() -> bool {
    able(
        "unshare",
        "mount a tmpfs of its own",
        Command::new("unshare").args(["-rm", "mount", "-t", "tmpfs", "tmpfs", "/mnt"]),
    )
}

/// Whether the limits of a process can be set.
pub fn prlimit() -> bool {
    able(
        "prlimit",
        "set a limit",
        Command::new("prlimit").args(["--fsize=100000", "true"]),
    )
}

/// Whether `minisign` is installed.
pub fn minisign() -> bool {
    able(
        "minisign",
        "say its version",
        Command::new("minisign").arg("-v"),
    )
}

/// Whether `nvim` is installed.
pub fn neovim() -> bool {
    able(
        "nvim",
        "say its version",
        Command::new("nvim").arg("--version"),
    )
}

/// Whether Python can read XML.
pub fn python() -> bool {
    able(
        "python3",
        "read XML",
        Command::new("python3").args(["-c", "import xml.etree.ElementTree"]),
    )
}

/// Whether `prove` is installed, Perl's reader of the Test Anything Protocol.
pub fn prove() -> bool {
    able(
        "prove",
        "say its version",
        Command::new("prove").arg("--version"),
    )
}

/// Whether `qpdf` and poppler's `pdftotext` are installed.
pub fn paper() -> bool {
    let version = |program: &str, flag: &str| able(program, "run", Command::new(program).arg(flag));
    version("qpdf", "--version") && version("pdftotext", "-v")
}

/// The library of the `faketime` package, which sets the wall clock of one process.
pub const FAKETIME: &str = "/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1";

/// Whether the wall clock of a process can be set.
pub fn faketime() -> bool {
    if !able(
        "faketime",
        "set a clock",
        Command::new("faketime").args(["-f", "-1y", "true"]),
    ) {
        return false;
    }
    let here = std::path::Path::new(FAKETIME).exists();
    here || skipped(
        &format!("the library of faketime is not at {FAKETIME}"),
        required(),
    )
}

/// Where programs are found: services are not in the search path of every user.
pub fn search_path() -> String {
    let path = std::env::var("PATH").unwrap_or_default();
    format!("{path}:/usr/sbin:/sbin")
}

/// Whether munge and the daemons and commands of Slurm are installed.
pub fn slurm() -> bool {
    let lookup = "command -v munged slurmctld slurmd sbatch srun scancel squeue sinfo scontrol";
    let mut proof = Command::new("sh");
    proof.env("PATH", search_path());
    able("slurm", "be found", proof.args(["-ec", lookup]))
}

/// Whether Node.js has the packages of the extension for VS Code: `npm ci --ignore-scripts` in its folder.
pub fn extension_packages() -> bool {
    let modules = concat!(env!("CARGO_MANIFEST_DIR"), "/grammar/editors/vscode/");
    let require = "for (const name of ['vscode-textmate', 'vscode-oniguruma', 'esbuild']) require.resolve(name)";
    able(
        "node",
        "find the packages of grammar/editors/vscode/package-lock.json",
        Command::new("node")
            .args(["-e", require])
            .current_dir(modules),
    )
}

/// Whether a program can have its own terminal, as from a shell.
pub fn setsid() -> bool {
    able(
        "setsid",
        "say its version",
        Command::new("setsid").arg("--version"),
    )
}

fn able(program: &str, what: &str, proof: &mut Command) -> bool {
    lacking(program, what, proof).is_none_or(|lacking| skipped(&lacking, required()))
}

/// The reason why the program cannot be used, if there is one.
fn lacking(program: &str, what: &str, proof: &mut Command) -> Option<String> {
    match proof
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
    {
        Ok(status) if status.success() => None,
        Ok(_) => Some(format!("{program} cannot {what} here")),
        Err(_) => Some(format!("no {program}")),
    }
}

/// Whether every test is required.
fn required() -> bool {
    std::env::var_os("PSD_REQUIRE_SYSTEM").is_some_and(|value| value == "1")
}

/// False: the test is not run, and a message says so.
fn skipped(lacking: &str, required: bool) -> bool {
    println!("SKIPPED: {lacking}");
    assert!(
        !required,
        "{lacking}, and PSD_REQUIRE_SYSTEM=1 wants every test"
    );
    false
}

#[test]
fn what_is_missing_and_what_is_forbidden_are_skipped_or_fail_alike() {
    let lacks = |program: &str| lacking(program, "trace", &mut Command::new(program));
    assert_eq!(lacks("true"), None);
    assert_eq!(lacks("false").as_deref(), Some("false cannot trace here"));
    assert_eq!(
        lacks("no-such-program").as_deref(),
        Some("no no-such-program")
    );
    assert!(!skipped("false cannot trace here", false));
    let failed = std::panic::catch_unwind(|| skipped("false cannot trace here", true));
    let message = failed.unwrap_err().downcast::<String>().unwrap();
    assert_eq!(
        *message,
        "false cannot trace here, and PSD_REQUIRE_SYSTEM=1 wants every test"
    );
}
