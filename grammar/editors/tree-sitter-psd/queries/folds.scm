[
  (fields)
  (arguments)
  (list)
] @fold
