//! `psd sign RUN --key FILE` and `psd keygen FILE`: the signature of a run folder. In: a folder that verifies, and a key outside it. Out:
//! one signature file over its manifest. It overwrites nothing.

use std::path::{Path, PathBuf};

use clap::Args;

use super::verify::refuse_unproven;
use crate::args::name;
use crate::commands::prediction::prediction;
use crate::evidence::keys;
use crate::evidence::keys::Protection;
use crate::evidence::{Folder, MANIFEST, Rebuilt, Statement, examine, file_name, sign_manifest};
use crate::exit::{Exit, Failure};
use crate::files::run_folder::write_new;
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use psd::report::OutputFile;
use psd_text::diagnostic::excerpt::one_line;

#[derive(Debug, Args)]
#[command(
    after_help = "psd writes manifest.sha256.minisig, or manifest.sha256.ROLE.minisig, into the run folder. Check it with \
    `psd verify RUN --key KEY.pub` or `minisign -Vm manifest.sha256 -p KEY.pub`.\n\n\
    Exit codes:\n\
    \x20 0  signed\n\
    \x20 2  error on the command line\n\
    \x20 3  the folder does not verify, or fault of a file"
)]
pub struct SignArguments {
    /// The run folder; it must verify
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Secret key of `psd keygen` or minisign, outside the run folder
    #[arg(long, value_name = "FILE")]
    pub key: PathBuf,
    /// Role, as listed under `sign` in the plan's `report` block
    #[arg(long, value_name = "ROLE", value_parser = name)]
    pub role: Option<String>,
    /// Name of the signatory
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub name: Option<String>,
    /// File with the password in its first line [default: prompt]
    #[arg(long, value_name = "FILE")]
    pub password_file: Option<PathBuf>,
}

/// Signs a run folder.
pub fn sign(arguments: &SignArguments, settings: Settings) -> Result<Exit, Failure> {
    let run = &arguments.run;
    keys::refuse_inside(&arguments.key, run)?;
    let folder = Folder::read(run)?;
    let rebuilt = Rebuilt::of(&folder, &prediction);
    refuse_unproven(run, &examine(&folder, &rebuilt, &[]))?;
    let (Some(report), Some(manifest)) = (&rebuilt.report, folder.bytes(MANIFEST)) else {
        return Err(Failure::file(run, "has no results yet").help("create them with `psd report`"));
    };
    let role = role(arguments.role.as_deref(), &report.roles)?;
    let path = file_name(role, &report.roles);
    if folder.files.contains_key(&path) {
        return Err(Failure::file(
            run.join(path),
            "exists already: a signature is never overwritten",
        ));
    }
    let (key, protection) = keys::secret(
        &arguments.key,
        arguments.password_file.as_deref(),
        settings.can_ask,
    )?;
    warn(&arguments.key, protection);
    let statement = Statement {
        run: report.run_id.clone(),
        report: report.id.clone(),
        status: report.status.to_owned(),
        issued: report.issued.as_deref().map(one_line),
        role: role.map(str::to_owned),
        name: arguments.name.clone(),
        key: None,
    };
    let signed = sign_manifest(manifest, &key, &statement)
        .map_err(|error| Failure::file(&arguments.key, error.to_string()))?;
    let file = OutputFile {
        path,
        bytes: signed.into_bytes(),
    };
    write_new(run, &file)?;
    print_message(&format!("  signed by key {}\n", keys::number(key.keynum())));
    print_result(&format!("{}\n", run.join(file.path).display()))?;
    Ok(Exit::Met)
}

/// The role as the plan writes it. A plan that names signatories accepts no others.
fn role<'a>(given: Option<&'a str>, roles: &'a [String]) -> Result<Option<&'a str>, Failure> {
    let known = || {
        roles
            .iter()
            .map(|role| format!("`{}`", one_line(role)))
            .collect::<Vec<_>>()
            .join(", ")
    };
    match given {
        None if roles.len() > 1 => Err(Failure::command_line("the plan names several signatories")
            .help(format!("name your role with `--role`: {}", known()))),
        // A single role need not be named.
        None => Ok(roles.first().map(String::as_str)),
        Some(given) if roles.is_empty() => Ok(Some(given)),
        Some(given) => roles
            .iter()
            .map(String::as_str)
            .find(|role| *role == given)
            .map(Some)
            .ok_or_else(|| {
                Failure::command_line(format!("the plan has no role `{}`", one_line(given)))
                    .help(format!("the plan names {}", known()))
            }),
    }
}

#[derive(Debug, Args)]
#[command(
    after_help = "psd writes the secret key to FILE and the public key to FILE.pub, in the format of minisign."
)]
pub struct KeygenArguments {
    /// New file for the secret key, outside every run folder
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// File with the password in its first line [default: prompt]
    #[arg(long, value_name = "FILE", conflicts_with = "no_password")]
    pub password_file: Option<PathBuf>,
    /// Create a key without a password: every reader can sign
    #[arg(long)]
    pub no_password: bool,
}

/// Makes a pair of keys.
pub fn keygen(arguments: &KeygenArguments, settings: Settings) -> Result<Exit, Failure> {
    let password = match (&arguments.password_file, arguments.no_password) {
        (_, true) => None,
        (Some(file), false) => Some(keys::password(Some(file), "", settings.can_ask)?),
        (None, false) => {
            let first = keys::password(None, "password of the new key: ", settings.can_ask)?;
            if keys::password(None, "repeat it: ", settings.can_ask)? != first {
                return Err(Failure::command_line("the two passwords differ"));
            }
            Some(first)
        }
    };
    let protection = if password.is_some() {
        Protection::Password
    } else {
        Protection::None
    };
    let (public, key) = keys::make(&arguments.file, password)?;
    warn(&arguments.file, protection);
    print_message(&format!(
        "  key {}: give {} to everyone who verifies your signatures\n",
        keys::number(key.keynum()),
        public.display()
    ));
    print_result(&format!("{}\n", public.display()))?;
    Ok(Exit::Met)
}

fn warn(key: &Path, protection: Protection) {
    let name = one_line(&key.display().to_string());
    if protection == Protection::None {
        print_message(&format!(
            "  {name} has no password: everyone who reads it can sign with it\n"
        ));
    }
    if keys::is_readable_by_others(key) {
        print_message(&format!(
            "  {name} can be read by others than its owner: `chmod 600` prevents this\n"
        ));
    }
}
