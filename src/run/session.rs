//! One run in progress: the guarded rig, the observer, and the events so far. In: actions of procedures. Out: events. It
//! knows no physics of a procedure.

use super::hybrid::Hybrid;
use super::stop::Stop;
use super::{Inspection, Keep, Motion, Next, Observer, StepReport};
use psd_plan::record::{Event, EventKind, NamedResult};
use psd_plan::uncertainty::engine::{Progress, Unknown};
use psd_plan::{Plan, Procedure};
use psd_rig::{
    Guard, IdealSteps, Identity, LineStatistics, Reading, Rig, RigFault, UnfinishedStep,
};
use psd_text::count::counted_in_words;
use psd_text::units::Dimension;
use psd_text::units::display::stated;

/// A reading, the time of the last move \[s\], and the fault that ends the run.
pub(super) type MovedReading = (Reading, Option<[f64; 2]>, Option<Stop>);

/// Longest wait of a real rig between two polls of the operator's decision, rig time \[s\]: the rig needs a heartbeat at least this
/// often.
const BREATH: f64 = 0.01;

/// The reason if the operator ends a run while nothing moves.
pub(super) const STOPPED_ON_REQUEST: &str = "stopped on request";

pub(crate) struct Session<'run> {
    pub(crate) guard: Guard<'run>,
    pub(super) observer: &'run mut dyn Observer,
    /// The identity that the rig reported.
    identity: Identity,
    events: Vec<Event>,
    procedure: Option<String>,
    /// Number of the last step done in this procedure.
    step: Option<u64>,
    /// Observations about an impact of this procedure, and the number of its later impacts to which each applies.
    remarks: Vec<(String, usize)>,
    /// The position of the rig when the session began \[m\].
    pub(super) home: Vec<f64>,
    /// The operator was asked to inspect, or has paused the run: the operator may be at the specimen.
    pub(super) attended: bool,
    pub(crate) keep: Keep,
    /// Whether rig time is only simulated, and must not pass while the operator decides. An emulator on a line is driven like any rig,
    /// and has a watchdog like any rig.
    is_simulated: bool,
    /// Of the readings of the rig \[N\].
    pub(super) force_resolution: f64,
    /// Stiffness of each axis in the pre-test check \[N/m\]; empty on a virtual rig.
    pub(super) probed: Vec<f64>,
    /// None if the rig carries the whole specimen.
    pub(super) hybrid: Option<Hybrid>,
}

impl<'run> Session<'run> {
    /// Puts the rig behind its guard. The error is the event to record and the reason of the end.
    pub(crate) fn begin(
        plan: &Plan,
        rig: &'run mut dyn Rig,
        observer: &'run mut dyn Observer,
    ) -> Result<Self, Box<(Event, Stop)>> {
        let time = rig.time();
        let axes = rig.degrees_of_freedom();
        let identity = rig.identity();
        let is_simulated = identity.simulated && plan.rig.link.as_real().is_none();
        let datum = rig.datum().is_some();
        let wanted = plan.axes_on_the_rig();
        let guard = if axes == wanted {
            Guard::with_axial_axes(
                rig,
                plan.limits,
                plan.rig.limits_of_axes(&plan.limits),
                plan.rig.axial_axes(&plan.limits),
            )
        } else {
            rig.hold();
            let degrees =
                |count| counted_in_words(count, "degree of freedom", "degrees of freedom");
            Err(RigFault::Device(format!(
                "these procedures move {}, but the rig has {axes}",
                degrees(wanted)
            )))
        };
        match guard {
            Ok(guard) => {
                let home = guard.commanded().to_vec();
                Ok(Self {
                    guard,
                    observer,
                    identity,
                    events: Vec::new(),
                    procedure: None,
                    step: None,
                    remarks: Vec::new(),
                    home,
                    attended: false,
                    keep: Keep::default(),
                    is_simulated,
                    force_resolution: plan.rig.force_resolution(),
                    probed: Vec::new(),
                    hybrid: Hybrid::of(plan),
                })
            }
            Err(fault) => {
                let stop = match fault {
                    RigFault::LimitBreached { .. } if datum => Stop::AtRest(fault),
                    fault => Stop::Rig(fault),
                };
                let event = Event {
                    time,
                    procedure: None,
                    step: None,
                    kind: stop.event_kind(),
                    text: stop.to_string(),
                };
                observer.event(&event);
                Err(Box::new((event, stop)))
            }
        }
    }

    /// The events. The last of them states the recovered communication errors: a deviation without effect on the results.
    pub(crate) fn finish(mut self) -> Vec<Event> {
        let line_statistics = self.guard.line_statistics();
        if line_statistics != LineStatistics::default() {
            self.event(EventKind::Recovered, line_statistics.to_string());
        }
        self.events
    }

    /// The guard, the observer, and the list of events.
    pub(crate) fn parts(
        &mut self,
    ) -> (
        &mut Guard<'run>,
        &mut (dyn Observer + 'run),
        &mut Vec<Event>,
    ) {
        (&mut self.guard, &mut *self.observer, &mut self.events)
    }

    pub(super) fn enter(&mut self, procedure: &Procedure, steps: Option<u64>) {
        self.procedure = Some(procedure.name.clone());
        self.step = None;
        self.remarks.clear();
        self.observer
            .procedure_started(&procedure.name, procedure.kind.keyword(), steps);
    }

    pub(super) fn leave(&mut self) {
        // The observations of the last step are recorded too.
        while let Next::Record(text) = self.observer.next() {
            self.event(EventKind::Note, text);
        }
        if let Some(name) = self.procedure.take() {
            self.observer.procedure_finished(&name);
        }
    }

    pub(crate) fn event(&mut self, kind: EventKind, text: String) {
        let event = Event {
            time: self.guard.time(),
            procedure: self.procedure.clone(),
            step: self.step,
            kind,
            text,
        };
        self.observer.event(&event);
        self.events.push(event);
    }

    /// Records an observation about an impact once; later impacts of the same procedure with the same observation are counted.
    pub(crate) fn remark(&mut self, text: String) {
        if let Some((_, again)) = self.remarks.iter_mut().find(|(known, _)| *known == text) {
            *again += 1;
            return;
        }
        self.remarks.push((text.clone(), 0));
        self.event(EventKind::Remark, text);
    }

    /// Adds the observations that apply to more than one impact.
    pub(crate) fn remark_again(&mut self) {
        for (text, again) in std::mem::take(&mut self.remarks) {
            match again {
                0 => {}
                1 => self.event(EventKind::Remark, format!("after 1 more impact: {text}")),
                _ => self.event(
                    EventKind::Remark,
                    format!("after {again} more impacts: {text}"),
                ),
            }
        }
    }

    /// Steps with this pause \[s\] on an ideal rig that carries the whole specimen.
    pub(crate) fn ideal_steps(&mut self, pause: f64) -> Option<IdealSteps> {
        if self.hybrid.is_some() {
            return None;
        }
        self.guard.ideal_steps(pause)
    }

    /// Whether the observer follows the steps.
    pub(crate) fn is_followed(&self) -> bool {
        self.observer.follows_steps()
    }

    /// A step is done that the observer does not follow.
    #[inline]
    pub(crate) const fn step_passed(&mut self, step: u64) {
        self.step = Some(step);
    }

    /// Reports to the observer that a step is done, and asks whether to continue.
    pub(crate) fn step_done(&mut self, report: &mut StepReport) -> Result<(), Stop> {
        self.step = Some(report.step);
        report.speed = self.guard.speed();
        report.axial_force = self.guard.axial_force();
        self.observer.step_done(report);
        loop {
            self.stop_if_requested()?;
            match self.observer.next() {
                Next::GoOn => {
                    self.attended = false;
                    return Ok(());
                }
                Next::Wait => {
                    self.attended = true;
                    self.breathe()?;
                }
                Next::Record(text) => self.event(EventKind::Note, text),
            }
        }
    }

    /// Lets the operator inspect the specimen; the answer is an event. The operator reads which axial loads it carries.
    pub(crate) fn inspect(&mut self, note: &str) -> Result<(), Stop> {
        let loads = self.guard.axial_loads().map(|(storey, force)| {
            let force = stated(force, Dimension::FORCE);
            format!(
                "; AXIAL of storey {} holds {force} in FORCE CONTROL",
                storey + 1
            )
        });
        let note = loads.fold(note.to_owned(), |note, load| note + &load);
        self.ask(&note, &mut |observer| observer.inspect(&note))
    }

    /// Requests the motion enable of a rig that has not moved yet. A refusal stops nothing, because nothing has begun.
    pub(super) fn release(&mut self, note: &str, motion: &Motion) -> Result<(), Stop> {
        self.ask(note, &mut |observer| observer.release(note, motion))
            .map_err(|stop| match stop {
                Stop::Person { reason } => Stop::NotReleased { reason },
                stop => stop,
            })
    }

    fn ask(
        &mut self,
        note: &str,
        ask: &mut dyn FnMut(&mut dyn Observer) -> Inspection,
    ) -> Result<(), Stop> {
        self.attended = true;
        self.look_at_a_hold()?;
        loop {
            match ask(self.observer) {
                Inspection::GoOn { note: remark, by } => {
                    let remark = remark.map_or_else(String::new, |remark| format!(": {remark}"));
                    self.event(
                        EventKind::Inspection,
                        format!("{note}{remark}{}", signed(by.as_deref())),
                    );
                    self.look_at_a_hold()?;
                    self.attended = false;
                    return Ok(());
                }
                Inspection::Stop { reason, by } => {
                    self.guard.hold();
                    self.event(
                        EventKind::Inspection,
                        format!("{note}: {reason}{}", signed(by.as_deref())),
                    );
                    return Err(Stop::Person { reason });
                }
                Inspection::Wait => {
                    self.stop_if_requested()?;
                    self.breathe()?;
                }
            }
        }
    }

    /// Nothing moves during an inspection: the readings show the zero drift, if it is evaluated.
    fn look_at_a_hold(&mut self) -> Result<(), Stop> {
        if self.guard.watches_holds() {
            self.guard.read()?;
        }
        Ok(())
    }

    /// The identity that the rig reported.
    pub(super) fn identity(&self) -> Identity {
        self.identity.clone()
    }

    /// Whether no real specimen is moved, so that the specimen behaves exactly as the plan states.
    pub(crate) const fn is_simulated(&self) -> bool {
        self.is_simulated
    }

    /// During the propagation of uncertainties: its progress is reported, and a real rig is polled.
    fn propagation(&mut self, done: usize, of: usize) -> Result<(), Stop> {
        self.observer.studying(done, of);
        self.breathe()
    }

    /// Evaluates the uncertainty of results, unless the run requests none. If it cannot be evaluated, it is withheld, and the reason is an
    /// event. The stop is that of a rig that failed meanwhile.
    pub(crate) fn evaluate_uncertainty(
        &mut self,
        results: &mut [NamedResult],
        propagation: impl FnOnce(&mut [NamedResult], Progress<'_, Stop>) -> Result<(), Unknown<Stop>>,
    ) -> Option<Stop> {
        if self.keep != Keep::Everything {
            return None;
        }
        match propagation(results, &mut |done, of| self.propagation(done, of)) {
            Ok(()) => None,
            Err(Unknown::Ended(stop)) => Some(stop),
            Err(Unknown::Reason(reason)) => {
                for result in results.iter_mut() {
                    result.withhold(&reason);
                }
                self.event(
                    EventKind::Remark,
                    format!("the uncertainty of the results is withheld: {reason}"),
                );
                None
            }
        }
    }

    /// Holds if the operator requests the end. Called after every step, and before any other motion begins.
    pub(crate) fn stop_if_requested(&mut self) -> Result<(), Stop> {
        if self.observer.stop_requested() {
            self.guard.hold();
            return Err(stopped_on_request());
        }
        Ok(())
    }

    /// A short wait for the operator. A real rig stays at its position meanwhile, and is polled. A request to hold during the wait
    /// is a request to stop: nothing moves.
    pub(super) fn breathe(&mut self) -> Result<(), Stop> {
        if self.is_simulated {
            return Ok(());
        }
        self.guard.pause(BREATH).map_err(|fault| match fault {
            RigFault::Interrupted => stopped_on_request(),
            fault => fault.into(),
        })
    }

    /// [`Self::step_done`] of a procedure with one axis that integrates nothing: rig time is its time. The reading is a displacement
    /// \[m\] and a force \[N\].
    pub(crate) fn measured(
        &mut self,
        step: u64,
        time: f64,
        reading: (f64, f64),
    ) -> Result<(), Stop> {
        self.at_rest(step, time, &[reading.0], &[reading.1])
    }

    /// The same for every axis, after a reading of the floors.
    pub(crate) fn measured_all(
        &mut self,
        step: u64,
        time: f64,
        floors: &Reading,
    ) -> Result<(), Stop> {
        let axes = self.axes_read(floors);
        let (displacement, force) = (axes.displacement.clone(), axes.force.clone());
        self.at_rest(step, time, &displacement, &force)
    }

    fn at_rest(
        &mut self,
        step: u64,
        time: f64,
        displacement: &[f64],
        force: &[f64],
    ) -> Result<(), Stop> {
        let commands = self.guard.commanded();
        let mut report = StepReport::of_readings(step, time, commands, displacement, force);
        if report.axes.is_empty() {
            return Ok(());
        }
        self.step_done(&mut report)
    }

    /// The last target \[m\].
    pub(crate) fn commanded(&self) -> f64 {
        self.guard.commanded()[0]
    }

    /// One reading: displacement \[m\] and force \[N\].
    pub(crate) fn read(&mut self) -> Result<(f64, f64), Stop> {
        Ok(first(&self.guard.read()?))
    }

    /// One reading of every axis after a motion or a wait, and the fault if it exceeds a limit. The reading is kept in both cases, also
    /// one that exceeded a limit during the motion and ended it.
    pub(crate) fn read_after(
        &mut self,
        motion: Result<(), RigFault>,
    ) -> Result<(Reading, Option<Stop>), Stop> {
        let read = motion.and_then(|()| self.guard.read());
        self.kept(read)
    }

    /// The same, with the time of the last move: start and end of the equivalent uniform motion \[s\].
    pub(crate) fn read_moved_after(
        &mut self,
        motion: Result<(), RigFault>,
    ) -> Result<MovedReading, Stop> {
        let read = motion.and_then(|()| self.guard.read_moved());
        let (read, moved) = read.map_or_else(
            |fault| (Err(fault), None),
            |(reading, moved)| (Ok(reading), moved),
        );
        self.kept(read)
            .map(|(reading, stop)| (reading, moved, stop))
    }

    /// Moves to targets \[m\], pauses for so long \[s\] and reads. A step that ended early with a reading, which exceeded a limit, is
    /// returned; the reading is kept.
    pub(crate) fn step(
        &mut self,
        targets: &[f64],
        pause: f64,
        reading: &mut Reading,
    ) -> Result<Option<UnfinishedStep>, Stop> {
        let stepped = self.guard.step(targets, pause, reading);
        self.with_broken(stepped, reading)
    }

    /// The same of a run on an ideal rig.
    #[inline]
    pub(crate) fn step_ideally(
        &mut self,
        steps: IdealSteps,
        targets: &[f64],
        reading: &mut Reading,
    ) -> Result<Option<UnfinishedStep>, Stop> {
        let stepped = self.guard.step_ideally(steps, targets, reading);
        if stepped.is_ok() {
            return Ok(None);
        }
        self.with_broken(stepped, reading)
    }

    fn with_broken(
        &mut self,
        stepped: Result<(), UnfinishedStep>,
        reading: &mut Reading,
    ) -> Result<Option<UnfinishedStep>, Stop> {
        let Err(ended) = stepped else {
            return Ok(None);
        };
        match self.guard.take_broken() {
            Some(broken) => *reading = broken,
            None => return Err(ended.fault.into()),
        }
        Ok(Some(ended))
    }

    fn kept(&mut self, read: Result<Reading, RigFault>) -> Result<(Reading, Option<Stop>), Stop> {
        match read {
            Ok(reading) => Ok((reading, None)),
            Err(fault) => match self.guard.take_broken() {
                Some(reading) => Ok((reading, Some(fault.into()))),
                None => Err(fault.into()),
            },
        }
    }

    /// Moves to `position` \[m\], in one move or, if increments are limited, in equal increments.
    pub(crate) fn go_to(&mut self, position: f64, speed: Option<f64>) -> Result<(), RigFault> {
        self.go_to_all(&[position], speed)
    }

    /// The same for every axis.
    pub(crate) fn go_to_all(
        &mut self,
        positions: &[f64],
        speed: Option<f64>,
    ) -> Result<(), RigFault> {
        for target in self.guard.increments_to(positions) {
            self.guard.move_to(&target, speed)?;
        }
        Ok(())
    }
}

fn stopped_on_request() -> Stop {
    Stop::Person {
        reason: STOPPED_ON_REQUEST.to_owned(),
    }
}

pub(super) fn signed(by: Option<&str>) -> String {
    by.map_or_else(String::new, |name| format!(" ({name})"))
}

/// Displacement \[m\] and force \[N\] of the single degree of freedom.
pub(crate) fn first(reading: &Reading) -> (f64, f64) {
    (reading.displacement[0], reading.force[0])
}
