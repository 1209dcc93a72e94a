//! The committed parser is what `grammar.js` makes: `grammar.json` by Node.js, the rest from `grammar.json` alone. With `PSD_BLESS=1` the
//! tests write the files (`cargo xtask generate tree-sitter`); the parser that other tests use is then built again.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use tree_sitter_generate::{OptLevel, generate_parser_in_directory, load_grammar_file};

/// The newest version that Helix and the Neovim of Debian 12 read.
const ABI: usize = 14;

/// Most bytes of the parser.
const LARGEST: u64 = 1 << 20;

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn is_blessed() -> bool {
    std::env::var_os("PSD_BLESS").is_some()
}

/// Compares a committed file with `wanted`, or writes it.
fn compare(name: &str, wanted: &str) {
    let path = folder().join(name);
    if is_blessed() {
        fs::create_dir_all(path.parent().expect("a file is in a folder"))
            .and_then(|()| fs::write(path, wanted))
            .expect("the file can be written");
    } else {
        let committed = fs::read_to_string(path).unwrap_or_default();
        assert!(
            committed == wanted,
            "{name} is behind its source: cargo xtask generate tree-sitter"
        );
    }
}

/// `grammar.json`, where Node.js is there to run `grammar.js`.
fn grammar_json() -> Option<String> {
    let has_node = Command::new("node").arg("--version").output().is_ok();
    if !has_node {
        let required = std::env::var_os("PSD_REQUIRE_SYSTEM").is_some_and(|value| value == "1");
        assert!(!required, "no node");
        println!("SKIPPED: no node, which runs grammar.js");
        return None;
    }
    let json = load_grammar_file(&folder().join("grammar.js"), None);
    Some(json.expect("grammar.js is right"))
}

/// One test, because the second half reads what the first may write.
#[test]
fn the_parser_is_that_of_the_grammar() {
    if let Some(json) = grammar_json() {
        compare("src/grammar.json", &json);
    }

    let fresh = tempfile::tempdir().expect("a folder");
    generate_parser_in_directory(
        folder(),
        Some(fresh.path()),
        Some(folder().join("src/grammar.json")),
        ABI,
        None,
        None,
        true,
        OptLevel::default(),
        &mut Vec::new(),
    )
    .expect("the grammar has no conflict");
    let files = [
        "parser.c",
        "node-types.json",
        "tree_sitter/alloc.h",
        "tree_sitter/array.h",
        "tree_sitter/parser.h",
    ];
    for file in files.map(PathBuf::from) {
        let wanted = fs::read_to_string(fresh.path().join(&file)).expect("it is generated");
        compare(&format!("src/{}", file.display()), &wanted);
    }
    let size = fs::metadata(folder().join("src/parser.c"))
        .expect("the parser is there")
        .len();
    assert!(size < LARGEST, "parser.c has {size} bytes");
}
