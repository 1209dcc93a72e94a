//! The queries of tree-sitter: the lists of words in `highlights.scm`, and the copies of each editor under its own names of captures.

use psd_testing::vocabulary::{self, Words};

use super::{compare, read};

const SOURCE: &str = "tree-sitter-psd/queries";
const END: &str = "; end of generated\n";

/// An editor: the folder of its queries, the queries that it has from the grammar, its names of captures where they differ.
type Edition = (
    &'static str,
    &'static [&'static str],
    &'static [(&'static str, &'static str)],
);

const EDITIONS: &[Edition] = &[
    (
        "neovim/queries/psd",
        &["highlights", "locals", "injections", "folds"],
        &[],
    ),
    (
        "helix/queries/psd",
        &["highlights", "locals", "injections", "indents", "tags"],
        &[
            ("@string.escape", "@constant.character.escape"),
            ("@number", "@constant.numeric"),
            ("@boolean", "@constant.builtin.boolean"),
            ("@property", "@variable.other.member"),
        ],
    ),
    ("zed/languages/psd", &["highlights", "injections"], &[]),
];

/// A pattern for the words, under the comment that begins its part.
fn with_list(page: &str, part: &str, node: &str, capture: &str, words: &Words) -> String {
    let start = format!("; generated: {part}\n");
    let (before, rest) = page.split_once(&start).expect("the part has a start");
    let (_, after) = rest.split_once(END).expect("the part has an end");
    let words: Vec<String> = words.iter().map(|word| format!("{word:?}")).collect();
    let words = words.join("\n    ");
    format!(
        "{before}{start}(({node}) {capture}\n  (#any-of? {capture}\n    {words}))\n{END}{after}"
    )
}

#[test]
fn the_words_of_the_queries_are_those_of_the_schema() {
    let name = format!("{SOURCE}/highlights.scm");
    let page = read(&name);
    let options = vocabulary::options();
    let functions = vocabulary::functions();
    let page = with_list(
        &page,
        "functions",
        "function",
        "@function.builtin",
        &functions,
    );
    let page = with_list(
        &page,
        "options with arguments",
        "function",
        "@constructor",
        &options,
    );
    let page = with_list(
        &page,
        "options",
        "identifier",
        "@constant.builtin",
        &options,
    );
    compare(&name, &page);
    for (folder, queries, captures) in EDITIONS {
        for query in *queries {
            // The list is the newest one, whether or not it is written yet.
            let source = match *query {
                "highlights" => page.clone(),
                query => read(&format!("{SOURCE}/{query}.scm")),
            };
            let renamed = captures
                .iter()
                .fold(source, |text, (from, to)| text.replace(from, to));
            let head =
                format!("; Generated from {SOURCE}/{query}.scm: cargo xtask generate editors\n");
            compare(&format!("{folder}/{query}.scm"), &(head + &renamed));
        }
    }
}
