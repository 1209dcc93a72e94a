//! The limits in `check --explain`: allowed range, range of the dry run, margin. In: a dry run. Out: rows, and the same as data.

use super::DryRun;
use super::cells::{distance, margin, row, span};
use super::dry_rig::{Reach, whole};
use psd::report::PredictedLimit;
use psd_plan::formula::ResultValue;
use psd_plan::schema::limits;
use psd_plan::{Interval, Limits, of_axis};
use psd_text::units::Dimension;
use psd_text::units::display::si_unit;

/// A limit with the range of the dry run.
struct LimitRange {
    /// Name of the field.
    name: &'static str,
    /// The axis (from 1) that comes nearest to its own limit.
    axis: Option<usize>,
    allowed: Interval,
    dimension: Dimension,
    /// None if nothing moved.
    reached: Option<Interval>,
}

impl DryRun<'_> {
    /// Every limit with the range of the dry run. If axes have limits of their own, displacement and force are those of the axis that comes
    /// nearest to its limit.
    fn reached(&self, limits: &Limits) -> [LimitRange; 8] {
        let absolute = |pick: fn(&Reach) -> f64| {
            let largest = self
                .reaches
                .iter()
                .filter(|reach| reach.moved)
                .map(pick)
                .reduce(f64::max);
            largest.map(|high| Interval { low: 0.0, high })
        };
        limits.named().map(|(name, allowed, dimension)| {
            let reached = match name {
                _ if name == limits::DISPLACEMENT.name => {
                    let reach: fn(&Reach) -> &[Interval] = |reach| &reach.displacement;
                    return self.nearest(name, dimension, limits, |of| of.displacement, reach);
                }
                _ if name == limits::FORCE.name => {
                    return self.nearest(
                        name,
                        dimension,
                        limits,
                        |of| of.force,
                        |reach| &reach.force,
                    );
                }
                _ if name == limits::SPEED.name => absolute(|reach| reach.speed),
                _ if name == limits::INCREMENT.name => absolute(|reach| reach.increment),
                _ if name == limits::TRACKING_ERROR.name => absolute(|reach| reach.tracking_error),
                // The name of such a limit is that of the result that it bounds.
                error => self.largest(error),
            };
            LimitRange {
                name,
                axis: None,
                allowed,
                dimension,
                reached,
            }
        })
    }

    /// A limit of which axes may have their own: that of the axis with the smallest margin; of all axes where none has.
    fn nearest(
        &self,
        name: &'static str,
        dimension: Dimension,
        limits: &Limits,
        of: fn(&Limits) -> Interval,
        ranges: fn(&Reach) -> &[Interval],
    ) -> LimitRange {
        let moved = self.reaches.iter().filter(|reach| reach.moved);
        let moved: Vec<&[Interval]> = moved.map(ranges).collect();
        let reached = |axis: usize| {
            let of_axis = moved.iter().filter_map(|ranges| ranges.get(axis));
            let of_axis: Vec<Interval> = of_axis.copied().collect();
            (!of_axis.is_empty()).then(|| whole(&of_axis))
        };
        let all = of(limits);
        let axes = self.plan.degrees_of_freedom();
        let own = |axis| of(&self.plan.rig.limits_of(axis, limits));
        if (0..axes).all(|axis| own(axis) == all) {
            let reached: Vec<Interval> = (0..axes).filter_map(reached).collect();
            return LimitRange {
                name,
                axis: None,
                allowed: all,
                dimension,
                reached: (!reached.is_empty()).then(|| whole(&reached)),
            };
        }
        let margin = |axis: usize| {
            reached(axis).map_or(f64::INFINITY, |reached| distance(name, own(axis), reached))
        };
        let nearest = (0..axes).min_by(|a, b| margin(*a).total_cmp(&margin(*b)));
        let axis = nearest.unwrap_or(0);
        LimitRange {
            name,
            axis: Some(axis + 1),
            allowed: own(axis),
            dimension,
            reached: reached(axis),
        }
    }

    /// The limits as the guard will apply them, as data.
    pub(super) fn predicted_limits(&self) -> Vec<PredictedLimit> {
        let finite = |end: f64| Some(end).filter(|end| end.is_finite());
        let held = self
            .reached(&self.plan.limits.held())
            .into_iter()
            .filter(|limit| limit.allowed.is_bounded());
        let predicted = held.map(|limit| {
            let reached = limit.reached;
            PredictedLimit {
                quantity: limit.name.to_owned(),
                unit: si_unit(limit.dimension),
                low: finite(limit.allowed.low),
                high: finite(limit.allowed.high),
                reached: reached
                    .filter(|reached| reached.low.is_finite())
                    .map(|reached| [reached.low, reached.high]),
                margin: reached
                    .and_then(|reached| finite(distance(limit.name, limit.allowed, reached))),
            }
        });
        predicted.collect()
    }

    /// One row per limit: allowed range, range of the dry run, margin.
    pub(super) fn limits(&self) -> Vec<Vec<String>> {
        let mut rows = vec![row(["limit", "allowed", "reached", "margin"])];
        for limit in self.reached(&self.plan.limits) {
            let LimitRange {
                name,
                axis,
                allowed,
                dimension,
                reached,
            } = limit;
            if allowed.is_bounded() {
                let name = if name == limits::NRMS_ERROR.name {
                    "NRMS tracking error".to_owned()
                } else {
                    name.replace('_', " ")
                };
                let margin = reached.map_or_else(
                    || "–".to_owned(),
                    |reached| margin(&name, allowed, reached, dimension),
                );
                rows.push(vec![
                    name + &of_axis(axis),
                    span(allowed, dimension),
                    reached.map_or_else(|| "–".to_owned(), |reached| span(reached, dimension)),
                    margin,
                ]);
            }
        }
        if rows.len() == 1 {
            vec![row(["none: only a virtual rig can run this plan"])]
        } else {
            rows
        }
    }

    /// Largest absolute value of a result over all procedures that have it.
    fn largest(&self, result: &str) -> Option<Interval> {
        let errors = self.record.procedures.iter().filter_map(|procedure| {
            match procedure.result(result)?.value {
                ResultValue::Number { value, .. } => value.map(f64::abs),
                ResultValue::List(_) => None,
            }
        });
        errors
            .reduce(f64::max)
            .map(|high| Interval { low: 0.0, high })
    }
}
