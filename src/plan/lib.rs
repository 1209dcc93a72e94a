//! The checked plan: in SI units, with every name resolved and every required value present. `language` makes
//! it, `run` and `report` read it. It contains text only where a report prints it.

pub mod contribution;
pub mod formula;
mod ground;
pub mod procedures;
pub mod record;
pub mod report;
pub mod reproduction;
pub mod results;
pub mod rig;
pub mod scaled;
pub mod schema;
pub mod source;
pub mod study;
pub mod time_step;
pub mod uncertainty;

#[cfg(test)]
extern crate self as psd_plan;
#[cfg(test)]
#[path = "../testing/plans.rs"]
pub mod testing;

use std::sync::Arc;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::formula::{Formula, ResultReference};
use psd_physics::contact::ContactSpring;
use psd_physics::contact::contact_time_step::{Approach, Flight};
use psd_text::units::Dimension;
use source::Source;

// The parameters of a model are declared beside it, in `physics`.
pub use psd_physics::impact::Until;
pub use psd_physics::integrator::Integrator;
pub use psd_physics::specimen::{
    Behaviour, Bolted, Breaks, Capping, Deterioration, Pinching, Table, Unloading,
};
pub use psd_physics::structure::beam::{Beam, Ends};
pub use psd_physics::structure::frame::{Element, Frame, Member, Part, Scale, Storey};
pub use psd_physics::structure::portal::{
    ElasticStiffnesses, FrameMasses, Loads, Mechanism, Portal, Sections, elastic_stiffnesses,
};

pub use ground::{Ground, MOST_STOREYS, ShakeDamping, rayleigh};
pub use procedures::parameters::*;
pub use procedures::{ProcedureBlock, ProcedureKind};
pub use psd_physics::statistics::DeclaredNoise;
pub use report::annex::Annex;
pub use report::figure::{Figure, FigureKind, MOST_TOGETHER};
pub use report::golden::{ColumnTolerance, Golden, ResultTolerance, Tolerance};
pub use report::picture::{MOST_PHOTOS, PICTURE_BYTES, Picture, PictureKind};
pub use report::undeclared::Dependence;
pub use reproduction::Reproduction;
pub use rig::axis::{AxialAxis, AxialColumn, AxisCalibration, AxisPlan};
pub use rig::axis_names::{named_axis, of_axis, who};
pub use rig::devices::Behind;
pub use rig::limits::{Interval, Limits};
pub use rig::{
    Abilities, BelowRange, Calibration, Datum, DeviceLink, Dialect, DriftCheck, Link, ModbusMap,
    ModbusNumber, PortPlan, PretestCheck, ReadingErrors, ReadingRules, RealLink, RigPlan,
    SafeState, Settle, VIRTUAL_SPEED, VirtualLink, ZeroAfter,
};
pub use study::{Collected, Fragility, Studies, Study, StudyEvent, StudyRequirement};

/// Everything that a run needs to know beforehand, in SI units. Names are resolved to indices into its lists.
#[derive(Clone, Debug)]
pub struct Plan {
    pub title: String,
    /// Administrative data of the `plan` block in the schema's order: (field, text). Only those that are given.
    pub particulars: Vec<(&'static str, String)>,
    pub parameters: Vec<Parameter>,
    pub specimens: Vec<Specimen>,
    pub strikers: Vec<Striker>,
    pub grounds: Vec<Ground>,
    /// The rig of this run: the named rig, else the first virtual rig of the plan itself, else an ideal virtual rig.
    pub rig: RigPlan,
    /// The intersection of the plan's limits and the rig's.
    pub limits: Limits,
    pub procedures: Vec<Procedure>,
    pub requirements: Vec<Requirement>,
    /// Numbers of the run that are compared with published ones.
    pub reproductions: Vec<Reproduction>,
    pub decision_rule: DecisionRule,
    pub report: Report,
    pub golden: Golden,
    /// Studies of the plan; a run does not read them.
    pub studies: Studies,
    /// For the part that a low-level check run measures: the plan that it belongs to.
    pub check_run_of: Option<Box<Plan>>,
    /// The plan first, then every file that it uses, by the name under which it is used.
    pub files: Vec<PlanFile>,
    /// `--set` values as given, in order of their names.
    pub settings: Vec<(String, String)>,
}

/// The particular of a plan that marks it as the part that a check run performs.
pub const CHECK_RUN: &str = "check_run";

impl Plan {
    /// What a check run performs of its plan; None if this is no check run.
    #[must_use]
    pub fn performed_part(&self) -> Option<&str> {
        self.particulars
            .iter()
            .find(|(field, _)| *field == CHECK_RUN)
            .map(|(_, text)| text.as_str())
    }

    /// The specimen on the rig: the one that the first procedure names, else the first.
    #[must_use]
    pub fn specimen_on_the_rig(&self) -> Option<&Specimen> {
        let named = self
            .procedures
            .iter()
            .find_map(|procedure| procedure.kind.specimen());
        self.specimens.get(named.unwrap_or(0))
    }

    /// The frame on the rig.
    #[must_use]
    pub fn frame_on_the_rig(&self) -> Option<&Frame> {
        self.specimen_on_the_rig()?.frame.as_ref()
    }

    /// Whether the rig tests a frame of matrices with elements.
    #[must_use]
    pub fn tests_elements(&self) -> bool {
        self.frame_on_the_rig().is_some_and(Frame::has_elements)
    }

    /// The specimen on the rig, if only a test on a real rig can measure its restoring force.
    #[must_use]
    pub fn unknown_specimen(&self) -> Option<&Specimen> {
        self.specimen_on_the_rig()
            .filter(|specimen| specimen.behaviour.is_none() && specimen.frame.is_none())
    }

    /// The same plan on an ideal copy of its rig.
    #[must_use]
    pub fn on_an_ideal_rig(&self) -> Self {
        let mut ideal = self.clone();
        ideal.rig.link = Link::Virtual(VirtualLink::ideal_of(&self.rig));
        ideal.rig.simulated_axes = self.rig.listed_axes().to_vec();
        ideal
    }

    /// Number of actuators that the rig needs, each with a load cell; the axial ones are beside them.
    #[must_use]
    pub fn degrees_of_freedom(&self) -> usize {
        self.specimen_on_the_rig()
            .map_or(1, Specimen::degrees_of_freedom)
    }

    /// The same with the axial ones.
    #[must_use]
    pub fn axes_on_the_rig(&self) -> usize {
        self.degrees_of_freedom() + self.rig.axial_axes(&self.limits).count()
    }

    /// The limits of the run. Axes may have their own: displacement and force are then the widest ones of an axis that moves a floor.
    #[must_use]
    pub fn lateral_limits(&self) -> Limits {
        let axes = 0..self.degrees_of_freedom();
        let of_axes = axes.map(|axis| self.rig.limits_of(axis, &self.limits));
        let widest = |a: Interval, b: Interval| Interval {
            low: a.low.min(b.low),
            high: a.high.max(b.high),
        };
        let all = of_axes.reduce(|all, axis| Limits {
            displacement: widest(all.displacement, axis.displacement),
            force: widest(all.force, axis.force),
            ..all
        });
        all.unwrap_or(self.limits)
    }
}

/// A file of the plan, as it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanFile {
    pub name: String,
    /// The text of the file; base64 of the bytes of a PNG or JPEG picture. Every run of a study has it.
    pub text: Arc<str>,
}

impl PlanFile {
    /// Whether the text is base64 of a picture.
    #[must_use]
    pub fn is_binary(&self) -> bool {
        PictureKind::of(&self.name).is_some_and(PictureKind::is_binary)
    }

    /// The bytes of the file. A text that is not base64 stays as it is.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        let decoded = self
            .is_binary()
            .then(|| STANDARD.decode(self.text.as_bytes()).ok());
        decoded
            .flatten()
            .unwrap_or_else(|| self.text.as_bytes().to_vec())
    }
}

/// A `param` with its value in this run.
#[derive(Clone, Debug)]
pub struct Parameter {
    pub name: String,
    pub value: f64,
    pub dimension: Dimension,
    /// Whether the value was set from outside the plan.
    pub set: bool,
}

/// The tested specimen: one degree of freedom, or a frame.
#[derive(Clone, Debug)]
pub struct Specimen {
    pub name: String,
    /// Equivalent mass at the struck section \[kg\]; for a frame the mass of all floors.
    pub mass: f64,
    /// The expression in the plan that gives the mass; None where the plan states the number.
    pub mass_from: Option<String>,
    /// Standard uncertainty of the mass \[kg\]; 0 where none is stated.
    pub mass_uncertainty: f64,
    /// The storeys, if any; each has an actuator and a load cell.
    pub frame: Option<Frame>,
    /// The restoring-force model of a virtual rig.
    pub behaviour: Option<Behaviour>,
    /// c of c·v on the virtual load cell while the actuator moves \[N·s/m\].
    pub damping: f64,
    /// Friction on the virtual load cell \[N\].
    pub coulomb: f64,
}

impl Specimen {
    /// A specimen with this mass \[kg\] and restoring-force model, and with nothing else stated.
    #[must_use]
    pub fn new(name: &str, mass: f64, behaviour: Option<Behaviour>) -> Self {
        Self {
            name: name.to_owned(),
            mass,
            mass_from: None,
            mass_uncertainty: 0.0,
            frame: None,
            behaviour,
            damping: 0.0,
            coulomb: 0.0,
        }
    }

    /// Number of actuators that it needs, each with its load cell.
    #[must_use]
    pub fn degrees_of_freedom(&self) -> usize {
        self.frame.as_ref().map_or(1, Frame::axes)
    }
}

/// A computed body: only the structure is on the rig.
#[derive(Clone, Debug)]
pub struct Striker {
    pub name: String,
    /// \[kg\]
    pub mass: f64,
    /// Standard uncertainty of the mass \[kg\]; 0 where none is stated.
    pub mass_uncertainty: f64,
    /// Velocity towards the structure \[m/s\].
    pub velocity: f64,
    /// Standard uncertainty of the velocity \[m/s\]; 0 where none is stated.
    pub velocity_uncertainty: f64,
    /// Distance to the structure at the start, at least 0 \[m\].
    pub gap: f64,
    /// Acceleration along its path \[m/s²\]: gn of a weight that falls.
    pub gravity: f64,
}

impl Striker {
    /// A striker with this mass \[kg\] and velocity \[m/s\], both exact, at the structure from the start.
    #[must_use]
    pub fn new(name: &str, mass: f64, velocity: f64) -> Self {
        let (mass_uncertainty, velocity_uncertainty) = (0.0, 0.0);
        Self {
            name: name.to_owned(),
            mass,
            mass_uncertainty,
            velocity,
            velocity_uncertainty,
            gap: 0.0,
            gravity: 0.0,
        }
    }

    /// State of the striker at contact, with the spring of a contact of finite stiffness.
    #[must_use]
    pub fn approach(&self, spring: Option<ContactSpring>) -> Approach {
        let flight = Flight {
            striker_mass: self.mass,
            velocity: self.velocity,
            gap: self.gap,
            gravity: self.gravity,
        };
        Approach::after(flight, spring)
    }
}

/// One block that is run, in the order of the plan.
#[derive(Clone, Debug)]
pub struct Procedure {
    pub name: String,
    pub kind: ProcedureKind,
}

/// When the operator is asked to inspect.
#[derive(Clone, Debug)]
pub enum InspectTrigger {
    /// Every n steps.
    Every(u32),
    /// The restoring force fell by this fraction of its largest value so far.
    ForceDrop(f64),
    /// At this simulated time \[s\].
    At(f64),
}

/// `require "label" condition`, one condition for each part joined with `and`.
#[derive(Clone, Debug)]
pub struct Requirement {
    pub label: String,
    pub conditions: Vec<Condition>,
}

/// A value and its limit.
#[derive(Clone, Debug)]
pub struct Condition {
    /// The text in the plan.
    pub text: String,
    pub value: Formula,
    pub test: Test,
    pub dimension: Dimension,
}

impl Condition {
    /// Adds the source of every number that is stated with an uncertainty, each once.
    pub fn collect_stated(&self, into: &mut Vec<Source>) {
        self.formulas()
            .for_each(|formula| formula.collect_stated(into));
    }

    /// Adds every result that it reads, each once.
    pub fn collect_references(&self, into: &mut Vec<ResultReference>) {
        self.formulas()
            .for_each(|formula| formula.collect_references(into));
    }

    /// Every formula of it: the value, and its limit.
    pub fn formulas(&self) -> impl Iterator<Item = &Formula> {
        let (against, more) = match &self.test {
            Test::Compare { limit, .. } => (limit, None),
            Test::Within {
                target, tolerance, ..
            } => (target, Some(tolerance)),
        };
        [&self.value, against].into_iter().chain(more)
    }
}

/// How conformity with a limit is assessed (ILAC-G8:09/2019).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DecisionRule {
    /// The value is compared with the limit (simple acceptance). Without a verdict if that is more likely wrong than right, or if the
    /// uncertainty is withheld.
    #[default]
    Simple,
    /// A guard band w = U = k·u is kept between the value and the limit: within it no statement of conformity is made.
    Guarded,
    /// The value alone is compared with the limit, whatever its uncertainty: in a study, whose runs scatter instead, and beside a published
    /// number. No plan states it.
    ValueAlone,
}

impl DecisionRule {
    /// The keyword of the language.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Simple => "simple",
            Self::Guarded => "guarded",
            Self::ValueAlone => "value alone",
        }
    }
}

/// The condition on a value; limits, targets and tolerances are in the SI unit of its dimension.
#[derive(Clone, Debug)]
pub enum Test {
    Compare {
        comparison: Comparison,
        limit: Formula,
    },
    /// |value − target| ≤ tolerance, or ≤ tolerance·|target| if relative.
    Within {
        target: Formula,
        tolerance: Formula,
        relative: bool,
    },
}

/// Comparison of a value, on the left, with a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
}

/// The files that a run writes beside its log and its summary.
#[derive(Clone, Debug)]
pub struct Report {
    pub title: Option<String>,
    pub figures: Vec<Figure>,
    /// Whether the plan names its figures; the report then prints every one.
    pub figures_named: bool,
    pub formats: Vec<Format>,
    pub sign: Vec<String>,
    /// The annexes after the first two pages.
    pub annexes: Vec<Annex>,
    /// Results of the second page beside those that a requirement reads; None: the headline results of the procedures.
    pub results: Option<Vec<ResultReference>>,
    /// The logo of the laboratory.
    pub logo: Option<Picture>,
    /// Photographs of the specimen.
    pub photos: Vec<Picture>,
}

/// A kind of file of results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Html,
    Pdf,
    Csv,
    Parquet,
}
