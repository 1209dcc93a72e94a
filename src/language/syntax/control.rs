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
            "a plan has no conditional statements",
            "write a requirement with `require`, or change a value with `--set`; every procedure runs, in the order written",
        ));
    }
    LOOPS.contains(&word).then_some((
        "a plan has no loops",
        "write each procedure; `cycle` repeats amplitudes, `escalate` repeats impacts, and `--set` changes a value",
    ))
}
