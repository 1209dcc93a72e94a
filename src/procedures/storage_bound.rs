//! How much room a run may take on the disk: its record and its results. In: a checked plan. Out: bytes, more than it will
//! take, and the procedures whose length is known only when they run. It asks no disk.
//!
//! What a run asks of its rig is counted procedure by procedure; a stiffness that a ramp will measure is taken as the highest
//! that the gate lets through, or as the specimen's own, for a stiffer specimen is stepped more finely. A record is taken to be as
//! long as its longest numbers make it. The tests hold the sum against what runs wrote.

use crate::plan::formula::{Formula, ResultReference, ResultValue, Results};
use crate::plan::{
    Counts, DampingSweep, FRAME, Impact, ImpactTarget, Interval, Plan, ProcedureKind, Sides,
    StiffnessRamp, Striker, steps_in,
};

use crate::run::zero_drift;

/// What a run may write.
#[derive(Clone, Debug, PartialEq)]
pub struct Need {
    /// Of the record and the results together.
    pub bytes: u64,
    /// Of the record alone.
    pub record: u64,
    /// Procedures that are not counted: their length hangs on what is not measured yet.
    pub unknown: Vec<String>,
}

/// A row of the tables and what figures and pages show of it.
const ROW: f64 = 1_200.0;
/// Certificate on page and paper, with the fonts of the latter; the figures of one procedure, drawn and set in both.
const REPORT: f64 = 1_048_576.0;
/// Increments of one way, at most: as the guard divides it.
const MOST_INCREMENTS: f64 = 1e5;
/// Targets of one unloading, at most.
const UNLOADING: f64 = 50.0;

/// What a run of the plan may write.
#[must_use]
pub fn of(plan: &Plan) -> Need {
    let reckoner = Reckoner {
        plan,
        assumed: Assumed(plan),
        way: way(plan),
    };
    let mut all = Counts {
        targets: 2.0 * reckoner.way,
        readings: 10.0,
        ..Counts::default()
    };
    if plan.rig.drift.is_some() {
        // Before the test and after it, and the way back.
        all = all.plus(Counts {
            targets: reckoner.way,
            readings: 2.0 * f64::from(zero_drift::READINGS),
            ..Counts::default()
        });
    }
    let mut unknown = Vec::new();
    for procedure in &plan.procedures {
        match reckoner.counts(&procedure.kind) {
            Some(counts) => {
                // A look at a hold, before what a person says and after it, where drift is watched.
                let looks = if plan.rig.drift.is_some() {
                    2.0 * (counts.steps + 1.0)
                } else {
                    0.0
                };
                all = all.plus(counts).plus(Counts {
                    readings: looks,
                    ..Counts::default()
                });
            }
            None => unknown.push(procedure.name.clone()),
        }
    }
    let axes = f64::from(u32::try_from(plan.degrees_of_freedom()).unwrap_or(u32::MAX));
    let lines = all.bytes(plan);
    // Twice: in the record, where a sign outside ASCII takes six bytes or twelve, and beside it.
    let texts: f64 = plan.files.iter().map(|file| bytes(&file.text)).sum();
    let record = FRAME + lines + texts;
    let procedures = f64::from(u32::try_from(plan.procedures.len()).unwrap_or(u32::MAX));
    let results = texts + REPORT * (1.0 + procedures) + all.steps * axes * ROW;
    Need {
        bytes: whole(record + results),
        record: whole(record),
        unknown,
    }
}

fn bytes(text: &str) -> f64 {
    let count: u64 = text
        .chars()
        .map(|character| if character.is_ascii() { 2 } else { 12 })
        .sum();
    rounded(count)
}

#[expect(clippy::cast_precision_loss, reason = "an estimate")]
const fn rounded(count: u64) -> f64 {
    count as f64
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "saturating, never below 0"
)]
fn whole(bytes: f64) -> u64 {
    bytes.ceil() as u64
}

/// Increments of a way from one end of the limits to the other.
fn way(plan: &Plan) -> f64 {
    let Interval { low, high } = plan.limits.displacement;
    let increments = (high - low) / plan.limits.increment.high;
    if increments.is_finite() {
        (increments.ceil() + 1.0).clamp(1.0, MOST_INCREMENTS)
    } else {
        1.0
    }
}

/// What results are taken to be before they are measured: only stiffnesses, the highest that can come.
struct Assumed<'a>(&'a Plan);

impl Results for Assumed<'_> {
    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        let ramp = match &self.0.procedures.get(reference.procedure.0)?.kind {
            ProcedureKind::StiffnessRamp(ramp) if reference.name.ends_with("stiffness") => ramp,
            _ => return None,
        };
        let gate = self
            .0
            .rig
            .link
            .as_real()
            .map(|link| link.gate.stiffness.high)
            .filter(|high| high.is_finite());
        let own = || {
            self.0
                .specimens
                .get(ramp.specimen)?
                .behaviour
                .as_ref()
                .map(|behaviour| 1.5 * behaviour.initial_stiffness())
        };
        Some(ResultValue::Number {
            value: Some(gate.or_else(own)?),
            uncertainty: None,
        })
    }
}

struct Reckoner<'a> {
    plan: &'a Plan,
    assumed: Assumed<'a>,
    /// Targets of one way, at most.
    way: f64,
}

impl Reckoner<'_> {
    fn number(&self, formula: &Formula) -> Option<f64> {
        formula
            .evaluate(&self.assumed, None)
            .ok()
            .map(|estimate| estimate.value)
    }

    /// None: not known before it runs.
    fn counts(&self, kind: &ProcedureKind) -> Option<Counts> {
        let moves = |targets| Counts {
            targets,
            readings: targets,
            ..Counts::default()
        };
        match kind {
            ProcedureKind::StiffnessRamp(ramp) => Some(self.ramp(ramp)),
            ProcedureKind::DampingSweep(sweep) => self.sweep(sweep),
            ProcedureKind::Impact(impact) => {
                self.impact(impact, self.plan.strikers.get(impact.striker)?)
            }
            ProcedureKind::Escalate(escalate) => {
                let between = moves(UNLOADING * self.way).plus(Counts {
                    steps: UNLOADING,
                    ..Counts::default()
                });
                let impact = &escalate.impact;
                let fastest = escalate.fastest(self.plan.strikers.get(impact.striker)?);
                let counts = self.impact(impact, &fastest)?;
                Some(
                    counts
                        .plus(between)
                        .times(rounded(escalate.velocities.len() as u64)),
                )
            }
            ProcedureKind::Shake(shaking) => {
                let steps = rounded(shaking.known_steps(self.plan)?) + 1.0;
                Some(Counts::stepped(shaking.stepping.mode, steps))
            }
            ProcedureKind::Cycle(cycle) => {
                let begin = Counts {
                    targets: self.way,
                    readings: 2.0 + f64::from(cycle.samples),
                    steps: 1.0,
                    ways: 0.0,
                };
                let Some(rate) = &cycle.rate else {
                    let targets = rounded(cycle.targets());
                    let readings = targets * (1.0 + f64::from(cycle.samples));
                    return Some(begin.plus(Counts {
                        targets: targets * self.way,
                        readings,
                        steps: targets,
                        ways: 0.0,
                    }));
                };
                let (rate, speed) = (self.number(rate)?, self.number(cycle.speed.as_ref()?)?);
                let legs = if cycle.sides == Sides::Both { 4.0 } else { 2.0 };
                let mut readings = 0.0;
                for level in &cycle.levels {
                    let length = legs * self.number(&level.amplitude)?;
                    readings += f64::from(level.cycles) * (length / speed * rate + legs);
                }
                let ways = legs * rounded(cycle.cycles());
                Some(begin.plus(Counts {
                    targets: ways,
                    ways,
                    readings,
                    steps: readings,
                }))
            }
            ProcedureKind::Unload(_) | ProcedureKind::FrameUnload(_) => Some(Counts {
                steps: UNLOADING,
                ..moves(UNLOADING * self.way)
            }),
            ProcedureKind::Move(_) => Some(Counts {
                steps: 1.0,
                ..moves(self.way)
            }),
            ProcedureKind::Inspect { .. } => Some(Counts::default()),
        }
    }

    fn ramp(&self, ramp: &StiffnessRamp) -> Counts {
        let once =
            rounded(ramp.displacements.len() as u64) * if ramp.return_path { 2.0 } else { 1.0 };
        let readings = once * (1.0 + f64::from(ramp.samples.max(1))) + 1.0;
        let all = Counts {
            targets: once + self.way,
            readings,
            steps: once,
            ways: 0.0,
        }
        .times(f64::from(ramp.repeats));
        // Those of watched pauses, and as long as one what the first of each says of the move before it.
        let watched = ramp
            .relaxation
            .map_or(0.0, |watched| once * (1.0 + f64::from(watched.readings)));
        all.plus(Counts {
            readings: watched,
            ..Counts::default()
        })
    }

    fn sweep(&self, sweep: &DampingSweep) -> Option<Counts> {
        let stroke = self.number(&sweep.stroke)?.abs();
        let lag = self.plan.rig.link.as_virtual().map_or(0.0, |link| link.lag);
        // To the place and over the first stroke, back, and then stroke by stroke.
        let mut all = Counts {
            targets: 2.0 * self.way,
            ..Counts::default()
        };
        for velocity in &sweep.velocities {
            let seconds = stroke / self.number(velocity)?.abs();
            let rate = sweep.rate.as_ref().map(|rate| self.number(rate));
            let samples = super::damping_sweep::run::wanted(
                seconds,
                lag,
                rate.map_or(Some(None), |rate| rate.map(Some))?,
            );
            let both = 2.0 * samples;
            all = all.plus(Counts {
                targets: 3.0,
                ways: 2.0,
                readings: both,
                steps: both,
            });
        }
        Some(all)
    }

    fn impact(&self, impact: &Impact, striker: &Striker) -> Option<Counts> {
        let steps = match &impact.target {
            ImpactTarget::Point(_) => {
                let critical =
                    impact.critical_time_step(striker, |formula| self.number(formula))?;
                let time_step = impact
                    .stepping
                    .time_step
                    .evaluate(&self.assumed, Some(critical))
                    .ok()?
                    .value;
                steps_in(self.number(&impact.duration)?, time_step)
            }
            ImpactTarget::Storey(_) => rounded(impact.known_steps(self.plan, striker)?),
        };
        Some(Counts::stepped(impact.stepping.mode, steps + 1.0))
    }
}
