//! Words of messages: the suggestion "did you mean", the nearest of a closed set of names; a word with its article.

/// The candidate nearest to `written`, if it is near enough to be a typing error.
#[must_use]
pub fn nearest<'a>(
    written: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let written = written.to_lowercase();
    let length = written.chars().count();
    let allowed = (length / 3).max(1);
    candidates
        .into_iter()
        // The distance is at least the difference in length, so longer candidates are skipped. A letter may become
        // three in lower case.
        .filter(|candidate| {
            let letters = if candidate.is_ascii() {
                candidate.len()
            } else {
                candidate.chars().count()
            };
            let most = if candidate.is_ascii() {
                letters
            } else {
                3 * letters
            };
            letters <= length + allowed && length <= most + allowed
        })
        .map(|candidate| (candidate.to_lowercase(), candidate))
        .filter(|(lower, _)| lower.chars().count().abs_diff(length) <= allowed)
        .map(|(lower, candidate)| (strsim::osa_distance(&written, &lower), candidate))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// `an impact`, `a shake`: words with their article.
#[must_use]
pub fn with_article(words: &str) -> String {
    let article = if words.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    format!("{article} {words}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggests_slips_and_nothing_else() {
        assert_eq!(nearest("velocty", ["mass", "velocity"]), Some("velocity"));
        assert_eq!(nearest("kn", ["N", "kN"]), Some("kN"));
        assert_eq!(nearest("banana", ["mass", "velocity"]), None);
        assert_eq!(nearest("", ["m", "mass"]), Some("m"));
        assert_eq!(
            nearest(
                "velocity_of_impact",
                ["mass", "velocity", "VELOCITY_AT_IMPACT"]
            ),
            Some("VELOCITY_AT_IMPACT")
        );
    }
}
