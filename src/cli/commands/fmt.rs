//! `psd fmt`: the canonical layout. In: files and folders. Out: the files rewritten, or with `--check` the names of those
//! that would change; a plan from standard input goes to standard output. In a Markdown document only the blocks of the plan change. A file with syntax errors is not changed.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::exit::{Exit, Failure};
use crate::files::difference;
use crate::files::difference::Named;
use crate::files::failure::plain;
use crate::files::loader::{is_stdin, read_plan};
use crate::files::plan_file::name_of;
use crate::files::plans::{Depth, named};
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use psd_language::syntax;
use psd_text::diagnostic::excerpt::one_line;
use psd_text::diagnostic::render::render_all;
use psd_text::markdown::is_document;
use psd_text::source::Sources;

#[derive(Debug, Args)]
pub struct FmtArguments {
    /// Plans, folders of plans, or `-` for standard input
    #[arg(value_name = "PATH", required = true)]
    pub paths: Vec<PathBuf>,
    /// Print the difference only; exit with 1 if there is one
    #[arg(long)]
    pub check: bool,
}

/// Formats every named file and every plan under every named folder.
pub fn fmt(arguments: &FmtArguments, settings: Settings) -> Result<Exit, Failure> {
    let mut exit = Exit::Met;
    for path in named(&arguments.paths, Depth::Below)? {
        let done = one(&path, arguments.check, settings).unwrap_or_else(|failure| {
            print_message(&failure.report(settings));
            failure.exit()
        });
        exit = exit.max(done);
    }
    Ok(exit)
}

fn one(path: &Path, check: bool, settings: Settings) -> Result<Exit, Failure> {
    let text = read_plan(path)?;
    let Some(formatted) = canonical(path, &text, settings) else {
        return Ok(Exit::Wrong);
    };
    if is_stdin(path) && !check {
        print_result(&formatted)?;
        return Ok(Exit::Met);
    }
    if formatted == text {
        return Ok(Exit::Met);
    }
    if check {
        let name = one_line(&path.display().to_string());
        let of_the_formatted = format!("{name} (formatted)");
        print_result(&difference::unified(
            &Named {
                name: &name,
                text: &text,
            },
            &Named {
                name: &of_the_formatted,
                text: &formatted,
            },
        ))?;
        return Ok(Exit::Missed);
    }
    // A check of the formatter: its output must parse without errors and be stable.
    if canonical(path, &formatted, settings).as_deref() != Some(formatted.as_str()) {
        return Err(Failure::file(
            path,
            "unchanged: formatting its formatted text would change it again",
        ));
    }
    replace(path, &formatted).map_err(|error| Failure::file(path, plain(&error)))?;
    print_message(&format!(
        "formatted {}\n",
        one_line(&path.display().to_string())
    ));
    Ok(Exit::Met)
}

/// The canonical text. None if the file has syntax errors, which are printed.
fn canonical(path: &Path, text: &str, settings: Settings) -> Option<String> {
    let mut sources = Sources::default();
    let file = sources.add(name_of(path), text);
    let (ast, faults) = syntax::parse(&sources, file);
    if faults
        .iter()
        .any(psd_text::diagnostic::Diagnostic::is_error)
    {
        print_message(&render_all(&faults, &sources, &settings.appearance(path)));
        return None;
    }
    Some(if is_document(&name_of(path)) {
        syntax::format_document(text)
    } else {
        syntax::format(&ast, text)
    })
}

/// Writes a new file and renames it, so that the plan on disk is always complete. A link stays a link.
fn replace(path: &Path, text: &str) -> std::io::Result<()> {
    let canonical = path.canonicalize()?;
    let temporary =
        canonical.with_file_name(format!(".{}.{}", name_of(&canonical), std::process::id()));
    let write = || -> std::io::Result<()> {
        let mut file = std::fs::OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&temporary)?;
        file.write_all(text.as_bytes())?;
        file.set_permissions(canonical.metadata()?.permissions())?;
        file.sync_all()?;
        std::fs::rename(&temporary, &canonical)
    };
    write().inspect_err(|_| {
        // The first error is reported.
        let _ = std::fs::remove_file(&temporary);
    })
}
