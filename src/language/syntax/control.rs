//! Keywords with which other languages begin a condition, a loop or a function. In: a keyword. Out: the message for it.

const CONDITIONS: [&str; 5] = ["if", "elif", "else", "unless", "when"];
const LOOPS: [&str; 5] = ["for", "foreach", "while", "loop", "repeat"];

/// The message and the suggestion for the definition of a function.
pub const NO_FUNCTIONS: (&str, &str) = (
    "a plan defines no functions",
    "name a value with `let`, as in `let width = 60 mm`",
);

const FUNCTIONS: [&str; 5] = ["def", "fn", "func", "function", "lambda"];

/// Whether another branch may follow it.
pub fn is_condition(word: &str) -> bool {
    CONDITIONS.contains(&word)
}

/// The message and the suggestion; None for any other word.
#[must_use]
pub fn of_another_language(word: &str) -> Option<(&'static str, &'static str)> {
    if is_condition(word) {
        return Some((
            "a plan has no conditional statements",
            "write a requirement with `require`, or change a value with `--set`; every procedure runs, in the order written",
        ));
    }
    if FUNCTIONS.contains(&word) {
        return Some(NO_FUNCTIONS);
    }
    LOOPS.contains(&word).then_some((
        "a plan has no loops",
        "write each procedure; `cycle` repeats amplitudes, `escalate` repeats impacts, and `--set` changes a value",
    ))
}
