//! Compiles the committed parser. `lib.rs` names the library that it links: rustdoc takes no such flag from a build script.

fn main() {
    println!("cargo::rerun-if-changed=src/parser.c");
    let folder = std::env::var("OUT_DIR").expect("cargo gives the folder");
    println!("cargo::rustc-link-search=native={folder}");
    cc::Build::new()
        .include("src")
        .file("src/parser.c")
        .warnings(false)
        .cargo_metadata(false)
        .compile("tree-sitter-psd");
}
