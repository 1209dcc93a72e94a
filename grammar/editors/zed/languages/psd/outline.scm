(block kind: (keyword) @context name: (name) @name) @item
(block kind: (keyword) @name !name) @item
(parameter "param" @context name: (name) @name) @item
(let "let" @context name: (name) @name) @item
(requirement "require" @context text: (string) @name) @item
