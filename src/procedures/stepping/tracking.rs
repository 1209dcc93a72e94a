//! The tracking of the actuators. In: the rig of a plan, or targets, readings and the energy of the test, step by step. Out: the delay
//! before a run; in it the tracking of each axis, an observation where the tracking energy is large, results of all axes together and of
//! each. It stops nothing: the guard does.

use crate::procedures::facts::Delay;
use crate::run::session::Session;
use psd_physics::structure::assemblies::Assemblies;
use psd_physics::structure::elements::ElementReading;
use psd_physics::structure::frame_properties::FrameProperties;
use psd_physics::tracking::monitor::{Monitor, TrackedStep, Tracking, WARN};
use psd_plan::formula::NoResults;
use psd_plan::record::{EventKind, NamedResult};
use psd_plan::schema::ResultKind;
use psd_plan::schema::procedures::tracking as schema;
use psd_plan::{Frame, Link, Mode, Plan, ShakeDamping, Stepping, VirtualLink};
use psd_rig::Reading;
use psd_text::units::display::significant;

/// A tracking monitor for every floor or element, with the motion and force of its axis; a computed one has no tracking error.
pub(crate) struct Monitors {
    axes: Vec<Monitor>,
    /// None if the axes are the floors.
    assemblies: Option<Assemblies>,
    /// Whether the recursion uses the force at the target of an element.
    i_modification: bool,
    /// Of each axis so far.
    tracking: Vec<Tracking>,
}

/// The floors at the end of a step.
pub(crate) struct At<'a> {
    pub commanded: &'a [f64],
    pub reading: &'a Reading,
    /// Those of a frame of matrices.
    pub elements: &'a [ElementReading],
    /// Effective forces of the recursion at the commanded displacements \[N\].
    pub effective_force: &'a [f64],
}

impl Monitors {
    /// From the start of a run.
    pub(crate) fn new(
        assemblies: Option<Assemblies>,
        i_modification: bool,
        start: &At<'_>,
    ) -> Self {
        let mut axes = Vec::new();
        each_tracked(assemblies.as_ref(), i_modification, start, |step| {
            axes.push(Monitor::new(step));
        });
        Self {
            tracking: axes.iter().map(Monitor::tracking).collect(),
            axes,
            assemblies,
            i_modification,
        }
    }

    /// The tracking of each axis so far.
    pub(crate) fn tracking(&self) -> &[Tracking] {
        &self.tracking
    }

    /// Adds a step.
    pub(crate) fn take(&mut self, at: &At<'_>) {
        let mut axes = self.axes.iter_mut().zip(&mut self.tracking);
        let assemblies = self.assemblies.as_ref();
        each_tracked(assemblies, self.i_modification, at, |step| {
            if let Some((monitor, tracking)) = axes.next() {
                *tracking = monitor.take(step);
            }
        });
    }
}

/// Calls with the step of the axis of each floor, from commands, readings and forces of the floors; for a frame of matrices, with that of
/// each element.
fn each_tracked(
    assemblies: Option<&Assemblies>,
    i_modification: bool,
    at: &At<'_>,
    mut take: impl FnMut(&TrackedStep),
) {
    let At {
        commanded,
        reading,
        elements,
        effective_force,
    } = *at;
    let Some(assemblies) = assemblies else {
        tracked(commanded, reading, effective_force).for_each(|step| take(&step));
        return;
    };
    if let Some(layout) = assemblies.elements() {
        let computed = assemblies.computed();
        for (element, (read, stiffness)) in elements.iter().zip(&layout.stiffness).enumerate() {
            let read = if computed.contains(&element) {
                ElementReading::default()
            } else {
                *read
            };
            let missed = read.deformation - read.target;
            let correction = if i_modification {
                stiffness * missed
            } else {
                0.0
            };
            take(&TrackedStep {
                commanded: read.target,
                measured: read.deformation,
                force: read.force,
                effective_force: read.force - correction,
            });
        }
        return;
    }
    let of_axes = Reading {
        time: reading.time,
        displacement: assemblies.in_assemblies(&reading.displacement),
        force: assemblies.forces_in_assemblies(&reading.force),
        raw: Vec::new(),
    };
    let commanded = assemblies.in_assemblies(commanded);
    let effective_force = assemblies.forces_in_assemblies(effective_force);
    tracked(&commanded, &of_axes, &effective_force).for_each(|step| take(&step));
}

/// The step of each axis.
fn tracked<'a>(
    commanded: &'a [f64],
    reading: &'a Reading,
    effective_force: &'a [f64],
) -> impl Iterator<Item = TrackedStep> {
    let read = reading
        .displacement
        .iter()
        .zip(&reading.force)
        .zip(effective_force);
    let axes = commanded.iter().zip(read);
    axes.map(
        |(commanded, ((measured, force), effective_force))| TrackedStep {
            commanded: *commanded,
            measured: *measured,
            force: *force,
            effective_force: *effective_force,
        },
    )
}

#[derive(Debug, Default)]
pub(crate) struct TrackingSummary {
    watch: EnergyWatch,
    /// At the last step.
    axes: Vec<Tracking>,
    /// For each axis, the energy error over the energy of the test, signed: the peak absolute value so far.
    worst: Vec<f64>,
}

impl TrackingSummary {
    /// Adds a step, `energy` \[J\] that of the test so far. Gives all axes together, and their energy error over that energy.
    pub(crate) fn assess(
        &mut self,
        axes: &[Tracking],
        energy: f64,
        session: &mut Session<'_>,
    ) -> (Tracking, Option<f64>) {
        let tracking = Tracking::together(axes);
        let share = tracking.share_of(energy);
        self.watch.assess(share, session);
        self.worst.resize(axes.len(), 0.0);
        for (worst, axis) in self.worst.iter_mut().zip(axes) {
            let share = axis.share_of(energy).unwrap_or(0.0);
            if share.abs() > worst.abs() {
                *worst = share;
            }
        }
        axes.clone_into(&mut self.axes);
        (tracking, share)
    }

    /// Energy error of all axes over the energy of the test, signed: the peak absolute value.
    pub(crate) const fn worst(&self) -> Option<f64> {
        self.watch.worst
    }

    /// All axes together, after the last step that was judged.
    pub(crate) fn of_all(&self) -> [NamedResult; 4] {
        let tracking = Some(Tracking::together(&self.axes)).filter(|_| !self.axes.is_empty());
        tracking_results(self.worst(), tracking)
    }

    /// Each axis, in the order of the reference.
    pub(crate) fn of_each(&self) -> [NamedResult; 4] {
        let list = |kind: ResultKind, values: Vec<f64>| {
            kind.found_list(Some(values).filter(|values| !values.is_empty()))
        };
        let ended = |value: fn(&Tracking) -> f64| self.axes.iter().map(value).collect();
        [
            list(schema::FLOOR_TRACKING_ENERGY_ERROR, self.worst.clone()),
            list(
                schema::FLOOR_TRACKING_INDICATOR,
                ended(|axis| axis.indicator),
            ),
            list(schema::FLOOR_NRMS_ERROR, ended(|axis| axis.nrms_error)),
            list(schema::FLOOR_PEAK_ERROR, ended(|axis| axis.peak_error)),
        ]
    }
}

/// Results of all axes together, in the order of the reference: energies and areas add, of the others the largest counts. `worst` is the
/// largest energy error over the energy of the test.
pub(crate) fn tracking_results(worst: Option<f64>, tracking: Option<Tracking>) -> [NamedResult; 4] {
    [
        schema::TRACKING_ENERGY_ERROR.found(worst),
        schema::TRACKING_INDICATOR.found(tracking.map(|all| all.indicator)),
        schema::NRMS_ERROR.found(tracking.map(|all| all.nrms_error)),
        schema::PEAK_ERROR.found(tracking.map(|all| all.peak_error)),
    ]
}

/// Observes the energy that tracking errors add to a test or remove from it: one event, and the largest fraction of the input energy.
#[derive(Debug, Default)]
struct EnergyWatch {
    /// Energy error of tracking over the input, signed: the peak absolute value so far.
    worst: Option<f64>,
    warned: bool,
}

impl EnergyWatch {
    /// Records once that tracking adds or removes more energy than usual practice accepts.
    fn assess(&mut self, share: Option<f64>, session: &mut Session<'_>) {
        let Some(share) = share else { return };
        if self.worst.is_none_or(|worst| share.abs() > worst.abs()) {
            self.worst = Some(share);
        }
        // A narrower limit has a proportionally lower warning threshold.
        let warn = WARN.min(0.4 * session.guard.tracking_energy_limit().high);
        if share.abs() > warn && !self.warned {
            self.warned = true;
            let does = if share < 0.0 {
                "puts energy into"
            } else {
                "takes energy out of"
            };
            let text = format!(
                "tracking {does} the test: {} % of the input energy",
                significant(100.0 * share.abs(), 2)
            );
            session.event(EventKind::Remark, text);
        }
    }
}

/// Delay of the actuators of a rig to first order, in simulated time \[s\]. An undershoot t of each increment gives Δt·t/(1 − t). A lag τ
/// gives the part that remains after a pause, or in continuous mode τ over the time scale.
pub(crate) fn delay(plan: &Plan, stepping: &Stepping, time_step: f64) -> f64 {
    let Link::Virtual(VirtualLink {
        tracking: short,
        lag,
        ..
    }) = plan.rig.link
    else {
        return 0.0;
    };
    if short >= 1.0 {
        return f64::INFINITY;
    }
    let of_lag = match stepping.mode {
        _ if lag <= 0.0 => 0.0,
        Mode::Continuous { time_scale } => lag / time_scale,
        // The rig settles into its band first.
        Mode::RampAndHold if plan.rig.settle.band > 0.0 => 0.0,
        Mode::RampAndHold => {
            let left = (-stepping.pause.constant().unwrap_or(0.0) / lag).exp();
            if left < 1.0 {
                time_step * left / (1.0 - left)
            } else {
                f64::INFINITY
            }
        }
    };
    (short * time_step + of_lag) / (1.0 - short)
}

/// The delay of a frame, whose critical time step \[s\] is `critical`; None where not enough is known before the run.
pub(crate) fn frame_delay(
    plan: &Plan,
    specimen: usize,
    damping: &ShakeDamping,
    stepping: &Stepping,
    critical: impl Fn(&FrameProperties) -> Option<f64>,
) -> Option<Delay> {
    let frame: &Frame = plan.specimens.get(specimen)?.frame.as_ref()?;
    let properties = FrameProperties::of(frame, &damping.known()?).ok()?;
    let time_step = stepping
        .time_step
        .evaluate(&NoResults, critical(&properties))
        .ok()?
        .value;
    Some(Delay {
        late: delay(plan, stepping, time_step),
        time_step,
        omega: properties.modes.angular_frequency(0),
    })
}
