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
    after_help = "psd recomputes targets, results, figures, report and manifest from the run log, and compares them with the files. An unsigned \
    folder is reported as unsigned; this is not an error.\n\n\
    Exit codes:\n\
    \x20 0  everything is verified\n\
    \x20 2  error on the command line\n\
    \x20 3  a difference, or a named key did not sign"
)]
pub struct VerifyArguments {
    /// The run folder
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Required public key; repeat for each signatory
    #[arg(long, value_name = "FILE")]
    pub key: Vec<PathBuf>,
}

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

#[derive(Debug, Args)]
#[command(
    after_help = "An amendment changes particulars of the `plan` block, such as the name of the customer. It never changes a measured or computed \
    number. Both reports are kept, each with its own id."
)]
pub struct ReportArguments {
    /// The run folder
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// New or empty folder for the results [default: the run folder, or RUN-amended-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Create a report that replaces the one in RUN
    #[arg(long, requires = "by", requires = "reason", requires = "date")]
    pub amend: bool,
    /// Person authorising the amendment
    #[arg(long, value_name = "NAME", value_parser = name, requires = "amend")]
    pub by: Option<String>,
    /// Date of the amendment, and of issue of the new report
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date, requires = "amend")]
    pub date: Option<String>,
    /// Reason of the amendment
    #[arg(long, value_name = "TEXT", value_parser = reason, requires = "amend")]
    pub reason: Option<String>,
    /// Change a particular; an empty text removes it
    #[arg(long, value_name = "FIELD=TEXT", value_parser = particular, requires = "amend")]
    pub set_particular: Vec<(String, String)>,
    /// File of particulars, one `field = text` per line
    #[arg(long, value_name = "FILE", requires = "amend")]
    pub particulars: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "psd writes a new folder, RUN-issued, with the same run log and all results recomputed from it. Only particulars of the `plan` \
    block can be stated, such as `condition`, `temperature`, `humidity` or `deviations`. To change an issued report, use \
    `psd report --amend`.\n\n\
    Exit codes:\n\
    \x20 0  issued\n\
    \x20 2  error on the command line, or dates out of order\n\
    \x20 3  the folder does not verify, or fault of a file"
)]
pub struct IssueArguments {
    /// The run folder; it must verify
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Person authorising the report
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub authorised_by: String,
    /// Date of issue
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date)]
    pub date: String,
    /// State a particular; an empty text removes it
    #[arg(long, value_name = "FIELD=TEXT", value_parser = particular)]
    pub set_particular: Vec<(String, String)>,
    /// File of particulars, one `field = text` per line
    #[arg(long, value_name = "FILE")]
    pub particulars: Option<PathBuf>,
    /// New or empty folder for the issued report [default: RUN-issued]
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
        return Err(format!(
            "a reason must be one line of at most {REASON} characters"
        ));
    }
    Ok(reason.to_owned())
}
