; Generated from tree-sitter-psd/queries/indents.scm: cargo xtask generate editors
[
  (fields)
  (arguments)
  (list)
  (parenthesised)
] @indent

[
  "}"
  ")"
  "]"
] @outdent
