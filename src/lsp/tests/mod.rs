//! The server over a connection in memory: every request, messages that are none, editors, transcripts and the rank of completions.

mod actions;
mod completion;
mod editors;
mod lifecycle;
mod navigation;
mod program;
mod ranks;
mod requests;
mod testing;
mod transcripts;
