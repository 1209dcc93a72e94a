(block name: (name) @name) @definition.class
(parameter name: (name) @name) @definition.constant
(let name: (name) @name) @definition.constant
(requirement text: (string) @name) @definition.function

(member of: (identifier) @name) @reference.class
