//! `stiffness ramp` (Melo et al. 2006, sec. 5 step 1 and sec. 6 (a)): prescribed displacements, a pause at each, then the mean of some
//! readings. In: the displacements. Out: K by least squares over the outward steps, the secant of the first increment, the tangent at
//! every one, relaxation and, with an unloading branch, the energy of the loop.

use super::hold::Arriving;
use super::points::{Point, point, secant};
use super::uncertainty::{Direct, Readings};
use super::{curve, hold};
use crate::procedures::common::dwell_readings::DwellReadings;
use crate::run::inputs::Inputs;
use crate::run::session::Session;
use crate::run::stop::Stop;
use crate::run::{Keep, Performed};
use psd_physics::identification::bilinear_fit::fit_bilinear;
use psd_physics::identification::{StatedVariance, fit_line};
use psd_plan::procedures::stiffness_ramp::block as schema;
use psd_plan::record::{
    BilinearFit, EventKind, History, Hold, LineFit, MultilinearFit, NamedResult, RampStep,
    StiffnessRampHistory,
};
use psd_plan::uncertainty::InstrumentUncertainty;
use psd_plan::{Plan, RampFit, StiffnessRamp, WatchedHold};

pub(crate) fn perform(
    plan: &StiffnessRamp,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    let mut ramp = Ramp {
        steps: Vec::new(),
        before: Vec::new(),
        holds: Vec::new(),
        arriving: Vec::new(),
        last_reading: 0.0,
    };
    let stop = ramp.run(plan, inputs, session).err();
    let declared = session.guard.declared_noise();
    let instruments = InstrumentUncertainty::of(whole, declared, 1);
    let fits = fits(
        &ramp.steps,
        plan,
        instruments.stated_variance(0, plan.samples),
    );
    for text in fits.remarks.iter().filter(|_| stop.is_none()) {
        session.event(EventKind::Remark, text.clone());
    }
    let noise = Some(instruments.errors(0).noise).filter(|noise| *noise > 0.0);
    let asked = plan.relaxation.map(|asked| asked.model);
    let start = ramp.before.first().map(point).unwrap_or_default();
    let evaluation = hold::evaluate_dwells(
        &ramp.arriving,
        start,
        asked,
        noise,
        instruments.stated_variance(0, 1),
    );
    for text in evaluation.remarks.into_iter().filter(|_| stop.is_none()) {
        session.event(EventKind::Remark, text);
    }
    let readings = Readings {
        starts: ramp.before.iter().map(point).collect(),
        steps: ramp.steps,
    };
    let mut results = results(&readings.direct(plan, declared.force), &fits);
    if session.keep == Keep::Everything {
        super::uncertainty::propagate(
            &readings,
            plan,
            declared,
            &instruments,
            inputs.procedure(),
            &mut results,
        );
    }
    results.extend(evaluation.results);
    let Fits {
        line: fit,
        bilinear,
        multilinear,
        ..
    } = fits;
    let (multilinear, relaxation, reached) = (
        multilinear.map(Box::new),
        evaluation.relaxation.map(Box::new),
        evaluation.reached.map(Box::new),
    );
    let history = StiffnessRampHistory {
        before: ramp.before,
        steps: readings.steps,
        fit,
        bilinear,
        multilinear,
        holds: ramp.holds,
        relaxation,
        reached,
    };
    Performed {
        history: History::StiffnessRamp(history),
        results,
        stop,
    }
}

/// The results of a fit to these steps; the others do not exist.
pub(super) fn fitted(
    steps: &[RampStep],
    plan: &StiffnessRamp,
    stated: StatedVariance,
) -> Vec<NamedResult> {
    results(&Direct::default(), &fits(steps, plan, stated))
}

/// The fits, one at most, and the observations on them.
#[derive(Default)]
struct Fits {
    line: Option<LineFit>,
    bilinear: Option<BilinearFit>,
    multilinear: Option<MultilinearFit>,
    remarks: Vec<String>,
}

struct Ramp {
    steps: Vec<RampStep>,
    /// The reading before the first increment of each repeat.
    before: Vec<RampStep>,
    /// Dwells of the first repeat, if they are recorded.
    holds: Vec<Hold>,
    /// The same with the arrival of the actuator.
    arriving: Vec<Arriving>,
    /// Laboratory time of the last reading before a move \[s\].
    last_reading: f64,
}

/// How a target is approached and read.
#[derive(Clone, Copy)]
struct Manner {
    samples: u32,
    /// \[s\]
    pause: f64,
    /// \[m/s\]
    speed: Option<f64>,
}

/// One target of a ramp.
struct Target {
    /// \[m\]
    command: f64,
    /// Whether it is on the way back.
    returning: bool,
    /// The reading at the target before.
    before: Option<Point>,
}

impl Ramp {
    fn run(
        &mut self,
        plan: &StiffnessRamp,
        inputs: &mut Inputs<'_>,
        session: &mut Session<'_>,
    ) -> Result<(), Stop> {
        let displacements = inputs.list(&schema::DISPLACEMENTS, &plan.displacements)?;
        let manner = Manner {
            samples: plan.samples,
            pause: inputs.number(&schema::PAUSE, &plan.pause)?,
            speed: inputs.speed(plan.speed.as_ref())?,
        };
        let home = session.commanded();
        for repeat in 0..plan.repeats {
            let start = session.read()?;
            self.last_reading = session.guard.time();
            let asked = plan.relaxation.filter(|_| repeat == 0);
            let reading = DwellReadings::single(start, self.last_reading);
            self.before
                .push(row(self.steps.len() as u64, home, &reading));
            let mut before = None;
            let outwards = displacements.iter().map(|command| (*command, false));
            let return_steps = displacements
                .iter()
                .rev()
                .skip(1)
                .copied()
                .chain(std::iter::once(home))
                .filter(|_| plan.return_path)
                .map(|command| (command, true));
            for (command, returning) in outwards.chain(return_steps) {
                let target = Target {
                    command,
                    returning,
                    before,
                };
                before = Some(self.step(&target, manner, asked, session)?);
            }
            if !plan.return_path {
                session.go_to(home, manner.speed)?;
            }
        }
        Ok(())
    }

    /// Moves, settles, reads once for the relaxation, pauses, reads the samples.
    fn step(
        &mut self,
        target: &Target,
        manner: Manner,
        asked: Option<WatchedHold>,
        session: &mut Session<'_>,
    ) -> Result<Point, Stop> {
        let Target {
            command,
            returning,
            before,
        } = *target;
        let reached = session.guard.move_to(&[command], manner.speed);
        let (settled, moved, broken) = match asked {
            Some(_) => session.read_moved_after(reached)?,
            None => session
                .read_after(reached)
                .map(|(reading, broken)| (reading, None, broken))?,
        };
        let watched = asked
            .filter(|_| broken.is_none())
            .map(|asked| hold::watched(&settled, manner.pause, asked.readings, session))
            .transpose()?;
        // A hold that is read includes the pause.
        let pause = if watched.is_some() { 0.0 } else { manner.pause };
        let dwell = DwellReadings::take(&settled, broken, pause, manner.samples, session)?;
        let read = row(self.steps.len() as u64 + 1, command, &dwell);
        if let Some(watched) = watched {
            let [waited_for, moved_for, settled_for] =
                hold::parts(self.last_reading, moved, settled.time);
            let hold = Hold {
                step: read.step,
                displacement: read.displacement,
                waited_for,
                moved_for,
                settled_for,
                readings: watched.readings.clone(),
            };
            let from = before.or(self.before.last().map(point)).unwrap_or_default();
            let resolution = session.guard.declared_noise().resolution;
            self.holds.push(hold.clone());
            self.arriving
                .push(Arriving::new(hold, &watched, from, resolution));
            self.last_reading = watched.last;
        }
        self.steps.push(RampStep {
            tangent_stiffness: before.and_then(|before| secant(before, point(&read))),
            returning,
            ..read
        });
        if let Some(stop) = dwell.broken {
            return Err(stop);
        }
        session.measured(read.step, read.wall_time, point(&read))?;
        Ok(point(&read))
    }
}

/// One line R = intercept + K·X over the outward steps of all repeats. Two or more lines through those of the first repeat only:
/// after yielding the curve no longer has the same bend.
fn fits(steps: &[RampStep], plan: &StiffnessRamp, stated: StatedVariance) -> Fits {
    let first = || steps.iter().take(plan.displacements.len()).map(point);
    match plan.fit {
        RampFit::Linear => {
            let (x, r): (Vec<f64>, Vec<f64>) = steps
                .iter()
                .filter(|step| !step.returning)
                .map(point)
                .unzip();
            let line = fit_line(&x, &r).map(|fit| fit.stated(&x, stated, fit.slope));
            let remarks = line
                .as_ref()
                .and_then(|line| curve::bends(&first().collect::<Vec<Point>>(), line));
            Fits {
                line,
                remarks: remarks.into_iter().collect(),
                ..Fits::default()
            }
        }
        RampFit::Bilinear => {
            let (x, r): (Vec<f64>, Vec<f64>) = first().unzip();
            let bilinear = fit_bilinear(&x, &r, stated);
            let none =
                "no bilinear fit: the outward steps are fewer than six, or show no yield point";
            let remarks = if bilinear.is_none() {
                vec![none.to_owned()]
            } else {
                Vec::new()
            };
            Fits {
                bilinear,
                remarks,
                ..Fits::default()
            }
        }
        RampFit::Multilinear(count) => {
            let (multilinear, remarks) = curve::fitted(
                &first().collect::<Vec<Point>>(),
                count,
                "outward steps",
                stated,
            );
            Fits {
                multilinear,
                remarks,
                ..Fits::default()
            }
        }
    }
}

/// A row of the table, without a step before it.
const fn row(step: u64, command: f64, read: &DwellReadings) -> RampStep {
    RampStep {
        step,
        wall_time: read.wall_time,
        command,
        displacement: read.displacement,
        restoring_force: read.restoring_force,
        force_scatter: read.force_scatter,
        relaxation: read.relaxation,
        tangent_stiffness: None,
        returning: false,
    }
}

/// In the order of the reference; `direct` are the results that are read without a fit.
fn results(direct: &Direct, fits: &Fits) -> Vec<NamedResult> {
    let Fits {
        line: fit,
        bilinear,
        multilinear,
        ..
    } = fits;
    let (fit, bilinear, multilinear) = (fit.as_ref(), bilinear.as_ref(), multilinear.as_ref());
    let with_error = |(value, error): (f64, f64)| (value, Some(error));
    let stiffness = fit.map(|fit| (fit.slope, fit.slope_error));
    let stiffness = stiffness.or(bilinear.map(|fit| (fit.stiffness, fit.stiffness_error)));
    let stiffness = stiffness
        .or(multilinear.map(|fit| fit.stiffnesses[0]))
        .map(with_error);
    let intercept = fit.map(|fit| (fit.intercept, fit.intercept_error));
    let intercept = intercept.or(bilinear.map(|fit| (fit.intercept, fit.intercept_error)));
    let intercept = intercept
        .or(multilinear.map(|fit| fit.intercept))
        .map(with_error);
    let r_squared = fit
        .map(|fit| fit.r_squared)
        .or(bilinear.map(|fit| fit.r_squared));
    let r_squared = r_squared.or(multilinear.map(|fit| fit.r_squared));
    let of = |value: fn(&BilinearFit) -> (f64, f64)| bilinear.map(value).map(with_error);
    let mut results = vec![
        schema::STIFFNESS.found_with(stiffness),
        schema::SECANT_STIFFNESS.found(direct.secant_stiffness),
        schema::INTERCEPT_FORCE.found_with(intercept),
        schema::R_SQUARED.found(r_squared),
        schema::MAX_FORCE.found(direct.max_force),
        schema::MAX_DISPLACEMENT.found(direct.max_displacement),
        schema::LOOP_ENERGY.found(direct.loop_energy),
        schema::RELAXATION.found(direct.relaxation),
        schema::TANGENT_STIFFNESS.found(direct.tangent_stiffness),
    ];
    if bilinear.is_some() {
        results.extend([
            schema::YIELD_FORCE.found_with(of(|fit| (fit.yield_force, fit.yield_force_error))),
            schema::YIELD_DISPLACEMENT.found_with(of(|fit| {
                (fit.yield_displacement, fit.yield_displacement_error)
            })),
            schema::POST_YIELD_STIFFNESS.found_with(of(|fit| {
                (fit.post_yield_stiffness, fit.post_yield_stiffness_error)
            })),
            schema::POST_YIELD_RATIO
                .found_with(of(|fit| (fit.post_yield_ratio, fit.post_yield_ratio_error))),
        ]);
    } else {
        results.extend(curve::yielding(multilinear));
    }
    results.extend(curve::lists(multilinear));
    results
}
