//! `cycle`: displacement cycles about one position, amplitude by amplitude. In: amplitudes, sides, the kind of readings. Out: every
//! reading, and energy, stiffness and damping of each complete cycle. Ramp-and-hold by default; with a rate the
//! actuator moves from end to end without stopping.

use super::results::results;
use super::uncertainty::{ENDS, RecordedLoops};
use crate::procedures::common::dwell_readings::DwellReadings;
use crate::procedures::stiffness_ramp::curve;
use crate::run::inputs::Inputs;
use crate::run::session::{Session, first};
use crate::run::stop::Stop;
use crate::run::{Keep, Performed};
use psd_physics::identification::cyclic::{LoopPoint, loop_of, work};
use psd_physics::identification::loop_sampling::spaced;
use psd_plan::procedures::cycle::block as schema;
use psd_plan::record::{CycleHistory, CycleStep, EventKind, History, WholeCycle};
use psd_plan::uncertainty::InstrumentUncertainty;
use psd_plan::{Cycle, CycleInspection, MOST_TARGETS, Plan};
use psd_rig::RigFault;
use psd_text::units::Dimension;
use psd_text::units::display::readable;

pub(crate) fn perform(
    plan: &Cycle,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let mut cycling = Cycling {
        history: CycleHistory::default(),
        amplitude: 0.0,
        cycle: 0,
    };
    let stop = cycling.run(plan, inputs, session).err();
    // Means of the samples at a target; in motion each reading is a single sample.
    let samples = if plan.rate.is_some() {
        1
    } else {
        plan.samples.max(1)
    };
    let declared = session.guard.declared_noise();
    let instruments = InstrumentUncertainty::of(whole, declared, 1);
    if let Some(count) = plan.fit {
        let stated = instruments.stated_variance(0, samples);
        let (backbone, remarks) =
            curve::fitted(&cycling.history.backbone_points(), count, ENDS, stated);
        cycling.history.backbone = backbone;
        for text in remarks.into_iter().filter(|_| stop.is_none()) {
            session.event(EventKind::Remark, text);
        }
    }
    let noise = declared.force / f64::from(samples).sqrt();
    let mut results = results(&cycling.history, noise);
    let left_open =
        super::uncertainty::left_open_by_points(&cycling.history, samples, instruments.errors(0));
    if session.keep == Keep::Everything {
        let loops = RecordedLoops {
            history: &cycling.history,
            samples,
            noise: declared.force,
            left_open: &left_open,
        };
        super::uncertainty::propagate(&loops, &instruments, inputs.procedure(), &mut results);
    }
    if let Some(text) = few_points(&cycling.history, &left_open).filter(|_| stop.is_none()) {
        session.event(EventKind::Remark, text);
    }
    Performed {
        history: History::Cycle(cycling.history),
        results,
        stop,
    }
}

/// Fraction of the energy of a cycle: if its points leave more of the area undetermined, an observation is made.
const OPEN: f64 = 0.05;
/// A loop with less energy than this fraction of its height times its width counts as having none.
const THIN: f64 = 1e-3;

/// An observation on loops with an undetermined part of the area, in J each.
fn few_points(history: &CycleHistory, left_open: &[f64]) -> Option<String> {
    let loops = history.cycles.iter().zip(left_open);
    let share = |(cycle, open): (&WholeCycle, &f64)| {
        let found = &cycle.found;
        let thin = THIN * (found.max_force - found.min_force) * 2.0 * found.amplitude;
        (
            cycle.cycle,
            if *open > thin {
                open / found.energy.abs()
            } else {
                0.0
            },
        )
    };
    let (cycle, worst) = loops
        .map(share)
        .max_by(|one, other| one.1.total_cmp(&other.1))?;
    (worst > OPEN).then(|| {
        let percent = 100.0 * worst;
        format!(
            "few points: the energy and damping ratio of cycle {cycle} may be wrong by {percent:.0} %; use more \
             `points`, or a higher `rate`"
        )
    })
}

/// How one quarter is travelled.
#[derive(Clone, Copy)]
struct Manner {
    /// Readings at each target.
    samples: u32,
    /// \[s\]
    pause: f64,
    /// \[m/s\]
    speed: Option<f64>,
    /// None: the rig stops at its targets and is read there.
    moving: Option<SampledMotion>,
    /// Number of targets of a quarter, from the middle to an end.
    points: u32,
}

/// A motion that is read on the way.
#[derive(Clone, Copy)]
struct SampledMotion {
    /// Sampling frequency \[Hz\].
    rate: f64,
    /// \[m/s\]
    speed: f64,
}

struct Cycling {
    history: CycleHistory,
    /// Requested amplitude \[m\].
    amplitude: f64,
    cycle: u64,
}

impl Cycling {
    fn run(
        &mut self,
        plan: &Cycle,
        inputs: &mut Inputs<'_>,
        session: &mut Session<'_>,
    ) -> Result<(), Stop> {
        let amplitudes = plan
            .levels
            .iter()
            .map(|level| level.amplitude.clone())
            .collect::<Vec<_>>();
        let amplitudes = inputs.list(&schema::GIVEN_AMPLITUDES, &amplitudes)?;
        let about = inputs.number(&schema::ABOUT, &plan.about)?;
        let pause = inputs.number(&schema::PAUSE, &plan.pause)?;
        let speed = inputs.speed(plan.speed.as_ref())?;
        let rate = plan
            .rate
            .as_ref()
            .map(|rate| inputs.number(&schema::RATE, rate))
            .transpose()?;
        let (samples, points) = (plan.samples.max(1), plan.points.max(1));
        let manner = Manner {
            samples,
            pause,
            speed,
            moving: rate
                .zip(speed)
                .map(|(rate, speed)| SampledMotion { rate, speed }),
            points,
        };
        let moved = session.go_to(about, speed);
        self.target(about, moved, manner, session)?;
        let mut looks = Looks::default();
        for (level, amplitude) in plan.levels.iter().zip(amplitudes) {
            self.amplitude = amplitude;
            for repeat in 1..=level.cycles {
                self.cycle += 1;
                let from = self.history.steps.len() - 1;
                for (end, stretch) in plan.sides.ends().iter().zip(plan.sides.stretches()) {
                    self.move_along_branch(about + end * amplitude, *stretch, manner, session)?;
                }
                self.whole(from, repeat);
            }
            let of_level = self
                .history
                .cycles
                .iter()
                .rev()
                .take_while(|cycle| cycle.amplitude == amplitude);
            let largest = of_level
                .map(|cycle| cycle.found.max_force.max(-cycle.found.min_force))
                .fold(0.0, f64::max);
            // After the last amplitude nothing follows that an inspection could stop.
            let more = self.history.cycles.len() as u64 != plan.cycles();
            if let Some(reason) = looks
                .after(&plan.inspect, amplitude, largest)
                .filter(|_| more)
            {
                session.inspect(&reason)?;
            }
        }
        Ok(())
    }

    /// Moves from the present position to `to` \[m\], which is this part of the branch from one reversal to the next.
    fn move_along_branch(
        &mut self,
        to: f64,
        [begin, end]: [f64; 2],
        manner: Manner,
        session: &mut Session<'_>,
    ) -> Result<(), Stop> {
        if let Some(sampled) = manner.moving {
            self.moving(to, sampled, session)?;
            session.guard.pause(manner.pause)?;
            return Ok(());
        }
        let from = session.commanded();
        // The number of quarters; 5e-10 allows for the rounding of the amplitude.
        let quarters = ((to - from).abs() / self.amplitude - 5e-10).ceil().max(1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "one or two"
        )]
        let targets = quarters as u32 * manner.points;
        let (first, last) = (spaced(begin), spaced(end));
        for target in 1..=targets {
            let even = f64::from(target) / f64::from(targets);
            let share = (spaced(begin + (end - begin) * even) - first) / (last - first);
            let commanded = if target == targets {
                to
            } else {
                from + (to - from) * share
            };
            let moved = session.go_to(commanded, manner.speed);
            self.target(commanded, moved, manner, session)?;
        }
        Ok(())
    }

    /// Reads at the position to which it `moved`: once for the relaxation, then the samples after the pause.
    fn target(
        &mut self,
        command: f64,
        moved: Result<(), RigFault>,
        manner: Manner,
        session: &mut Session<'_>,
    ) -> Result<(), Stop> {
        let (settled, broken) = session.read_after(moved)?;
        let dwell = DwellReadings::take(&settled, broken, manner.pause, manner.samples, session)?;
        self.take(command, dwell, session)
    }

    /// Moves to `to` without a stop and reads during the motion.
    fn moving(
        &mut self,
        to: f64,
        sampled: SampledMotion,
        session: &mut Session<'_>,
    ) -> Result<(), Stop> {
        let from = session.commanded();
        let SampledMotion { rate, speed } = sampled;
        let wanted = ((to - from).abs() / speed * rate).round().max(1.0);
        if wanted > MOST_TARGETS {
            return Err(Stop::bad_input(
                schema::RATE.name,
                wanted,
                Dimension::NUMBER,
                format!("at most {MOST_TARGETS} readings per move"),
            ));
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and MOST_TARGETS"
        )]
        let samples = wanted as usize;
        let traversed = session
            .guard
            .traverse(&[to], speed.copysign(to - from), samples);
        let broken = session.guard.take_broken();
        let whole = traversed.readings.len() - usize::from(broken.is_some());
        for (sample, reading) in (1_u32..).zip(&traversed.readings) {
            #[expect(clippy::cast_precision_loss, reason = "at most MOST_TARGETS")]
            let share = (f64::from(sample) / samples as f64).min(1.0);
            let command = from + (to - from) * share;
            let reading = DwellReadings::single(first(reading), reading.time);
            if sample as usize > whole {
                self.keep(command, &reading);
            } else {
                self.take(command, reading, session)?;
            }
        }
        traversed.fault.map_or(Ok(()), |fault| Err(fault.into()))
    }

    fn take(
        &mut self,
        command: f64,
        reading: DwellReadings,
        session: &mut Session<'_>,
    ) -> Result<(), Stop> {
        let step = self.keep(command, &reading);
        if let Some(stop) = reading.broken {
            return Err(stop);
        }
        session.measured(
            step,
            reading.wall_time,
            (reading.displacement, reading.restoring_force),
        )
    }

    /// Records a step and returns its number.
    fn keep(&mut self, command: f64, reading: &DwellReadings) -> u64 {
        let DwellReadings {
            displacement,
            restoring_force,
            force_scatter,
            relaxation,
            wall_time,
            ..
        } = *reading;
        let steps = &mut self.history.steps;
        let energy = steps.last().map_or(0.0, |before| {
            before.energy
                + work(
                    (before.displacement, before.restoring_force),
                    (displacement, restoring_force),
                )
        });
        let step = steps.len() as u64 + 1;
        steps.push(CycleStep {
            step,
            wall_time,
            cycle: self.cycle,
            amplitude: self.amplitude,
            command,
            displacement,
            restoring_force,
            force_scatter,
            relaxation,
            energy,
        });
        step
    }

    /// Evaluates the complete cycle whose first point is step `from`.
    fn whole(&mut self, from: usize, repeat: u32) {
        let points: Vec<LoopPoint> = self.history.steps[from..]
            .iter()
            .map(CycleStep::point)
            .collect();
        let Some(found) = loop_of(&points) else {
            return;
        };
        self.history.cycles.push(WholeCycle {
            cycle: self.cycle,
            amplitude: self.amplitude,
            repeat,
            found,
        });
    }
}

/// When the operator must inspect the specimen.
#[derive(Default)]
struct Looks {
    levels: u32,
    /// Largest force since the last inspection that a force drop required \[N\].
    largest: f64,
}

impl Looks {
    fn after(&mut self, inspect: &[CycleInspection], amplitude: f64, force: f64) -> Option<String> {
        self.levels += 1;
        let shown = readable(amplitude, Dimension::LENGTH);
        let mut reason = None;
        for trigger in inspect {
            let due = match *trigger {
                CycleInspection::Every(levels) => (levels > 0
                    && self.levels.is_multiple_of(levels))
                .then(|| format!("inspection after the cycles to {shown}")),
                CycleInspection::ForceDrop(fraction) => {
                    let dropped = force < (1.0 - fraction) * self.largest;
                    self.largest = if dropped {
                        force
                    } else {
                        self.largest.max(force)
                    };
                    dropped.then(|| {
                        format!(
                            "the largest force of the cycles to {shown} fell by {} % or more",
                            fraction * 100.0
                        )
                    })
                }
            };
            reason = reason.or(due);
        }
        reason
    }
}
