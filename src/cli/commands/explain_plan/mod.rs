//! `psd check --explain`: a prediction of a run. In: a checked plan. Out: text, from a dry run of
//! the same code on an ideal virtual rig: same procedures and limits, no noise, lag or drift. It
//! moves no real rig.

pub(crate) mod base_excitation;
pub(crate) mod dry_rig;
pub(crate) mod start;
pub(crate) mod tracking;
pub(crate) mod zero_drift;

use std::fmt::Write as _;

use super::explain_plan::dry_rig::{Reach, Watched};
use crate::cli::columns::columns;
use crate::cli::exit::Exit;
use crate::cli::settings::Settings;
use crate::plan::formula::ResultValue;
use crate::plan::{
    Condition, DecisionRule, Interval, Limits, Link, Plan, ProcedureKind, VirtualLink,
};
use crate::record::{History, ImpactHistory, Outcome, Record};
use crate::report::{
    PredictedLimit, PredictedProcedure, PredictedRequirement, Prediction, specimen_text,
};
use crate::text::diagnostic::excerpt::escape;
use crate::units::Dimension;
use crate::units::display::{digits, join, readable, si_unit, significant, stated, unit};
use crate::verdict::{self, Assessment, ConditionOutcome};

/// What a run would do.
pub enum Explained<'a> {
    Dry(Box<DryRun<'a>>),
    /// The specimen of this name has no behaviour: only a real rig knows how it bends.
    Unknown {
        specimen: &'a str,
        rig: &'a str,
    },
}

impl<'a> Explained<'a> {
    /// Runs the plan dry, where the specimen that it tests has a behaviour or none is tested.
    pub fn of(plan: &'a Plan) -> Self {
        match plan.specimen_on_the_rig() {
            Some(specimen) if specimen.behaviour.is_none() && specimen.frame.is_none() => {
                Self::Unknown {
                    specimen: &specimen.name,
                    rig: &plan.rig.name,
                }
            }
            _ => Self::Dry(Box::new(DryRun::of(plan))),
        }
    }

    /// A dry run that a limit stops ends as the run would; where there is none, nothing is wrong with the plan.
    pub fn exit(&self) -> Exit {
        match self {
            Self::Dry(dry) => dry.exit(),
            Self::Unknown { .. } => Exit::Met,
        }
    }

    pub fn text(&self, settings: Settings) -> String {
        match self {
            Self::Dry(dry) => dry.text(settings),
            Self::Unknown { specimen, rig } => format!(
                "no dry run: specimen `{specimen}` has no `behaviour`, and only rig `{rig}` knows how it bends. A `behaviour` as it is \
                 expected gives one.\n"
            ),
        }
    }
}

/// A run that moved nothing but numbers.
pub struct DryRun<'a> {
    plan: &'a Plan,
    /// What it ran on, in words.
    model: String,
    record: Record,
    reaches: Vec<Reach>,
    assessment: Assessment,
}

impl<'a> DryRun<'a> {
    pub fn of(plan: &'a Plan) -> Self {
        let mut ideal = plan.clone();
        ideal.rig.link = Link::Virtual(VirtualLink::ideal_of(&plan.rig));
        let model = format!(
            "dry run on an ideal copy of rig `{}`: same specimen and limits, no noise, lag or drift",
            plan.rig.name
        );
        Self::on(plan, &ideal, model)
    }

    /// Runs the plan as `stand_in` has it, whose rig is virtual.
    pub fn on(plan: &'a Plan, stand_in: &Plan, model: String) -> Self {
        let (record, reaches) =
            Watched::run(stand_in, plan.rig.link.as_real().map(|link| link.own_speed));
        let assessment = verdict::assess(stand_in, &record);
        Self {
            plan,
            model,
            record,
            reaches,
            assessment,
        }
    }

    /// A dry run that a limit stops ends as the run would.
    pub fn exit(&self) -> Exit {
        match self.record.outcome {
            Outcome::Completed => Exit::Met,
            Outcome::Aborted { .. } | Outcome::NotReleased { .. } => Exit::Stopped,
            Outcome::Blocked { .. } => Exit::Missed,
            Outcome::Faulted { .. } => Exit::Fault,
        }
    }

    pub fn text(&self, settings: Settings) -> String {
        let mut text = format!("{}\n", settings.paint_heading(&escape(&self.plan.title)));
        let _ = writeln!(text, "{}\n", self.model);
        let mut section = |heading: &str, rows: Vec<Vec<String>>| {
            if !rows.is_empty() {
                let _ = writeln!(
                    text,
                    "{}\n{}",
                    settings.paint_heading(heading),
                    columns(&rows)
                );
            }
        };
        for specimen in &self.plan.specimens {
            if let Some(behaviour) = &specimen.behaviour {
                let from = specimen
                    .mass_from
                    .as_ref()
                    .map_or_else(String::new, |formula| format!(" from {formula}"));
                let mass = (
                    "equivalent mass",
                    stated(specimen.mass, Dimension::MASS) + &from,
                );
                let rows = std::iter::once(mass).chain(specimen_text::rows(behaviour, &stated));
                let rows = rows
                    .map(|(label, text)| vec![label.to_owned(), escape(&text)])
                    .collect();
                section(&format!("Specimen {}", specimen.name), rows);
            }
        }
        let lagging = tracking::lagging(self.plan);
        section("Start", start::rows(self.plan));
        section("What moves", self.motions());
        for (index, (procedure, planned)) in self
            .record
            .procedures
            .iter()
            .zip(&self.plan.procedures)
            .enumerate()
        {
            if let (History::Impact(history), ProcedureKind::Impact(blow)) =
                (&procedure.history, &planned.kind)
                && history.frame.is_none()
                && !history.steps.is_empty()
            {
                let foretold = tracking::rows(self.plan, blow, procedure, history);
                let energy = tracking::energy(lagging.as_ref(), index);
                section(
                    &format!("{}, impact", procedure.name),
                    [impact(history), foretold, energy].concat(),
                );
            }
            if let (History::Impact(history), ProcedureKind::Impact(blow)) =
                (&procedure.history, &planned.kind)
                && let Some(frame) = history
                    .frame
                    .as_ref()
                    .filter(|frame| !frame.floors.is_empty())
            {
                let modes = base_excitation::modes(frame.modes.as_ref(), &frame.damping_ratios);
                section(&format!("{}, modes", procedure.name), modes);
                section(
                    &format!("{}, shapes", procedure.name),
                    base_excitation::shapes(frame.modes.as_ref()),
                );
                let heading = format!("{}, impact on storey {}", procedure.name, frame.struck + 1);
                let foretold = tracking::storey_rows(self.plan, blow, history.time_step, frame);
                let energy = tracking::energy(lagging.as_ref(), index);
                section(
                    &heading,
                    [
                        impact(history),
                        base_excitation::floors(frame),
                        foretold,
                        energy,
                    ]
                    .concat(),
                );
            }
            if matches!(procedure.history, History::Escalate(_)) {
                section(
                    &format!("{}, worst blow", procedure.name),
                    tracking::energy(lagging.as_ref(), index),
                );
            }
            if let (History::Shake(history), ProcedureKind::Shake(shake)) =
                (&procedure.history, &planned.kind)
            {
                let modes = base_excitation::modes(history.modes.as_ref(), &history.damping_ratios);
                section(&format!("{}, modes", procedure.name), modes);
                section(
                    &format!("{}, shapes", procedure.name),
                    base_excitation::shapes(history.modes.as_ref()),
                );
                let foretold = tracking::shake_rows(self.plan, shake, history);
                let energy = tracking::energy(lagging.as_ref(), index);
                section(
                    &format!("{}, shake", procedure.name),
                    [base_excitation::steps(history), foretold, energy].concat(),
                );
            }
        }
        section("Limits", self.limits());
        section("Zeros", zero_drift::rows(self.plan, &self.record));
        section("Requirements, as predicted", self.requirements());
        let undeclared = self.plan.rig.undeclared(self.plan.degrees_of_freedom());
        if !undeclared.is_empty()
            && self
                .assessment
                .requirements
                .iter()
                .flat_map(|each| &each.conditions)
                .any(|it| it.uncertainty.is_some())
        {
            let _ = writeln!(
                text,
                "Not in u, for the plan does not declare it: {}\n",
                undeclared.join(", ")
            );
        }
        if let Some(stopped) = self.stopped() {
            let _ = writeln!(text, "{}", settings.paint_heading(&stopped));
        }
        text
    }

    /// ` in hit, step 12`: where it was stopped.
    fn stopped_in(&self) -> String {
        let last = self
            .record
            .events
            .iter()
            .rev()
            .find(|event| event.procedure.is_some());
        last.map_or_else(String::new, |event| {
            let name = event
                .procedure
                .as_deref()
                .map_or_else(String::new, |name| format!(" in {name}"));
            let next = event.step.map_or(1, |step| step + 1);
            format!("{name}, step {next}")
        })
    }

    /// One row a procedure: how far, how hard, how fast, how long.
    fn motions(&self) -> Vec<Vec<String>> {
        let mut rows = vec![row([
            "procedure",
            "",
            "displacement",
            "force",
            "fastest",
            "largest step",
            "steps",
            "rig time",
        ])];
        for reach in &self.reaches {
            let mut cells = vec![reach.name.clone(), reach.keyword.clone()];
            if reach.moved {
                cells.extend([
                    span(reach.displacement, Dimension::LENGTH),
                    span(reach.force, Dimension::FORCE),
                    readable(reach.speed, Dimension::VELOCITY),
                    readable(reach.increment, Dimension::LENGTH),
                ]);
            } else {
                cells.extend(row(["–", "–", "–", "–"]));
            }
            cells.extend([
                reach.steps.to_string(),
                readable(reach.ended - reach.started, Dimension::TIME),
            ]);
            rows.push(cells);
        }
        let total = self.reaches.last().map_or(0.0, |reach| reach.ended);
        rows.push(row([
            "together",
            "",
            "",
            "",
            "",
            "",
            "",
            &readable(total, Dimension::TIME),
        ]));
        rows
    }

    /// Every limit by the name of its field, and how far the dry run went.
    fn reached(
        &self,
        limits: &Limits,
    ) -> [(&'static str, Interval, Dimension, Option<Interval>); 8] {
        let over = |pick: fn(&Reach) -> Interval| {
            let moved = self.reaches.iter().filter(|reach| reach.moved).map(pick);
            moved.reduce(|a, b| Interval {
                low: a.low.min(b.low),
                high: a.high.max(b.high),
            })
        };
        let size = |pick: fn(&Reach) -> f64| {
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
                "displacement" => over(|reach| reach.displacement),
                "force" => over(|reach| reach.force),
                "speed" => size(|reach| reach.speed),
                "increment" => size(|reach| reach.increment),
                "tracking_error" => size(|reach| reach.tracking_error),
                error => self.largest(error),
            };
            (name, allowed, dimension, reached)
        })
    }

    /// The same as data, with the limits as the guard will hold them.
    pub fn prediction(&self) -> Prediction {
        let ends = |interval: Interval| [interval.low, interval.high];
        let finite = |end: f64| Some(end).filter(|end| end.is_finite());
        let procedures = self.reaches.iter().map(|reach| PredictedProcedure {
            name: reach.name.clone(),
            kind: reach.keyword.clone(),
            steps: reach.steps,
            rig_time_s: reach.ended - reach.started,
            displacement_m: reach.moved.then(|| ends(reach.displacement)),
            force_n: (reach.moved && reach.force.low.is_finite()).then(|| ends(reach.force)),
            speed_m_per_s: reach.moved.then_some(reach.speed),
            increment_m: reach.moved.then_some(reach.increment),
        });
        let held = self
            .reached(&self.plan.limits.held())
            .into_iter()
            .filter(|(_, allowed, ..)| allowed.is_bounded());
        let limits = held.map(|(name, allowed, dimension, reached)| PredictedLimit {
            quantity: name.to_owned(),
            unit: si_unit(dimension),
            low: finite(allowed.low),
            high: finite(allowed.high),
            reached: reached.filter(|reached| reached.low.is_finite()).map(ends),
            margin: reached.and_then(|reached| finite(left(name, allowed, reached))),
        });
        let required = self.assessment.requirements.iter();
        Prediction {
            model: self.model.clone(),
            stopped: self.stopped(),
            zeros: zero_drift::predicted(&self.record),
            procedures: procedures.collect(),
            limits: limits.collect(),
            requirements: required
                .map(|each| PredictedRequirement {
                    name: each.label.clone(),
                    verdict: each.verdict.name(),
                })
                .collect(),
        }
    }

    /// What would end the run early.
    fn stopped(&self) -> Option<String> {
        match &self.record.outcome {
            Outcome::Completed => None,
            Outcome::Aborted { reason } | Outcome::NotReleased { reason } => Some(format!(
                "The run would be stopped{}: {}",
                self.stopped_in(),
                escape(reason)
            )),
            Outcome::Blocked { reason } => {
                Some(format!("The run could not go on: {}", escape(reason)))
            }
            Outcome::Faulted { reason } => Some(format!("The rig would fail: {}", escape(reason))),
        }
    }

    /// One row a limit: the bound, how far the dry run went, what is left.
    fn limits(&self) -> Vec<Vec<String>> {
        let mut rows = vec![row(["limit", "allowed", "reached", "margin"])];
        for (name, allowed, dimension, reached) in self.reached(&self.plan.limits) {
            if allowed.is_bounded() {
                let name = if name == "nrms_error" {
                    "NRMS tracking error".to_owned()
                } else {
                    name.replace('_', " ")
                };
                let margin = reached.map_or_else(
                    || "–".to_owned(),
                    |reached| margin(&name, allowed, reached, dimension),
                );
                rows.push(vec![
                    name,
                    span(allowed, dimension),
                    reached.map_or_else(|| "–".to_owned(), |reached| span(reached, dimension)),
                    margin,
                ]);
            }
        }
        if rows.len() == 1 {
            vec![row(["none: only a virtual rig may run this plan"])]
        } else {
            rows
        }
    }

    /// Largest size of a result over all procedures that have it.
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

    /// One row a condition: what it would come to, how well that would be known, and whether so much is left.
    fn requirements(&self) -> Vec<Vec<String>> {
        let planned = self
            .plan
            .requirements
            .iter()
            .zip(&self.assessment.requirements);
        let rows =
            planned.flat_map(|(requirement, outcome)| {
                requirement.conditions.iter().zip(&outcome.conditions).map(
                    |(condition, outcome)| {
                        let shown = |value: Option<f64>| {
                            value.map_or_else(
                                || "–".to_owned(),
                                |value| readable(value, outcome.dimension),
                            )
                        };
                        let mut row = vec![
                            outcome.verdict.name().to_owned(),
                            escape(&requirement.label),
                            escape(&outcome.text),
                            shown(outcome.value),
                            format!("margin {}", shown(outcome.margin)),
                        ];
                        row.extend(self.known(condition, outcome));
                        row
                    },
                )
            });
        rows.collect()
    }

    /// How far the uncertainty that the plan declares reaches, and what that leaves of the decision.
    fn known(&self, condition: &Condition, outcome: &ConditionOutcome) -> [String; 2] {
        let nothing = || ["u not known".to_owned(), String::new()];
        let band =
            verdict::assess_condition(condition, DecisionRule::Guarded, &self.record).guard_band;
        let (Some(band), Some(margin)) = (band, outcome.margin) else {
            return nothing();
        };
        let uncertain = outcome
            .uncertainty
            .map_or_else(|| "–".to_owned(), |u| readable(u, outcome.dimension));
        let left = match (margin.abs() >= band, self.plan.decision_rule) {
            (true, _) => "is decided",
            (false, DecisionRule::Guarded) => "NOT decided: the limit is nearer",
            (false, DecisionRule::Simple) => "decided by the value alone: the limit is nearer",
        };
        [
            format!("u {uncertain}"),
            format!(
                "U of the margin {}, {left}",
                readable(band, outcome.dimension)
            ),
        ]
    }
}

/// What is left to the nearer end. What is a size has one end, and an end of 0 at which the run stands at rest is not run into.
fn margin(name: &str, allowed: Interval, reached: Interval, dimension: Dimension) -> String {
    let above = allowed.high - reached.high;
    let below = reached.low - allowed.low;
    let is_size = !["displacement", "force"].contains(&name);
    let rests = |allowed: f64, reached: f64| allowed == 0.0 && reached == 0.0;
    let (low, high) = (
        !is_size && rests(allowed.low, reached.low),
        rests(allowed.high, reached.high),
    );
    match (low, high) {
        // Where nothing asks for less the rig goes as fast as it may.
        _ if name == "speed" && above == 0.0 => "none: as fast as allowed".to_owned(),
        (true, true) => "none, and it rests there".to_owned(),
        (true, false) => format!("{}; it begins at 0", readable(above, dimension)),
        (false, true) if !is_size => format!("{}; it begins at 0", readable(below, dimension)),
        _ if is_size => readable(above, dimension),
        _ => readable(above.min(below), dimension),
    }
}

/// The steps of an impact and its predicted peaks.
fn impact(history: &ImpactHistory) -> Vec<Vec<String>> {
    let peak = |of: fn(&crate::record::ImpactStep) -> f64, dimension| {
        let largest = history
            .steps
            .iter()
            .map(|step| (of(step).abs(), step.time))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        largest.map_or_else(String::new, |(value, time)| {
            format!(
                "{} at {}",
                readable(value, dimension),
                readable(time, Dimension::TIME)
            )
        })
    };
    let ratio = history.time_step / history.critical_time_step;
    let judged = if ratio > 1.0 {
        "ABOVE critical"
    } else {
        "of it"
    };
    let ends = history.steps.last().map_or(0.0, |step| step.time);
    vec![
        row([
            "critical time step",
            &readable(history.critical_time_step, Dimension::TIME),
        ]),
        row([
            "chosen time step",
            &format!(
                "{}, {} {judged}",
                readable(history.time_step, Dimension::TIME),
                significant(ratio, 3)
            ),
        ]),
        row([
            "virtual time",
            &format!(
                "{} in {} steps",
                readable(ends, Dimension::TIME),
                history.steps.len().saturating_sub(1)
            ),
        ]),
        row([
            "peak displacement",
            &peak(|step| step.computed, Dimension::LENGTH),
        ]),
        row([
            "peak restoring force",
            &peak(|step| step.restoring_force, Dimension::FORCE),
        ]),
        row([
            "peak contact force",
            &peak(|step| step.contact_force, Dimension::FORCE),
        ]),
        row([
            "peak velocity of the structure",
            &peak(|step| step.velocity, Dimension::VELOCITY),
        ]),
    ]
}

/// What is left to the nearer end; negative: past it. What is a size has one end.
fn left(name: &str, allowed: Interval, reached: Interval) -> f64 {
    let above = allowed.high - reached.high;
    if ["displacement", "force"].contains(&name) {
        above.min(reached.low - allowed.low)
    } else {
        above
    }
}

/// `0 .. 1.000 mm`: both ends in the unit that suits the larger one.
fn span(interval: Interval, dimension: Dimension) -> String {
    let finite = |end: f64| if end.is_finite() { end.abs() } else { 0.0 };
    let (unit, factor) = unit(finite(interval.low).max(finite(interval.high)), dimension);
    let shown = |end: f64| digits(end, factor, dimension);
    let text = match (interval.low.is_finite(), interval.high.is_finite()) {
        (true, true) => format!("{} .. {}", shown(interval.low), shown(interval.high)),
        (false, true) => format!("up to {}", shown(interval.high)),
        (true, false) => format!("from {}", shown(interval.low)),
        (false, false) => return "any".to_owned(),
    };
    join(&text, &unit)
}

fn row<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::testing::empty_plan;

    #[test]
    fn a_span_has_one_unit() {
        assert_eq!(
            span(
                Interval {
                    low: -2e-3,
                    high: 25e-3
                },
                Dimension::LENGTH
            ),
            "−2.000 .. 25.00 mm"
        );
        assert_eq!(
            span(
                Interval {
                    low: f64::NEG_INFINITY,
                    high: 12e3
                },
                Dimension::FORCE
            ),
            "up to 12.00 kN"
        );
        assert_eq!(
            span(
                Interval {
                    low: 0.0,
                    high: 0.01
                },
                Dimension::NUMBER
            ),
            "0 .. 0.01000"
        );
    }

    #[test]
    fn a_limit_that_starts_at_nothing_has_the_margin_of_its_other_end() {
        let at = |name, allowed: (f64, f64), reached: (f64, f64)| {
            let interval = |(low, high)| Interval { low, high };
            margin(
                name,
                interval(allowed),
                interval(reached),
                Dimension::LENGTH,
            )
        };
        assert_eq!(at("displacement", (-1e-3, 0.1), (0.0, 0.04)), "1.000 mm");
        assert_eq!(
            at("displacement", (0.0, 0.1), (0.0, 0.04)),
            "60.00 mm; it begins at 0"
        );
        assert_eq!(
            at("displacement", (-0.1, 0.0), (-0.04, 0.0)),
            "60.00 mm; it begins at 0"
        );
        assert_eq!(at("increment", (0.0, 5e-3), (0.0, 4e-3)), "1.000 mm");
        assert_eq!(
            at("speed", (0.0, 0.02), (0.0, 0.02)),
            "none: as fast as allowed"
        );
    }

    /// Example 1 of Melo et al. 2006, with the actuator allowed to go to `farthest`.
    fn example(farthest: f64) -> Plan {
        use crate::plan::formula::Formula::Constant;
        use crate::plan::{
            Behaviour, Contact, Impact, ImpactTarget, Limits, PointTarget, Procedure,
            ProcedureKind, RigPlan, Settle, Specimen, Stepping, Striker, Until,
        };
        use crate::tests::testing::every;
        let specimen = Specimen::new("beam", 1.0, Some(Behaviour::Elastic { stiffness: 327.65 }));
        let impact = Impact {
            specimen: 0,
            striker: 0,
            target: ImpactTarget::Point(PointTarget {
                mass: Constant(1.0),
                mass_uncertainty: 0.0,
                stiffness: Constant(327.65),
                damping: Constant(0.0),
            }),
            contact: Contact::Rigid,
            stepping: Stepping {
                max_tangent_ratio: Constant(2.0),
                ..every(0.01)
            },
            duration: Constant(1.0),
            until: Until::StrikerStop,
        };
        Plan {
            title: "Example 1".to_owned(),
            specimens: vec![specimen],
            strikers: vec![Striker::new("hammer", 10.0, 1.0)],
            rig: RigPlan {
                name: "noisy".to_owned(),
                link: Link::Virtual(VirtualLink {
                    noise: 5.0,
                    lag: 0.1,
                    ..VirtualLink::default()
                }),
                settle: Settle {
                    band: 0.0,
                    force_rate: 0.0,
                    dwell: 0.0,
                    timeout: 10.0,
                },
                ..empty_plan().rig
            },
            limits: Limits {
                displacement: Interval {
                    low: -0.1,
                    high: farthest,
                },
                ..Limits::NONE
            },
            procedures: vec![Procedure {
                name: "hit".to_owned(),
                kind: ProcedureKind::Impact(impact),
            }],
            ..empty_plan()
        }
    }

    #[test]
    fn the_papers_first_example_is_predicted_without_the_rigs_noise() {
        let plan = example(0.2);
        let dry = DryRun::of(&plan);
        let text = dry.text(Settings::PLAIN);
        // Critical step (2π/10)√(M/K), the paper's largest displacement, and what is left to the limit.
        for expected in [
            "34.71 ms",
            "10.00 ms, 0.288 of it",
            "0.1579 m",
            "42.14 mm",
            "`noisy`",
        ] {
            assert!(text.contains(expected), "{expected} in\n{text}");
        }
        assert_eq!(dry.exit(), Exit::Met);
    }

    #[test]
    fn a_specimen_without_behaviour_is_not_run_dry() {
        let mut plan = example(0.2);
        assert!(
            Explained::of(&plan)
                .text(Settings::PLAIN)
                .contains("peak displacement")
        );
        plan.specimens[0].behaviour = None;
        let explained = Explained::of(&plan);
        assert!(
            explained
                .text(Settings::PLAIN)
                .starts_with("no dry run: specimen `beam`"),
            "{}",
            explained.text(Settings::PLAIN)
        );
        assert_eq!(explained.exit(), Exit::Met);
    }

    #[test]
    fn a_limit_that_would_stop_the_run_is_said() {
        let plan = example(0.1);
        let dry = DryRun::of(&plan);
        assert!(
            dry.text(Settings::PLAIN)
                .contains("The run would be stopped in hit"),
            "{}",
            dry.text(Settings::PLAIN)
        );
        assert_eq!(dry.exit(), Exit::Stopped);
    }
}
