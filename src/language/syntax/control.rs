//! Keywords with which other languages begin a condition or a loop. In: a keyword. Out: the message for it.

const CONDITIONS: [&str; 5] = ["if", "elif", "else", "unless", "when"];
const LOOPS: [&str; 5] = ["for", "foreach", "while", "loop", "repeat"];

/// Whether another branch may follow it.
pub fn is_condition(word: &str) -> bool {
    CONDITIONS.contains(&word)
}

/// The message and the suggestion; None for any other word.
#[must_use]
pub fn of_another_language(word: &str) -> Option<(&'static str, &'static str)> {
    if is_condition(word) {
        return Some((
            "there are no conditions in a plan",
            "every procedure runs, in the order written; what must hold is said by `require`, and a value is changed by `--set`",
        ));
    }
    LOOPS.contains(&word).then_some((
        "there are no loops in a plan",
        "write each procedure out; a `cycle` repeats its amplitudes and an `escalate` its blows, and a value is changed by `--set`",
    ))
}
