//! The tree-sitter parser of psd plans, for the tests beside it. It is C, generated from `grammar.js`.

use tree_sitter_language::LanguageFn;

#[link(name = "tree-sitter-psd", kind = "static")]
unsafe extern "C" {
    fn tree_sitter_psd() -> *const ();
}

/// The language, for `tree_sitter::Parser::set_language`.
// SAFETY: the function is that of the committed parser, which build.rs compiles: it takes nothing and returns a static table.
pub const LANGUAGE: LanguageFn = unsafe { LanguageFn::from_raw(tree_sitter_psd) };
