//! The console blocks of the book. `sh` runs each `$ ` line in a folder of the page, which contains a copy of `plans/` and the plans of
//! the page whose fence has a file name: `psd rod.psd`. The output on both streams must equal the block of the page. A line `...`
//! represents any lines.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use tempfile::TempDir;

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder can be made");
    for entry in fs::read_dir(from).expect("a readable folder") {
        let path = entry.expect("a readable entry").path();
        let target = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, target).expect("a file can be copied");
        }
    }
}

/// Output of a command, including standard error, without the progress of writing.
fn printed(command: &str, folder: &Path) -> Vec<String> {
    let program = Path::new(env!("CARGO_BIN_EXE_psd"));
    let path = format!(
        "{}:{}",
        program.parent().expect("a folder").display(),
        std::env::var("PATH").unwrap_or_default()
    );
    let output = Command::new("sh")
        .args(["-c", &format!("{{ {command}\n}} 2>&1")])
        .current_dir(folder)
        .env("PATH", path)
        .env("NO_COLOR", "1")
        .stdin(Stdio::null())
        .output()
        .expect("sh starts");
    String::from_utf8(output.stdout)
        .expect("UTF-8")
        .replace(&*folder.to_string_lossy(), "/home/tester")
        .lines()
        .filter(|line| !line.starts_with("  writing "))
        .map(|line| line.trim_end().to_owned())
        .collect()
}

/// A line whose digests are replaced: they change with every build.
fn without_digests(line: &str) -> String {
    line.split(' ')
        .map(|word| {
            let bare = word.trim_end_matches([',', '.']);
            let digest =
                bare.len() >= 16 && bare.chars().all(|c| c.is_ascii_hexdigit() || c == '-');
            if digest { "DIGEST" } else { word }
        })
        .collect::<Vec<_>>()
        .join(" ")
}

/// Whether lines equal the expected ones; `...` represents any number of lines.
fn matches(shown: &[String], printed: &[String]) -> bool {
    match (shown.first().map(String::as_str), printed.first()) {
        (None, None) => true,
        (Some("..."), _) => (0..=printed.len()).any(|skip| matches(&shown[1..], &printed[skip..])),
        (Some(line), Some(other)) => {
            without_digests(line) == without_digests(other) && matches(&shown[1..], &printed[1..])
        }
        _ => false,
    }
}

/// Text that the page must show: the whole output, or as many first and last lines around `...` as before.
fn rewritten(shown: &[String], printed: Vec<String>) -> Vec<String> {
    let is_gap = |line: &String| line == "...";
    let (Some(first), Some(last)) = (
        shown.iter().position(is_gap),
        shown.iter().rposition(is_gap),
    ) else {
        return printed;
    };
    let (head, tail) = (first, shown.len() - last - 1);
    if head + tail >= printed.len() {
        return printed;
    }
    let mut lines = printed[..head].to_vec();
    lines.push("...".to_owned());
    lines.extend_from_slice(&printed[printed.len() - tail..]);
    lines
}

/// The page with the output of every console block. A block that differs from the page is wrong.
fn run(page: &Path) -> (String, String) {
    let text = super::text(page);
    let folder = TempDir::new().expect("a folder can be made");
    copy(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("plans"),
        &folder.path().join("plans"),
    );
    for block in super::blocks(&text) {
        let file = Path::new(block.info.strip_prefix("psd ").unwrap_or_default());
        let is_plan = file.extension().is_some_and(|ending| ending == "psd");
        if is_plan && file.components().count() == 1 {
            fs::write(folder.path().join(file), &block.body).expect("the plan can be written");
        }
    }
    let mut lines = text.lines().peekable();
    let mut new = Vec::new();
    let mut inside = false;
    while let Some(line) = lines.next() {
        new.push(line.to_owned());
        inside = (inside || line == "```console") && line != "```";
        let Some(command) = line.strip_prefix("$ ").filter(|_| inside) else {
            continue;
        };
        let mut shown = Vec::new();
        while let Some(next) = lines.next_if(|next| !next.starts_with("$ ") && *next != "```") {
            shown.push(next.to_owned());
        }
        let printed = printed(command, folder.path());
        if matches(&shown, &printed) {
            new.extend(shown);
        } else {
            new.extend(rewritten(&shown, printed));
        }
    }
    (text, new.join("\n") + "\n")
}

#[test]
fn every_console_block_shows_what_psd_prints() {
    let mut run_pages = 0;
    for page in super::pages() {
        if !super::text(&page).contains("\n```console\n") {
            continue;
        }
        let (old, new) = run(&page);
        if super::accepts_output() && old != new {
            fs::write(super::docs().join(&page), &new).expect("the page can be written");
        } else {
            snapbox::assert_data_eq!(new, snapbox::Data::text(old).raw());
        }
        run_pages += 1;
    }
    assert!(run_pages >= 6, "{run_pages} pages with console blocks");
}
