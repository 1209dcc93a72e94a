//! A complete `psd run` on example 1 in one process: from the text to report, tables and figures.

use std::process::Command;

fn main() {
    divan::main();
}

fn psd(arguments: &[&str]) {
    let status = Command::new(env!("CARGO_BIN_EXE_psd"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .status();
    assert!(
        status.is_ok_and(|status| status.success()),
        "psd {arguments:?}"
    );
}

#[divan::bench(sample_count = 20)]
fn run_example_1_to_certificate(bencher: divan::Bencher) {
    let scratch = tempfile::tempdir().expect("a folder");
    let count = std::sync::atomic::AtomicUsize::new(0);
    bencher.bench(|| {
        let number = count.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let out = scratch.path().join(number.to_string());
        psd(&[
            "run",
            "plans/example_1.psd",
            "--out",
            &out.to_string_lossy(),
        ]);
    });
}

#[divan::bench(sample_count = 50)]
fn check_a_small_plan() {
    psd(&["check", "plans/01_first_blow.psd"]);
}
