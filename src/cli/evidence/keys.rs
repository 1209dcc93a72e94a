//! Keys in minisign's format: reading, creating, and keeping them out of run folders. In: paths and passwords. Out: keys. A secret key is
//! never printed, and no password is shown or read from the command line.

use std::fs::{File, OpenOptions};
use std::io::{Read as _, Write as _};
use std::os::unix::fs::{OpenOptionsExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use minisign::{KeyPair, PublicKey, SecretKey, SecretKeyBox};

use crate::files::failure::Failure;
use crate::files::failure::plain;
use crate::files::recorded_run::JOURNAL;

/// The largest key file that is read \[bytes\].
const KEY_BYTES: u64 = 4096;
/// The longest password that minisign accepts \[bytes\].
const PASSWORD_BYTES: usize = 1024;

/// A public key that the user trusts, and its name here.
#[derive(Clone, Debug)]
pub struct KnownKey {
    pub name: String,
    pub key: PublicKey,
}

/// The number of a key as minisign shows it.
pub fn number(keynum: &[u8]) -> String {
    keynum
        .iter()
        .rev()
        .fold(String::new(), |text, byte| text + &format!("{byte:02X}"))
}

/// Reads a public key: a file with a comment and the key, in the format of minisign.
pub fn public(path: &Path) -> Result<KnownKey, Failure> {
    let text = text_of(path)?;
    let key = text
        .lines()
        .nth(1)
        .and_then(|key| PublicKey::from_base64(key).ok());
    let key = key.ok_or_else(|| {
        Failure::file(path, "is not a public key").help("name the file that ends with `.pub`")
    })?;
    Ok(KnownKey {
        name: path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
        key,
    })
}

/// Reads a secret key, with its password if it has one. Also returns whether it has one.
pub fn secret(
    path: &Path,
    password_file: Option<&Path>,
    can_ask: bool,
) -> Result<(SecretKey, Protection), Failure> {
    let failed = |error: minisign::PError| {
        Failure::file(path, format!("is not a usable secret key: {error}"))
    };
    let text = text_of(path)?;
    let kept = SecretKeyBox::from_string(&text).map_err(failed)?;
    let open = SecretKey::from_unencrypted_box(kept.clone())
        .ok()
        .or_else(|| without_checksum(&text));
    if let Some(key) = open {
        return Ok((key, Protection::None));
    }
    let password = password(password_file, "password of the key: ", can_ask)?;
    SecretKey::from_box(kept, Some(password))
        .map(|key| (key, Protection::Password))
        .map_err(failed)
}

/// A key without a password in the format of the minisign program: with zeros for a checksum. Signing detects halves that do not belong
/// together.
fn without_checksum(text: &str) -> Option<SecretKey> {
    let bytes = STANDARD.decode(text.lines().nth(1)?).ok()?;
    // Algorithms of the signature, of the password and of the checksum, two bytes each; 32 bytes of checksum at the end.
    let (head, checksum) = (bytes.get(..6)?, bytes.last_chunk::<32>()?);
    let is_open = head == b"Ed\0\0B2" && *checksum == [0; 32];
    if is_open {
        SecretKey::from_bytes(&bytes).ok()
    } else {
        None
    }
}

/// The protection of a secret key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Protection {
    Password,
    /// Any reader of the file can sign with it.
    None,
}

/// Whether users other than the owner can read a key file.
pub fn is_readable_by_others(path: &Path) -> bool {
    path.metadata()
        .is_ok_and(|metadata| metadata.is_file() && metadata.permissions().mode() & 0o077 != 0)
}

/// Makes a pair of keys: the secret one in a new file that only its owner can read, the public one beside it with `.pub`.
pub fn make(path: &Path, password: Option<String>) -> Result<(PathBuf, PublicKey), Failure> {
    let failed = |error: minisign::PError| Failure::file(path, error.to_string());
    refuse_run_folder(path)?;
    let protection = if password.is_some() {
        "encrypted"
    } else {
        "unencrypted"
    };
    let pair = match password {
        Some(password) => KeyPair::generate_encrypted_keypair(Some(password)),
        None => KeyPair::generate_unencrypted_keypair(),
    };
    let KeyPair { pk, sk } = pair.map_err(failed)?;
    let public_path = PathBuf::from(format!("{}.pub", path.display()));
    let public = pk.to_box().map_err(failed)?.into_string();
    let comment = format!("psd {protection} secret key {}", number(pk.keynum()));
    let secret = sk.to_box(Some(&comment)).map_err(failed)?.into_string();
    // The public key first, because a secret key without it is useless; the public key alone is useless too.
    new_file(&public_path, public.as_bytes(), 0o644)?;
    new_file(path, secret.as_bytes(), 0o600)
        .inspect_err(|_| drop(std::fs::remove_file(&public_path)))?;
    Ok((public_path, pk))
}

/// Refuses a secret key in the folder of its evidence: it would be copied together with the evidence.
pub fn refuse_inside(key: &Path, run: &Path) -> Result<(), Failure> {
    let canonical = |path: &Path| {
        path.canonicalize()
            .map_err(|error| Failure::file(path, plain(&error)))
    };
    if canonical(key)?.starts_with(canonical(run)?) {
        return Err(
            Failure::file(key, "a secret key must not lie in the run folder")
                .help("keep it in a folder that only you can read"),
        );
    }
    Ok(())
}

/// The password from a file, or from the terminal without being shown.
pub fn password(file: Option<&Path>, prompt: &str, can_ask: bool) -> Result<String, Failure> {
    let password = match file {
        Some(path) => text_of(path)?.lines().next().unwrap_or_default().to_owned(),
        None if can_ask => rpassword::prompt_password(prompt)
            .map_err(|error| Failure::file("/dev/tty", plain(&error)))?,
        None => {
            return Err(Failure::command_line(
                "the key has a password, and no operator can be asked",
            )
            .help("write it into a file, and name the file with `--password-file`"));
        }
    };
    if password.is_empty() || password.len() > PASSWORD_BYTES {
        return Err(Failure::command_line(format!(
            "a password has 1 to {PASSWORD_BYTES} bytes"
        )));
    }
    Ok(password)
}

/// A run folder is recognised by its run log.
fn refuse_run_folder(path: &Path) -> Result<(), Failure> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    let folder = folder
        .canonicalize()
        .map_err(|error| Failure::file(folder, plain(&error)))?;
    match folder
        .ancestors()
        .find(|folder| folder.join(JOURNAL).exists())
    {
        Some(run) => refuse_inside(&folder, run),
        None => Ok(()),
    }
}

fn text_of(path: &Path) -> Result<String, Failure> {
    let failed = |error: std::io::Error| Failure::file(path, plain(&error));
    // A pipe is also accepted, so that another program can supply a password.
    let mut text = String::new();
    File::open(path)
        .and_then(|file| file.take(KEY_BYTES + 1).read_to_string(&mut text))
        .map_err(failed)?;
    if text.len() as u64 > KEY_BYTES {
        return Err(Failure::file(path, "is not a key or a password"));
    }
    Ok(text)
}

fn new_file(path: &Path, bytes: &[u8], mode: u32) -> Result<(), Failure> {
    let write = || {
        let mut file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .mode(mode)
            .open(path)?;
        file.write_all(bytes)?;
        file.sync_all()
    };
    write().map_err(|error: std::io::Error| Failure::file(path, plain(&error)))
}
