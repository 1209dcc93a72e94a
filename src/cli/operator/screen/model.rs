//! The data of the screen about a run. In: reports of the run to its observer. Out: numbers in SI and strings, bounded in number for a
//! run of any length. It knows no terminal and no clock.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use super::curve::Curves;
use crate::commands::explain_plan::dry_rig::Reach;
use crate::operator::shown::Shown;
use psd::run::StepReport;
use psd_plan::record::UNLOADING;
use psd_plan::record::{Event, EventKind};
use psd_plan::{Interval, Limits, Plan, SafeState};
use psd_rig::Feedback;
use psd_rig::real::commands_only;
use psd_text::units::Dimension;

/// Largest number of events kept for the screen.
const MOST_EVENTS: usize = 32;

/// The procedure without motion.
pub const INSPECT: &str = "inspect";

/// All drawn data except the dialogue with the operator.
#[derive(Clone, Debug)]
pub struct Model {
    pub title: String,
    pub rig: String,
    pub simulated: bool,
    pub limits: Limits,
    /// The displacement and the force of a step that are drawn.
    pub shown: Shown,
    /// The procedure that runs, or that ran last.
    pub procedure: Option<Running>,
    pub last: Option<StepReport>,
    /// While the uncertainty of the results is calculated: number of re-runs done, and their total.
    pub study: Option<(usize, usize)>,
    /// The curves of this procedure.
    pub curves: Curves,
    /// The predicted procedures; empty if nothing is predicted.
    pub predicted: Arc<[Reach]>,
    /// The time left of the run, if it is known.
    pub left: Option<Duration>,
    /// Change of target in the last step \[m\].
    pub increment: Option<f64>,
    /// Of each axis, whether its last change of target was towards negative displacements; None: its target has not changed.
    pub falling: Vec<Option<bool>>,
    /// The events; the newest is last.
    pub events: VecDeque<Event>,
    /// The title in place of a running procedure: `monitor`.
    pub by_hand: Option<&'static str>,
    /// The actuator has no displacement feedback.
    pub open_loop: bool,
    /// The safe state of the rig is to unload.
    pub unloads: bool,
    /// Number of axial axes, the last ones: their readings are beside the others.
    pub axial: usize,
    /// The last reading, also at rest and during a move: \[m\], \[N\], one entry per axis.
    pub live: Option<Feedback>,
    /// The run has ended early: the state of the rig.
    pub ended: Option<Ended>,
}

/// State of a rig whose run has ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    Held,
    NotHeld,
    Unloading,
}

/// A procedure and its maximum number of steps.
#[derive(Clone, Debug)]
pub struct Running {
    pub name: String,
    pub keyword: String,
    /// Upper bound of its steps, if one is known.
    pub steps: Option<u64>,
}

/// One limit and the position of the last step in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitRow {
    pub name: &'static str,
    pub dimension: Dimension,
    pub limit: Interval,
    /// Whether it bounds an absolute value, for which 0 is not a danger.
    pub size: bool,
    /// Whether psd itself applies the limit. At the bound the rig follows its command; only a value beyond the bound is an error.
    pub kept: bool,
    /// None if no value is known yet.
    pub value: Option<f64>,
    /// Whether the rig moves towards the low end; None: it has not moved, or the limit bounds an absolute value.
    pub falling: Option<bool>,
}

impl LimitRow {
    /// Distance to the end that is approached; negative beyond an end.
    pub fn margin(&self) -> Option<f64> {
        let value = self.value?;
        let Interval { low, high } = self.limit;
        let margin = if self.approaches_low(value) {
            value - low
        } else {
            high - value
        };
        margin.is_finite().then_some(margin)
    }

    /// Whether the low end is approached: the end in the direction of the motion. Without a motion: the end on the side of the value from
    /// zero, or the nearer end of a limit without zero. A value beyond an end is at that end.
    pub fn approaches_low(&self, value: f64) -> bool {
        let Interval { low, high } = self.limit;
        if let Some(falling) = self.falling {
            value < low || (falling && value <= high)
        } else if low <= 0.0 && high >= 0.0 && value != 0.0 {
            value < 0.0
        } else {
            !self.size && value - low < high - value
        }
    }
}

impl Model {
    pub fn new(plan: &Plan, simulated: bool) -> Self {
        let axial = plan.rig.axial_axes(&plan.limits).count();
        Self {
            title: plan.title.clone(),
            rig: plan.rig.name.clone(),
            simulated,
            limits: plan.lateral_limits(),
            shown: Shown::of(plan),
            procedure: None,
            last: None,
            study: None,
            curves: Curves::default(),
            predicted: Arc::default(),
            left: None,
            increment: None,
            falling: Vec::new(),
            events: VecDeque::new(),
            by_hand: None,
            open_loop: plan.rig.link.as_real().is_some_and(commands_only),
            unloads: plan
                .rig
                .link
                .as_real()
                .is_some_and(|link| link.safe_state == SafeState::Unload)
                && axial == 0,
            axial,
            live: None,
            ended: None,
        }
    }

    /// `force`, or `force on the rig`.
    pub fn on_the_rig(&self, word: &str) -> String {
        format!("{word}{}", self.shown.of_rig)
    }

    pub fn procedure_started(&mut self, name: &str, keyword: &str, steps: Option<u64>) {
        self.study = None;
        self.procedure = Some(Running {
            name: name.to_owned(),
            keyword: keyword.to_owned(),
            steps,
        });
        // During an inspection of the specimen, the earlier data stay visible.
        if keyword == INSPECT {
            return;
        }
        self.last = None;
        self.increment = None;
        self.curves = Curves::default();
    }

    pub fn step_done(&mut self, report: &StepReport) {
        self.study = None;
        self.increment = self.last.as_ref().map(|last| {
            let changes = report
                .axes
                .iter()
                .zip(&last.axes)
                .map(|(to, from)| (to.command - from.command).abs());
            changes.fold(0.0, f64::max)
        });
        self.falling.resize(report.axes.len(), None);
        let from = self.last.iter().flat_map(|last| &last.axes);
        for ((falling, to), from) in self.falling.iter_mut().zip(&report.axes).zip(from) {
            if to.command.total_cmp(&from.command).is_ne() {
                *falling = Some(to.command < from.command);
            }
        }
        self.curves.push(report, &self.shown);
        self.last = Some(report.clone());
    }

    /// The prediction of the procedure that runs.
    pub fn prediction(&self) -> Option<&Reach> {
        let running = self.procedure.as_ref()?;
        self.predicted
            .iter()
            .find(|reach| reach.name == running.name)
    }

    /// Number of axes in the last step.
    pub fn axes(&self) -> usize {
        self.feedback().len().max(1)
    }

    pub fn event(&mut self, event: &Event) {
        if self.events.len() == MOST_EVENTS {
            self.events.pop_front();
        }
        match event.kind {
            EventKind::Held => self.ended = Some(Ended::Held),
            EventKind::NotHeld => self.ended = Some(Ended::NotHeld),
            EventKind::Hold if event.text == UNLOADING => self.ended = Some(Ended::Unloading),
            _ => {}
        }
        self.events.push_back(event.clone());
    }

    /// Displacement \[m\] and force \[N\] of every axis: the last reading, or else the end of the last step.
    pub fn feedback(&self) -> Vec<(f64, f64)> {
        match &self.live {
            Some(live) => live
                .displacement
                .iter()
                .copied()
                .zip(live.force.iter().copied())
                .take(live.displacement.len().saturating_sub(self.axial))
                .collect(),
            None => self
                .last
                .iter()
                .flat_map(|last| &last.axes)
                .map(|axis| (axis.displacement, axis.force))
                .collect(),
        }
    }

    /// |command − displacement| of the last step \[m\]; None while the rig is read during a move.
    pub fn tracking_error(&self) -> Option<f64> {
        let read_in_motion = self
            .procedure
            .as_ref()
            .is_some_and(|running| running.keyword == "damping sweep");
        if read_in_motion || self.by_hand.is_some() || self.open_loop {
            return None;
        }
        let errors = self
            .last
            .iter()
            .flat_map(|last| &last.axes)
            .map(|axis| (axis.command - axis.displacement).abs());
        errors.reduce(f64::max)
    }

    /// The limits of the plan for which a step gives a value; limits without a bound are left out.
    pub fn limit_rows(&self) -> Vec<LimitRow> {
        let Limits {
            displacement,
            force,
            speed,
            increment,
            tracking_error,
            energy_error,
            tracking_energy_error,
            nrms_error,
        } = self.limits;
        // For several axes: the one with the largest absolute value, and its direction.
        let of = |value: fn((f64, f64)) -> f64| {
            let feedback = self.feedback();
            let values = feedback.into_iter().map(value).enumerate();
            let largest = values.reduce(|largest, next| {
                if next.1.abs() > largest.1.abs() {
                    next
                } else {
                    largest
                }
            });
            let falling = largest.and_then(|(axis, _)| *self.falling.get(axis)?);
            (largest.map(|(_, value)| value), falling)
        };
        let last = self.last.as_ref();
        let energy = last.and_then(|last| last.energy_error).map(f64::abs);
        let share = last
            .and_then(|last| last.tracking_energy_error)
            .map(f64::abs);
        let nrms = last
            .and_then(|last| last.tracking)
            .map(|tracking| tracking.nrms_error);
        let sizes = |limit: Interval| Interval {
            low: limit.low.max(0.0),
            ..limit
        };
        let row = |name, dimension, limit, size, value| LimitRow {
            name,
            dimension,
            limit,
            size,
            kept: false,
            value,
            falling: None,
        };
        let directed = |name, dimension, limit, (value, falling)| LimitRow {
            falling,
            ..row(name, dimension, limit, false, value)
        };
        let speed_found = last.and_then(|last| last.speed);
        [
            directed(
                "displacement",
                Dimension::LENGTH,
                displacement,
                of(|(displacement, _)| displacement),
            ),
            directed("force", Dimension::FORCE, force, of(|(_, force)| force)),
            LimitRow {
                kept: true,
                ..row(
                    "speed",
                    Dimension::VELOCITY,
                    sizes(speed),
                    true,
                    speed_found,
                )
            },
            row(
                "increment",
                Dimension::LENGTH,
                sizes(increment),
                true,
                self.increment,
            ),
            row(
                "tracking error",
                Dimension::LENGTH,
                sizes(tracking_error),
                true,
                self.tracking_error(),
            ),
            row(
                "energy error",
                Dimension::NUMBER,
                sizes(energy_error),
                true,
                energy,
            ),
            row(
                "tracking energy",
                Dimension::NUMBER,
                sizes(tracking_energy_error),
                true,
                share,
            ),
            row(
                "NRMS error",
                Dimension::NUMBER,
                sizes(nrms_error),
                true,
                nrms,
            ),
        ]
        .into_iter()
        .filter(|row| {
            row.limit.high < f64::INFINITY
                || row.limit.low > if row.size { 0.0 } else { f64::NEG_INFINITY }
        })
        .collect()
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use psd_plan::AxisPlan;
    use psd_testing::plans::empty_plan;

    pub fn step(step: u64, time: f64, command: f64, force: f64) -> StepReport {
        StepReport {
            speed: Some(0.4),
            energy_error: Some(-1e-4),
            ..StepReport::of_readings(step, time, &[command], &[command - 2e-6], &[force])
        }
    }

    #[test]
    fn limits_are_shown_with_value_and_margin_and_only_where_they_bound() {
        let mut plan = empty_plan();
        plan.limits.displacement = Interval {
            low: -0.01,
            high: 0.1,
        };
        plan.limits.increment = Interval {
            low: 0.0,
            high: 0.02,
        };
        plan.limits.speed = Interval {
            low: 0.0,
            high: 1.0,
        };
        let mut model = Model::new(&plan, true);
        model.procedure_started("hit", "impact", Some(3));
        assert_eq!(
            model
                .limit_rows()
                .iter()
                .map(|row| (row.name, row.value))
                .collect::<Vec<_>>(),
            [("displacement", None), ("speed", None), ("increment", None)]
        );
        model.step_done(&step(1, 0.1, 0.01, 5.0));
        model.step_done(&step(2, 0.2, 0.025, 6.0));
        let rows = model.limit_rows();
        assert!((rows[0].margin().unwrap() - 0.075_002).abs() < 1e-12);
        assert!(
            (rows[1].margin().unwrap() - 0.6).abs() < 1e-12,
            "0.4 m/s of 1 m/s"
        );
        assert!((rows[2].margin().unwrap() - 0.005).abs() < 1e-12);
        // An axis with a narrower limit of its own.
        let force = Interval {
            low: -20.0,
            high: 10.0,
        };
        plan.limits.force = Interval {
            low: -300.0,
            high: 300.0,
        };
        plan.rig.simulated_axes = vec![AxisPlan {
            force: Some(force),
            ..AxisPlan::default()
        }];
        assert_eq!(Model::new(&plan, true).limits.force, force);
        // On the way back the low end is approached.
        model.step_done(&step(3, 0.3, 0.024, 5.0));
        assert!((model.limit_rows()[0].margin().unwrap() - 0.033_998).abs() < 1e-12);
        model.step_done(&step(3, 0.3, 0.025, 6.0));
        model.step_done(&step(3, 0.3, 0.026, 6.0));
        assert!(
            (model.limit_rows()[2].margin().unwrap() - 0.019).abs() < 1e-12,
            "no increment at all is as far as can be"
        );
        assert!((model.tracking_error().unwrap() - 2e-6).abs() < 1e-12);
        model.procedure_started("c", "damping sweep", None);
        model.step_done(&step(1, 0.1, 0.01, 5.0));
        assert_eq!(
            model.tracking_error(),
            None,
            "the target of a stroke is its end"
        );
        model.procedure_started("look", INSPECT, Some(0));
        assert_eq!(
            model.curves.displacement.points().count(),
            2,
            "a procedure begins its own curves"
        );
    }

    #[test]
    fn events_are_bounded() {
        let mut model = Model::new(&empty_plan(), true);
        for number in 0..100 {
            let text = format!("event {number}");
            model.event(&Event {
                time: 0.0,
                procedure: None,
                step: None,
                kind: EventKind::Note,
                text,
            });
        }
        assert_eq!(model.events.len(), MOST_EVENTS);
        assert_eq!(model.events.back().unwrap().text, "event 99");
    }
}
