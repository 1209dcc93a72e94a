//! The grammar of VS Code: the patterns that name words of the schema, in a page that is otherwise written by hand.

use psd_plan::schema::{BLOCKS, ITEM_WORDS};
use psd_testing::vocabulary::{self, Words};
use serde_json::Value;

use super::{compare, read};

const PAGE: &str = "vscode/syntaxes/psd.tmLanguage.json";

/// The words between two values. None of them is a unit.
const JOINING: &str = "and|between|of|step|within";

const NAME: &str = r"[A-Za-z_]\w*";
const FACTOR: &str = r"(?:%|[A-Za-zµμ][\wµμ]*)(?:\^-?\d+(?:\.\d+)?)?";

/// Any of the words, which end where they end.
fn any(words: &Words) -> String {
    let words: Vec<&str> = words.iter().copied().collect();
    format!(r"\b(?:{})\b", words.join("|"))
}

fn patterns() -> Vec<(&'static str, String)> {
    // A keyword of two words comes before one that begins it.
    let mut keywords: Vec<String> = BLOCKS
        .iter()
        .map(|block| block.keyword.join(r"\s+"))
        .collect();
    keywords.sort_by_key(|words| std::cmp::Reverse(words.len()));
    let (blocks, items) = (keywords.join("|"), ITEM_WORDS.join("|"));
    let unit = format!(r"(?!(?:{items}|{JOINING})\b)(?:1/)?{FACTOR}(?:[*/]{FACTOR})*");
    let number = r"\d+(?:\.\d+)?(?:[eE][+-]?\d+)?";
    let (fields, options) = (any(&vocabulary::fields()), any(&vocabulary::options()));
    let functions = any(&vocabulary::functions());
    vec![
        ("item", format!(r"^\s*({items})\b(?:\s+({NAME}))?")),
        (
            "block",
            format!(r#"^\s*({blocks})\b(?:\s+({NAME}))?(?=\s*(?:["{{#]|$))"#),
        ),
        ("quantity", format!(r"(?<!\w)({number})(?:[ \t]*({unit}))?")),
        ("list-unit", format!(r"(?<=\])[ \t]*({unit})")),
        ("key", format!(r"{fields}(?=\s*=(?!=))")),
        ("argument", format!(r"{fields}(?=\s*:)")),
        ("function", format!(r"{functions}(?=\s*\()")),
        ("option-with-arguments", format!(r"{options}(?=\s*\()")),
        ("operator-word", format!(r"\b(?:{JOINING}|in)\b")),
        ("option", options),
    ]
}

#[test]
fn the_words_of_the_grammar_are_those_of_the_schema() {
    let mut page: Value = serde_json::from_str(&read(PAGE)).expect("JSON");
    for (name, pattern) in patterns() {
        page["repository"][name]["match"] = pattern.into();
    }
    let wanted = serde_json::to_string_pretty(&page).expect("JSON");
    compare(PAGE, &format!("{wanted}\n"));
}
