(fields "}" @end) @indent
(arguments ")" @end) @indent
(parenthesised ")" @end) @indent
(list "]" @end) @indent
