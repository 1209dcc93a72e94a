//! All integration tests in one binary: one link, one module a concern.

mod cli;
mod cli_rig;
mod cli_screen;
mod dialects;
mod docs;
mod evidence;
mod explain;
mod golden;
mod house;
mod lang;
mod manual;
mod manual_golden;
mod outputs;
mod physics;
mod plans;
mod reference;
mod rehearse;
mod relaxing_rig;
mod serve;
mod shake;
mod shake_continuous;
mod specimens_page;
mod storey;
mod sweep;
mod uncertainty;
