//! The words of the comparison with published numbers. In: values as text. Out: sentences.

phrases! {
    TITLE = "Comparison with published numbers";
    COLUMNS = ["Number", "Value ± U", "Published", "Difference", "Statement"];
    NOTE = "A comparison with a published number is not a statement of conformity of a specimen.";
    fn tolerance(tolerance) = "tolerance {tolerance}";
    fn differs(difference, tolerance) = "difference {difference}, tolerance {tolerance}";
    fn published(number) = "published {number}";
    ONE = "the published number is reproduced";
    fn of(reproduced, total) = "{reproduced} of {total} published numbers reproduced";
    NO_CONFORMITY = "The plan states no requirement: its numbers are compared with published ones, and no statement of \
        conformity is made.";
    fn not_reproduced(names) = "Not reproduced: {names}.";
}
