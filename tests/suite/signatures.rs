//! The signatures of functions, read from the source text. In: the code of a file. Out: each function with its parameters. This module
//! contains no rule.

/// One function of a file.
pub struct Signature {
    pub name: String,
    pub parameters: Vec<Parameter>,
}

/// One parameter, without `self`.
pub struct Parameter {
    /// As written before the colon.
    pub pattern: String,
    pub kind: String,
}

impl Signature {
    /// The longest row of parameters of type `f64`, side by side.
    pub fn longest_run_of_numbers(&self) -> usize {
        let runs = self.parameters.split(|parameter| parameter.kind != "f64");
        runs.map(<[Parameter]>::len).max().unwrap_or(0)
    }

    /// Whether a parameter is a tuple that the signature takes apart: several arguments in the place of one.
    pub fn takes_a_tuple_apart(&self) -> bool {
        let destructures = |parameter: &Parameter| {
            parameter.pattern.starts_with('(') && parameter.kind.starts_with('(')
        };
        self.parameters.iter().any(destructures)
    }
}

/// Every function of code without comments and tests.
pub fn signatures(code: &str) -> Vec<Signature> {
    let starts = code.match_indices("fn ").filter(|(at, _)| {
        let before = code[..*at].chars().next_back();
        before.is_none_or(|before| !before.is_alphanumeric() && before != '_')
    });
    starts
        .filter_map(|(at, head)| signature(&code[at + head.len()..]))
        .collect()
}

/// The function whose name stands first in `code`; None for text that is no function.
fn signature(code: &str) -> Option<Signature> {
    let name_ends = code.find(|letter: char| !letter.is_alphanumeric() && letter != '_')?;
    let (name, rest) = code.split_at(name_ends);
    let rest = if rest.starts_with('<') {
        &rest[closed(rest)?..]
    } else {
        rest
    };
    let inside = rest.strip_prefix('(').filter(|_| !name.is_empty())?;
    let inside = &inside[..closed(rest)? - 2];
    let parameters = at_top_level(inside).into_iter().filter_map(|parameter| {
        // An attribute stands before its parameter.
        let parameter = if parameter.starts_with("#[") {
            parameter[parameter.find(']')? + 1..].trim()
        } else {
            parameter
        };
        let (pattern, kind) = parameter.split_once(": ")?;
        let is_self = ["self", "mut self"].contains(&pattern);
        (!is_self).then(|| Parameter {
            pattern: pattern.trim_start_matches("mut ").trim().to_owned(),
            kind: kind.trim().to_owned(),
        })
    });
    Some(Signature {
        name: name.to_owned(),
        parameters: parameters.collect(),
    })
}

/// How deep a bracket takes the text; the arrow of a function's result is no bracket.
fn step(letter: char, before: char) -> isize {
    match letter {
        '(' | '[' | '{' | '<' => 1,
        '>' if before == '-' || before == '=' => 0,
        ')' | ']' | '}' | '>' => -1,
        _ => 0,
    }
}

/// The index after the bracket that closes the first one.
fn closed(text: &str) -> Option<usize> {
    let (mut depth, mut before) = (0, ' ');
    for (at, letter) in text.char_indices() {
        depth += step(letter, before);
        if depth == 0 {
            return Some(at + letter.len_utf8());
        }
        before = letter;
    }
    None
}

/// The parts between the commas outside all brackets, without blanks around them.
fn at_top_level(text: &str) -> Vec<&str> {
    let (mut depth, mut before, mut start, mut parts) = (0, ' ', 0, Vec::new());
    for (at, letter) in text.char_indices() {
        depth += step(letter, before);
        if letter == ',' && depth == 0 {
            parts.push(text[start..at].trim());
            start = at + 1;
        }
        before = letter;
    }
    parts.push(text[start..].trim());
    parts.retain(|part| !part.is_empty());
    parts
}
