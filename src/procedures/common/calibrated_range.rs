//! Calibrated ranges. In: the readings of a procedure, and the ranges for which the rig is calibrated. Out: its results, those from a
//! reading outside of its range without uncertainty. It changes no value.

use psd_plan::record::NamedResult;
use psd_plan::uncertainty::Source;
use psd_plan::{Interval, RigPlan, named_axis, of_axis};
use psd_text::units::Dimension;
use psd_text::units::display::{readable, stated};

/// Gives displacement \[m\] and force \[N\] of every axis, reading by reading.
pub(crate) type Readings<'a> = &'a dyn Fn(&mut dyn FnMut(&[f64], &[f64]));

/// Withholds the uncertainty of every result that uses a channel with a reading above its calibrated range, or without any in it. A result
/// uses a channel if the scale factor of the channel contributes to it. Returns one sentence for each such channel, with its results.
pub(crate) fn withhold(
    rig: &RigPlan,
    axes: usize,
    readings: Readings<'_>,
    results: &mut [NamedResult],
) -> Vec<String> {
    let mut remarks = Vec::new();
    for axis in 0..axes.max(1) {
        let calibration = rig.calibration_of(axis);
        let channels = [
            (
                "force",
                Dimension::FORCE,
                calibration.force_calibrated,
                Source::ForceScale(axis),
            ),
            (
                "displacement",
                Dimension::LENGTH,
                calibration.displacement_calibrated,
                Source::DisplacementScale(axis),
            ),
        ];
        for (name, dimension, calibrated, source) in channels {
            let of_force = dimension == Dimension::FORCE;
            let Some(reason) = calibrated.and_then(|range| {
                let largest = largest(readings, of_force, axis)?;
                let name = format!("{name}{}", of_axis(named_axis(axis, axes)));
                outside_of(range, largest, &name, dimension)
            }) else {
                continue;
            };
            let uses = |result: &&mut NamedResult| {
                let mut parts = result.contributions.iter();
                parts.any(|part| part.source == source)
            };
            let mut names = Vec::new();
            for result in results.iter_mut().filter(uses) {
                result.withhold(&reason);
                names.push(format!("`{}`", result.name));
            }
            if !names.is_empty() {
                remarks.push(format!("U of {} is withheld: {reason}", names.join(", ")));
            }
        }
    }
    remarks
}

/// The largest absolute force \[N\] or displacement \[m\] of an axis; None without a reading.
fn largest(readings: Readings<'_>, of_force: bool, axis: usize) -> Option<f64> {
    let mut largest: Option<f64> = None;
    readings(&mut |displacement, force| {
        let read = if of_force { force } else { displacement }.get(axis);
        if let Some(read) = read.filter(|read| read.is_finite()) {
            largest = Some(largest.map_or(read.abs(), |largest| largest.max(read.abs())));
        }
    });
    largest
}

/// Why the largest reading is not calibrated. Every test begins near 0, so that smaller readings are below every range.
fn outside_of(
    Interval { low, high }: Interval,
    largest: f64,
    name: &str,
    dimension: Dimension,
) -> Option<String> {
    let side = if largest > high {
        "above"
    } else if largest < low {
        "below"
    } else {
        return None;
    };
    let [low, high] = [low, high].map(|end| stated(end, dimension));
    let largest = readable(largest, dimension);
    Some(format!(
        "the largest {name}, {largest}, is {side} the calibrated range of {low} to {high}"
    ))
}

#[cfg(test)]
mod tests {
    use crate::tests::testing::{elastic_plan, impact, ramp, result_of, run_unwatched};
    use psd_plan::formula::Formula::Constant;
    use psd_plan::record::{EventKind, Record};
    use psd_plan::{Calibration, Contact, Impact, Interval, Plan, ProcedureKind};

    /// A ramp of ten steps of 2 mm at 1 kN/m, so to 20 N, and an impact with the stiffness that it finds.
    fn plan(force: Interval) -> Plan {
        let mut plan = elastic_plan(
            1000.0,
            vec![
                ProcedureKind::StiffnessRamp(ramp(2e-3)),
                // Its contacts do not follow the time step.
                ProcedureKind::Impact(Impact {
                    contact: Contact::Restitution {
                        coefficient: Constant(0.5),
                    },
                    ..impact(result_of(0, "stiffness"))
                }),
            ],
        );
        plan.rig.calibration = Calibration {
            force_uncertainty: 0.01,
            displacement_uncertainty: 0.01,
            force_calibrated: Some(force),
            ..Calibration::default()
        };
        plan
    }

    fn withheld(record: &Record, procedure: usize, name: &str) -> Option<String> {
        let result = record.procedures[procedure].result(name).unwrap();
        result.withheld.clone()
    }

    /// Above the range, below the range, inside: only there does a result have U. A result that no force enters has it everywhere. An
    /// impact that reads a stiffness without U has none either.
    #[test]
    fn a_result_from_a_reading_outside_of_its_calibrated_range_has_no_uncertainty() {
        let run = |low, high| run_unwatched(&plan(Interval { low, high }));
        let inside = run(1.0, 1e6);
        for (procedure, name) in [(0, "stiffness"), (0, "max_force"), (1, "max_displacement")] {
            assert_eq!(withheld(&inside, procedure, name), None, "{name}");
        }
        let above = run(1.0, 19.0);
        let reason = "the largest force, 20.00 N, is above the calibrated range of 1 N to 19 N";
        assert_eq!(withheld(&above, 0, "stiffness").as_deref(), Some(reason));
        assert_eq!(withheld(&above, 0, "max_force").as_deref(), Some(reason));
        assert_eq!(withheld(&above, 0, "max_displacement"), None);
        let result = above.procedures[0].result("stiffness").unwrap();
        assert!(result.contributions.is_empty());
        let read = withheld(&above, 1, "max_displacement").unwrap();
        assert_eq!(read, format!("U of `stiffness` is withheld: {reason}"));
        assert!(above.events.iter().any(|event| {
            event.kind == EventKind::Remark
                && event.text.contains("`stiffness`")
                && event.text.ends_with(reason)
        }));
        let below = withheld(&run(1e5, 1e6), 0, "stiffness").unwrap();
        assert!(below.contains("is below the calibrated range"), "{below}");
    }
}
