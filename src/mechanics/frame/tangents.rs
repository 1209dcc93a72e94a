//! The tangent stiffness of a shear building, storey by storey (Melo et al. 2006, eq. 6): the secant of its shear over its
//! drift. In: what the floors' actuators read. Out: storey stiffnesses, and whether one changed.

use crate::mechanics::tangent::TangentStiffness;

/// What the tangent form takes for `K_t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tangents {
    /// K0 throughout: for a frame whose matrix has no storeys.
    Initial,
    /// Each storey's own secant, within `[0, largest_ratio · k0]`. The frame is a shear building.
    Storeys { largest_ratio: f64 },
}

/// How far rounding may move a secant, over the first-order bound of it: products and the specimen's own arithmetic take
/// their share too. Smaller, and a linear frame is factored again in every step; far larger, and a slow change is missed.
const ROUNDING_MARGIN: f64 = 4.0;

/// Storeys as they are followed.
#[derive(Clone, Debug)]
pub(super) struct StoreyTangents {
    storeys: Vec<Storey>,
    /// N/m
    stiffnesses: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Storey {
    followed: TangentStiffness,
    last: Reading,
}

/// One storey at one instant.
#[derive(Clone, Copy, Debug)]
struct Reading {
    /// m
    drift: f64,
    /// N
    shear: f64,
    /// m and N: how far rounding may have moved them.
    drift_rounding: f64,
    shear_rounding: f64,
}

/// Calls with each storey's reading, from the top down: a drift is the difference of two displacements, a shear the sum of
/// the restoring forces of the floors above.
#[inline]
fn each_reading(displacement: &[f64], force: &[f64], mut tell: impl FnMut(usize, Reading)) {
    let (mut shear, mut size, mut cells) = (0.0, 0.0, 0.0);
    for storey in (0..force.len()).rev() {
        let (here, below) = (displacement[storey], if storey == 0 { 0.0 } else { displacement[storey - 1] });
        shear += force[storey];
        size += force[storey].abs();
        cells += 1.0;
        let drift_rounding = f64::EPSILON * (here.abs() + below.abs());
        tell(storey, Reading { drift: here - below, shear, drift_rounding, shear_rounding: f64::EPSILON * cells * size });
    }
}

impl StoreyTangents {
    /// From the first readings (m, N); noise of a load cell in N, resolution of a displacement in m.
    pub fn new(
        stiffnesses: Vec<f64>,
        largest_ratio: f64,
        (force_noise, resolution): (f64, f64),
        displacement: &[f64],
        force: &[f64],
    ) -> Self {
        let mut storeys = Vec::with_capacity(stiffnesses.len());
        each_reading(displacement, force, |storey, last| {
            // Independent cells add as squares; a drift above the first storey is read in two places.
            #[expect(clippy::cast_precision_loss, reason = "no frame has 2^53 storeys")]
            let cells = (stiffnesses.len() - storey) as f64;
            let resolution = if storey == 0 { resolution } else { 2.0 * resolution };
            let (noise, first) = (cells.sqrt() * force_noise, (last.drift, last.shear));
            let followed = TangentStiffness::new(stiffnesses[storey], largest_ratio, noise, resolution, first);
            storeys.push(Storey { followed, last });
        });
        storeys.reverse();
        Self { storeys, stiffnesses }
    }

    /// N/m, from the ground up.
    pub fn stiffnesses(&self) -> &[f64] {
        &self.stiffnesses
    }

    /// Takes the readings at the end of a step. True if some storey's stiffness is another than before by more than
    /// rounding can make it: only then is a new factor worth its price.
    pub fn take(&mut self, displacement: &[f64], force: &[f64]) -> bool {
        let mut changed = false;
        let Self { storeys, stiffnesses } = self;
        each_reading(displacement, force, |storey, now| {
            let (storey, stiffness) = (&mut storeys[storey], &mut stiffnesses[storey]);
            storey.followed.take(now.drift, now.shear);
            let difference = (storey.followed.value() - *stiffness).abs();
            let last = storey.last;
            let rounding = last.shear_rounding + now.shear_rounding + *stiffness * (last.drift_rounding + now.drift_rounding);
            // |Δk| > margin · rounding / |Δδ|, without the division.
            if difference * (now.drift - last.drift).abs() > ROUNDING_MARGIN * rounding {
                *stiffness = storey.followed.value();
                changed = true;
            }
            storey.last = now;
        });
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::super::storeys::floor_forces;
    use super::*;

    const INITIAL: [f64; 3] = [3000.0, 2000.0, 1000.0];

    fn read(stiffnesses: &[f64; 3], drift: &[f64; 3]) -> ([f64; 3], [f64; 3]) {
        let displacement = [drift[0], drift[0] + drift[1], drift[0] + drift[1] + drift[2]];
        let shear = [stiffnesses[0] * drift[0], stiffnesses[1] * drift[1], stiffnesses[2] * drift[2]];
        let mut force = [0.0; 3];
        floor_forces(&shear, &mut force);
        (displacement, force)
    }

    fn at_rest(noise: f64, resolution: f64) -> StoreyTangents {
        StoreyTangents::new(INITIAL.to_vec(), 2.0, (noise, resolution), &[0.0; 3], &[0.0; 3])
    }

    /// Any small linear motion leaves every storey at its very number.
    #[test]
    fn rounding_is_no_stiffness() {
        let mut tangents = at_rest(0.0, 0.0);
        for step in 0..20_000 {
            let time = f64::from(step) * 1e-3;
            let drift = [(3.0 * time).sin(), 0.3 * (7.0 * time).cos(), 1e-3 * (11.0 * time).sin()];
            let (displacement, force) = read(&INITIAL, &drift);
            assert!(!tangents.take(&displacement, &force), "step {step}: {:?}", tangents.stiffnesses());
        }
        assert_eq!(tangents.stiffnesses(), INITIAL);
    }

    /// One storey softens, another stiffens beyond its bound: each by its own drift, the third is as it was.
    #[test]
    fn each_storey_is_followed_by_its_own_drift() {
        let mut tangents = at_rest(0.0, 0.0);
        let (displacement, force) = read(&[3000.0, 500.0, 9000.0], &[1e-3, -2e-3, 3e-3]);
        assert!(tangents.take(&displacement, &force));
        let found = tangents.stiffnesses();
        assert_eq!((found[0], found[2]), (3000.0, 2000.0));
        assert!((found[1] - 500.0).abs() < 1e-9);
    }

    /// Load cells of 1 N: a shear of three has √3 N, so that the first storey needs 10·√3/3000 m to tell, the third 10/1000.
    #[test]
    fn a_change_too_small_to_tell_tells_nothing() {
        let told = |drift: [f64; 3], storey: usize| {
            let mut tangents = at_rest(1.0, 0.0);
            let (displacement, force) = read(&[300.0, 200.0, 100.0], &drift);
            tangents.take(&displacement, &force);
            tangents.stiffnesses()[storey] != INITIAL[storey]
        };
        assert!(!told([0.0057, 0.0, 0.0], 0) && told([0.0059, 0.0, 0.0], 0));
        assert!(!told([0.0, 0.0, 0.0099], 2) && told([0.0, 0.0, 0.0101], 2));
        let mut coarse = at_rest(0.0, 1e-3);
        let (displacement, force) = read(&[300.0, 200.0, 100.0], &[1.5e-3, 1.5e-3, 2.5e-3]);
        coarse.take(&displacement, &force);
        assert_eq!(coarse.stiffnesses()[1], INITIAL[1], "two readings, two quanta");
        assert!(coarse.stiffnesses()[0] < INITIAL[0] && coarse.stiffnesses()[2] < INITIAL[2]);
    }
}
