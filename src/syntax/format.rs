//! format
use super::ast::Ast;
/// The canonical text.
#[must_use]
pub fn format(_ast: &Ast, text: &str) -> String {
    text.to_owned()
}
