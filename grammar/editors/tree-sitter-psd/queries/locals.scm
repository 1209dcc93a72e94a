(source_file) @local.scope

(block name: (name) @local.definition)
(parameter name: (name) @local.definition)
(let name: (name) @local.definition)

(identifier) @local.reference
