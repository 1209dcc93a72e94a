//! The grammar of the language: `grammar/psd.pest`, compiled.

use pest_derive::Parser;

#[derive(Parser)]
#[grammar = "../../grammar/psd.pest"]
pub struct Grammar;
