//! Zero drift of a rig that checks its zeros, in `psd check --explain`. In: the plan, the record of its dry run. Out: rows: times of the
//! zero readings, time between them, allowed zero drift, and the effect of a declared zero drift.

use psd::report::PredictedZeros;
use psd_plan::record::{Drift, Record};
use psd_plan::{DriftCheck, Plan, ZeroAfter};
use psd_text::units::Dimension;
use psd_text::units::display::{readable, stated};

/// No rows for a rig that does not specify its allowed zero drift.
pub fn rows(plan: &Plan, record: &Record) -> Vec<Vec<String>> {
    let Some(found) = &record.drift else {
        return Vec::new();
    };
    let DriftCheck {
        force,
        displacement,
        over,
        after,
    } = found.check;
    let duration = stated(over, Dimension::TIME);
    let row = |name: &str, text: String| vec![name.to_owned(), text];
    let also = displacement.map_or_else(String::new, |change| {
        format!(", {} of displacement", stated(change, Dimension::LENGTH))
    });
    let mut rows = vec![row(
        "allowed",
        format!("{} of force{also}", stated(force, Dimension::FORCE)),
    )];
    rows.push(row(
        "before the test",
        format!("read over {duration} at rest, before any load"),
    ));
    let holds = match found.held.count {
        0 => format!("none lasts {duration}: no drift is visible between the zeros"),
        1 => format!(
            "one lasts {duration} or more: {}",
            readable(found.held.longest, Dimension::TIME)
        ),
        count => format!(
            "{count} last {duration} or more, the longest {}",
            readable(found.held.longest, Dimension::TIME)
        ),
    };
    rows.push(row("holds", holds));
    let between = time_between(found);
    let later = between.map_or_else(String::new, |seconds| {
        format!(
            ", {} after the first zeros",
            readable(seconds, Dimension::TIME)
        )
    });
    let read = match after {
        ZeroAfter::Start => format!("back at its start position, read over {duration}{later}"),
        ZeroAfter::Free => {
            format!(
                "the operator removes the specimen from the load cell; read over {duration}{later}"
            )
        }
        ZeroAfter::Nowhere => "not read again: only rest and dwells are assessed".to_owned(),
    };
    rows.push(row("after the test", read));
    let judged = judged_over(found);
    let steady = readable(force / judged, Dimension::FORCE);
    rows.push(row(
        "a steady drift",
        format!("of up to {steady}/s is within the limit"),
    ));
    if let Some(drift) = plan
        .rig
        .link
        .as_virtual()
        .map(|link| link.drift)
        .filter(|drift| *drift != 0.0)
    {
        let comes_to = (drift * judged).abs();
        let conclusion = if comes_to <= force {
            "within"
        } else {
            "EXCEEDS the limit: every requirement that reads the force is inconclusive"
        };
        let text = format!(
            "{}/s results in {}: {conclusion}",
            readable(drift, Dimension::FORCE),
            readable(comes_to, Dimension::FORCE)
        );
        rows.push(row("declared for this rig", text));
    }
    rows
}

/// The same as data.
pub fn predicted(record: &Record) -> Option<PredictedZeros> {
    let found = record.drift.as_ref()?;
    let DriftCheck {
        force,
        displacement,
        over,
        after,
    } = found.check;
    Some(PredictedZeros {
        allowed_force_n: force,
        allowed_displacement_m: displacement,
        over_s: over,
        after: after.name(),
        holds: found.held.count,
        longest_hold_s: (found.held.count > 0).then_some(found.held.longest),
        between_s: time_between(found),
        steady_force_n_per_s: force / judged_over(found),
    })
}

/// The longest time over which a zero drift is assessed \[s\].
fn judged_over(found: &Drift) -> f64 {
    time_between(found).unwrap_or(0.0).max(found.check.over)
}

/// Time between the zeros before and after \[s\]; None if they are not read again.
fn time_between(found: &Drift) -> Option<f64> {
    let axis = found.axes.first()?;
    axis.after.map(|after| after.time - axis.before.time)
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd::check::{Options, check, no_files};
    use psd::run::{Unwatched, run};
    use psd_rig::virtual_rig;

    /// Ten dwells of 5 s, and 8 s of zero readings.
    fn zero_drift_text(declared: &str, check_of: &str) -> String {
        let text = format!(
            "specimen beam {{\n  mass = 1 kg\n  behaviour = elastic(stiffness: 300 kN/m)\n}}\nrig r {{\n  link = virtual({declared})\n{check_of}}}\n\
             stiffness ramp k0 {{\n  displacements = 0.1 mm .. 1 mm step 0.1 mm\n  pause = 5 s\n}}\nrequire \"stiff\" k0.stiffness > 1 kN/m\n"
        );
        let checked = check("plan.psd", &text, &no_files, &Options::default());
        let plan = checked
            .plan
            .unwrap_or_else(|| panic!("{:?}", checked.diagnostics));
        let record = run(&plan, virtual_rig(&plan).as_mut(), &mut Unwatched);
        rows(&plan, &record)
            .into_iter()
            .map(|row| row.join(": ") + "\n")
            .collect()
    }

    #[test]
    fn what_is_declared_is_held_against_the_time_between_the_zeros() {
        let within = zero_drift_text(
            "zero_drift: 0.02 N/s",
            "  zero_drift = within(5 N, 10 um, over: 4 s)\n",
        );
        assert!(
            within.contains("allowed: 5 N of force, 10 µm of displacement"),
            "{within}"
        );
        assert!(
            within.contains("holds: 10 last 4 s or more, the longest 5.000 s"),
            "{within}"
        );
        assert!(
            within.contains("back at its start position, read over 4 s, 5"),
            "between 50 s and 60 s: {within}"
        );
        assert!(
            within.contains("results in 1.") && within.contains(": within\n"),
            "0.02 N/s over almost a minute: {within}"
        );
        let beyond = zero_drift_text(
            "zero_drift: 0.2 N/s",
            "  zero_drift = within(5 N, over: 4 s)\n",
        );
        assert!(beyond.contains("EXCEEDS the limit"), "{beyond}");
        let nowhere = zero_drift_text(
            "zero_drift: -0.2 N/s",
            "  zero_drift = within(5 N, over: 4 s, after: nowhere)\n",
        );
        assert!(
            nowhere.contains("not read again") && nowhere.contains("results in 0.8000 N: within"),
            "{nowhere}"
        );
    }

    #[test]
    fn a_rig_that_does_not_report_it_is_not_listed() {
        assert_eq!(zero_drift_text("zero_drift: 0.2 N/s", ""), "");
    }
}
