//! Did you mean: the nearest of a closed set of names.

/// The candidate nearest to `written`, if it is near enough to be a slip of the finger.
#[must_use]
pub fn nearest<'a>(written: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = (written.chars().count() / 3).max(1);
    candidates
        .into_iter()
        .map(|candidate| (strsim::osa_distance(&written.to_lowercase(), &candidate.to_lowercase()), candidate))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggests_slips_and_nothing_else() {
        assert_eq!(nearest("velocty", ["mass", "velocity"]), Some("velocity"));
        assert_eq!(nearest("kn", ["N", "kN"]), Some("kN"));
        assert_eq!(nearest("banana", ["mass", "velocity"]), None);
    }
}
