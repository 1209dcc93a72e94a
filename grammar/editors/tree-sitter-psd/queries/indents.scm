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
