//! `psd check --explain`: the prediction of a run. In: a checked plan. Out: text, from a dry run of the same code on an ideal simulated
//! rig: same procedures and limits, no noise, lag or zero drift. It moves no real rig.

mod cells;
pub(crate) mod dry_rig;
mod limits;
pub(crate) mod start;
mod substructures;
#[cfg(test)]
mod tests;
pub(crate) mod tracking;
pub(crate) mod zero_drift;

use std::fmt::Write as _;

use super::explain_plan::dry_rig::{Reach, Watched, whole};
use crate::exit::Exit;
use crate::settings::Settings;
use cells::{row, span};
use psd::procedures;
use psd::report::wording::specimen as specimen_text;
use psd::report::{PredictedProcedure, PredictedRequirement, Prediction};
use psd::verdict::{self, Assessment, ConditionOutcome, Declared, ReproductionOutcome, Verdict};
use psd_plan::record::{Outcome, Record};
use psd_plan::{Condition, DecisionRule, Interval, Link, Plan, ReadingErrors, VirtualLink};
use psd_text::columns::columns;
use psd_text::diagnostic::excerpt::escape;
use psd_text::units::Dimension;
use psd_text::units::display::{readable, stated};

/// The prediction of a run.
pub enum Explained<'a> {
    Dry(Box<DryRun<'a>>),
    /// The specimen of this name has no restoring-force model: only a test on a real rig can measure it.
    Unknown {
        specimen: &'a str,
        rig: &'a str,
    },
}

impl<'a> Explained<'a> {
    /// Makes a dry run of the plan if its specimen has a restoring-force model, or if no specimen is tested.
    pub fn of(plan: &'a Plan) -> Self {
        match plan.unknown_specimen() {
            Some(specimen) => Self::Unknown {
                specimen: &specimen.name,
                rig: &plan.rig.name,
            },
            None => Self::Dry(Box::new(DryRun::of(plan))),
        }
    }

    /// The exit of a dry run that a limit stops is that of the run. Without a dry run the plan has no error.
    pub fn exit(&self) -> Exit {
        match self {
            Self::Dry(dry) => dry.exit(),
            Self::Unknown { .. } => Exit::Met,
        }
    }

    /// The prediction as data; None without a dry run.
    pub fn prediction(&self) -> Option<Prediction> {
        match self {
            Self::Dry(dry) => Some(dry.prediction()),
            Self::Unknown { .. } => None,
        }
    }

    pub fn text(&self, settings: Settings) -> String {
        match self {
            Self::Dry(dry) => dry.text(settings),
            Self::Unknown { specimen, rig } => format!(
                "no dry run: specimen `{specimen}` has no `behaviour`, and only rig `{rig}` has its stiffness. Add the expected `behaviour` for a dry run.\n"
            ),
        }
    }
}

/// The plan on a simulated rig whose readings have the errors that an ideal copy only predicts; None if there are none.
fn with_reading_errors(ideal: &Plan) -> Option<Plan> {
    let link = ideal.rig.link.as_virtual()?;
    let errors = link.predicted.filter(ReadingErrors::any)?;
    let mut noisy = ideal.clone();
    noisy.rig.link = Link::Virtual(VirtualLink {
        noise: errors.noise,
        resolution: errors.resolution,
        force_resolution: errors.force_resolution,
        predicted: None,
        ..*link
    });
    Some(noisy)
}

/// A simulated run that moves no hardware.
pub struct DryRun<'a> {
    plan: &'a Plan,
    /// Description of the simulated rig.
    model: String,
    record: Record,
    reaches: Vec<Reach>,
    assessment: Assessment,
}

impl<'a> DryRun<'a> {
    pub fn of(plan: &'a Plan) -> Self {
        let ideal = plan.on_an_ideal_rig();
        let model = format!(
            "dry run on an ideal copy of rig `{}`: same specimen and limits, no noise, lag or drift",
            plan.rig.name
        );
        let mut dry = Self::on(plan, &ideal, model);
        if let Some(noisy) = with_reading_errors(&ideal) {
            // The path of exact readings is determined even where that of the rig's own readings is not.
            let (record, _) = Watched::run(&noisy, None);
            dry.withhold_as_in(&record);
            dry.assessment = verdict::assess(plan, &dry.record);
        }
        dry
    }

    /// Withholds the uncertainties that a run with the errors of the rig withholds.
    fn withhold_as_in(&mut self, noisy: &Record) {
        for (own, noisy) in self.record.procedures.iter_mut().zip(&noisy.procedures) {
            for result in &mut own.results {
                let noisy = noisy.result(result.name);
                if let Some(reason) = noisy.and_then(|noisy| noisy.withheld.as_deref()) {
                    result.withhold(reason);
                }
            }
        }
    }

    /// Runs the plan on the simulated rig of `stand_in`.
    pub fn on(plan: &'a Plan, stand_in: &Plan, model: String) -> Self {
        let (record, reaches) =
            Watched::run(stand_in, plan.rig.link.as_real().map(|link| link.own_speed));
        // The rig of the plan decides whether a budget is partial, not its stand-in.
        let assessment = verdict::assess(plan, &record);
        Self {
            plan,
            model,
            record,
            reaches,
            assessment,
        }
    }

    /// What it recorded.
    pub fn record(&self) -> &Record {
        &self.record
    }

    /// Its verdicts.
    pub fn assessment(&self) -> &Assessment {
        &self.assessment
    }

    /// The exit of a dry run that a limit stops is that of the run.
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
        for specimen in &self.plan.specimens {
            let frame = specimen.frame.as_ref();
            let weights = frame.and_then(specimen_text::weights);
            let mut rows: Vec<Vec<String>> = weights
                .into_iter()
                .map(|text| vec!["P-Δ".to_owned(), text])
                .collect();
            if let Some((frame, text)) =
                frame.and_then(|frame| Some((frame, specimen_text::substructures(frame)?)))
            {
                rows.push(vec!["substructures".to_owned(), text]);
                let numbers = specimen_text::numbers(self.plan, frame);
                rows.extend(numbers.map(|text| vec!["numbers".to_owned(), text]));
                rows.push(vec!["assumed".to_owned(), specimen_text::assumed(frame)]);
            }
            if frame.is_some_and(|frame| !frame.storeys.is_empty()) {
                let axes = self.plan.rig.axial_axes(&self.plan.limits);
                rows.extend(axes.map(|(axis, limits)| {
                    let text = specimen_text::axial_axis(
                        self.plan,
                        &axis,
                        limits.displacement,
                        &|value, dimension| stated(value, dimension),
                    );
                    vec!["axial load".to_owned(), text]
                }));
            }
            section(&format!("Specimen {}", specimen.name), rows);
            let hybrid = frame.filter(|frame| specimen_text::substructures(frame).is_some());
            let drawn = hybrid.map_or_else(Vec::new, substructures::drawing);
            section(&format!("{}, drawn", specimen.name), drawn);
        }
        let lagging = tracking::lagging(self.plan);
        section("Start", start::rows(self.plan));
        let of_rig = self.plan.specimens_at_scale();
        let of_rig = of_rig.map_or("", |_| ", in numbers of the rig");
        section(&format!("Motion{of_rig}"), self.motions());
        for (index, (procedure, planned)) in self
            .record
            .procedures
            .iter()
            .zip(&self.plan.procedures)
            .enumerate()
        {
            let energy = tracking::energy(lagging.as_ref(), index);
            for part in procedures::predicted(self.plan, &planned.kind, procedure, &energy) {
                section(&part.heading, part.rows);
            }
        }
        section(&format!("Limits{of_rig}"), self.limits());
        section("Zeros", zero_drift::rows(self.plan, &self.record));
        section("Requirements, as predicted", self.requirements());
        section("Published numbers, as predicted", self.reproductions());
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
                "Not included in u (not declared in the plan): {}\n",
                undeclared.join(", ")
            );
        }
        if let Some(stopped) = self.stopped() {
            let _ = writeln!(text, "{}", settings.paint_heading(&stopped));
        }
        text
    }

    /// ` in hit, step 12`: the position of the stop.
    fn stopped_in(&self) -> String {
        let position = self.record.stop_position();
        position.map_or_else(String::new, |(name, step)| {
            format!(" in {name}, step {step}")
        })
    }

    /// One row per procedure: displacement, force, speed, steps and laboratory time.
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
                    span(whole(&reach.displacement), Dimension::LENGTH),
                    span(whole(&reach.force), Dimension::FORCE),
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

    /// The same as data, with the limits as the guard will apply them.
    pub fn prediction(&self) -> Prediction {
        let ends = |interval: Interval| [interval.low, interval.high];
        let procedures = self.reaches.iter().map(|reach| PredictedProcedure {
            name: reach.name.clone(),
            kind: reach.keyword.clone(),
            steps: reach.steps,
            rig_time_s: reach.ended - reach.started,
            displacement_m: reach.moved.then(|| ends(whole(&reach.displacement))),
            force_n: (reach.moved && !reach.force.is_empty()).then(|| ends(whole(&reach.force))),
            speed_m_per_s: reach.moved.then_some(reach.speed),
            increment_m: reach.moved.then_some(reach.increment),
        });
        let required = self.assessment.requirements.iter();
        Prediction {
            model: self.model.clone(),
            stopped: self.stopped(),
            zeros: zero_drift::predicted(&self.record),
            procedures: procedures.collect(),
            limits: self.predicted_limits(),
            requirements: required
                .map(|each| PredictedRequirement {
                    name: each.label.clone(),
                    verdict: each.verdict.name(),
                })
                .collect(),
        }
    }

    /// The reason of a predicted stop.
    pub fn stopped(&self) -> Option<String> {
        match &self.record.outcome {
            Outcome::Completed => None,
            Outcome::Aborted { reason } | Outcome::NotReleased { reason } => Some(format!(
                "The run would be stopped{}: {}",
                self.stopped_in(),
                escape(reason)
            )),
            Outcome::Blocked { reason } => {
                Some(format!("The run could not continue: {}", escape(reason)))
            }
            Outcome::Faulted { reason } => Some(format!("The rig would fail: {}", escape(reason))),
        }
    }

    /// One row per condition: predicted value, margin, uncertainty, and whether it is conclusive.
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

    /// One row per published number: predicted value, and its difference.
    fn reproductions(&self) -> Vec<Vec<String>> {
        let row = |outcome: &ReproductionOutcome| {
            let dimension = outcome.compared.dimension;
            let shown = |value: Option<f64>| {
                value.map_or_else(|| "–".to_owned(), |value| readable(value, dimension))
            };
            let (published, tolerance) = outcome.published().unzip();
            vec![
                outcome.statement().to_owned(),
                escape(&outcome.name),
                shown(outcome.compared.value),
                format!("published {}", shown(published)),
                format!(
                    "difference {}, tolerance {}",
                    shown(outcome.difference()),
                    shown(tolerance)
                ),
            ]
        };
        self.assessment.reproductions.iter().map(row).collect()
    }

    /// The declared uncertainty of a condition, and whether it leaves it conclusive.
    fn known(&self, condition: &Condition, outcome: &ConditionOutcome) -> [String; 2] {
        let results = Declared::of(self.plan, &self.record);
        let guarded = verdict::assess_condition(condition, DecisionRule::Guarded, &results);
        let conclusion = match (guarded.guard_band.zip(outcome.margin), outcome.verdict) {
            (_, Verdict::Inconclusive) => {
                let reason = outcome.reason.as_deref().unwrap_or_default();
                format!("INCONCLUSIVE: {}", escape(reason))
            }
            (Some((band, margin)), _) if margin.abs() >= band => "conclusive".to_owned(),
            (Some(_), _) => "value alone compared: the limit is within U".to_owned(),
            (None, _) => "no U".to_owned(),
        };
        let uncertain = outcome.uncertainty.map_or_else(
            || "u –".to_owned(),
            |u| format!("u {}", readable(u, outcome.dimension)),
        );
        let band = guarded.guard_band.map_or_else(String::new, |band| {
            format!("U of the margin {}, ", readable(band, outcome.dimension))
        });
        [uncertain, band + &conclusion]
    }
}
