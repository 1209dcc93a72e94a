//! The words of the statement of conformity. In: values as text. Out: sentences.

phrases! {
    TITLE = "Statement of conformity";
    COLUMNS = ["Requirement", "Value ± U", "Limit", "Probability of conformity", "Statement"];
    SIMPLE_RULE = "Decision rule: simple acceptance (ILAC-G8:09/2019, guard band w = 0). Inconclusive: a value inside \
        its tolerance with P < 50\u{a0}%, a value whose U is withheld, and a decision that finer time steps change.";
    EXPANDED = "± is the expanded uncertainty U = 2u, about 95\u{a0}% coverage.";
    PROBABILITY = "P is the probability of conformity (JCGM 106): a pass is wrong with probability 1 − P, a fail with \
        probability P. U and P cover the declared uncertainty contributions only.";
    NO_U = "no U";
    WIDER_THAN_TOLERANCE = "U exceeds the tolerance";
    fn impact_passes_while(condition) = "an impact passes while {condition}";
    fn outside(distance) = "outside the limit by {distance}";
    fn inside(distance) = "inside the limit by {distance}";
    fn largest_part(input, percent) = "largest part of U: {input} ({percent:.0}\u{a0}% of u²)";
    fn of_studies(names) = "Not decided by one run, but by a study of the plan: {names}.";
    fn guarded_rule(equation) = "Decision rule: guarded acceptance (ILAC-G8:09/2019), guard band w = {equation} of \
        the distance between value and limit. Pass: inside the limit by at least w. Fail: outside by more than \
        w. Otherwise, where no uncertainty is known, and where finer time steps change the decision: inconclusive. \
        Exact values are compared without w.";
    fn expanded_up_to(k) = "± is the expanded uncertainty U = k·u, about 95\u{a0}% coverage, k ≤ {k} (Student's t, \
        JCGM 100, G.4).";
    fn quantity(result, entry, procedure) = "{result}{entry} of {procedure}";
}
