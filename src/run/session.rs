//! One run as it goes: the guarded rig, who watches, and the events so far. In: what procedures do. Out: events.
//! It knows no procedure's physics.

use super::stop::Stop;
use super::{AxisReport, Inspection, Motion, Next, Observer, Settings, StepReport};
use crate::plan::{Plan, Procedure};
use crate::record::{Event, EventKind};
use crate::rig::{Guard, Identity, Reading, Rig, RigFault, Tally};
use crate::uncertainty::engine::{Tick, Unknown};

/// A reading, when the rig went on its last move (s), and what ends the run.
pub(super) type MovedReading = (Reading, Option<[f64; 2]>, Option<Stop>);

/// How long a real rig stays where it is between two looks at whether the person has decided, s of rig time: it takes a
/// sign of life at least this often.
const BREATH: f64 = 0.01;

/// Why a run ends that a person wants to end while nothing moves.
pub(super) const STOPPED_ON_REQUEST: &str = "stopped on request";

pub(crate) struct Session<'run> {
    pub(crate) guard: Guard<'run>,
    pub(super) observer: &'run mut dyn Observer,
    /// Who the rig says it is.
    identity: Identity,
    events: Vec<Event>,
    procedure: Option<String>,
    /// Number of the last step done in this procedure.
    step: Option<u64>,
    /// What a reader was told of a blow of this procedure, and after how many more of its blows it was so again.
    remarks: Vec<(String, usize)>,
    /// Where the rig was found, m.
    pub(super) home: Vec<f64>,
    /// [`Plan::unloads_at_once`]
    pub(crate) unloads_at_once: bool,
    /// A person was asked to look, or has paused the run: somebody may stand at the specimen.
    pub(super) attended: bool,
    pub(crate) settings: Settings,
    /// Whether rig time is only reckoned, and must not pass while a person thinks. A simulator on a line is driven as any
    /// rig, and has a watchdog as any.
    reckoned: bool,
}

impl<'run> Session<'run> {
    /// Takes the rig behind its guard. The error is the event to record and what ended the run.
    pub(crate) fn begin(
        plan: &Plan,
        rig: &'run mut dyn Rig,
        observer: &'run mut dyn Observer,
    ) -> Result<Self, Box<(Event, Stop)>> {
        let time = rig.time();
        let axes = rig.degrees_of_freedom();
        let identity = rig.identity();
        let reckoned = identity.simulated && plan.rig.link.as_real().is_none();
        let datum = rig.datum().is_some();
        let wanted = plan.degrees_of_freedom();
        let guard = if axes == wanted {
            Guard::of_axes(rig, plan.limits, plan.rig.limits_of_axes(&plan.limits))
        } else {
            rig.hold();
            let degrees = |count| {
                if count == 1 {
                    "one degree of freedom".to_owned()
                } else {
                    format!("{count} degrees of freedom")
                }
            };
            Err(RigFault::Device(format!(
                "these procedures move {}, and the rig has {axes}",
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
                    unloads_at_once: plan.unloads_at_once,
                    attended: false,
                    settings: Settings::default(),
                    reckoned,
                })
            }
            Err(fault) => {
                // Records of older versions have the fault alone.
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

    /// The events, the last of which says what was mended on the lines of the rig: a deviation, though it did no harm.
    pub(crate) fn finish(mut self) -> Vec<Event> {
        let tally = self.guard.tally();
        if tally != Tally::default() {
            self.event(EventKind::Mended, tally.to_string());
        }
        self.events
    }

    /// The guard, who watches, and where events go.
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
        // What was said during the last step is not lost.
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

    /// What a reader must know of a blow, once: of further blows of the same procedure it is counted.
    pub(crate) fn remark(&mut self, text: String) {
        if let Some((_, again)) = self.remarks.iter_mut().find(|(known, _)| *known == text) {
            *again += 1;
            return;
        }
        self.remarks.push((text.clone(), 0));
        self.event(EventKind::Remark, text);
    }

    /// Says what was so of more blows than one.
    pub(crate) fn remark_again(&mut self) {
        for (text, again) in std::mem::take(&mut self.remarks) {
            match again {
                0 => {}
                1 => self.event(EventKind::Remark, format!("after one more blow: {text}")),
                _ => self.event(
                    EventKind::Remark,
                    format!("after {again} more blows: {text}"),
                ),
            }
        }
    }

    /// Tells who watches that a step is done, and asks whether to go on.
    pub(crate) fn step_done(&mut self, report: StepReport) -> Result<(), Stop> {
        self.step = Some(report.step);
        self.observer.step_done(&StepReport {
            speed: self.guard.speed(),
            ..report
        });
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

    /// Lets a person look at the specimen; what was said, and by whom, is an event.
    pub(crate) fn inspect(&mut self, note: &str) -> Result<(), Stop> {
        self.ask(note, &mut |observer| observer.inspect(note))
    }

    /// Asks for the release of a rig that has not moved yet. Whoever does not give it stops nothing: nothing was begun.
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
                Inspection::GoOn { note: said, by } => {
                    let said = said.map_or_else(String::new, |said| format!(": {said}"));
                    self.event(
                        EventKind::Inspection,
                        format!("{note}{said}{}", signed(by.as_deref())),
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

    /// While a person looks nothing moves: what the readings do meanwhile tells of drift, where that is asked for.
    fn look_at_a_hold(&mut self) -> Result<(), Stop> {
        if self.guard.watches_holds() {
            self.guard.read()?;
        }
        Ok(())
    }

    /// Who the rig says it is.
    pub(super) fn identity(&self) -> Identity {
        self.identity.clone()
    }

    /// Whether nothing real is moved, so that what the plan says of the specimen is what the specimen does.
    pub(crate) const fn reckoned(&self) -> bool {
        self.reckoned
    }

    /// While a study of the run is under way, of which so much is done: who watches is told, and a real rig is heard from.
    fn study(&mut self, done: usize, of: usize) -> Result<(), Stop> {
        self.observer.studying(done, of);
        self.breathe()
    }

    /// Evaluates the uncertainty of results, unless the run asks for none. Why it is not known is an event; the stop is that of a rig that
    /// failed meanwhile.
    pub(crate) fn evaluate_uncertainty(
        &mut self,
        study: impl FnOnce(Tick<'_, Stop>) -> Result<(), Unknown<Stop>>,
    ) -> Option<Stop> {
        if !self.settings.uncertainty {
            return None;
        }
        match study(&mut |done, of| self.study(done, of)) {
            Ok(()) => None,
            Err(Unknown::Ended(stop)) => Some(stop),
            Err(Unknown::Reason(reason)) => {
                self.event(
                    EventKind::Remark,
                    format!("the uncertainty of the results is not known: {reason}"),
                );
                None
            }
        }
    }

    /// Holds where a person wants the end. Asked after every step, and before anything else begins to move.
    pub(crate) fn stop_if_requested(&mut self) -> Result<(), Stop> {
        if self.observer.stop_requested() {
            self.guard.hold();
            return Err(stopped_on_request());
        }
        Ok(())
    }

    /// A moment of a person's time. A real rig spends it where it is, and is heard from. A request to hold that comes meanwhile is a
    /// request to stop: nothing moves.
    pub(super) fn breathe(&mut self) -> Result<(), Stop> {
        if self.reckoned {
            return Ok(());
        }
        self.guard.pause(BREATH).map_err(|fault| match fault {
            RigFault::Interrupted => stopped_on_request(),
            fault => fault.into(),
        })
    }

    /// [`Self::step_done`] of a procedure that integrates nothing: rig time is its time.
    pub(crate) fn measured(
        &mut self,
        step: u64,
        time: f64,
        displacement: f64,
        force: f64,
    ) -> Result<(), Stop> {
        self.at_rest(step, time, &[displacement], &[force])
    }

    /// The same of every axis.
    pub(crate) fn measured_all(
        &mut self,
        step: u64,
        time: f64,
        reading: &Reading,
    ) -> Result<(), Stop> {
        self.at_rest(step, time, &reading.displacement, &reading.force)
    }

    fn at_rest(
        &mut self,
        step: u64,
        time: f64,
        displacement: &[f64],
        force: &[f64],
    ) -> Result<(), Stop> {
        let places = self.guard.commanded().iter().zip(displacement).zip(force);
        let mut axes = places.map(|((command, displacement), force)| AxisReport {
            command: *command,
            displacement: *displacement,
            velocity: 0.0,
            acceleration: 0.0,
            force: *force,
        });
        let Some(first) = axes.next() else {
            return Ok(());
        };
        let others = axes.collect();
        self.step_done(StepReport {
            step,
            time,
            command: first.command,
            displacement: first.displacement,
            velocity: None,
            acceleration: None,
            force: first.force,
            speed: None,
            energy_error: None,
            others,
            tracking: None,
            tracking_energy_error: None,
        })
    }

    /// Where the last target was, m.
    pub(crate) fn commanded(&self) -> f64 {
        self.guard.commanded()[0]
    }

    /// One reading: displacement (m) and force (N).
    pub(crate) fn read(&mut self) -> Result<(f64, f64), Stop> {
        Ok(first(&self.guard.read()?))
    }

    /// One reading of every axis, and what ends the run where it breaks a limit: it was made all the same, and is kept.
    pub(crate) fn read_kept(&mut self) -> Result<(Reading, Option<Stop>), Stop> {
        let read = self.guard.read();
        self.kept(read)
    }

    /// The same, with when the rig went on its last move: begin and end of the even motion that stands for it, s.
    pub(crate) fn read_moved_kept(&mut self) -> Result<MovedReading, Stop> {
        let read = self.guard.read_moved();
        let (read, moved) = read.map_or_else(
            |fault| (Err(fault), None),
            |(reading, moved)| (Ok(reading), moved),
        );
        self.kept(read)
            .map(|(reading, stop)| (reading, moved, stop))
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

    /// Back to `place` (m), as one move or, where increments are limited, as equal ones.
    pub(crate) fn go_to(&mut self, place: f64, speed: Option<f64>) -> Result<(), Stop> {
        self.go_to_all(&[place], speed)
    }

    /// The same of every axis.
    pub(crate) fn go_to_all(&mut self, places: &[f64], speed: Option<f64>) -> Result<(), Stop> {
        for target in self.guard.way_to(places) {
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

/// Standard deviation of the base shear as the cells of all floors read it, N.
pub(crate) fn of_base_shear(session: &Session<'_>) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "at most MOST_STOREYS")]
    let floors = session.guard.commanded().len() as f64;
    session.guard.declared_noise().force * floors.sqrt()
}

/// Displacement (m) and force (N) of the one degree of freedom.
pub(crate) fn first(reading: &Reading) -> (f64, f64) {
    (reading.displacement[0], reading.force[0])
}
