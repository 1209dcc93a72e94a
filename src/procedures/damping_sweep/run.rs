//! `damping sweep` (Melo et al. 2006, sec. 6 (b)): constant-velocity passes over one stroke and back, at increasing velocities.
//! In: velocities, stroke, the K of an earlier ramp. Out: c and the Coulomb force by `F_d = R − K·X = c·v + F_c·sign v`.
//!
//! X and R are as measured, X from the rig's zero. A zero offset of the load cell adds the same force to both directions at one position.
//! The fit uses half the difference between a reading and the one at the same position on the return. The offset therefore does not
//! affect c, `F_c` or their standard errors. The K of the plan does not affect them either. A lagging actuator is behind in both
//! directions: the distance between the two positions of a pair is corrected with the stiffness of the strokes themselves, whose error
//! contributes to c. The velocity of a pair is that of the lagging actuator. Yielding of the specimen does not affect them: with `about`, one unread stroke precedes the first that is read, and
//! a stroke with plastic deformation is left out.
//!
//! A rig that reads at the requested times has nearly the same positions out and back. For a rig that reads at its own times, the
//! measured fraction of the stroke determines the steady part. The pass with fewer readings is then paired with the other one
//! interpolated.

use std::ops::Range;

use super::findings::{Findings, RatioOf};
use super::pairing::{Paired, paired_by_position, paired_by_time};
use super::sweep::{Stroke, Sweep};
use crate::procedures::common::results::largest;
use crate::run::Performed;
use crate::run::inputs::Inputs;
use crate::run::session::{Session, first};
use crate::run::stop::Stop;
use psd_physics::identification::damping_strokes::OutAndBack;
use psd_physics::identification::{StatedVariance, damping_ratio, fit_damping, fit_line};
use psd_physics::structure::Matrices;
use psd_plan::formula::Estimate;
use psd_plan::procedures::damping_sweep::block as schema;
use psd_plan::record::{
    BroughtTogether, DampingSweepHistory, EventKind, History, LineFit, NamedResult, SweepStep,
};
use psd_plan::uncertainty::InstrumentUncertainty;
use psd_plan::{DampingSweep, Plan};
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// Part of the stroke left out at either end: the actuator starts and stops there.
const END: f64 = 0.1;

/// Time constants of the actuator left out at the start: the piston then moves within 1 % of the commanded velocity, also after a
/// reversal (2·exp(−5)). Three would leave a tenth, and bias c.
const LAGS: f64 = 5.0;

/// Readings on the steady part if the plan gives no rate.
const STEADY_SAMPLES: f64 = 50.0;

/// Readings of one pass, at most.
pub const MOST_SAMPLES: f64 = 1e6;

pub(crate) fn perform(
    plan: &DampingSweep,
    whole: &Plan,
    inputs: &mut Inputs<'_>,
    session: &mut Session<'_>,
) -> Performed {
    // A real actuator ends each stroke at the commanded velocity, or its firmware reports an error: its lag is not known here.
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
    let mut paired = sweep.paired();
    if sweep.lag > 0.0
        && let Some(fit) = sweep.line(&paired).1
    {
        // The stiffness of the strokes is read at different speeds out and back. Its effect on c is thereby of second order.
        for pair in paired.iter_mut().flat_map(|(_, pairs)| pairs) {
            *pair = pair.at_one_speed(fit.slope);
        }
    }
    let findings = sweep.findings(&paired);
    let kept = || findings.kept(&paired);
    let stiffness = sweep.stiffness_of(&findings);
    let (pairs, fit) = sweep.line(&paired);
    let together = BroughtTogether {
        stiffness,
        error: findings.stiffness.map(|(_, error)| error),
        effects: effects_of_stiffness(kept().flat_map(|(_, pairs)| pairs)),
    };
    let instruments = InstrumentUncertainty::of(whole, session.guard.declared_noise(), 1);
    // With a lag, or readings at other times than requested, the displacements out and back differ.
    let apart = whole.rig.link.as_real().is_some() || together.effects != [0.0; 2];
    let of_reading = instruments.stated_variance(0, 1);
    let force = 0.5 * of_reading.about(if apart { stiffness } else { 0.0 });
    let stated = StatedVariance {
        force,
        displacement: 0.0,
        ..of_reading
    };
    let fit = fit.map(|fit| of_readings(fit, &pairs, stated));
    if fit.is_none() && stop.is_none() {
        let text =
            "damping not evaluated: too few steady readings, or too few velocities, to fit a line"
                .to_owned();
        session.event(EventKind::Remark, text);
    }
    for text in sweep
        .observations(&paired)
        .into_iter()
        .chain(findings.observations)
        .chain(fit.as_ref().and_then(negative))
    {
        session.event(EventKind::Remark, text);
    }
    let results = sweep.results(
        fit.as_ref(),
        findings.ratio_of,
        whole
            .specimens
            .get(plan.specimen)
            .map(|specimen| specimen.mass),
    );
    let own_stiffness = if let RatioOf::Strokes(own) = findings.ratio_of {
        Some(own)
    } else {
        None
    };
    let history = DampingSweepHistory {
        steps: sweep.steps,
        pairs,
        together,
        own_stiffness,
        fit,
    };
    Performed {
        history: History::DampingSweep(history),
        results,
        stop,
    }
}

/// Observes negative damping, which would release energy.
fn negative(fit: &LineFit) -> Option<String> {
    (fit.slope + fit.slope_error < 0.0).then(|| {
        let damping = readable(fit.slope, Dimension::DAMPING);
        format!("c = {damping} is negative, which no specimen can have: the change between the strokes is not damping")
    })
}

fn steady_from(seconds: f64, lag: f64) -> f64 {
    END.max(LAGS * lag / seconds)
}

/// Readings of one pass that takes `seconds`, at a rate \[Hz\] or by the default.
pub(crate) fn wanted(seconds: f64, lag: f64, rate: Option<f64>) -> f64 {
    let steady = 1.0 - END - steady_from(seconds, lag);
    match rate {
        Some(rate) => (rate * seconds).round().max(1.0),
        // One more: the first steady reading may just miss the beginning of the steady part.
        None if steady > 0.0 => (STEADY_SAMPLES / steady).ceil() + 1.0,
        None => STEADY_SAMPLES,
    }
}

/// `stated`: the variance of half the difference of two readings.
fn of_readings(fit: LineFit, pairs: &[(f64, f64)], stated: StatedVariance) -> LineFit {
    let speeds: Vec<f64> = pairs
        .iter()
        .map(|(velocity, _)| velocity.abs())
        .filter(|speed| *speed != 0.0)
        .collect();
    fit.stated(&speeds, stated, 0.0)
}

/// ∂c/∂K \[s\] and ∂F_c/∂K \[m\], with K the stiffness that corrects the readings of each pair to one position.
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
    // Strokes at one velocity determine no line.
    fit_line(&speeds, &apart).map_or([0.0; 2], |line| [-line.slope, -line.intercept])
}

/// A commanded constant-velocity pass.
#[derive(Clone, Copy)]
struct Pass {
    /// \[m\]
    from: f64,
    to: f64,
    /// With its sign \[m/s\].
    velocity: f64,
    /// \[s\]
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
        let velocities = inputs.list(&schema::VELOCITIES, &plan.velocities)?;
        let stroke = inputs.number(&schema::STROKE, &plan.stroke)?;
        let stiffness = inputs.estimate(&schema::STIFFNESS, &plan.stiffness, None)?;
        let rate = plan
            .rate
            .as_ref()
            .map(|rate| inputs.number(&schema::RATE, rate))
            .transpose()?;
        self.stiffness = Some(stiffness);
        if let Some(about) = &plan.about {
            let middle = inputs.number(&schema::ABOUT, about)?;
            // Plastic deformation of the first stroke occurs before anything is read.
            session.go_to(middle + 0.5 * stroke, None)?;
            session.go_to(middle - 0.5 * stroke, None)?;
        }
        let home = session.commanded();
        for velocity in velocities {
            let seconds = stroke / velocity;
            let samples = self.samples(seconds, rate)?;
            let out_pass = Pass {
                from: home,
                to: home + stroke,
                velocity,
                seconds,
                samples,
            };
            let out = self.traverse(out_pass, session)?;
            let back = self.traverse(
                Pass {
                    from: out_pass.to,
                    to: home,
                    velocity: -velocity,
                    ..out_pass
                },
                session,
            )?;
            let on_grid = self.exact && out.len() == samples && back.len() == samples;
            self.strokes.push(Stroke {
                out,
                back,
                speed: velocity,
                seconds,
                on_grid,
            });
            // A pass ends in motion: the piston stops at home before the next reading or command.
            session.guard.move_to(&[home], None)?;
        }
        Ok(())
    }

    /// Fraction of a pass of `seconds` after which it is steady.
    fn steady_from(&self, seconds: f64) -> f64 {
        steady_from(seconds, self.lag)
    }

    fn samples(&self, seconds: f64, rate: Option<f64>) -> Result<usize, Stop> {
        let wanted = wanted(seconds, self.lag, rate);
        if wanted > MOST_SAMPLES {
            return Err(Stop::bad_input(
                schema::RATE.name,
                wanted,
                Dimension::NUMBER,
                format!("at most {MOST_SAMPLES} readings a stroke"),
            ));
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and MOST_SAMPLES"
        )]
        Ok(wanted as usize)
    }

    /// One pass; the range of steps that it added.
    fn traverse(&mut self, pass: Pass, session: &mut Session<'_>) -> Result<Range<usize>, Stop> {
        let Pass {
            from,
            to,
            velocity,
            seconds,
            samples,
        } = pass;
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
                session.measured(step, reading.time, (displacement, restoring_force))?;
            }
        }
        traversed
            .fault
            .map_or(Ok(began..self.steps.len()), |fault| Err(fault.into()))
    }

    /// Every stroke with its pairs of readings over the part that is steady in both directions.
    fn paired(&self) -> Vec<Paired<'_>> {
        let pairs = |stroke: &Stroke| {
            let (out, back) = (
                &self.steps[stroke.out.clone()],
                &self.steps[stroke.back.clone()],
            );
            if stroke.on_grid {
                paired_by_time(out, back, stroke.seconds, self.lag)
            } else {
                paired_by_position(out, back)
            }
        };
        self.strokes
            .iter()
            .map(|stroke| (stroke, pairs(stroke)))
            .collect()
    }

    /// K that brings the readings of a pair to one position \[N/m\].
    fn stiffness_of(&self, findings: &Findings) -> f64 {
        findings
            .stiffness
            .map_or_else(|| self.planned(), |(stiffness, _)| stiffness)
    }

    /// Velocity \[m/s\] and damping force \[N\] of every pair that counts, and their line.
    fn line(&self, paired: &[Paired<'_>]) -> (Vec<(f64, f64)>, Option<LineFit>) {
        let findings = self.findings(paired);
        let stiffness = self.stiffness_of(&findings);
        let of_history = |pair: &OutAndBack| (pair.velocity, pair.damping_force(stiffness));
        let pairs: Vec<(f64, f64)> = findings
            .kept(paired)
            .flat_map(|(_, pairs)| pairs.iter().map(of_history))
            .collect();
        let (velocities, forces): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
        (pairs, fit_damping(&velocities, &forces))
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
                let ratio_of = |damping| {
                    damping_ratio(&Matrices {
                        mass,
                        damping,
                        stiffness: stiffness.value,
                        gravity: None,
                    })
                };
                let ratio = ratio_of(fit.slope);
                // ζ = c/(2√(KM)): u(ζ)² = (u(c)/(2√(KM)))² + (ζ·u(K)/(2K))².
                let by_damping = ratio_of(fit.slope_error);
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
