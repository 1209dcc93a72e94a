//! The command line of the evidence: `psd verify`, `sign`, `keygen`, `issue`, `report`. In: words. Out: their shapes, not their
//! meaning.

use std::path::PathBuf;

use clap::Args;

use super::{date, name};
use crate::text::diagnostic::excerpt::one_line;

/// The longest reason, characters.
const REASON: usize = 1000;

#[derive(Debug, Args)]
#[command(
    after_help = "Says of record, targets, results, figures, certificate, plan, manifest, sidecars and signature whether\n\
    each is what it must be. A folder that nobody signed is told to be unsigned.\n\n\
    Exit codes: 0 all is proven, 2 the command line is wrong, 3 something is not what it must be, or a key\n\
    that was named did not sign."
)]
pub struct VerifyArguments {
    /// The run folder
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// A public key that must have signed the folder; once for each signer, and nobody else may have signed
    #[arg(long, value_name = "FILE")]
    pub key: Vec<PathBuf>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Writes manifest.sha256.minisig into the run folder, or manifest.sha256.ROLE.minisig. Anybody checks it\n\
    with `psd verify RUN --key KEY.pub`, or with `minisign -Vm manifest.sha256 -p KEY.pub`.\n\n\
    Exit codes: 0 signed, 2 the command line is wrong, 3 the folder does not verify, or a file failed."
)]
pub struct SignArguments {
    /// The run folder; it must verify
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// The secret key, of `psd keygen` or of minisign; it must not lie in the run folder
    #[arg(long, value_name = "FILE")]
    pub key: PathBuf,
    /// As whom, of those the plan's `report` block names under `sign`
    #[arg(long, value_name = "ROLE", value_parser = name)]
    pub role: Option<String>,
    /// Who signs
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub name: Option<String>,
    /// A file whose first line is the key's password [default: it is asked for]
    #[arg(long, value_name = "FILE")]
    pub password_file: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Writes the secret key to FILE and the public one to FILE.pub, in minisign's format."
)]
pub struct KeygenArguments {
    /// The secret key's file, new, outside every run folder
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// A file whose first line becomes the key's password [default: it is asked for, twice]
    #[arg(long, value_name = "FILE", conflicts_with = "no_password")]
    pub password_file: Option<PathBuf>,
    /// A key without a password: whoever reads its file can sign with it
    #[arg(long)]
    pub no_password: bool,
}

#[derive(Debug, Args)]
#[command(
    after_help = "An amendment changes particulars of the `plan` block, such as the customer's name, and no measured or\n\
    computed number. Both reports are kept; each has an id of its own."
)]
pub struct ReportArguments {
    /// The run folder
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Where the results go, with a copy of the record: a new or empty folder [default: the run folder, if it has none; of an
    /// amendment RUN-amended-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Makes a report that takes the place of the one in RUN and says so
    #[arg(long, requires = "by", requires = "reason", requires = "date")]
    pub amend: bool,
    /// Who answers for the amendment
    #[arg(long, value_name = "NAME", value_parser = name, requires = "amend")]
    pub by: Option<String>,
    /// The day of the amendment, which is the new report's day of issue
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date, requires = "amend")]
    pub date: Option<String>,
    /// Why there is one
    #[arg(long, value_name = "TEXT", value_parser = reason, requires = "amend")]
    pub reason: Option<String>,
    /// Tells a particular otherwise; without a text it is not given any more
    #[arg(long, value_name = "FIELD=TEXT", value_parser = particular, requires = "amend")]
    pub set_particular: Vec<(String, String)>,
    /// A file of such particulars, one `field = text` a line
    #[arg(long, value_name = "FILE", requires = "amend")]
    pub particulars: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Writes a new folder beside the run, RUN-issued, with the same record and every result made from it again.\n\
    Only particulars of the `plan` block are stated so, such as `condition`, `temperature`, `humidity` or `deviations`; a\n\
    measured or computed number never is. A report that is issued already is changed by `psd report --amend`.\n\n\
    Exit codes: 0 issued, 2 the command line is wrong or the days are not in order, 3 the folder does not verify,\n\
    or a file failed."
)]
pub struct IssueArguments {
    /// The run folder; it must verify
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Who authorises the report
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub authorised_by: String,
    /// The day of issue
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date)]
    pub date: String,
    /// States a particular that is known only after the test; without a text it is not given any more
    #[arg(long, value_name = "FIELD=TEXT", value_parser = particular)]
    pub set_particular: Vec<(String, String)>,
    /// A file of such particulars, one `field = text` a line
    #[arg(long, value_name = "FILE")]
    pub particulars: Option<PathBuf>,
    /// Where the issued report goes, with a copy of the record: a new or empty folder [default: RUN-issued]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

fn particular(text: &str) -> Result<(String, String), String> {
    let (field, text) = text.split_once('=').ok_or("write it as FIELD=TEXT")?;
    Ok((field.trim().to_owned(), text.trim().to_owned()))
}

fn reason(text: &str) -> Result<String, String> {
    let reason = text.trim();
    if reason.is_empty() || reason.chars().count() > REASON || reason != one_line(reason) {
        return Err(format!("a reason is one line of at most {REASON} letters"));
    }
    Ok(reason.to_owned())
}
