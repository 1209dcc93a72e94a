//! The plugin of `grammar/editors/neovim` in Debian's neovim: it recognises a plan and starts `psd lsp`. The editor shows a diagnostic, asks
//! for a hover, a definition, a rename, a fix and the layout, and applies what it gets.

use std::path::Path;
use std::process::{Command, Stdio};

use super::needs;

/// What the editor does. It prints one line for each answer.
const SCRIPT: &str = r"
local function say(name, value) io.stdout:write(name .. ': ' .. tostring(value) .. '\n') end
local client
local function ask(method, line, character, more)
  local params = { textDocument = { uri = vim.uri_from_bufnr(0) }, position = { line = line, character = character } }
  local answers = vim.lsp.buf_request_sync(0, method, vim.tbl_extend('force', params, more or {}), 20000)
  return answers and answers[client] and answers[client].result
end
vim.cmd('edit plan.psd')
say('filetype', vim.bo.filetype)
say('omnifunc', vim.bo.omnifunc)
vim.wait(20000, function() return next(vim.lsp.buf_get_clients(0)) ~= nil end)
client = next(vim.lsp.buf_get_clients(0))
vim.wait(20000, function() return #vim.diagnostic.get(0) > 0 end)
for _, one in ipairs(vim.diagnostic.get(0)) do say('diagnostic', one.lnum .. ' ' .. one.message:gsub('\n', '; ')) end
local at = { start = { line = 6, character = 4 }, ['end'] = { line = 6, character = 4 } }
local actions = ask('textDocument/codeAction', 6, 4, { range = at, context = { diagnostics = {} } })
for _, one in ipairs(actions or {}) do
  if one.kind == 'quickfix' then
    say('fix', one.title)
    vim.lsp.util.apply_workspace_edit(one.edit, 'utf-16')
  end
end
say('fixed', vim.fn.getline(7))
vim.wait(20000, function() return #vim.diagnostic.get(0) == 0 end)
say('left', #vim.diagnostic.get(0))
say('hover', ask('textDocument/hover', 5, 15).contents.value:gsub('\n.*', ''))
say('definition', ask('textDocument/definition', 5, 15).uri:gsub('.*/', ''))
vim.lsp.util.apply_workspace_edit(ask('textDocument/rename', 5, 15, { newName = 'mallet' }), 'utf-16')
say('renamed', vim.fn.getline(6))
vim.cmd('edit lib.psd')
say('renamed there', vim.fn.getline(1))
vim.cmd('buffer plan.psd')
local edits = ask('textDocument/formatting', 0, 0, { options = { tabSize = 2, insertSpaces = true } })
vim.lsp.util.apply_text_edits(edits, vim.api.nvim_get_current_buf(), 'utf-16')
say('formatted', vim.fn.getline(6))
vim.lsp.stop_client(client)
vim.wait(20000, function() return vim.lsp.client_is_stopped(client) end)
say('stopped', vim.lsp.client_is_stopped(client))
vim.cmd('qall!')
";

const LIBRARY: &str = "striker hammer {\n  mass     = 10 kg\n  velocity = 1 m/s\n}\n\nspecimen beam {\n  mass      = 1 kg\n  behaviour = elastic(stiffness: 300 N/m)\n}\n";

/// The sixth line names the striker of the library, the seventh has a misspelt field.
const PLAN: &str = "use \"lib.psd\"\n\n# One impact on the beam of the library\n\nimpact hit {\n  striker = hammer\n  durtion = 1 s\n}\n\nrequire \"stays below the stop\" hit.max_displacement < 1 m\n";

#[test]
fn neovim_shows_fixes_renames_and_formats() {
    if !needs::neovim() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [
        ("lib.psd", LIBRARY),
        ("plan.psd", PLAN),
        ("script.lua", SCRIPT),
    ] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let plugin = Path::new(env!("CARGO_MANIFEST_DIR")).join("grammar/editors/neovim");
    let output = Command::new("nvim")
        .args(["--headless", "-u", "NONE", "-i", "NONE", "-n"])
        .arg("--cmd")
        .arg(format!("set hidden runtimepath^={}", plugin.display()))
        .args(["--cmd", "let g:psd_path = $PSD"])
        .args(["-c", "filetype plugin on"])
        .args(["-c", "luafile script.lua", "-c", "cquit"])
        .current_dir(folder.path())
        .env("PSD", env!("CARGO_BIN_EXE_psd"))
        .env("XDG_CACHE_HOME", folder.path())
        .env("XDG_STATE_HOME", folder.path())
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    for wanted in [
        "filetype: psd",
        "omnifunc: v:lua.vim.lsp.omnifunc",
        "diagnostic: 6 `impact` has no field `durtion`; did you mean `duration`?",
        "fix: replace by `duration`",
        "fixed:   duration = 1 s",
        "left: 0",
        "hover: **striker hammer**",
        "definition: lib.psd",
        "renamed:   striker = mallet",
        "renamed there: striker mallet {",
        "formatted:   striker  = mallet",
        "stopped: true",
    ] {
        assert!(
            said.lines().any(|line| line == wanted),
            "{wanted}\nsaid:\n{said}\nerrors:\n{errors}"
        );
    }
    assert!(output.status.success(), "{errors}");
}
