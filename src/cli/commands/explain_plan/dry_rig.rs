//! A simulated rig that records the range of displacement, force and speed of each procedure. In: a plan. Out: the record of a run on it,
//! and the ranges.

use std::cell::RefCell;
use std::rc::Rc;

use crate::operator::screen::curve::Curves;
use crate::operator::shown::Shown;
use psd::run::{self, Inspection, Observer, StepReport};
use psd_physics::statistics::samples::peak;
use psd_physics::tracking::trajectory::Path;
use psd_plan::record::Record;
use psd_plan::{Interval, Plan};
use psd_rig::{
    DeclaredNoise, EachReading, EncodedMove, Identity, OWN_SPEED, Reading, Rig, RigFault,
    virtual_rig,
};

/// The demand of one procedure on the rig, SI.
#[derive(Clone, Debug)]
pub struct Reach {
    pub name: String,
    pub keyword: String,
    pub steps: u64,
    /// Whether any target was sent.
    pub moved: bool,
    /// Of each axis in displacement control.
    pub displacement: Vec<Interval>,
    /// Of the same axes.
    pub force: Vec<Interval>,
    pub speed: f64,
    pub increment: f64,
    pub tracking_error: f64,
    /// Rig time \[s\].
    pub started: f64,
    pub ended: f64,
    /// Whether it integrates: then the time of its steps is simulated, and the same in every run.
    pub integrates: bool,
    pub curves: Curves,
}

impl Reach {
    /// A procedure with these curves, and without motion.
    pub fn of(name: &str, curves: Curves) -> Self {
        Self {
            name: name.to_owned(),
            keyword: String::new(),
            steps: 0,
            moved: false,
            displacement: Vec::new(),
            force: Vec::new(),
            speed: 0.0,
            increment: 0.0,
            tracking_error: 0.0,
            started: 0.0,
            ended: 0.0,
            integrates: false,
            curves,
        }
    }
}

/// From the lowest to the highest of these; empty without any.
pub fn whole(ranges: &[Interval]) -> Interval {
    ranges.iter().fold(EMPTY, |whole, range| Interval {
        low: whole.low.min(range.low),
        high: whole.high.max(range.high),
    })
}

/// The rig. It shares its data with the observer that receives the name of the running procedure.
pub struct Watched {
    inner: Box<dyn Rig>,
    /// Speed of the rig that it represents \[m/s\].
    own_speed: Option<f64>,
    reaches: Rc<RefCell<Vec<Reach>>>,
    /// The last targets \[m\]; before the first target every axis is at 0.
    target: Vec<f64>,
    /// The axes whose targets are displacements: those in force control are behind them.
    displaced: usize,
}

/// Sets the ends of ranges that are rounding errors of the largest range to 0.
fn without_rounding(reaches: &mut [Reach], ranges: fn(&mut Reach) -> &mut Vec<Interval>) {
    let ends = |interval: &Interval| [interval.low, interval.high];
    let all: Vec<f64> = reaches
        .iter_mut()
        .flat_map(|reach| ranges(reach).iter().flat_map(ends))
        .collect();
    let finite = all.into_iter().filter(|end| end.is_finite());
    let tiny = 1e-12 * peak(finite);
    for interval in reaches.iter_mut().flat_map(ranges) {
        for end in [&mut interval.low, &mut interval.high] {
            if end.abs() < tiny {
                *end = 0.0;
            }
        }
    }
}

impl Watched {
    /// Runs `plan` on its own simulated rig. `own_speed` is the speed of the rig that it represents \[m/s\].
    pub fn run(plan: &Plan, own_speed: Option<f64>) -> (Record, Vec<Reach>) {
        let reaches = Rc::new(RefCell::new(Vec::new()));
        let mut rig = Self {
            inner: virtual_rig(plan),
            own_speed,
            reaches: Rc::clone(&reaches),
            target: Vec::new(),
            displaced: plan.degrees_of_freedom(),
        };
        let record = run::run(
            plan,
            &mut rig,
            &mut Listener {
                reaches: Rc::clone(&reaches),
                shown: Shown::of(plan),
            },
        );
        let mut noted = reaches.borrow().clone();
        without_rounding(&mut noted, |reach| &mut reach.displacement);
        without_rounding(&mut noted, |reach| &mut reach.force);
        (record, noted)
    }

    fn note(&self, change: impl FnOnce(&mut Reach)) {
        if let Some(reach) = self.reaches.borrow_mut().last_mut() {
            change(reach);
            reach.ended = self.inner.time();
        }
    }

    fn note_target(&mut self, targets: &[f64], speed: f64) {
        let targets = &targets[..self.displaced.min(targets.len())];
        let before = self.target.iter().copied().chain(std::iter::repeat(0.0));
        let increment = targets
            .iter()
            .zip(before)
            .map(|(to, from)| (to - from).abs())
            .fold(0.0, f64::max);
        self.target = targets.to_vec();
        self.note(|reach| {
            reach.moved = true;
            widen(&mut reach.displacement, targets);
            reach.increment = reach.increment.max(increment);
            if increment > 0.0 {
                reach.speed = reach.speed.max(speed.abs());
            }
        });
    }

    fn note_reading(&self, reading: &Reading, at_rest: bool) {
        self.note(|reach| {
            let displaced = self.displaced.min(reading.force.len());
            widen(&mut reach.force, &reading.force[..displaced]);
            widen(&mut reach.displacement, &reading.displacement[..displaced]);
            if at_rest && reach.moved {
                let errors = reading
                    .displacement
                    .iter()
                    .zip(&self.target)
                    .map(|(measured, target)| (measured - target).abs());
                reach.tracking_error = errors.fold(reach.tracking_error, f64::max);
            }
        });
    }
}

/// An empty interval: its low end is above its high end.
const EMPTY: Interval = Interval {
    low: f64::INFINITY,
    high: f64::NEG_INFINITY,
};

/// Widens the range of each axis to its value.
fn widen(ranges: &mut Vec<Interval>, values: &[f64]) {
    ranges.resize(values.len(), EMPTY);
    for (range, value) in ranges.iter_mut().zip(values) {
        range.low = range.low.min(*value);
        range.high = range.high.max(*value);
    }
}

impl Rig for Watched {
    fn identity(&self) -> Identity {
        self.inner.identity()
    }

    fn degrees_of_freedom(&self) -> usize {
        self.inner.degrees_of_freedom()
    }

    fn time(&self) -> f64 {
        self.inner.time()
    }

    fn propose(&mut self, targets: &[f64], speed: Option<f64>) -> Result<EncodedMove, RigFault> {
        let encoded = self.inner.propose(targets, speed)?;
        self.note_target(targets, speed.unwrap_or(OWN_SPEED));
        Ok(encoded)
    }

    fn execute(&mut self) -> Result<(), RigFault> {
        let done = self.inner.execute();
        self.note(|_| ());
        done
    }

    fn pause(&mut self, seconds: f64) -> Result<(), RigFault> {
        let done = self.inner.pause(seconds);
        self.note(|_| ());
        done
    }

    fn read(&mut self) -> Result<Reading, RigFault> {
        let reading = self.inner.read()?;
        self.note_reading(&reading, true);
        Ok(reading)
    }

    fn traverse(
        &mut self,
        targets: &[f64],
        velocity: f64,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        self.note_target(targets, velocity);
        let mut readings = Vec::new();
        let traversed = self
            .inner
            .traverse(targets, velocity, samples, &mut |reading| {
                readings.push(reading.clone());
                each(reading)
            });
        for reading in &readings {
            self.note_reading(reading, false);
        }
        traversed
    }

    fn follow_paths(
        &mut self,
        paths: &[Path],
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let ends: Vec<f64> = paths.iter().map(|path| path.to).collect();
        self.note_target(&ends, paths.iter().map(Path::fastest).fold(0.0, f64::max));
        let mut readings = Vec::new();
        let traversed = self.inner.follow_paths(paths, samples, &mut |reading| {
            readings.push(reading.clone());
            each(reading)
        });
        for reading in &readings {
            self.note_reading(reading, false);
        }
        traversed
    }

    fn hold(&mut self) {
        self.inner.hold();
    }

    fn declared_noise(&self) -> DeclaredNoise {
        self.inner.declared_noise()
    }

    fn own_speed(&self) -> Option<f64> {
        self.own_speed
    }
}

/// Receives the name of the running procedure. It continues at every inspection, because there is no specimen to inspect.
struct Listener {
    reaches: Rc<RefCell<Vec<Reach>>>,
    shown: Shown,
}

impl Observer for Listener {
    fn procedure_started(&mut self, name: &str, keyword: &str, _: Option<u64>) {
        let mut reaches = self.reaches.borrow_mut();
        let time = reaches.last().map_or(0.0, |last| last.ended);
        reaches.push(Reach {
            keyword: keyword.to_owned(),
            started: time,
            ended: time,
            ..Reach::of(name, Curves::default())
        });
    }

    fn step_done(&mut self, report: &StepReport) {
        if let Some(reach) = self.reaches.borrow_mut().last_mut() {
            reach.steps = reach.steps.max(report.step);
            reach.integrates = report.axes.iter().any(|axis| axis.velocity.is_some());
            reach.curves.push(report, &self.shown);
        }
    }

    fn inspect(&mut self, _: &str) -> Inspection {
        Inspection::go_on()
    }
}
