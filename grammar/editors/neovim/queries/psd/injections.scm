; Generated from tree-sitter-psd/queries/injections.scm: cargo xtask generate editors
((comment) @injection.content
  (#set! injection.language "comment"))
