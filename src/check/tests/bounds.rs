//! Bounds on the depth and the size of values: the cost of a small file is limited.

use super::{checked, no_files};
use psd_language::check::{DEEPEST_VALUES, MOST_TERMS};

const IMPACT: &str = "specimen beam {\n  mass = 1 kg\n  behaviour = elastic(stiffness: 300 N/m)\n}\n\
                    striker hammer {\n  mass = 10 kg\n  velocity = 1 m/s\n}\n\
                    impact hit {\n  striker = hammer\n  duration = 1 s\n}\n";

/// `let a3 = a2 + 1`, `let a2 = a1 + 1`, …: each needs the one after it, `count` in all, and adds so many times.
fn from_below(count: usize, operators: usize) -> String {
    let values = (1..count).rev().map(|value| {
        format!(
            "let a{value} = a{}{}\n",
            value - 1,
            " + 1 mm".repeat(operators)
        )
    });
    IMPACT.to_owned()
        + &values.collect::<String>()
        + &format!(
            "let a0 = 1 mm\nrequire \"low\" hit.max_displacement < a{}\n",
            count - 1
        )
}

/// `let a1 = a0 + a0`, …, a0 a result: 2ⁿ⁺¹ − 1 terms after n doublings.
fn doubled(doublings: usize) -> String {
    let values = (1..=doublings).map(|value| format!("let a{value} = a{0} + a{0}\n", value - 1));
    IMPACT.to_owned()
        + "let a0 = hit.max_displacement\n"
        + &values.collect::<String>()
        + &format!("require \"low\" a{doublings} < 1 km\n")
}

#[test]
fn a_chain_of_values_is_as_deep_as_the_bound_and_no_deeper() {
    assert_eq!(
        checked(&from_below(DEEPEST_VALUES, 1), &no_files, &[]).1,
        ""
    );
    let (_, reported) = checked(&from_below(DEEPEST_VALUES + 1, 1), &no_files, &[]);
    assert_eq!(reported, "E405 a0");
    let (_, reported) = checked(&from_below(30 * DEEPEST_VALUES, 1), &no_files, &[]);
    assert_eq!(reported.lines().count(), 1, "it is said once: {reported}");
}

/// Each of the 99 values stands below 500 operators of the one that needs it.
#[test]
fn a_chain_of_values_below_many_operators_is_evaluated() {
    assert_eq!(
        checked(&from_below(DEEPEST_VALUES, 500), &no_files, &[]).1,
        ""
    );
}

#[test]
fn a_value_that_doubles_stays_small() {
    let most = MOST_TERMS.ilog2() as usize - 1;
    assert_eq!(checked(&doubled(most), &no_files, &[]).1, "");
    for doublings in [most + 1, 60] {
        let (_, reported) = checked(&doubled(doublings), &no_files, &[]);
        assert_eq!(reported, format!("E405 a{most} + a{most}"));
    }
}

/// A plan of many blocks, each with its number.
fn many(count: usize, each: impl Fn(usize) -> String) -> String {
    let striker = "striker hammer {\n  mass     = 10 kg\n  velocity = 1 m/s\n}\n";
    (0..count).fold(striker.to_owned(), |text, index| text + &each(index))
}

/// The output grows with the number of errors and not with its square: the labels and names of each are bounded, and so is a list of them.
#[test]
fn errors_are_counted_and_their_spans_are_within_the_text() {
    let pair = |index: usize| {
        let specimen = format!(
            "specimen s{index} {{\n  mass      = 1 kg\n  behaviour = elastic(stiffness: 300 N/m)\n}}\n"
        );
        format!("{specimen}impact h{index} {{\n  striker  = hammer\n  duration = 1 s\n}}\n")
    };
    let unknown = |index: usize| {
        format!(
            "let a_name_{index} = a_nam_{index}x * 2\nimpact h{index} {{\n  striker  = hamer{index}\n}}\n"
        )
    };
    let unread = |index: usize| format!("let q{index} = 3 $ x\nlet w{index} = other{index} * 2\n");
    for (text, count) in [
        (many(1200, pair), 1200),
        (many(600, unknown), 1801),
        (many(900, unread), 1800),
    ] {
        let (checked, _) = checked(&text, &no_files, &[]);
        assert!(checked.plan.is_none());
        let list = &checked.diagnostics;
        let labels: usize = list.iter().map(|diagnostic| diagnostic.labels.len()).sum();
        let widest = list
            .iter()
            .map(|diagnostic| diagnostic.labels.len())
            .max()
            .unwrap();
        let longest = list
            .iter()
            .filter_map(|diagnostic| diagnostic.help.as_ref().map(String::len))
            .max()
            .unwrap();
        assert!(
            list.len() <= 1001 && widest <= 21 && labels <= 21_100 && longest < 1200,
            "{} {widest} {labels} {longest}",
            list.len()
        );
        let left: usize = count - 1000;
        let last = list
            .iter()
            .rev()
            .find(|diagnostic| diagnostic.message.contains("not listed"))
            .map(|diagnostic| diagnostic.message.as_str());
        assert_eq!(
            last,
            Some(format!("{left} more errors are not listed (at most 1000)").as_str())
        );
    }
}

/// Only the first of many errors have a suggestion, because each compares every name.
#[test]
fn the_first_of_many_unknown_names_have_a_suggestion() {
    let (checked, _) = checked(
        &many(200, |index| {
            format!("let a_name_{index} = a_nam_{index} * 2\n")
        }),
        &no_files,
        &[],
    );
    let helped = checked.diagnostics.iter().filter(|diagnostic| {
        diagnostic
            .help
            .as_ref()
            .is_some_and(|help| help.contains("did you mean"))
    });
    assert!((50..60).contains(&helped.count()));
}

/// Two springs whose stiffnesses add to more than the largest number: a slope without a bound states no stability limit, least of all
/// one of 0 s.
#[test]
fn a_stiffness_without_a_bound_states_no_limit() {
    let spring = "elastic(stiffness: 1.7e308 N/m)";
    let plan = IMPACT.replace(
        "behaviour = elastic(stiffness: 300 N/m)",
        &format!("behaviour = parallel({spring}, {spring})"),
    );
    let plan = plan.replace(
        "  duration = 1 s\n",
        "  duration = 1 s\n  stiffness = 300 N/m\n  integrator = explicit\n  time_step = 1 ms\n",
    );
    let (_, reported) = checked(&plan, &no_files, &[]);
    assert!(!reported.contains("E643"), "{reported}");
}
