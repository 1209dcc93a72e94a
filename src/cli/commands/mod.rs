//! The commands, one file or folder each, with its flags. In: parsed arguments and settings. Out: an exit code or a failure. A command
//! does not know another command. The list of them is here.

pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod evidence;
pub(crate) mod explain;
pub(crate) mod explain_plan;
pub(crate) mod fmt;
pub(crate) mod limits;
pub(crate) mod lsp;
pub(crate) mod new;
pub(crate) mod prediction;
pub(crate) mod rig;
pub(crate) mod run;
pub(crate) mod study;
pub(crate) mod test;
pub(crate) mod units;

use clap::{CommandFactory as _, Parser, Subcommand};

use super::args::Color;
use super::exit::{Exit, Failure};
use super::settings::Settings;

/// Pseudo-dynamic structural tests, from a plan to a test report.
#[derive(Debug, Parser)]
#[command(name = "psd", version, long_version = concat!(
    env!("CARGO_PKG_VERSION"), "\nsources, SHA-256 ", env!("PSD_BUILD"), "\nbuilt for ", env!("PSD_TOOLCHAIN"),
), about, max_term_width = 100, arg_required_else_help = true)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,

    /// Colour the output; respects `NO_COLOR`
    #[arg(long, global = true, value_enum, default_value_t = Color::Auto, value_name = "WHEN")]
    pub color: Color,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a commented plan to start from
    New(new::NewArguments),
    /// Check plans, run them, write results and test reports
    Run(run::RunArguments),
    /// Resume an interrupted run on a real rig
    Resume(run::resume::ResumeArguments),
    /// Issue the report of a run (no motion)
    Issue(evidence::issue::IssueArguments),
    /// Recompute the results of a run from its run log (no motion)
    Report(evidence::report::ReportArguments),
    /// Verify run log, results and signatures of a run (no motion)
    Verify(evidence::verify::VerifyArguments),
    /// Sign a verified run folder
    Sign(evidence::sign::SignArguments),
    /// Create a pair of signature keys
    Keygen(evidence::sign::KeygenArguments),
    /// Report all errors of plans (no motion)
    Check(check::CheckArguments),
    /// Compare results of two or more runs
    Compare(compare::CompareArguments),
    /// Compare plans on virtual rigs with their accepted results
    Test(test::TestArguments),
    /// Format plans in the canonical layout
    Fmt(fmt::FmtArguments),
    /// Explain a code, block, field, result, option or unit
    Explain(explain::ExplainArguments),
    /// Convert a value: `psd units 3 kip/in to N/mm`; list the units
    Units(units::UnitsArguments),
    /// List the limits of the language: sizes, nesting, steps
    Limits,
    /// Serve an editor: the language server, over standard input and output
    Lsp,
    /// Print the completions of a shell
    Completions(completions::CompletionsArguments),
    /// Print the manual page
    Man(completions::ManArguments),
    /// Run many simulations of a plan with scattered inputs
    Study {
        #[command(subcommand)]
        command: study::StudyCommand,
    },
    /// Probe, monitor, jog, emulate or serve a rig
    Rig {
        #[command(subcommand)]
        command: rig::RigCommand,
    },
}

impl Command {
    /// Runs it.
    pub(super) fn run(&self, settings: Settings) -> Result<Exit, Failure> {
        match self {
            Self::New(arguments) => new::new(arguments),
            Self::Run(arguments) => run::run(arguments, settings),
            Self::Resume(arguments) => run::resume::resume(arguments, settings),
            Self::Issue(arguments) => evidence::issue::issue(arguments, settings),
            Self::Report(arguments) => evidence::report::report(arguments, settings),
            Self::Verify(arguments) => evidence::verify::verify(arguments, settings),
            Self::Sign(arguments) => evidence::sign::sign(arguments, settings),
            Self::Keygen(arguments) => evidence::sign::keygen(arguments, settings),
            Self::Compare(arguments) => compare::compare(arguments),
            Self::Test(arguments) => test::test(arguments, settings),
            Self::Check(arguments) => check::check(arguments, settings),
            Self::Fmt(arguments) => fmt::fmt(arguments, settings),
            Self::Explain(arguments) => {
                explain::explain(arguments.word.as_deref(), arguments.full, settings)
            }
            Self::Units(arguments) => units::units(arguments, settings),
            Self::Completions(arguments) => {
                completions::completions(arguments, Arguments::command())
            }
            Self::Man(arguments) => completions::man(arguments, Arguments::command()),
            Self::Limits => limits::limits(),
            Self::Lsp => lsp::lsp(),
            Self::Study { command } => study::study(command, settings),
            Self::Rig { command } => rig::rig(command, settings),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        Arguments::command().debug_assert();
    }
}
