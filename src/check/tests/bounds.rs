//! How deep values may stand one inside another, and how large one may become: what a small file can ask for is bounded.

use super::{Files, checked};
use crate::check::{DEEPEST_VALUES, MOST_TERMS};

const BLOW: &str = "specimen beam {\n  mass = 1 kg\n  behaviour = elastic(stiffness: 300 N/m)\n}\n\
                    striker hammer {\n  mass = 10 kg\n  velocity = 1 m/s\n}\n\
                    impact hit {\n  striker = hammer\n  duration = 1 s\n}\n";

/// `let a3 = a2 + 1`, `let a2 = a1 + 1`, …: each needs the one after it, `count` in all.
fn from_below(count: usize) -> String {
    let values = (1..count).rev().map(|value| format!("let a{value} = a{} + 1 mm\n", value - 1));
    BLOW.to_owned()
        + &values.collect::<String>()
        + &format!("let a0 = 1 mm\nrequire \"low\" hit.max_displacement < a{}\n", count - 1)
}

/// `let a1 = a0 + a0`, …, a0 a result: 2ⁿ⁺¹ − 1 terms after n doublings.
fn doubled(doublings: usize) -> String {
    let values = (1..=doublings).map(|value| format!("let a{value} = a{0} + a{0}\n", value - 1));
    BLOW.to_owned()
        + "let a0 = hit.max_displacement\n"
        + &values.collect::<String>()
        + &format!("require \"low\" a{doublings} < 1 km\n")
}

#[test]
fn a_chain_of_values_is_as_deep_as_the_bound_and_no_deeper() {
    assert_eq!(checked(&from_below(DEEPEST_VALUES), &Files(&[]), &[]).1, "");
    let (_, said) = checked(&from_below(DEEPEST_VALUES + 1), &Files(&[]), &[]);
    assert_eq!(said, "E405 a0");
    let (_, said) = checked(&from_below(30 * DEEPEST_VALUES), &Files(&[]), &[]);
    assert_eq!(said.lines().count(), 1, "it is said once: {said}");
}

#[test]
fn a_value_that_doubles_stays_small() {
    let most = MOST_TERMS.ilog2() as usize - 1;
    assert_eq!(checked(&doubled(most), &Files(&[]), &[]).1, "");
    for doublings in [most + 1, 60] {
        let (_, said) = checked(&doubled(doublings), &Files(&[]), &[]);
        assert_eq!(said, format!("E405 a{most} + a{most}"));
    }
}
