//! `damping sweep` (Melo et al. 2006, sec. 6 (b)): traverses of one stroke and back at rising constant velocities.
//! In: velocities, stroke, the K of an earlier ramp. Out: c and the Coulomb force by `F_d = R − K·X = c·v + F_c·sign v`.
//!
//! X and R are as measured, X from the rig's zero. An offset of the cell adds the same to both directions at one place: the fit is
//! of half the difference between a reading and the one at the same place on the way back, so that it does not reach c, `F_c` or
//! their standard errors. Nor does the K of the plan: an actuator that lags reads behind on both ways, and what a pair is apart by
//! is made up for with the stiffness that the strokes show themselves; its error is one of c. Nor does a specimen that flows: about
//! a place, one stroke takes its flow before the first that is read, and one that flowed all the same is left out.
//!
//! A rig that reads at the times it was asked has nearly the same places out and back. One that reads when it can has not: there
//! the measured share of the stroke says what is steady, and the sparser way is paired with the other one interpolated.

use std::ops::Range;

use crate::physics::identification::damping_strokes::{OutAndBack, change_along, own_stiffness};
use crate::physics::identification::{StatedVariance, damping_ratio, fit_damping, fit_line};
use crate::plan::formula::Estimate;
use crate::plan::{DampingSweep, Plan};
use crate::procedures::results::largest;
use crate::record::{
    BroughtTogether, EventKind, History, LineFit, NamedResult, SweepHistory, SweepStep,
};
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::{Session, first};
use crate::run::stop::Stop;
use crate::schema::procedures::damping_sweep as schema;
use crate::uncertainty::InstrumentUncertainty;
use crate::units::Dimension;
use crate::units::display::readable;

/// Part of the stroke left out at either end: the actuator starts and stops there.
const END: f64 = 0.1;

/// Time constants of the actuator left out at the start: the piston then moves within 1 % of the velocity asked for,
/// also after a reversal (2·exp(−5)). Three would leave a tenth, which c would show.
const LAGS: f64 = 5.0;

/// Readings on the steady part where the plan gives no rate.
const STEADY_SAMPLES: f64 = 50.0;

/// Fewer pairs of steady readings than this in a stroke are worth a word.
const FEW: usize = 3;

/// A share of the velocity by which the piston may miss it.
const OFF_SPEED: f64 = 0.05;

/// The strokes have another K than the plan's where the two differ by so many standard errors, and by this share.
const CONTRADICTS: f64 = 5.0;
const OFF_STIFFNESS: f64 = 0.1;

/// Of the largest force: what a stiffness makes of the way is rounding below it.
const ROUNDING: f64 = 1e-9;

/// Readings of one traverse, at most.
pub const MOST_SAMPLES: f64 = 1e6;

pub(crate) fn perform(
    plan: &DampingSweep,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    // A real actuator ends each stroke at the velocity asked for, or its own firmware says so: its lag is not known here.
    let link = whole.rig.link.as_virtual();
    let lag = link.map_or(0.0, |link| link.lag);
    let mut sweep = Sweep {
        steps: Vec::new(),
        strokes: Vec::new(),
        stiffness: None,
        lag,
        exact: link.is_some(),
    };
    let stop = sweep.run(plan, inputs, session).err();
    let paired = sweep.paired();
    let told = sweep.told(&paired);
    let kept = || {
        paired
            .iter()
            .filter(|(stroke, _)| !told.left_out.contains(&stroke.out.start))
    };
    let stiffness = told
        .stiffness
        .map_or_else(|| sweep.planned(), |(stiffness, _)| stiffness);
    let of_history = |pair: &OutAndBack| {
        (
            (pair.velocity, pair.damping_force(stiffness)),
            [pair.place, pair.mean],
        )
    };
    let (pairs, middles): (Vec<(f64, f64)>, Vec<[f64; 2]>) = kept()
        .flat_map(|(_, pairs)| pairs.iter().map(of_history))
        .unzip();
    let together = BroughtTogether {
        stiffness,
        error: told.stiffness.map(|(_, error)| error),
        effects: effects_of_stiffness(kept().flat_map(|(_, pairs)| pairs)),
    };
    let instruments = InstrumentUncertainty::of(whole, session.guard.declared_noise(), 1);
    // Behind by a lag, or read when it can be, the displacement is another one out than back.
    let apart = whole.rig.link.as_real().is_some() || together.effects != [0.0; 2];
    let of_reading = instruments.stated_variance(0, 1);
    let force = 0.5 * of_reading.about(if apart { stiffness } else { 0.0 });
    let stated = StatedVariance {
        force,
        displacement: 0.0,
        ..of_reading
    };
    let fit = fit_of(&pairs, stated);
    if fit.is_none() && stop.is_none() {
        let text =
            "no damping: the steady parts of the strokes hold too few readings, or too few velocities, for a line".to_owned();
        session.event(EventKind::Remark, text);
    }
    for text in sweep
        .remarks(&paired)
        .into_iter()
        .chain(told.remarks)
        .chain(fit.as_ref().and_then(negative))
    {
        session.event(EventKind::Remark, text);
    }
    let results = sweep.results(
        fit.as_ref(),
        told.ratio_of,
        whole
            .specimens
            .get(plan.specimen)
            .map(|specimen| specimen.mass),
    );
    let stiffness = sweep.stiffness.map(|stiffness| stiffness.value);
    let own_stiffness = if let RatioOf::Strokes(own) = told.ratio_of {
        Some(own)
    } else {
        None
    };
    let history = SweepHistory {
        steps: sweep.steps,
        pairs,
        middles,
        stiffness,
        together,
        own_stiffness,
        fit,
    };
    Performed {
        history: History::Sweep(history),
        results,
        stop,
    }
}

/// Damping that gives energy back is none.
fn negative(fit: &LineFit) -> Option<String> {
    (fit.slope + fit.slope_error < 0.0).then(|| {
        let damping = readable(fit.slope, Dimension::DAMPING);
        format!("c is {damping}, and no specimen gives energy back: what changed between the strokes is not damping")
    })
}

fn steady_from(seconds: f64, lag: f64) -> f64 {
    END.max(LAGS * lag / seconds)
}

/// Readings of one way that takes `seconds`, at a rate (Hz) or by the plan's default.
pub(crate) fn wanted(seconds: f64, lag: f64, rate: Option<f64>) -> f64 {
    let steady = 1.0 - END - steady_from(seconds, lag);
    match rate {
        Some(rate) => (rate * seconds).round().max(1.0),
        // One more, for the first steady reading may just miss the beginning of the steady part.
        None if steady > 0.0 => (STEADY_SAMPLES / steady).ceil() + 1.0,
        None => STEADY_SAMPLES,
    }
}

/// `stated`: of half the difference of two readings.
fn fit_of(pairs: &[(f64, f64)], stated: StatedVariance) -> Option<LineFit> {
    let (velocities, forces): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    let speeds: Vec<f64> = velocities
        .iter()
        .map(|velocity| velocity.abs())
        .filter(|speed| *speed != 0.0)
        .collect();
    fit_damping(&velocities, &forces).map(|fit| fit.stated(&speeds, stated, 0.0))
}

/// ∂c/∂K (s) and ∂F_c/∂K (m), K the stiffness that brings the readings of each pair to one place.
fn effects_of_stiffness<'a>(pairs: impl Iterator<Item = &'a OutAndBack>) -> [f64; 2] {
    let moving = pairs.filter(|pair| pair.velocity != 0.0);
    let (speeds, apart): (Vec<f64>, Vec<f64>) = moving
        .map(|pair| {
            (
                pair.velocity.abs(),
                pair.half_apart * pair.velocity.signum(),
            )
        })
        .unzip();
    // Of strokes at one velocity there is no line.
    fit_line(&speeds, &apart).map_or([0.0; 2], |line| [-line.slope, -line.intercept])
}

/// What strokes tell beside c.
struct Told {
    /// K of the strokes that count and its standard error, N/m, where they show it.
    stiffness: Option<(f64, f64)>,
    /// By their first steps: strokes that flowed, where others did not.
    left_out: Vec<usize>,
    ratio_of: RatioOf,
    remarks: Vec<String>,
}

/// The stiffness that a damping ratio is told with.
#[derive(Clone, Copy)]
enum RatioOf {
    Plan,
    /// K and its standard error, N/m: it is not the plan's.
    Strokes((f64, f64)),
    /// The strokes contradict the plan's, and show none.
    Nothing,
}

/// Steps of one stroke, out and back.
struct Stroke {
    out: Range<usize>,
    back: Range<usize>,
    /// Asked for, m/s.
    speed: f64,
    /// Whether every reading came at the time it was asked for.
    on_grid: bool,
}

struct Sweep {
    steps: Vec<SweepStep>,
    /// The steps of each stroke that came back whole.
    strokes: Vec<Stroke>,
    stiffness: Option<Estimate>,
    /// s
    lag: f64,
    /// Whether the rig keeps the times it is asked for.
    exact: bool,
}

/// One way of a stroke as it is asked for.
#[derive(Clone, Copy)]
struct Way {
    /// m
    from: f64,
    to: f64,
    /// Signed, m/s.
    velocity: f64,
    /// s
    seconds: f64,
    samples: usize,
}

impl Sweep {
    fn run(
        &mut self,
        plan: &DampingSweep,
        inputs: &mut Inputs<'_>,
        session: &mut Session<'_>,
    ) -> Result<(), Stop> {
        let velocities = inputs.list("velocities", &plan.velocities)?;
        let stroke = inputs.number("stroke", &plan.stroke, Dimension::LENGTH)?;
        let stiffness =
            inputs.positive_estimate("stiffness", &plan.stiffness, Dimension::STIFFNESS, None)?;
        let rate = plan
            .rate
            .as_ref()
            .map(|rate| inputs.positive("rate", rate, Dimension::FREQUENCY))
            .transpose()?;
        if stroke == 0.0 {
            return Err(Stop::BadInput {
                field: "stroke",
                value: stroke,
                dimension: Dimension::LENGTH,
                wanted: "other than 0".into(),
            });
        }
        self.stiffness = Some(stiffness);
        if let Some(about) = &plan.about {
            let middle = inputs.number("about", about, Dimension::LENGTH)?;
            // What the specimen flows on the first way out it has flowed before anything is read.
            session.go_to(middle + 0.5 * stroke, None)?;
            session.go_to(middle - 0.5 * stroke, None)?;
        }
        let home = session.commanded();
        for velocity in velocities {
            if velocity == 0.0 {
                return Err(Stop::BadInput {
                    field: "velocities",
                    value: velocity,
                    dimension: Dimension::VELOCITY,
                    wanted: "other than 0".into(),
                });
            }
            let seconds = (stroke / velocity).abs();
            let samples = self.samples(seconds, rate)?;
            let speed = velocity.abs().copysign(stroke);
            let there = Way {
                from: home,
                to: home + stroke,
                velocity: speed,
                seconds,
                samples,
            };
            let out = self.traverse(there, session)?;
            let back = self.traverse(
                Way {
                    from: there.to,
                    to: home,
                    velocity: -speed,
                    ..there
                },
                session,
            )?;
            let on_grid = self.exact && out.len() == samples && back.len() == samples;
            self.strokes.push(Stroke {
                out,
                back,
                speed: speed.abs(),
                on_grid,
            });
            // A traverse ends in motion: the piston comes to rest at home before anything is read or asked of it there.
            session.guard.move_to(&[home], None)?;
        }
        Ok(())
    }

    /// Share of a traverse of `seconds` after which it is steady.
    fn steady_from(&self, seconds: f64) -> f64 {
        steady_from(seconds, self.lag)
    }

    fn samples(&self, seconds: f64, rate: Option<f64>) -> Result<usize, Stop> {
        let wanted = wanted(seconds, self.lag, rate);
        if wanted > MOST_SAMPLES {
            return Err(Stop::BadInput {
                field: "rate",
                value: wanted,
                dimension: Dimension::NUMBER,
                wanted: format!("at most {MOST_SAMPLES} readings a stroke").into(),
            });
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and MOST_SAMPLES"
        )]
        Ok(wanted as usize)
    }

    /// One way of a stroke; the steps it added.
    fn traverse(&mut self, way: Way, session: &mut Session<'_>) -> Result<Range<usize>, Stop> {
        let Way {
            from,
            to,
            velocity,
            seconds,
            samples,
        } = way;
        let began = self.steps.len();
        let stiffness = self.stiffness.map_or(0.0, |estimate| estimate.value);
        let steady_from = self.steady_from(seconds);
        let traversed = session.guard.traverse(&[to], velocity, samples);
        let broken = session.guard.take_broken();
        let whole = traversed.readings.len() - usize::from(broken.is_some());
        for (sample, reading) in (1_u32..).zip(&traversed.readings) {
            let (displacement, restoring_force) = first(reading);
            #[expect(clippy::cast_precision_loss, reason = "far fewer samples than 2^53")]
            let passed = if self.exact {
                f64::from(sample) / samples as f64
            } else {
                (displacement - from) / (to - from)
            };
            let step = self.steps.len() as u64 + 1;
            self.steps.push(SweepStep {
                step,
                wall_time: reading.time,
                velocity,
                displacement,
                restoring_force,
                damping_force: restoring_force - stiffness * displacement,
                steady: steady_from <= passed && passed <= 1.0 - END,
            });
            if sample as usize <= whole {
                session.measured(step, reading.time, displacement, restoring_force)?;
            }
        }
        traversed
            .fault
            .map_or(Ok(began..self.steps.len()), |fault| Err(fault.into()))
    }

    /// Every stroke with its pairs of readings over what is steady on both ways.
    fn paired(&self) -> Vec<Paired<'_>> {
        let pairs = |stroke: &Stroke| {
            let (out, back) = (
                &self.steps[stroke.out.clone()],
                &self.steps[stroke.back.clone()],
            );
            if stroke.on_grid {
                paired_by_time(out, back)
            } else {
                paired_by_place(out, back)
            }
        };
        self.strokes
            .iter()
            .map(|stroke| (stroke, pairs(stroke)))
            .collect()
    }

    /// What a person should know of the readings before believing c.
    fn remarks(&self, paired: &[Paired<'_>]) -> Vec<String> {
        let told = |(stroke, pairs): &Paired<'_>| {
            let pairs = pairs.len();
            let shown = readable(stroke.speed, Dimension::VELOCITY);
            let few = (!stroke.on_grid && pairs < FEW).then(|| {
                format!(
                    "the strokes at {shown} give {pairs} steady pairs of readings: the line is too slow, or the stroke too short"
                )
            });
            let off = [&stroke.out, &stroke.back].into_iter().filter(|_| !stroke.on_grid).find_map(|way| {
                let moved = moved_at(&self.steps[way.clone()])?;
                let error = (moved.slope.abs() - stroke.speed).abs();
                let differs = error > OFF_SPEED * stroke.speed + 3.0 * moved.slope_error;
                let measured = readable(moved.slope.abs(), Dimension::VELOCITY);
                differs.then(|| {
                    format!("by the times of the readings the piston went at {measured}, not at {shown}: c is as wrong as that")
                })
            });
            few.into_iter().chain(off)
        };
        paired.iter().flat_map(told).collect()
    }

    /// What the strokes tell of the specimen beside its damping.
    fn told(&self, strokes: &[Paired<'_>]) -> Told {
        let of_all = own_stiffness(&strokes.iter().map(|(_, pairs)| pairs.as_slice()));
        let of_all = of_all.map_or_else(|| self.planned(), |(stiffness, _)| stiffness);
        let flowed: Vec<(&Stroke, f64)> = strokes
            .iter()
            .filter_map(|(stroke, pairs)| Some((*stroke, change_along(pairs, of_all)?)))
            .collect();
        let all = flowed.len() == strokes.len();
        let mut remarks: Vec<String> = Vec::new();
        for (stroke, change) in &flowed {
            let (speed, change) = (
                readable(stroke.speed, Dimension::VELOCITY),
                readable(*change, Dimension::FORCE),
            );
            let so = if all {
                "c and the Coulomb force are of its loop too"
            } else {
                "it is left out"
            };
            remarks.push(format!(
                "the stroke at {speed} comes back by another way: half of out minus back changes by {change} along it, as of a specimen \
                 that flows; {so}"
            ));
        }
        let left_out: Vec<usize> = flowed
            .iter()
            .filter(|_| !all)
            .map(|(stroke, _)| stroke.out.start)
            .collect();
        let kept = strokes
            .iter()
            .filter(|(stroke, _)| !left_out.contains(&stroke.out.start));
        let stiffness = own_stiffness(&kept.map(|(_, pairs)| pairs.as_slice()));
        let own_stiffness = stiffness.filter(|own| self.contradicts(*own));
        let resists = |(own, error): (f64, f64)| {
            let pairs = || strokes.iter().flat_map(|(_, pairs)| pairs);
            let most = |read: fn(&OutAndBack) -> f64| pairs().map(read).fold(0.0, f64::max);
            let force = most(|pair| pair.mean.abs() + pair.half_difference.abs());
            own > CONTRADICTS * error && own * most(|pair| pair.place.abs()) > ROUNDING * force
        };
        let shown = |stiffness| readable(stiffness, Dimension::STIFFNESS);
        let ratio_of = match own_stiffness.map(|own| (own, resists(own))) {
            None => RatioOf::Plan,
            Some((own, true)) => RatioOf::Strokes(own),
            Some((_, false)) => RatioOf::Nothing,
        };
        let assumed = shown(self.planned());
        match ratio_of {
            RatioOf::Plan => {}
            RatioOf::Strokes((own, _)) => remarks.push(format!(
                "the strokes run at {}, not at the {assumed} of `stiffness`: the damping ratio is told with theirs",
                shown(own)
            )),
            RatioOf::Nothing => {
                remarks
                    .push(format!("the strokes show no stiffness, not the {assumed} of `stiffness`: there is no damping ratio"));
            }
        }
        Told {
            stiffness,
            left_out,
            ratio_of,
            remarks,
        }
    }

    /// K of the plan, N/m.
    fn planned(&self) -> f64 {
        self.stiffness.map_or(0.0, |stiffness| stiffness.value)
    }

    /// Whether the K of the strokes (N/m, with its standard error) is another than the plan's.
    fn contradicts(&self, (own, error): (f64, f64)) -> bool {
        let Some(assumed) = self.stiffness else {
            return false;
        };
        let sure = CONTRADICTS * error.hypot(assumed.uncertainty.unwrap_or(0.0));
        (own - assumed.value).abs() > sure.max(OFF_STIFFNESS * assumed.value)
    }

    fn results(
        &self,
        fit: Option<&LineFit>,
        ratio_of: RatioOf,
        mass: Option<f64>,
    ) -> Vec<NamedResult> {
        let stiffness = match ratio_of {
            RatioOf::Plan => self.stiffness,
            RatioOf::Strokes((value, error)) => Some(Estimate {
                value,
                uncertainty: Some(error),
            }),
            RatioOf::Nothing => None,
        };
        let ratio = fit
            .zip(stiffness)
            .zip(mass)
            .map(|((fit, stiffness), mass)| {
                let ratio = damping_ratio(fit.slope, stiffness.value, mass);
                // ζ = c/(2√(KM)): u(ζ)² = (u(c)/(2√(KM)))² + (ζ·u(K)/(2K))².
                let by_damping = damping_ratio(fit.slope_error, stiffness.value, mass);
                let by_stiffness =
                    ratio * stiffness.uncertainty.unwrap_or(0.0) / (2.0 * stiffness.value);
                (ratio, Some(by_damping.hypot(by_stiffness)))
            });
        vec![
            schema::DAMPING.found_with(fit.map(|fit| (fit.slope, Some(fit.slope_error)))),
            schema::COULOMB_FORCE
                .found_with(fit.map(|fit| (fit.intercept, Some(fit.intercept_error)))),
            schema::R_SQUARED.found(fit.map(|fit| fit.r_squared)),
            schema::DAMPING_RATIO.found_with(ratio),
            schema::MAX_VELOCITY.found(largest(self.steps.iter().map(|step| step.velocity))),
        ]
    }
}

/// A stroke with its pairs of readings.
type Paired<'a> = (&'a Stroke, Vec<OutAndBack>);

/// Pairs of readings at the same place by their times: the last reading of a way is where the next one starts, and has no
/// partner.
fn paired_by_time(out: &[SweepStep], back: &[SweepStep]) -> Vec<OutAndBack> {
    let steady = out
        .iter()
        .zip(back.iter().rev().skip(1))
        .filter(|(out, back)| out.steady && back.steady);
    let pair = |(out, back): (&SweepStep, &SweepStep)| OutAndBack {
        velocity: out.velocity,
        place: 0.5 * (out.displacement + back.displacement),
        half_apart: 0.5 * (out.displacement - back.displacement),
        half_difference: 0.5 * (out.restoring_force - back.restoring_force),
        mean: 0.5 * (out.restoring_force + back.restoring_force),
    };
    steady.map(pair).collect()
}

/// Pairs at the places where the sparser way was read; there the other one lies between two of its readings.
fn paired_by_place(out: &[SweepStep], back: &[SweepStep]) -> Vec<OutAndBack> {
    let steady = |way: &[SweepStep]| {
        let mut way: Vec<SweepStep> = way.iter().filter(|step| step.steady).copied().collect();
        way.sort_by(|one, other| one.displacement.total_cmp(&other.displacement));
        way
    };
    let (out, back) = (steady(out), steady(back));
    let (sparse, dense) = if out.len() <= back.len() {
        (out, back)
    } else {
        (back, out)
    };
    let pair = |step: &SweepStep| {
        let other = interpolated(&dense, step.displacement)?;
        Some(OutAndBack {
            velocity: step.velocity,
            place: step.displacement,
            half_apart: 0.0,
            half_difference: 0.5 * (step.restoring_force - other),
            mean: 0.5 * (step.restoring_force + other),
        })
    };
    sparse.iter().filter_map(pair).collect()
}

/// Force (N) at `place` (m) between the two readings about it, which are sorted by place.
fn interpolated(steps: &[SweepStep], place: f64) -> Option<f64> {
    let after = steps.iter().position(|step| step.displacement >= place)?;
    let above = steps[after];
    if above.displacement == place {
        return Some(above.restoring_force);
    }
    let below = steps[after.checked_sub(1)?];
    let share = (place - below.displacement) / (above.displacement - below.displacement);
    Some(below.restoring_force + share * (above.restoring_force - below.restoring_force))
}

/// Measured place over time on the steady part: its slope is the velocity, m/s.
fn moved_at(way: &[SweepStep]) -> Option<LineFit> {
    let steady = way.iter().filter(|step| step.steady);
    let (times, places): (Vec<f64>, Vec<f64>) = steady
        .map(|step| (step.wall_time, step.displacement))
        .unzip();
    fit_line(&times, &places)
}
