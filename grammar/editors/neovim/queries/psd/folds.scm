; Generated from tree-sitter-psd/queries/folds.scm: cargo xtask generate editors
[
  (fields)
  (arguments)
  (list)
] @fold
