//! The answers of a study on a terminal. In: metadata and answers. Out: text: what is decided, probabilities, results, what they depend on,
//! the worst runs with the options that reproduce them, and why runs have no result. It decides nothing.

use std::fmt::Write as _;

use super::answers::{Answers, Probability, RequirementAnswer, ResultAnswer, StudiedAnswer};
use super::data_set::{Metadata, StudyKind};
use psd_physics::study::probability::Decision;
use psd_plan::schema::readable_result;
use psd_text::sanitize::one_line;
use psd_text::units::display;

/// Worst runs that are shown; the summary has more.
const WORST: usize = 3;
/// Reasons that are shown.
const REASONS: usize = 3;

/// The answers, line by line. `plan`: its path in the lines that reproduce a run.
#[must_use]
pub fn summary(metadata: &Metadata, plan: &str, answers: &Answers) -> String {
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{}  {}, study {}: {} runs  SIMULATION",
        heading(answers),
        one_line(&metadata.title),
        metadata.study,
        answers.runs
    );
    for studied in &answers.studied {
        text += &of_studied(studied);
    }
    for requirement in &answers.requirements {
        text += &of_requirement(metadata, plan, requirement);
    }
    for result in &answers.results {
        text += &of_result(metadata, result);
    }
    text += &of_fragility(metadata, answers);
    text += &of_subset(answers);
    for reason in answers.reasons.iter().take(REASONS) {
        let _ = writeln!(
            text,
            "  no result in {} runs, first in run {}: {}",
            reason.runs,
            reason.first_run,
            one_line(&reason.reason)
        );
    }
    text
}

fn heading(answers: &Answers) -> &'static str {
    let is = |decision| answers.studied.iter().any(|it| it.decision == decision);
    match (is(Decision::NotMet), is(Decision::Undecided)) {
        _ if answers.studied.is_empty() => "FINISHED",
        (true, _) => "NOT MET",
        (_, true) => "UNDECIDED",
        _ => "MET",
    }
}

fn of_studied(studied: &StudiedAnswer) -> String {
    let decision = match studied.decision {
        Decision::Met => "met",
        Decision::NotMet => "not met",
        Decision::Undecided => "undecided",
    };
    let look = studied
        .look
        .map_or_else(String::new, |look| format!(", decided at look {look}"));
    format!(
        "  {decision}  {}  probability {} (limit {}){look}\n",
        one_line(&studied.label),
        probability(studied.probability.as_ref()),
        percent(studied.limit)
    )
}

fn of_requirement(metadata: &Metadata, plan: &str, requirement: &RequirementAnswer) -> String {
    let runs = requirement.met + requirement.not_met + requirement.no_result;
    let label = one_line(&requirement.label);
    let mut text = if matches!(metadata.kind, StudyKind::Fragility(_)) {
        format!("  {label}: exceeded in {} of {runs} runs", requirement.met)
    } else if requirement.probability.is_none() {
        format!(
            "  {label}: not met in {} of {runs} runs of all levels",
            requirement.not_met
        )
    } else {
        format!(
            "  {label}: not met in {} of {runs} runs, probability {}",
            requirement.not_met,
            probability(requirement.probability.as_ref())
        )
    };
    if requirement.no_result > 0 {
        let _ = write!(text, ", {} without a result", requirement.no_result);
    }
    text.push('\n');
    for worst in requirement.worst.iter().take(WORST) {
        let settings = worst.settings.iter();
        let settings: Vec<String> = settings.map(|it| format!("--set {it}")).collect();
        let _ = writeln!(
            text,
            "    run {}: psd run {plan} {}",
            worst.run,
            settings.join(" ")
        );
    }
    text
}

fn of_result(metadata: &Metadata, result: &ResultAnswer) -> String {
    let column = metadata.results.iter().find(|it| it.name == result.name);
    let (Some(column), Some(mean)) = (column, result.mean) else {
        return format!("  {}: no run has it\n", one_line(&result.name));
    };
    let shown = |value: f64| readable_result(&column.name, value, column.dimension);
    let mut text = format!("  {}: mean {}", one_line(&result.name), shown(mean));
    if let Some(deviation) = result.standard_deviation {
        let _ = write!(text, ", standard deviation {}", shown(deviation));
    }
    if result.no_result > 0 {
        let all = result.runs + result.no_result;
        let _ = write!(text, ", of the {} of {all} runs that have it", result.runs);
    }
    text.push('\n');
    for quantile in &result.quantiles {
        let [Some(low), Some(high)] = quantile.estimates else {
            continue;
        };
        let _ = write!(
            text,
            "    {} below {}",
            percent(quantile.probability),
            shown(low)
        );
        if low != high {
            let _ = write!(text, " to {}", shown(high));
        }
        let end = |end: Option<f64>| end.map_or_else(|| "unbounded".to_owned(), shown);
        if quantile.interval != [None; 2] {
            let [low, high] = quantile.interval.map(end);
            let _ = write!(text, " [{low}, {high}]");
        }
        text.push('\n');
    }
    for input in &result.sensitivities {
        let (index, what) = match (&input.first_order, &input.rank_correlation) {
            (Some(index), _) => (index, "of the variance explained"),
            (None, Some(index)) => (index, "rank correlation"),
            (None, None) => continue,
        };
        let zero = if index.may_be_zero {
            ", not distinguishable from 0"
        } else {
            ""
        };
        let _ = writeln!(
            text,
            "    {}: {:.2} [{:.2}, {:.2}] {what}{zero}",
            one_line(&input.input),
            index.value,
            index.interval[0],
            index.interval[1]
        );
    }
    text
}

fn of_fragility(metadata: &Metadata, answers: &Answers) -> String {
    let Some(fragility) = &answers.fragility else {
        return String::new();
    };
    let column = metadata
        .inputs
        .iter()
        .find(|it| it.name == fragility.intensity);
    let shown = |value: f64| {
        column.map_or_else(
            || value.to_string(),
            |column| display::readable(value, column.dimension),
        )
    };
    let mut text = String::new();
    for stripe in &fragility.stripes {
        let runs = stripe.exceeded + stripe.not_exceeded + stripe.no_result;
        let [low, high] = stripe.interval.map(percent);
        let _ = writeln!(
            text,
            "    {} = {}: exceeded in {} of {runs} runs [{low}, {high}]",
            one_line(&fragility.intensity),
            shown(stripe.intensity),
            stripe.exceeded
        );
    }
    for fit in &fragility.fits {
        if let Some(reason) = &fit.no_fit {
            let _ = writeln!(text, "  no curve fits: {}", one_line(reason));
        }
        if let (Some(median), Some(dispersion)) = (fit.median, fit.dispersion) {
            let interval = fit.median_interval.map_or_else(String::new, |[low, high]| {
                format!(" [{}, {}]", shown(low), shown(high))
            });
            let _ = writeln!(
                text,
                "  median {}{interval}, dispersion {dispersion:.3}",
                shown(median)
            );
        }
        if let Some(split) = &fit.split {
            let [low, high] = split.share_interval.map(percent);
            let _ = writeln!(
                text,
                "  record-to-record dispersion {:.3}, modelling dispersion {:.3}: {} of the variance [{low}, {high}] is between {} records",
                split.record_to_record,
                split.modelling,
                percent(split.share),
                split.records
            );
        }
    }
    text
}

/// The levels of a subset simulation.
fn of_subset(answers: &Answers) -> String {
    let Some(subset) = &answers.subset else {
        return String::new();
    };
    let mut text = format!("  subset simulation, {} replicates", subset.replicates);
    if let Some(variation) = subset.variation {
        let _ = write!(
            text,
            ", coefficient of variation of one {}",
            percent(variation)
        );
    }
    text.push('\n');
    for level in &subset.levels {
        let _ = writeln!(
            text,
            "    level {}: {} replicates, {} of the runs beyond its threshold, {} of the moves accepted",
            level.level,
            level.replicates,
            percent(level.fraction),
            percent(level.accepted)
        );
    }
    text
}

/// The estimate, or both bounds, with the interval; without failures an upper bound.
fn probability(found: Option<&Probability>) -> String {
    let Some(Probability {
        bounds: [low, high],
        interval,
        ..
    }) = found
    else {
        return "unknown".to_owned();
    };
    let interval = interval.map(percent);
    let estimate = if *high == 0.0 {
        return format!("below {}", interval[1]);
    } else if *low >= 1.0 {
        return format!("above {}", interval[0]);
    } else if low == high {
        percent(*low)
    } else {
        format!("{} to {}", percent(*low), percent(*high))
    };
    format!("{estimate} [{}, {}]", interval[0], interval[1])
}

/// Three digits, in percent.
fn percent(fraction: f64) -> String {
    let digits = display::significant(100.0 * fraction, 3);
    format!("{} %", display::trimmed(&digits))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::answers::testing::{
        answers, fragility_metadata, fragility_rows, metadata, normals, rows,
    };
    use psd_physics::study::sampling::Design;

    #[test]
    fn the_answers_name_probability_scatter_causes_and_the_worst_runs() {
        let metadata = metadata(1000);
        let inputs = normals(Design::Random, 1);
        let rows = rows(&inputs, 1000, |run| run % 100 == 7);
        let answers = answers(&metadata, &rows);
        let text = summary(&metadata, &metadata.plan, &answers);
        for part in [
            "FINISHED  Beam, study scatter: 1000 runs  SIMULATION\n",
            "  small: not met in ",
            ", 10 without a result\n",
            "    run ",
            ": psd run beam.psd --set a=",
            "  y: mean 3.",
            "    5 % below 2.6",
            "    b: 0.7",
            " of the variance explained\n",
            "  no result in 10 runs, first in run 7: stopped\n",
        ] {
            assert!(text.contains(part), "{part:?} in\n{text}");
        }
        assert_eq!(text.matches("psd run").count(), WORST);
    }

    #[test]
    fn no_failure_is_an_upper_bound_and_not_zero() {
        let percents = |bounds: [f64; 2], interval: [f64; 2]| {
            probability(Some(&Probability {
                bounds,
                interval,
                is_exact: true,
            }))
        };
        assert_eq!(percents([0.0, 0.0], [0.0, 0.0037]), "below 0.37 %");
        assert_eq!(percents([1.0, 1.0], [0.99, 1.0]), "above 99 %");
        assert_eq!(percents([0.02, 0.02], [0.01, 0.035]), "2 % [1 %, 3.5 %]");
        assert_eq!(
            percents([0.02, 0.03], [0.01, 0.035]),
            "2 % to 3 % [1 %, 3.5 %]"
        );
        assert_eq!(probability(None), "unknown");
    }

    #[test]
    fn a_fragility_has_its_stripes_and_its_median() {
        let stripes = [0.4, 0.8, 1.6];
        let metadata = fragility_metadata(&stripes, 200);
        let answers = answers(&metadata, &fragility_rows(&stripes, 200));
        let text = summary(&metadata, &metadata.plan, &answers);
        for part in [
            "    drop_height = 0.4000 m: exceeded in ",
            "    drop_height = 1.600 m: exceeded in ",
            " of 200 runs [",
            "  median ",
            ", dispersion 0.3",
        ] {
            assert!(text.contains(part), "{part:?} in\n{text}");
        }
    }
}
