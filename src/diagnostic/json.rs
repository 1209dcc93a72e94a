//! Diagnostics for an editor.
