-- A buffer with a plan: comments, indents, the language server, and the colours of tree-sitter where its parser is built.

vim.bo.commentstring = '# %s'
vim.bo.expandtab = true
vim.bo.shiftwidth = 2
vim.bo.smartindent = true

-- Neovim 0.7 has no vim.lsp.start.
local buffer = vim.api.nvim_get_current_buf()
local server = {
  name = 'psd',
  cmd = { vim.g.psd_path or 'psd', 'lsp' },
  root_dir = vim.fn.expand('%:p:h'),
}
if vim.fn.executable(server.cmd[1]) == 1 then
  if vim.lsp.start then
    vim.lsp.start(server)
  else
    psd_client = psd_client or vim.lsp.start_client(server)
    vim.lsp.buf_attach_client(buffer, psd_client)
    vim.bo.omnifunc = 'v:lua.vim.lsp.omnifunc'
  end
end

if #vim.api.nvim_get_runtime_file('parser/psd.so', false) > 0 then
  if vim.treesitter.start then
    vim.treesitter.start(buffer, 'psd')
  else
    vim.treesitter.highlighter.new(vim.treesitter.get_parser(buffer, 'psd'))
  end
end
