//! Tells Zed how the language server of psd starts. The rest of the extension is data.

use zed_extension_api as zed;

struct Psd;

impl zed::Extension for Psd {
    fn new() -> Self {
        Self
    }

    fn language_server_command(
        &mut self,
        _: &zed::LanguageServerId,
        worktree: &zed::Worktree,
    ) -> zed::Result<zed::Command> {
        let command = worktree.which("psd").ok_or("there is no psd on PATH")?;
        Ok(zed::Command {
            command,
            args: vec!["lsp".to_owned()],
            env: worktree.shell_env(),
        })
    }
}

zed::register_extension!(Psd);
