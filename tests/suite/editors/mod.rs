//! The editors in `grammar/editors/`: what follows from the schema is generated. `cargo xtask generate editors` writes it. The grammar
//! for tree-sitter has tests of its own, beside it. `tests/system/editors.rs` has those that need Node.js.

mod queries;
mod snippets;
mod textmate;

use std::fs;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("grammar/editors")
}

fn read(name: &str) -> String {
    fs::read_to_string(folder().join(name)).unwrap_or_default()
}

/// Compares a file with `wanted`, or writes it.
#[track_caller]
fn compare(name: &str, wanted: &str) {
    if std::env::var_os("PSD_BLESS").is_some() {
        fs::write(folder().join(name), wanted).expect("the file can be written");
        return;
    }
    assert!(
        read(name) == wanted,
        "grammar/editors/{name} is behind the schema: cargo xtask generate editors"
    );
}
