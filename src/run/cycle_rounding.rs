//! What the rounding of readings leaves open of the results of a `cycle`. In: what was recorded, the quanta of the rig. Out: a standard
//! uncertainty for each result of its loops. Nothing is reckoned again: every result has a slope by every reading.
//!
//! With ΔF and w the force and the way from the left end of a loop to its right end, K = ΔF/w, E = ∫R dX by the trapezoid and
//! ζ = 2E/(πΔF·w). The readings of a loop tell their own forces to a quantum only: what is told is the most that is left, with errors
//! that go together as the forces and places do (`mechanics::rounding`, open by a quantum along either), or each by itself.

use super::rounding_doubts::Quanta;
use crate::mechanics::rounding::{Rounded, along};
use crate::record::{CycleHistory, WholeCycle};

/// Slopes of one result by the force and by the displacement of every reading.
#[derive(Clone)]
struct Slopes {
    force: Vec<f64>,
    displacement: Vec<f64>,
}

impl Slopes {
    fn none(history: &CycleHistory) -> Self {
        Self { force: vec![0.0; history.steps.len()], displacement: vec![0.0; history.steps.len()] }
    }

    fn add(&mut self, other: &Self, by: f64) {
        for (own, other) in self.force.iter_mut().zip(&other.force).chain(self.displacement.iter_mut().zip(&other.displacement)) {
            *own += by * other;
        }
    }
}

/// Of the results of the loops, and of each cycle in their lists, those that are uncertain by it: name and entry.
pub(super) fn of_loops(history: &CycleHistory, quanta: Quanta, samples: u32) -> Vec<(&'static str, usize, f64)> {
    if quanta.force == 0.0 && quanta.displacement == 0.0 {
        return Vec::new();
    }
    let mut energy = Slopes::none(history);
    for cycle in &history.cycles {
        energy.add(&of_energy(history, cycle), 1.0);
    }
    let secant = |cycle: Option<&WholeCycle>| cycle.and_then(|cycle| of_stiffness(history, cycle));
    let extreme = |better: fn(f64, f64) -> bool| {
        let forces = history.steps.iter().map(|step| step.restoring_force).enumerate();
        let (place, _) = forces.reduce(|best, next| if better(next.1, best.1) { next } else { best })?;
        let mut slopes = Slopes::none(history);
        slopes.force[place] = 1.0;
        Some(slopes)
    };
    let told = [
        ("dissipated_energy", Some(energy)),
        ("max_force", extreme(|next, best| next > best)),
        ("min_force", extreme(|next, best| next < best)),
        ("equivalent_damping_ratio", history.cycles.last().and_then(|cycle| of_damping(history, cycle))),
        ("stiffness", secant(history.cycles.first())),
        ("last_stiffness", secant(history.cycles.last())),
    ];
    let amplitude = |cycle: &WholeCycle| {
        let mut slopes = Slopes::none(history);
        let [_, (_, of_way)] = across(history, cycle)?;
        slopes.add(&of_way, 0.5);
        Some(slopes)
    };
    let of_cycle = |(entry, cycle): (usize, &WholeCycle)| {
        [
            ("amplitudes", entry, amplitude(cycle)),
            ("energies", entry, Some(of_energy(history, cycle))),
            ("damping_ratios", entry, of_damping(history, cycle)),
            ("stiffnesses", entry, of_stiffness(history, cycle)),
        ]
    };
    let all = told.into_iter().map(|(name, slopes)| (name, 0, slopes));
    let all = all.chain(history.cycles.iter().enumerate().flat_map(of_cycle));
    all.filter_map(|(name, entry, slopes)| Some((name, entry, uncertain(history, &slopes?, quanta, samples)))).collect()
}

/// Steps of a cycle; it begins with the last reading of the one before it.
fn steps_of(history: &CycleHistory, cycle: &WholeCycle) -> std::ops::Range<usize> {
    let first = history.steps.partition_point(|step| step.cycle < cycle.cycle);
    first.saturating_sub(1)..history.steps.partition_point(|step| step.cycle <= cycle.cycle)
}

fn of_energy(history: &CycleHistory, cycle: &WholeCycle) -> Slopes {
    let mut slopes = Slopes::none(history);
    let steps = steps_of(history, cycle);
    for (from, to) in steps.clone().zip(steps.skip(1)) {
        let (one, other) = (&history.steps[from], &history.steps[to]);
        let (way, mean) = (other.displacement - one.displacement, 0.5 * (one.restoring_force + other.restoring_force));
        slopes.force[from] += 0.5 * way;
        slopes.force[to] += 0.5 * way;
        slopes.displacement[from] -= mean;
        slopes.displacement[to] += mean;
    }
    slopes
}

/// The readings at the left and at the right end, as a loop takes them.
fn ends(history: &CycleHistory, cycle: &WholeCycle) -> Option<[usize; 2]> {
    let mut steps = steps_of(history, cycle);
    let first = steps.next()?;
    let command = |step: usize| history.steps[step].command;
    Some(steps.fold([first; 2], |[left, right], step| {
        [if command(step) <= command(left) { step } else { left }, if command(step) >= command(right) { step } else { right }]
    }))
}

/// Of ΔF and of w, with their values.
fn across(history: &CycleHistory, cycle: &WholeCycle) -> Option<[(f64, Slopes); 2]> {
    let [left, right] = ends(history, cycle)?;
    let (mut of_force, mut of_way) = (Slopes::none(history), Slopes::none(history));
    (of_force.force[left], of_force.force[right]) = (-1.0, 1.0);
    (of_way.displacement[left], of_way.displacement[right]) = (-1.0, 1.0);
    let (left, right) = (&history.steps[left], &history.steps[right]);
    let (force, way) = (right.restoring_force - left.restoring_force, right.displacement - left.displacement);
    (force != 0.0 && way > 0.0).then_some([(force, of_force), (way, of_way)])
}

fn of_stiffness(history: &CycleHistory, cycle: &WholeCycle) -> Option<Slopes> {
    let [(force, of_force), (way, of_way)] = across(history, cycle)?;
    let mut slopes = Slopes::none(history);
    slopes.add(&of_force, 1.0 / way);
    slopes.add(&of_way, -force / (way * way));
    Some(slopes)
}

fn of_damping(history: &CycleHistory, cycle: &WholeCycle) -> Option<Slopes> {
    let [(force, of_force), (way, of_way)] = across(history, cycle)?;
    let each = 2.0 / (std::f64::consts::PI * force * way);
    let ratio = each * cycle.found.energy;
    let mut slopes = Slopes::none(history);
    slopes.add(&of_energy(history, cycle), each);
    slopes.add(&of_force, -ratio / force);
    slopes.add(&of_way, -ratio / way);
    Some(slopes)
}

fn uncertain(history: &CycleHistory, slopes: &Slopes, quanta: Quanta, samples: u32) -> f64 {
    let used = |weights: &[f64]| -> Vec<usize> { (0..weights.len()).filter(|step| weights[*step] != 0.0).collect() };
    let read = |steps: &[usize], of: &dyn Fn(usize) -> f64| -> Vec<f64> { steps.iter().map(|step| of(*step)).collect() };
    let (force, command) = (|step: usize| history.steps[step].restoring_force, |step: usize| history.steps[step].command);
    let mut variance = 0.0;
    if quanta.force > 0.0 {
        let steps = used(&slopes.force);
        let weights = read(&steps, &|step| slopes.force[step]);
        let places = read(&steps, &|step| force(step) / quanta.force);
        let open = vec![along(&read(&steps, &force)), along(&read(&steps, &command))];
        let together = Rounded { places, open, noise: quanta.noise / quanta.force, samples };
        let alone: f64 = weights.iter().map(|weight| weight * weight).sum::<f64>() / 12.0;
        variance += quanta.force.powi(2) * together.variance(&weights).max(alone);
    }
    if quanta.displacement > 0.0 {
        let steps = used(&slopes.displacement);
        let weights = read(&steps, &|step| slopes.displacement[step]);
        let places = read(&steps, &|step| command(step) / quanta.displacement);
        let rounded = Rounded { places, open: vec![along(&read(&steps, &command))], noise: 0.0, samples };
        variance += quanta.displacement.powi(2) * rounded.variance(&weights);
    }
    variance.sqrt()
}
