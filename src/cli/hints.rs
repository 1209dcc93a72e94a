//! Options and commands that other programs have, with what psd has instead. In: an error of the command line. Out: the same error, with
//! the hint in place of a similar word.

use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory as _, Error};

use crate::commands::Arguments;

/// Options, and what to write: the first option of psd in the hint is one of the command, or the hint names another command.
const OPTIONS: &[(&[&str], &str)] = &[
    (
        &["-o", "--output", "--output-dir"],
        "`--out DIR` names the folder",
    ),
    (
        &["-n", "--dry-run", "--simulate"],
        "`psd check --explain PLAN` predicts the run, and moves nothing",
    ),
    (
        &["-q", "--quiet", "--silent"],
        "`--screen never` prints no progress",
    ),
    (
        &["-v", "--verbose", "--debug"],
        "`--screen plain` prints a line for each procedure; the run log has every step",
    ),
    (
        &["-y", "--force"],
        "`--yes` answers every prompt with yes, also the release of a real rig",
    ),
    (
        &["-D", "-p", "--param", "--define", "--var"],
        "`--set NAME=VALUE` changes a `param`",
    ),
    (&["--json"], "`--format json` prints for programs"),
    (
        &["--strict", "-W", "--werror"],
        "`--deny-warnings` makes a warning an error",
    ),
];

/// Commands, and what to write.
const COMMANDS: &[(&[&str], &str)] = &[
    (
        &["init", "create", "template"],
        "`psd new impact` writes a plan to start from",
    ),
    (
        &["lint", "validate"],
        "`psd check PLAN` reports all errors of a plan",
    ),
    (
        &["format"],
        "`psd fmt PLAN` writes a plan in the standard layout",
    ),
    (
        &["simulate"],
        "`psd run PLAN` simulates a test; `psd rig simulate PLAN` emulates its rig",
    ),
    (
        &["list", "ls", "runs"],
        "the runs are folders: `ls -t runs`",
    ),
    (
        &["plot", "show", "open", "view"],
        "`psd report --open RUN` opens the report with its figures",
    ),
    (&["diff"], "`psd compare RUN RUN` compares runs"),
    (
        &["probe", "jog", "monitor", "serve"],
        "write `psd rig` before it",
    ),
    (&["accept", "bless"], "`psd test --accept` accepts results"),
];

/// The long option that a hint begins with; none if it begins with a command.
fn option_of(hint: &str) -> Option<&str> {
    hint.strip_prefix("`--")?.split([' ', '`']).next()
}

/// Whether the command of this line takes a long option.
fn takes(line: &[OsString], option: &str) -> bool {
    let mut command = Arguments::command();
    for word in line.iter().skip(1).filter_map(|word| word.to_str()) {
        let Some(found) = command.find_subcommand(word).cloned() else {
            break;
        };
        command = found;
    }
    command
        .get_arguments()
        .any(|argument| argument.get_long() == Some(option))
}

/// The error of a line with a hint, if it is about a word of another program. An unknown long option of a command that takes `--set` may be
/// the name of a parameter.
pub fn with_hint(mut error: Error, line: &[OsString]) -> Error {
    let (words, written, similar) = match error.kind() {
        ErrorKind::UnknownArgument => (OPTIONS, ContextKind::InvalidArg, ContextKind::SuggestedArg),
        ErrorKind::InvalidSubcommand => (
            COMMANDS,
            ContextKind::InvalidSubcommand,
            ContextKind::SuggestedSubcommand,
        ),
        _ => return error,
    };
    let Some(ContextValue::String(word)) = error.get(written) else {
        return error;
    };
    let word = word.split('=').next().unwrap_or(word).to_owned();
    let known = words.iter().find(|(known, hint)| {
        known.contains(&&*word) && option_of(hint).is_none_or(|option| takes(line, option))
    });
    let hint = match known {
        Some((_, hint)) => {
            error.remove(similar);
            (*hint).to_owned()
        }
        None if word.starts_with("--") && takes(line, "set") => {
            format!(
                "a value of the plan is set with `--set {}=VALUE`",
                &word[2..]
            )
        }
        None => return error,
    };
    error.insert(
        ContextKind::Suggested,
        ContextValue::StyledStrs(vec![hint.into()]),
    );
    error
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser as _;

    fn shown(line: &str) -> String {
        let words = ["psd"].into_iter().chain(line.split(' '));
        let line: Vec<OsString> = words.map(OsString::from).collect();
        let error = Arguments::try_parse_from(&line).expect_err("an error");
        with_hint(error, &line).to_string()
    }

    #[test]
    fn a_word_of_another_program_has_a_hint() {
        let output = shown("run plan.psd -o results");
        assert!(
            output.contains("tip: `--out DIR`") && !output.contains("-- -o"),
            "{output}"
        );
        let speed = shown("run plan.psd --speed 1");
        assert!(speed.contains("`--set speed=VALUE`"), "{speed}");
        let list = shown("list");
        assert!(
            list.contains("`ls -t runs`") && !list.contains("lsp"),
            "{list}"
        );
        let dry = shown("run plan.psd --dry-run");
        assert!(dry.contains("`psd check --explain PLAN`"), "{dry}");
        let near = shown("chek plan.psd");
        assert!(near.contains("'check'"), "{near}");
    }

    /// A hint names an option that its command takes.
    #[test]
    fn a_hint_is_true_of_its_command() {
        for line in [
            "fmt plan.psd --speed 1",
            "verify run --quiet",
            "fmt -o plan.psd",
        ] {
            let shown = shown(line);
            assert!(!shown.contains("`--"), "{line}: {shown}");
        }
        for (_, hint) in OPTIONS {
            let option = option_of(hint);
            let has = |line: &[&str]| {
                let line: Vec<OsString> = line.iter().map(OsString::from).collect();
                option.is_none_or(|option| takes(&line, option))
            };
            assert!(has(&["psd", "run"]) || has(&["psd", "check"]), "{hint}");
        }
    }

    /// A hint for a word that psd has would never be seen.
    #[test]
    fn no_hint_is_for_a_command_of_psd() {
        let program = Arguments::command();
        let own: Vec<&str> = program
            .get_subcommands()
            .map(clap::Command::get_name)
            .collect();
        for (words, hint) in COMMANDS {
            for word in *words {
                assert!(!own.contains(word), "{word}: {hint}");
            }
        }
    }
}
