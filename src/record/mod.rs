//! The record of a run: every event, reading and result, typed, in SI. `run` and `procedures` write
//! it; verdict, tables, figures and reports are functions of it. It does not know how it is
//! printed.

mod cycle;
pub mod equipment;
pub mod failpoint;
mod floors;
mod held;
mod identity;
mod impact_series;
pub mod journal;
pub mod remote;
mod unload;
mod zero_drift;

use serde::{Deserialize, Serialize};

pub use crate::physics::contact::state::StepState;
pub use crate::physics::identification::LineFit;
pub use crate::physics::identification::bilinear_fit::BilinearFit;
pub use crate::physics::identification::multilinear_fit::MultilinearFit;
use crate::physics::impact::energy::Energies;
use crate::physics::impact::summary::still_rising;
pub use crate::physics::relaxation::hold::Hold;
pub use crate::physics::relaxation::superposition::{LawFit, SuperpositionFit};
pub use crate::physics::relaxation::time_constant::RelaxationFit;
pub use crate::physics::structure::{FrameEnergies, Modes};
use crate::physics::tracking::monitor::Tracking;
use crate::plan::formula::{Estimate, ResultReference, ResultValue, Results};
use crate::schema::block_of_words;
use crate::uncertainty::{Contribution, Source, combined_entries};
use crate::units::Dimension;
pub use cycle::{CycleHistory, CycleStep, WholeCycle};
pub use floors::{FloorStep, Floors, FloorsAt, StruckFrame};
pub use held::Held;
pub use identity::Identity;
pub use impact_series::{Blow, EscalateHistory};
pub use unload::{Rest, UnloadStep};
pub use zero_drift::{AxisDrift, Beyond, Drift, Zero};

/// What a run measured and did, all numbers in SI. Every output is a function of it, its plan and its assessment.
#[derive(Clone, Debug)]
pub struct Record {
    pub rig: Identity,
    /// In the order run; those after a stop are missing.
    pub procedures: Vec<ProcedureRecord>,
    pub events: Vec<Event>,
    pub outcome: Outcome,
    /// What the zeros of the rig did, where it says how far they may drift.
    pub drift: Option<Drift>,
}

/// How the run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    Completed,
    /// Stopped by a limit or by a person: exit 4.
    Aborted {
        reason: String,
    },
    /// Nobody released the rig, and nothing moved: exit 4.
    NotReleased {
        reason: String,
    },
    /// A value of the plan, known only in the run, cannot be used: exit 1.
    Blocked {
        reason: String,
    },
    /// The rig failed: exit 3.
    Faulted {
        reason: String,
    },
}

/// Something worth a line in the report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Rig time, s.
    pub time: f64,
    pub procedure: Option<String>,
    pub step: Option<u64>,
    pub kind: EventKind,
    pub text: String,
}

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EventKind {
    Note,
    Inspection,
    LimitBreach,
    Hold,
    /// Where the rig holds after an early end.
    Held,
    /// Nobody knows whether it does.
    NotHeld,
    Fault,
    /// What went wrong on the lines of the rig and was mended: frames sent again, replies ignored, readings taken again.
    Mended,
    /// A numerical remark: the last blow is cut, the peak is not a peak, …
    Remark,
    /// The run goes on after it was cut off or stopped.
    Resume,
    /// The plan, the program or a limit is no longer what the run began with.
    Amendment,
}

impl EventKind {
    /// Its word for people, also in `summary.json`.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Inspection => "inspection",
            Self::LimitBreach => "limit breach",
            Self::Hold => "hold",
            Self::Held => "held",
            Self::NotHeld => "not confirmed held",
            Self::Fault => "fault",
            Self::Mended => "mended",
            Self::Remark => "remark",
            Self::Resume => "resume",
            Self::Amendment => "amendment",
        }
    }
}

/// What one procedure took in and came to.
#[derive(Clone, Debug)]
pub struct ProcedureRecord {
    pub name: String,
    /// The block's keyword: `impact`.
    pub kind: &'static str,
    /// Whether it ran to its own end.
    pub complete: bool,
    /// Inputs as they were evaluated for this procedure: name, value, dimension.
    pub inputs: Vec<(&'static str, Estimate, Dimension)>,
    /// In the schema's order.
    pub results: Vec<NamedResult>,
    pub history: History,
}

/// A result under its name in the language.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedResult {
    pub name: &'static str,
    pub value: ResultValue,
    pub dimension: Dimension,
    /// What the uncertainty of a number, or of each entry of a list, is made of; empty where it is all its own, or there is none.
    pub contributions: Vec<Contribution>,
}

/// What was recorded step by step.
#[derive(Clone, Debug)]
pub enum History {
    Ramp(RampHistory),
    Sweep(SweepHistory),
    Impact(ImpactHistory),
    Shake(ShakeHistory),
    Cycle(CycleHistory),
    Escalate(EscalateHistory),
    Move(Vec<RampStep>),
    /// The floors of a frame on their way to where they carry no load.
    FrameUnload(Vec<UnloadStep>),
    Inspect,
}

/// One pause of a stiffness ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RampStep {
    pub step: u64,
    /// Rig time, s.
    pub wall_time: f64,
    /// m
    pub command: f64,
    /// Mean of the samples, m.
    pub displacement: f64,
    /// Mean of the samples, N.
    pub restoring_force: f64,
    /// Standard deviation of the samples, N; 0 for one sample.
    pub force_scatter: f64,
    /// First reading after settling less the mean at the end of the pause, N.
    pub relaxation: f64,
    /// Secant from the step before, N/m; None at the first or without motion.
    pub tangent_stiffness: Option<f64>,
    /// Whether this is on the way back.
    pub returning: bool,
}

/// A stiffness ramp, place by place, and what was fitted to it.
#[derive(Clone, Debug)]
pub struct RampHistory {
    /// The reading before the first increment, m and N.
    pub start: Option<(f64, f64)>,
    /// The reading before the first increment of each repeat, numbered by the steps before it.
    pub before: Vec<RampStep>,
    pub steps: Vec<RampStep>,
    /// None if too few steps were recorded, or the fit is of two lines.
    pub fit: Option<LineFit>,
    /// Of a ramp past yield, where the plan asks for it.
    pub bilinear: Option<BilinearFit>,
    pub multilinear: Option<Box<MultilinearFit>>,
    /// Pauses that were watched, and what they tell.
    pub holds: Vec<Hold>,
    pub relaxation: Option<Box<RelaxationFit>>,
    /// By which law the reached force relaxes, where the plan asks for that.
    pub reached: Option<Box<SuperpositionFit>>,
}

/// One reading of a damping sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepStep {
    pub step: u64,
    /// Rig time, s.
    pub wall_time: f64,
    /// Commanded velocity, signed, m/s.
    pub velocity: f64,
    /// m
    pub displacement: f64,
    /// N
    pub restoring_force: f64,
    /// F_d = R − K·X, N.
    pub damping_force: f64,
    /// On the steady part, used by the fit.
    pub steady: bool,
}

/// A damping sweep, reading by reading, and the line through its pairs.
#[derive(Clone, Debug)]
pub struct SweepHistory {
    pub steps: Vec<SweepStep>,
    /// What the fit is of: velocity (m/s), and half the difference of `F_d` (N) between the way out and the way back at
    /// one place.
    pub pairs: Vec<(f64, f64)>,
    /// Of each pair, the place (m) and the mean of its two forces (N).
    pub middles: Vec<[f64; 2]>,
    /// K that the damping forces were told with, N/m.
    pub stiffness: Option<f64>,
    pub together: BroughtTogether,
    /// K of the strokes and its standard error, N/m, where it contradicts that one: the damping ratio is told with it.
    pub own_stiffness: Option<(f64, f64)>,
    /// F_d = intercept·sign v + slope·v: intercept is the Coulomb force.
    pub fit: Option<LineFit>,
}

/// How the two readings of each pair of a sweep, which an actuator that lags leaves apart, were brought to one place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BroughtTogether {
    /// K of the strokes, N/m; that of the plan where they do not show it.
    pub stiffness: f64,
    /// Its standard error, N/m; None: it is the plan's.
    pub error: Option<f64>,
    /// ∂c/∂K (s) and ∂F_c/∂K (m): 0 where no pair is apart.
    pub effects: [f64; 2],
}

/// One row of an impact's table; step 0 is the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactStep {
    pub step: u64,
    /// Virtual time, s.
    pub time: f64,
    /// Rig time, s.
    pub wall_time: f64,
    pub state: StepState,
    /// Commanded to the actuator, m.
    pub command: f64,
    /// Computed displacement X, m: the command, but under α-OS what the force read there corrects it to.
    pub computed: f64,
    /// Measured, m.
    pub displacement: f64,
    pub velocity: f64,
    pub acceleration: f64,
    pub restoring_force: f64,
    /// Mean over the step, N; at step 0 none.
    pub contact_force: f64,
    pub striker_displacement: f64,
    pub striker_velocity: f64,
    pub tangent_stiffness: f64,
    /// Permanent, m.
    pub indentation: f64,
    pub energies: Energies,
    /// What the monitors of tracking show.
    pub tracking: Tracking,
}

/// An impact, step by step: on one degree of freedom, or on one floor of a frame.
#[derive(Clone, Debug)]
pub struct ImpactHistory {
    /// The striker and what it strikes; of a frame the struck floor and storey, with the energies of the whole frame and the tracking of
    /// all axes together.
    pub steps: Vec<ImpactStep>,
    /// None of one degree of freedom.
    pub frame: Option<StruckFrame>,
    /// s
    pub time_step: f64,
    /// s
    pub critical_time_step: f64,
}

impl ImpactHistory {
    /// Whether the structure still moved on past its largest displacement as the record ends: that is no peak then.
    #[must_use]
    pub fn still_rising(&self) -> bool {
        let largest = self
            .steps
            .iter()
            .map(|step| step.computed)
            .fold(f64::NEG_INFINITY, f64::max);
        self.steps
            .last()
            .is_some_and(|last| still_rising(last.velocity, last.computed, largest))
    }
}

/// One row of a shake for all floors; step 0 is the start. Displacements are relative to the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct ShakeStep {
    pub step: u64,
    /// Virtual time, s.
    pub time: f64,
    /// Rig time, s.
    pub wall_time: f64,
    /// m/s², as it was applied.
    pub ground_acceleration: f64,
    /// Targets, m.
    pub command: Vec<f64>,
    /// Measured, m.
    pub displacement: Vec<f64>,
    /// Computed X, m: the target, but under α-OS.
    pub computed: Vec<f64>,
    /// m/s
    pub velocity: Vec<f64>,
    /// m/s²
    pub acceleration: Vec<f64>,
    /// Measured, of each floor, N.
    pub restoring_force: Vec<f64>,
    pub energies: FrameEnergies,
    /// Of each axis.
    pub tracking: Vec<Tracking>,
}

impl Floors for ShakeStep {
    fn at(&self) -> FloorsAt<'_> {
        FloorsAt {
            time: self.time,
            command: &self.command,
            measured: &self.displacement,
            computed: &self.computed,
            velocity: &self.velocity,
            acceleration: &self.acceleration,
            restoring_force: &self.restoring_force,
            tracking: &self.tracking,
        }
    }
}

/// A frame on moving ground, step by step.
#[derive(Clone, Debug, Default)]
pub struct ShakeHistory {
    pub steps: Vec<ShakeStep>,
    /// None where it did not begin.
    pub modes: Option<Modes>,
    /// Fraction of critical damping of each mode.
    pub damping_ratios: Vec<f64>,
    /// s
    pub time_step: f64,
    /// s
    pub critical_time_step: f64,
}

impl History {
    /// The time step and the critical one, s, of what was integrated in longer steps than that; of several blows, of the first.
    #[must_use]
    pub fn above_critical(&self) -> Option<(f64, f64)> {
        let of_blow = |blow: &ImpactHistory| (blow.time_step, blow.critical_time_step);
        let mut steps = match self {
            Self::Impact(blow) => vec![of_blow(blow)],
            Self::Shake(history) => vec![(history.time_step, history.critical_time_step)],
            Self::Escalate(history) => history
                .blows
                .iter()
                .map(|blow| of_blow(&blow.history))
                .collect(),
            Self::Ramp(_)
            | Self::Sweep(_)
            | Self::Cycle(_)
            | Self::Move(_)
            | Self::FrameUnload(_)
            | Self::Inspect => Vec::new(),
        };
        steps.retain(|(step, critical)| step > critical);
        steps.first().copied()
    }

    /// Degrees of freedom of the scatter that a result fitted here is known by; None of what is no fit.
    #[must_use]
    pub fn degrees(&self, result: &str) -> Option<f64> {
        match self {
            Self::Ramp(RampHistory {
                reached: Some(fit), ..
            }) if SuperpositionFit::RESULTS.contains(&result) => Some(fit.best().degrees),
            Self::Ramp(ramp) => match (result, ramp.relaxation.as_deref()) {
                ("relaxed_stiffness", Some(fit)) => Some(fit.degrees_of_stiffness()),
                (
                    "time_constant" | "branch_stiffness" | "remaining_relaxation" | "needed_pause",
                    Some(fit),
                ) => Some(fit.degrees),
                _ => {
                    let line = ramp.fit.map(|fit| fit.degrees);
                    let bilinear = || ramp.bilinear.as_ref().map(|fit| fit.degrees);
                    line.or_else(bilinear)
                        .or_else(|| ramp.multilinear.as_ref().map(|fit| fit.degrees))
                }
            },
            Self::Sweep(sweep) => sweep.fit.map(|fit| fit.degrees),
            Self::Cycle(cycle) => cycle.backbone.as_ref().map(|fit| fit.degrees),
            _ => None,
        }
    }
}

impl Record {
    /// The procedure of this name; None where the run did not get to it.
    #[must_use]
    pub fn procedure(&self, name: &str) -> Option<&ProcedureRecord> {
        self.procedures
            .iter()
            .find(|procedure| procedure.name == name)
    }
}

impl ProcedureRecord {
    /// The number that a result of this name has; None of a list, and where this run gave none.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.result(name).map(|result| &result.value) {
            Some(ResultValue::Number { value, .. }) => *value,
            _ => None,
        }
    }

    /// The result of this name.
    #[must_use]
    pub fn result(&self, name: &str) -> Option<&NamedResult> {
        self.results.iter().find(|result| result.name == name)
    }
}

impl NamedResult {
    /// Standard uncertainty of each entry of a list; empty where none is known.
    #[must_use]
    pub fn entry_uncertainties(&self) -> Vec<Option<f64>> {
        match &self.value {
            ResultValue::List(values) if !self.contributions.is_empty() => {
                combined_entries(&self.contributions, values.len())
            }
            _ => Vec::new(),
        }
    }

    /// What the uncertainty of the result, as `reference` names it, is made of.
    #[must_use]
    pub fn contributions_of(&self, reference: ResultReference) -> Vec<Contribution> {
        match self.value {
            ResultValue::Number {
                uncertainty: Some(own),
                ..
            } if self.contributions.is_empty() => {
                vec![Contribution::new(
                    Source::Fit {
                        procedure: reference.procedure,
                        result: self.name,
                    },
                    own,
                )]
            }
            _ => self.contributions.clone(),
        }
    }
}

impl NamedResult {
    /// Why it has no expanded uncertainty, of a procedure of this kind; None where it has one, is exact or does not exist.
    #[must_use]
    pub fn no_uncertainty(&self, kind: &str) -> Option<String> {
        let words: Vec<&str> = kind.split(' ').collect();
        block_of_words(&words)?
            .result(self.name)
            .filter(|result| result.measured)?;
        let lacks = match &self.value {
            ResultValue::Number { value, uncertainty } => value.is_some() && uncertainty.is_none(),
            ResultValue::List(values) => {
                let known = self.entry_uncertainties();
                let lacks = |(entry, value): (usize, &f64)| {
                    value.is_finite() && known.get(entry).is_none_or(Option::is_none)
                };
                values.iter().enumerate().any(lacks)
            }
        };
        lacks.then(|| {
            format!(
                "no uncertainty of `{}` is known, and a guard band needs one",
                self.name
            )
        })
    }
}

impl Results for Record {
    /// Procedures are recorded in the plan's order, so that their place there is their place here.
    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        let found = self
            .procedures
            .get(reference.procedure.0)?
            .result(reference.name)?;
        Some(found.value.clone())
    }

    fn contributions(&self, reference: ResultReference) -> Vec<Contribution> {
        let found = self
            .procedures
            .get(reference.procedure.0)
            .and_then(|procedure| procedure.result(reference.name));
        found.map_or_else(Vec::new, |found| found.contributions_of(reference))
    }

    fn degrees(&self, source: Source) -> f64 {
        let (Source::Fit { procedure, result }
        | Source::FitEntry {
            procedure, result, ..
        }) = source
        else {
            return f64::INFINITY;
        };
        let history = self
            .procedures
            .get(procedure.0)
            .map(|procedure| &procedure.history);
        history
            .and_then(|history| history.degrees(result))
            .unwrap_or(f64::INFINITY)
    }

    fn no_uncertainty(&self, reference: ResultReference) -> Option<String> {
        let procedure = self.procedures.get(reference.procedure.0)?;
        procedure
            .result(reference.name)?
            .no_uncertainty(procedure.kind)
    }
}
