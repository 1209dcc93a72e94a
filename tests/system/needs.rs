//! What a test needs of the system. In: a program and something it must be able to do here. Out: whether it can; if
//! not, the test says that it is skipped, and fails where `PSD_REQUIRE_SYSTEM=1` wants every test, whether the program is
//! missing or the machine forbids what it does.

use std::process::{Command, Stdio};

/// Whether `strace` is here and may trace.
pub fn strace() -> bool {
    able(
        "strace",
        "trace",
        Command::new("strace").args(["-f", "-o", "/dev/null", "true"]),
    )
}

/// Whether a file system of one's own can be mounted.
pub fn own_mounts() -> bool {
    able(
        "unshare",
        "mount a tmpfs of its own",
        Command::new("unshare").args(["-rm", "mount", "-t", "tmpfs", "tmpfs", "/mnt"]),
    )
}

/// Whether limits of a process can be set.
pub fn prlimit() -> bool {
    able(
        "prlimit",
        "set a limit",
        Command::new("prlimit").args(["--fsize=100000", "true"]),
    )
}

/// Whether `minisign` is here.
pub fn minisign() -> bool {
    able(
        "minisign",
        "say its version",
        Command::new("minisign").arg("-v"),
    )
}

/// Whether Python reads XML.
pub fn python() -> bool {
    able(
        "python3",
        "read XML",
        Command::new("python3").args(["-c", "import xml.etree.ElementTree"]),
    )
}

/// Whether `prove` is here, Perl's reader of the Test Anything Protocol.
pub fn prove() -> bool {
    able(
        "prove",
        "say its version",
        Command::new("prove").arg("--version"),
    )
}

/// Whether `qpdf` and poppler's `pdftotext` are here.
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

/// Whether a program can be given a terminal of its own, as a shell gives it one.
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

/// What stands in the way, if anything.
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

/// Whether every test is wanted.
fn required() -> bool {
    std::env::var_os("PSD_REQUIRE_SYSTEM").is_some_and(|value| value == "1")
}

/// False: the test is not done, and says so.
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
    let told = failed.unwrap_err().downcast::<String>().unwrap();
    assert_eq!(
        *told,
        "false cannot trace here, and PSD_REQUIRE_SYSTEM=1 wants every test"
    );
}
