//! A number with the word for what it counts. In: the number, the word for one and for several. Out: `1 step`, `3 axes`.

use std::fmt::Display;

/// `1 step`, `3 steps`
#[must_use]
pub fn counted<N: Copy + Display + PartialEq + From<u8>>(
    count: N,
    one: &str,
    several: &str,
) -> String {
    let word = if count == N::from(1) { one } else { several };
    format!("{count} {word}")
}

/// `one axis`, `3 axes`: in a sentence.
#[must_use]
pub fn counted_in_words(count: usize, one: &str, several: &str) -> String {
    if count == 1 {
        format!("one {one}")
    } else {
        format!("{count} {several}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_singular_and_none_is_plural() {
        let texts = [0_usize, 1, 2].map(|count| counted(count, "axis", "axes"));
        assert_eq!(texts, ["0 axes", "1 axis", "2 axes"]);
        let texts = [0, 1, 2].map(|count| counted_in_words(count, "axis", "axes"));
        assert_eq!(texts, ["0 axes", "one axis", "2 axes"]);
    }
}
