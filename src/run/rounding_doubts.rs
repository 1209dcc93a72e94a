//! What the rounding of its readings leaves open of a fit, beyond what their scatter about it shows: on a quiet rig with a coarse
//! quantum they may lie on one line to the last digit, and that line is not the specimen's. In: what was recorded, what the rig
//! declares. Out: contributions. Nothing is read again, and no fit is changed.

use nalgebra::DMatrix;

use super::hold_rounding::of_holds;
use super::propagation::quanta;
use crate::formula::{ProcedureId, ResultValue};
use crate::mechanics::breaks::row;
use crate::mechanics::identification::fit_line;
use crate::mechanics::relaxation_law::RelaxationLaw;
use crate::mechanics::rounding::{Rounded, along, line_weights};
use crate::plan::{Plan, ProcedureKind};
use crate::record::{BilinearFit, History, LineFit, MultilinearFit, NamedResult, RampStep, SweepHistory};
use crate::rig::DeclaredNoise;
use crate::uncertainty::{Contribution, Source};

/// What a reading may be off by: its noise (N), and the quanta of force (N) and displacement (m).
#[derive(Clone, Copy, Debug)]
pub(super) struct Quanta {
    pub noise: f64,
    pub force: f64,
    pub displacement: f64,
}

/// Covariance of two numbers of a fit.
type Covariance = [[f64; 2]; 2];

/// Adds to fitted results what rounding makes of them; their contributions so far are what the scatter shows.
pub(super) fn widen(
    kind: &ProcedureKind,
    history: &History,
    plan: &Plan,
    (procedure, declared): (ProcedureId, DeclaredNoise),
    results: &mut [NamedResult],
) {
    let quanta = quanta(plan, declared, 0);
    if quanta.force == 0.0 && quanta.displacement == 0.0 {
        return;
    }
    let doubts = Doubts { quanta, procedure };
    match (kind, history) {
        (ProcedureKind::StiffnessRamp(asked), History::Ramp(ramp)) => {
            let outward: Vec<&RampStep> = ramp.steps.iter().filter(|step| !step.returning).collect();
            if let Some(fit) = &ramp.fit {
                let found = doubts.ramp(fit, &outward, asked.samples);
                doubts.give_line(["stiffness", "intercept_force"], fit, found, results);
            }
            let first = &outward[..asked.displacements.len().min(outward.len())];
            let bilinear = ramp.bilinear.as_ref().map(Curve::of_bilinear);
            if let Some(curve) = bilinear.or_else(|| ramp.multilinear.as_deref().map(Curve::of_multilinear)) {
                let points: Vec<[f64; 2]> = first.iter().map(|step| [step.command, step.displacement]).collect();
                doubts.give_curve(&curve, &points, asked.samples, results);
            }
            for (name, variance, own) in of_holds(ramp, quanta, results) {
                doubts.add(results, name, 0, &[(name, (variance - own * own).max(0.0).sqrt())]);
            }
        }
        (ProcedureKind::Cycle(asked), History::Cycle(cycle)) => {
            if let Some(mut curve) = cycle.backbone.as_ref().map(Curve::of_multilinear) {
                // Its stiffness is that of its loops.
                curve.told.retain(|(name, ..)| !["stiffness", "intercept_force"].contains(name));
                let points: Vec<[f64; 2]> = cycle.backbone_points().iter().map(|(place, _)| [*place, *place]).collect();
                doubts.give_curve(&curve, &points, if asked.rate.is_some() { 1 } else { asked.samples }, results);
            }
        }
        (ProcedureKind::DampingSweep(_), History::Sweep(sweep)) => {
            if let Some(fit) = &sweep.fit {
                let real = plan.rig.link.as_real().is_some();
                let found = doubts.sweep(fit, sweep, real);
                doubts.give_line(["damping", "coulomb_force"], fit, found, results);
            }
        }
        _ => {}
    }
}

/// Lets the errors of the fits, as figures and reports tell them, be no less than what rounding makes of the results.
pub(super) fn floor(history: &mut History, results: &[NamedResult]) {
    let widened = |error: &mut f64, name: &str| {
        let parts = results.iter().filter(|result| result.name == name).flat_map(|result| &result.contributions);
        let rounding = parts.filter(|part| matches!(part.source, Source::Rounding { .. }));
        *error = error.hypot(rounding.map(|part| part.amount * part.amount).sum::<f64>().sqrt());
    };
    match history {
        History::Ramp(ramp) => {
            if let Some(fit) = &mut ramp.fit {
                widened(&mut fit.slope_error, "stiffness");
                widened(&mut fit.intercept_error, "intercept_force");
            }
            if let Some(fit) = &mut ramp.bilinear {
                widened(&mut fit.stiffness_error, "stiffness");
                widened(&mut fit.yield_force_error, "yield_force");
            }
            if let Some(fit) = &mut ramp.relaxation {
                widened(&mut fit.time_constant.1, "time_constant");
                widened(&mut fit.remaining.1, "remaining_relaxation");
                for (part, name) in
                    [(&mut fit.relaxed_stiffness, "relaxed_stiffness"), (&mut fit.branch_stiffness, "branch_stiffness")]
                {
                    if let Some((_, error)) = part {
                        widened(error, name);
                    }
                }
            }
            if let Some(fit) = ramp.reached.as_mut().and_then(|fit| fit.fits.first_mut()) {
                let time = if fit.law == RelaxationLaw::Exponential { "time_constant" } else { "reference_time" };
                widened(&mut fit.share.1, "relaxation_share");
                widened(&mut fit.time.1, time);
                widened(&mut fit.rate.1, "relaxation_rate");
            }
            if let Some((_, error)) = ramp.multilinear.as_mut().and_then(|fit| fit.stiffnesses.first_mut()) {
                widened(error, "stiffness");
            }
        }
        History::Sweep(sweep) => {
            if let Some(fit) = &mut sweep.fit {
                widened(&mut fit.slope_error, "damping");
                widened(&mut fit.intercept_error, "coulomb_force");
            }
        }
        _ => {}
    }
}

struct Doubts {
    quanta: Quanta,
    procedure: ProcedureId,
}

impl Doubts {
    /// Readings at these places (m), of which these forces (N) are foretold: of the forces and of the displacements, each with its
    /// quantum. A line may rise by a quantum more or less from end to end than it seems to, and so may the way itself.
    fn rounded(&self, places: &[f64], forces: &[f64], samples: u32) -> [(Rounded, f64); 2] {
        let Quanta { noise, force, displacement } = self.quanta;
        let of = |values: &[f64], quantum: f64, noise: f64| {
            // Without a quantum there is nothing to count in.
            let each = if quantum > 0.0 { 1.0 / quantum } else { 0.0 };
            let counted = values.iter().map(|value| value * each).collect();
            (Rounded { places: counted, open: vec![along(places)], noise: noise * each, samples }, quantum)
        };
        [of(forces, force, noise), of(places, displacement, 0.0)]
    }

    /// Slope and intercept of the line of a ramp. A displacement that is off by e puts its force off the line by −K·e.
    fn ramp(&self, fit: &LineFit, steps: &[&RampStep], samples: u32) -> Covariance {
        let places: Vec<f64> = steps.iter().map(|step| step.command).collect();
        let forces: Vec<f64> = places.iter().map(|x| fit.intercept + fit.slope * x).collect();
        let [slope, intercept] = line_weights(&steps.iter().map(|step| step.displacement).collect::<Vec<f64>>());
        let [(force, newtons), (displacement, metres)] = self.rounded(&places, &forces, samples);
        plus(
            times(newtons * newtons, force.covariance(&slope, &intercept)),
            times((fit.slope * metres).powi(2), displacement.covariance(&slope, &intercept)),
        )
    }

    /// Slope and intercept of the line of a sweep, of half the differences of two readings at one place. A rig that keeps its times
    /// reads the displacement at one place alike on both ways; one that reads when it can rounds each by itself.
    fn sweep(&self, fit: &LineFit, sweep: &SweepHistory, real: bool) -> Covariance {
        let moving = || sweep.pairs.iter().zip(smooth(sweep)).filter(|((velocity, _), _)| *velocity != 0.0);
        let speeds: Vec<f64> = moving().map(|((velocity, _), _)| velocity.abs()).collect();
        let both = |of: &dyn Fn(usize) -> f64, sign: f64| -> Vec<f64> {
            (0..speeds.len()).map(of).chain((0..speeds.len()).map(|pair| sign * of(pair))).collect()
        };
        let middles: Vec<[f64; 2]> = moving().map(|(_, middle)| middle).collect();
        let damping = both(&|pair| fit.intercept + fit.slope * speeds[pair], -1.0);
        let middle = both(&|pair| middles[pair][1], 1.0);
        let forces: Vec<f64> = middle.iter().zip(&damping).map(|(middle, damping)| middle + damping).collect();
        let places = both(&|pair| middles[pair][0], 1.0);
        let [slope, intercept] = line_weights(&speeds);
        let halved = |weights: &[f64]| both(&|pair| 0.5 * weights[pair], -1.0);
        let [slope, intercept] = [halved(&slope), halved(&intercept)];
        let [(mut force, newtons), (mut displacement, metres)] = self.rounded(&places, &forces, 1);
        let faster = along(&speeds);
        force.open.push(both(&|pair| faster[pair], -1.0));
        displacement.noise = f64::INFINITY;
        // Behind by a lag, it reads other places out than back.
        let apart = real || sweep.together.effects != [0.0; 2];
        let of_displacement = if apart { (sweep.together.stiffness * metres).powi(2) } else { 0.0 };
        plus(
            times(newtons * newtons, force.covariance(&slope, &intercept)),
            times(of_displacement, displacement.covariance(&slope, &intercept)),
        )
    }

    /// The rest of what rounding makes of slope and intercept where their scatter does not show it; both share as much of it as
    /// of the whole.
    fn give_line(&self, [slope, intercept]: [&'static str; 2], fit: &LineFit, found: Covariance, results: &mut [NamedResult]) {
        let rest = |variance: f64, own: f64| (variance - own * own).max(0.0).sqrt();
        let of_slope = rest(found[0][0], fit.slope_error);
        let of_intercept = rest(found[1][1], fit.intercept_error);
        let both = (found[0][0] * found[1][1]).sqrt();
        let shared = if both > 0.0 { (found[0][1] / both).clamp(-1.0, 1.0) } else { 0.0 };
        self.add(results, slope, 0, &[(slope, of_slope)]);
        self.add(
            results,
            intercept,
            0,
            &[(slope, shared * of_intercept), (intercept, (1.0 - shared * shared).max(0.0).sqrt() * of_intercept)],
        );
    }

    /// The same of every number of a curve, each by itself; its points are where the actuator was told to be, and was read, m.
    fn give_curve(&self, curve: &Curve, points: &[[f64; 2]], samples: u32, results: &mut [NamedResult]) {
        let places: Vec<f64> = points.iter().map(|[place, _]| curve.way * place).collect();
        let read: Vec<f64> = points.iter().map(|[_, read]| curve.way * read).collect();
        let Some(weights) = curve.weights(&read) else { return };
        let forces: Vec<f64> = places.iter().map(|x| curve.force(*x)).collect();
        let [(force, newtons), (displacement, metres)] = self.rounded(&places, &forces, samples);
        // A displacement that is off by e puts its force off the curve by the slope there times e.
        let slopes: Vec<f64> = read.iter().map(|x| curve.slope(*x)).collect();
        for (name, entry, effect, own) in curve.numbers() {
            let of_force: Vec<f64> = (0..read.len()).map(|reading| weight(&effect, &weights, reading)).collect();
            let of_displacement: Vec<f64> = of_force.iter().zip(&slopes).map(|(weight, slope)| weight * slope).collect();
            let variance =
                newtons * newtons * force.variance(&of_force) + metres * metres * displacement.variance(&of_displacement);
            self.add(results, name, entry, &[(name, (variance - own * own).max(0.0).sqrt())]);
        }
    }

    fn add(&self, results: &mut [NamedResult], name: &'static str, entry: usize, parts: &[(&'static str, f64)]) {
        let Some(result) = results.iter_mut().find(|result| result.name == name) else { return };
        // Of a result that does not exist nothing is uncertain.
        if matches!(result.value, ResultValue::Number { value: None, .. }) {
            return;
        }
        let procedure = self.procedure;
        let told = parts.iter().filter(|(_, amount)| *amount != 0.0);
        result.contributions.extend(told.map(|(of, amount)| Contribution {
            entry,
            ..Contribution::new(Source::Rounding { procedure, result: of, entry }, *amount)
        }));
    }
}

fn times(by: f64, covariance: Covariance) -> Covariance {
    covariance.map(|row| row.map(|cell| by * cell))
}

fn plus(one: Covariance, other: Covariance) -> Covariance {
    [0, 1].map(|row: usize| [0, 1].map(|column: usize| one[row][column] + other[row][column]))
}

/// Place (m) and mean force (N) of each pair on the line through those of its stroke, for their own are rounded.
fn smooth(sweep: &SweepHistory) -> Vec<[f64; 2]> {
    let mut smoothed = Vec::with_capacity(sweep.pairs.len());
    let mut first = 0;
    while first < sweep.pairs.len() {
        // A stroke goes on and on from where it began.
        let far = |pair: usize| (sweep.middles[pair][0] - sweep.middles[first][0]).abs();
        let same = |pair: usize| sweep.pairs[pair].0 == sweep.pairs[first].0 && far(pair) >= far(pair - 1);
        let after = (first + 1..sweep.pairs.len()).find(|pair| !same(*pair)).unwrap_or(sweep.pairs.len());
        let middles = &sweep.middles[first..after];
        first = after;
        #[expect(clippy::cast_precision_loss, reason = "at most MOST_SAMPLES")]
        let order: Vec<f64> = (0..middles.len()).map(|place| place as f64).collect();
        let lines = [0, 1].map(|part: usize| fit_line(&order, &middles.iter().map(|middle| middle[part]).collect::<Vec<f64>>()));
        let on = |place: usize, part: usize| {
            lines[part].map_or(middles[place][part], |line| line.intercept + line.slope * order[place])
        };
        smoothed.extend((0..middles.len()).map(|place| [on(place, 0), on(place, 1)]));
    }
    smoothed
}

/// Straight stretches that meet, turned so that the ramp pushes, with the standard errors that its scatter tells.
pub(super) struct Curve {
    way: f64,
    intercept: f64,
    slopes: Vec<f64>,
    breaks: Vec<f64>,
    /// Name, entry of a list, effects of intercept, stiffnesses and breaks, and standard error.
    told: Vec<Told>,
}

/// A number that a curve gives.
type Told = (&'static str, usize, Vec<f64>, f64);

impl Curve {
    pub(super) fn of_bilinear(fit: &BilinearFit) -> Self {
        let (way, knee) = (fit.way, fit.way * fit.yield_displacement);
        let (first, last) = (fit.stiffness, fit.hardened);
        let told = [
            ("stiffness", [0.0, 1.0, 0.0, 0.0], fit.stiffness_error),
            ("intercept_force", [1.0, 0.0, 0.0, 0.0], fit.intercept_error),
            ("hardened_stiffness", [0.0, 0.0, 1.0, 0.0], fit.hardened_error),
            ("yield_displacement", [0.0, 0.0, 0.0, 1.0], fit.yield_displacement_error),
            ("yield_force", [1.0, knee, 0.0, first], fit.yield_force_error),
            ("hardening", [0.0, -last / (first * first), 1.0 / first, 0.0], fit.hardening_error),
        ];
        let told = told.into_iter().map(|(name, effect, own)| (name, 0, effect.to_vec(), own)).collect();
        Self { way, intercept: way * fit.intercept, slopes: vec![first, last], breaks: vec![knee], told }
    }

    pub(super) fn of_multilinear(fit: &MultilinearFit) -> Self {
        let way = fit.way;
        let breaks: Vec<f64> = fit.breaks.iter().map(|(place, _)| way * place).collect();
        let slopes: Vec<f64> = fit.stiffnesses.iter().map(|(slope, _)| *slope).collect();
        let mut curve = Self { way, intercept: way * fit.intercept.0, slopes, breaks, told: Vec::new() };
        let (count, size) = (curve.breaks.len(), 2 * curve.breaks.len() + 2);
        let unit = |of: usize| (0..size).map(|place| if place == of { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        let at_break = |index: usize| {
            let mut effect: Vec<f64> = curve.effects(curve.breaks[index]);
            effect[count + 2 + index] = curve.slopes[index];
            effect
        };
        let (first, last) = (curve.slopes[0], curve.slopes[count]);
        let mut ratio = unit(size);
        ratio[1] -= last / (first * first);
        ratio[count + 1] += 1.0 / first;
        let mut told: Vec<Told> =
            vec![("stiffness", 0, unit(1), fit.stiffnesses[0].1), ("intercept_force", 0, unit(0), fit.intercept.1)];
        if let Some(knee) = curve.slopes.windows(2).position(|pair| pair[1] < pair[0]) {
            told.push(("yield_displacement", 0, unit(count + 2 + knee), fit.breaks[knee].1));
            told.push(("yield_force", 0, at_break(knee), fit.forces[knee].1));
        }
        told.push(("hardened_stiffness", 0, unit(count + 1), fit.stiffnesses[count].1));
        told.push(("hardening", 0, ratio, fit.hardening.1));
        for index in 0..=count {
            told.push(("curve_stiffnesses", index, unit(index + 1), fit.stiffnesses[index].1));
        }
        for index in 0..count {
            told.push(("breaks", index, unit(count + 2 + index), fit.breaks[index].1));
            told.push(("break_forces", index, at_break(index), fit.forces[index].1));
        }
        curve.told = told;
        curve
    }

    /// 1, or −1 of a curve that pulls.
    pub(super) const fn way(&self) -> f64 {
        self.way
    }

    fn numbers(&self) -> impl Iterator<Item = Told> {
        self.told.iter().cloned()
    }

    /// What intercept, stiffnesses and breaks do to the force at `x`.
    pub(super) fn effects(&self, x: f64) -> Vec<f64> {
        let falls = self.breaks.iter().zip(self.slopes.windows(2));
        let beyond = falls.map(|(place, pair)| if x > *place { pair[0] - pair[1] } else { 0.0 });
        row(x, &self.breaks).chain(beyond).collect()
    }

    pub(super) fn force(&self, x: f64) -> f64 {
        row(x, &self.breaks).zip(std::iter::once(&self.intercept).chain(&self.slopes)).map(|(part, by)| part * by).sum()
    }

    pub(super) fn slope(&self, x: f64) -> f64 {
        self.slopes[self.breaks.iter().filter(|place| x > **place).count()]
    }

    /// What each reading does to intercept, stiffnesses and breaks, by the linearised model: (JᵀJ)⁻¹Jᵀ.
    fn weights(&self, x: &[f64]) -> Option<DMatrix<f64>> {
        let effects: Vec<Vec<f64>> = x.iter().map(|x| self.effects(*x)).collect();
        let rows = DMatrix::from_fn(x.len(), 2 * self.breaks.len() + 2, |reading, number| effects[reading][number]);
        // Taken with columns of one size, so that no number is of another size than the next.
        let sizes: Vec<f64> = rows.column_iter().map(|column| column.norm()).collect();
        if sizes.contains(&0.0) {
            return None;
        }
        let scaled = DMatrix::from_fn(rows.nrows(), rows.ncols(), |reading, number| rows[(reading, number)] / sizes[number]);
        let solved = (scaled.transpose() * &scaled).cholesky()?.solve(&scaled.transpose());
        Some(DMatrix::from_fn(solved.nrows(), solved.ncols(), |number, reading| solved[(number, reading)] / sizes[number]))
    }
}

/// What one reading does to a number with these effects.
fn weight(effect: &[f64], weights: &DMatrix<f64>, reading: usize) -> f64 {
    effect.iter().enumerate().map(|(number, by)| by * weights[(number, reading)]).sum()
}
