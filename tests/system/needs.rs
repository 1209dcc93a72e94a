//! What a test needs of the system. In: a program and something it must be able to do here. Out: whether it can; if
//! not, the test says that it is skipped, and fails where `PSD_REQUIRE_SYSTEM=1` asks for a program that is missing.

use std::process::{Command, Stdio};

/// Whether `strace` is here and may trace.
pub fn strace() -> bool {
    able("strace", "trace", Command::new("strace").args(["-f", "-o", "/dev/null", "true"]))
}

/// Whether a file system of one's own can be mounted.
pub fn own_mounts() -> bool {
    able("unshare", "mount a tmpfs of its own", Command::new("unshare").args(["-rm", "mount", "-t", "tmpfs", "tmpfs", "/mnt"]))
}

/// Whether limits of a process can be set.
pub fn prlimit() -> bool {
    able("prlimit", "set a limit", Command::new("prlimit").args(["--fsize=100000", "true"]))
}

/// Whether `minisign` is here.
pub fn minisign() -> bool {
    able("minisign", "say its version", Command::new("minisign").arg("-v"))
}

/// Whether Python reads XML.
pub fn python() -> bool {
    able("python3", "read XML", Command::new("python3").args(["-c", "import xml.etree.ElementTree"]))
}

/// Whether `prove` is here, Perl's reader of the Test Anything Protocol.
pub fn prove() -> bool {
    able("prove", "say its version", Command::new("prove").arg("--version"))
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
    if !able("faketime", "set a clock", Command::new("faketime").args(["-f", "-1y", "true"])) {
        return false;
    }
    let here = std::path::Path::new(FAKETIME).exists();
    if !here {
        println!("SKIPPED: the library of faketime is not at {FAKETIME}");
    }
    here
}

fn able(program: &str, what: &str, proof: &mut Command) -> bool {
    let proven = proof.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    let missing = match proven {
        Ok(status) if status.success() => return true,
        // A machine that forbids it lacks no program: no installation would help.
        Ok(_) => {
            println!("SKIPPED: {program} cannot {what} here");
            return false;
        }
        Err(_) => format!("no {program}"),
    };
    println!("SKIPPED: {missing}");
    let required = std::env::var_os("PSD_REQUIRE_SYSTEM").is_some_and(|value| value == "1");
    assert!(!required, "{missing}, and PSD_REQUIRE_SYSTEM=1 wants every test");
    false
}
