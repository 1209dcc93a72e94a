//! Force that relaxes, on the virtual rig: the standard linear solid in closed form, whatever the rig does, and the energy of its
//! cycles.

use psd::mechanics::maxwell::{MaxwellBranch, Travel};
use psd::mechanics::path::Path;
use psd::plan::{Behaviour, Settle, Specimen, VirtualLink};
use psd::rig::{Rig, VirtualRig};

/// 300 kN/m, beside it 200 kN/m that relax with 1.5 s.
const K: f64 = 3e5;
const K1: f64 = 2e5;
const TAU: f64 = 1.5;

fn rig(link: VirtualLink, settle: Settle) -> VirtualRig {
    let of = Box::new(Behaviour::Elastic { stiffness: K });
    let behaviour = Some(Behaviour::Maxwell { of, stiffness: K1, time_constant: TAU });
    let specimen = Specimen::new("pad", 1.0, behaviour);
    VirtualRig::new(link, settle, Some(&specimen), -1.0)
}

const AT_ONCE: Settle = Settle { band: 0.0, force_rate: 0.0, dwell: 0.0, timeout: 60.0 };

fn go(rig: &mut VirtualRig, target: f64, speed: f64) -> (f64, f64) {
    rig.propose(&[target], Some(speed)).expect("a target");
    rig.execute().expect("it goes there");
    read(rig)
}

/// Time and force.
fn read(rig: &mut VirtualRig) -> (f64, f64) {
    let reading = rig.read().expect("a reading");
    (reading.time, reading.force[0])
}

/// Two ramps of v for T with a hold of P between: q = K₁vτ(1 − e^(−T/τ)), then e^(−P/τ) of it and the same again.
#[test]
fn ramps_and_holds_are_those_of_the_standard_linear_solid() {
    let mut rig = rig(VirtualLink::default(), AT_ONCE);
    let (v, seconds, pause) = (2e-3, 0.5, 0.8);
    let gained = K1 * v * TAU * (1.0 - f64::exp(-seconds / TAU));
    let (time, force) = go(&mut rig, v * seconds, v);
    assert!((time - seconds).abs() < 1e-15 && (force - (K * 1e-3 + gained)).abs() < 1e-9, "{force} N");
    rig.pause(pause).expect("a pause");
    assert!((read(&mut rig).1 - (K * 1e-3 + gained * f64::exp(-pause / TAU))).abs() < 1e-9);
    let (_, force) = go(&mut rig, 2.0 * v * seconds, v);
    let twice = gained * f64::exp(-(pause + seconds) / TAU) + gained;
    assert!((force - (K * 2e-3 + twice)).abs() < 1e-9, "{force} N");
    rig.pause(1e5).expect("a long pause");
    assert!((read(&mut rig).1 - K * 2e-3).abs() < 1e-9, "the slow spring is left");
}

/// ẋ = (reference − x)/lag and q̇ = K₁ẋ − q/τ by the trapezoid, through a ramp and a hold; and along a smooth path.
#[test]
fn a_lagging_piston_is_followed_in_closed_form() {
    let link = VirtualLink { lag: 0.2, ..VirtualLink::default() };
    let (mut x, mut q, parts) = (0.0, 0.0, 200_000);
    let mut stepped = |reference: &dyn Fn(f64) -> f64, seconds: f64| {
        let step = seconds / f64::from(parts);
        for part in 0..parts {
            let (half, aim) = (0.5 * step / 0.2, reference(step * (f64::from(part) + 0.5)));
            let before = x;
            x = (x * (1.0 - half) + 2.0 * half * aim) / (1.0 + half);
            let half = 0.5 * step / TAU;
            q = (q * (1.0 - half) + K1 * (x - before)) / (1.0 + half);
        }
        K * x + q
    };
    let mut stopping = rig(link, AT_ONCE);
    let (_, force) = go(&mut stopping, 1e-3, 2e-3);
    assert!((force - stepped(&|time| 2e-3 * time, 0.5)).abs() < 1e-4, "{force} N");
    stopping.pause(0.3).expect("a pause");
    assert!((read(&mut stopping).1 - stepped(&|_| 1e-3, 0.3)).abs() < 1e-4);
    let path = Path { from: 1e-3, to: 4e-3, start_velocity: 0.0, end_velocity: 0.01, seconds: 0.6 };
    let mut forces = Vec::new();
    let mut take = |reading: psd::rig::Reading| {
        forces.push(reading.force[0]);
        Ok(())
    };
    stopping.glide(&[path], 3, &mut take).expect("a path");
    let by_steps = stepped(&|time| path.place(time), 0.6);
    assert!((forces[2] - by_steps).abs() < 1e-3, "{} N, by steps {by_steps} N", forces[2]);
}

/// Settling by the force rate waits for the relaxation: after it the force falls no faster than asked.
#[test]
fn a_rig_settles_when_the_force_has_nearly_relaxed() {
    let settle = Settle { band: 1e-5, force_rate: 4.0, dwell: 0.5, timeout: 60.0 };
    let mut slow = rig(VirtualLink { lag: 0.05, ..VirtualLink::default() }, settle);
    let (time, force) = go(&mut slow, 1e-3, 2e-3);
    slow.pause(0.01).expect("a pause");
    let rate = (force - read(&mut slow).1) / 0.01;
    // Half of it is the lag's; the dwell has made less of the other half.
    assert!(rate > 0.8 && rate < 2.0, "{rate} N/s after {time} s");
    let mut never = rig(VirtualLink::default(), Settle { timeout: 3.0, ..settle });
    never.propose(&[1e-3], Some(2e-3)).expect("a target");
    assert!(never.execute().is_err(), "1.5 s · ln(…) is longer than 3 s");
    assert!((never.time() - 3.5).abs() < 1e-12);
}

/// Back and forth between ±A at v, once it repeats: q at the ends is K₁vτ tanh(T/2τ) with T = 2A/v, and a cycle takes
/// 4vτ(K₁A − q). Slow or fast, it takes less than in between.
#[test]
fn a_cycle_takes_the_energy_of_the_closed_form() {
    let energy = |velocity: f64| {
        let (amplitude, parts) = (1e-3, 4000);
        let seconds = 2.0 * amplitude / velocity;
        let mut branch = MaxwellBranch::new(K1, TAU);
        branch.follow(&Travel::even(velocity, 0.5 * seconds));
        let mut energy = 0.0;
        // Thirty time constants, and a whole cycle at least: e^(−30) is left of how it began.
        let whole = (15.0 * TAU / seconds).ceil().max(1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some hundreds
        for half in 0..2 * whole as u32 {
            let way = if half % 2 == 0 { -velocity } else { velocity };
            energy = if half % 2 == 0 { 0.0 } else { energy };
            for _ in 0..parts {
                let before = branch.force();
                branch.follow(&Travel::even(way, seconds / f64::from(parts)));
                energy += 0.5 * (before + branch.force()) * way * seconds / f64::from(parts);
            }
        }
        let at_the_ends = K1 * velocity * TAU * (0.5 * seconds / TAU).tanh();
        let by_hand = 4.0 * velocity * TAU * (K1 * amplitude - at_the_ends);
        assert!((energy / by_hand - 1.0).abs() < 1e-5, "{energy} J at {velocity} m/s, by hand {by_hand} J");
        energy
    };
    let [slow, middle, fast] = [1e-4, 1e-3, 1e-2].map(energy);
    assert!(slow < middle && fast < middle, "{slow}, {middle}, {fast} J");
}
