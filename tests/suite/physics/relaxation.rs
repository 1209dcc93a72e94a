//! Relaxation of force on the virtual rig: the standard linear solid compared with its closed form, for any rig, and the energy of its
//! cycles.

use psd_physics::relaxation::law::RelaxationLaw;
use psd_physics::relaxation::maxwell::{MaxwellBranch, Motion};
use psd_physics::relaxation::relaxation_state::{Deformed, RelaxationState};
use psd_physics::specimen::SpecimenModel;
use psd_physics::tracking::trajectory::Path;
use psd_plan::{Behaviour, Settle, Specimen, VirtualLink};
use psd_rig::{Rig, VirtualRig};

/// 300 kN/m in parallel with 200 kN/m that relax with 1.5 s.
const K: f64 = 3e5;
const K1: f64 = 2e5;
const TAU: f64 = 1.5;

fn rig(link: VirtualLink, settle: Settle) -> VirtualRig {
    let of = Box::new(Behaviour::Elastic { stiffness: K });
    let behaviour = Some(Behaviour::Maxwell {
        of,
        stiffness: K1,
        time_constant: TAU,
    });
    let specimen = Specimen::new("pad", 1.0, behaviour);
    VirtualRig::new(link, settle, Some(&specimen), -1.0)
}

const AT_ONCE: Settle = Settle {
    band: 0.0,
    force_rate: 0.0,
    dwell: 0.0,
    timeout: 60.0,
};

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
    assert!(
        (time - seconds).abs() < 1e-15 && (force - (K * 1e-3 + gained)).abs() < 1e-9,
        "{force} N"
    );
    rig.pause(pause).expect("a pause");
    assert!((read(&mut rig).1 - (K * 1e-3 + gained * f64::exp(-pause / TAU))).abs() < 1e-9);
    let (_, force) = go(&mut rig, 2.0 * v * seconds, v);
    let twice = gained * f64::exp(-(pause + seconds) / TAU) + gained;
    assert!((force - (K * 2e-3 + twice)).abs() < 1e-9, "{force} N");
    rig.pause(1e5).expect("a long pause");
    assert!(
        (read(&mut rig).1 - K * 2e-3).abs() < 1e-9,
        "the slow spring is left"
    );
}

/// ẋ = (reference − x)/lag and q̇ = K₁ẋ − q/τ by the trapezoid, through a ramp and a hold; and along a smooth path.
#[test]
fn a_lagging_piston_is_followed_in_closed_form() {
    let link = VirtualLink {
        lag: 0.2,
        ..VirtualLink::default()
    };
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
    assert!(
        (force - stepped(&|time| 2e-3 * time, 0.5)).abs() < 1e-4,
        "{force} N"
    );
    stopping.pause(0.3).expect("a pause");
    assert!((read(&mut stopping).1 - stepped(&|_| 1e-3, 0.3)).abs() < 1e-4);
    let path = Path {
        from: 1e-3,
        to: 4e-3,
        start_velocity: 0.0,
        end_velocity: 0.01,
        seconds: 0.6,
    };
    let mut forces = Vec::new();
    let mut take = |reading: psd_rig::Reading| {
        forces.push(reading.force[0]);
        Ok(())
    };
    stopping
        .follow_paths(&[path], 3, &mut take)
        .expect("a path");
    let by_steps = stepped(&|time| path.position(time), 0.6);
    assert!(
        (forces[2] - by_steps).abs() < 1e-3,
        "{} N, by steps {by_steps} N",
        forces[2]
    );
}

/// Settling by the force rate waits for the relaxation: afterwards the force decreases no faster than required.
#[test]
fn a_rig_settles_when_the_force_has_nearly_relaxed() {
    let settle = Settle {
        band: 1e-5,
        force_rate: 4.0,
        dwell: 0.5,
        timeout: 60.0,
    };
    let mut slow = rig(
        VirtualLink {
            lag: 0.05,
            ..VirtualLink::default()
        },
        settle,
    );
    let (time, force) = go(&mut slow, 1e-3, 2e-3);
    slow.pause(0.01).expect("a pause");
    let rate = (force - read(&mut slow).1) / 0.01;
    // Half of it comes from the lag; the dwell has reduced the other half.
    assert!(rate > 0.8 && rate < 2.0, "{rate} N/s after {time} s");
    let mut never = rig(
        VirtualLink::default(),
        Settle {
            timeout: 3.0,
            ..settle
        },
    );
    never.propose(&[1e-3], Some(2e-3)).expect("a target");
    assert!(never.execute().is_err(), "1.5 s · ln(…) is longer than 3 s");
    assert!((never.time() - 3.5).abs() < 1e-12);
}

/// Back and forth between ±A at v, in steady state: q at the ends is K₁vτ tanh(T/2τ) with T = 2A/v, and a cycle dissipates 4vτ(K₁A − q).
/// Very slow and very fast cycles dissipate less than cycles in between.
#[test]
fn a_cycle_takes_the_energy_of_the_closed_form() {
    let energy = |velocity: f64| {
        let (amplitude, parts) = (1e-3, 4000);
        let seconds = 2.0 * amplitude / velocity;
        let mut branch = MaxwellBranch::new(K1, TAU);
        branch.follow(&Motion::even(velocity, 0.5 * seconds));
        let mut energy = 0.0;
        // At least thirty time constants and a whole cycle: e^(−30) of the initial state is left.
        let whole = (15.0 * TAU / seconds).ceil().max(1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some hundreds
        for half in 0..2 * whole as u32 {
            let signed_velocity = if half % 2 == 0 { -velocity } else { velocity };
            energy = if half % 2 == 0 { 0.0 } else { energy };
            for _ in 0..parts {
                let before = branch.force();
                branch.follow(&Motion::even(signed_velocity, seconds / f64::from(parts)));
                energy +=
                    0.5 * (before + branch.force()) * signed_velocity * seconds / f64::from(parts);
            }
        }
        let at_the_ends = K1 * velocity * TAU * (0.5 * seconds / TAU).tanh();
        let by_hand = 4.0 * velocity * TAU * (K1 * amplitude - at_the_ends);
        assert!(
            (energy / by_hand - 1.0).abs() < 1e-5,
            "{energy} J at {velocity} m/s, by hand {by_hand} J"
        );
        energy
    };
    let [slow, middle, fast] = [1e-4, 1e-3, 1e-2].map(energy);
    assert!(slow < middle && fast < middle, "{slow}, {middle}, {fast} J");
}

fn logarithmic(of: Behaviour, share: f64) -> Behaviour {
    Behaviour::Logarithmic {
        of: Box::new(of),
        share,
        reference_time: 0.4,
        longest: 1e12,
    }
}

fn rig_of(behaviour: Behaviour, link: VirtualLink, settle: Settle) -> VirtualRig {
    VirtualRig::new(
        link,
        settle,
        Some(&Specimen::new("plate", 1.0, Some(behaviour))),
        -1.0,
    )
}

/// 1 kN/mm to 3 kN: elastic loading in three steps, yielding in the fourth and unloading in the fifth, a dwell after each. The measured
/// force is the instantaneous force minus `a` times the sum of the logarithms of all increments, independent of later increments.
#[test]
fn a_yielding_specimen_relaxes_by_what_it_reached_in_every_step() {
    let of = Behaviour::Bilinear {
        stiffness: 1e6,
        yield_force: 3000.0,
        post_yield_ratio: 0.0,
    };
    let (share, pause, v) = (0.01, 7.0, 2e-3);
    let mut rig = rig_of(logarithmic(of, share), VirtualLink::default(), AT_ONCE);
    let steps = [
        (1e-3, 1000.0),
        (2e-3, 2000.0),
        (3e-3, 3000.0),
        (5e-3, 3000.0),
        (4e-3, 2000.0),
    ];
    let (mut time, mut from, mut before) = (0.0, 0.0, 0.0);
    let mut increments: Vec<(f64, f64, f64)> = Vec::new();
    for (position, reached) in steps {
        let took = f64::abs(position - from) / v;
        time += took;
        increments.push((reached - before, time, took));
        let expected_force = |now: f64| {
            let lost = |(force, ended, took): &(f64, f64, f64)| {
                force
                    * RelaxationLaw::Logarithmic
                        .timed(0.4)
                        .lost(now - ended, *took)
            };
            reached - share * increments.iter().map(lost).sum::<f64>()
        };
        let (_, force) = go(&mut rig, position, v);
        assert!(
            (force - expected_force(time)).abs() < 1e-6,
            "{force} N is not {} N",
            expected_force(time)
        );
        rig.pause(0.3 * pause).expect("a pause");
        rig.pause(0.7 * pause).expect("its rest");
        time += pause;
        let (_, force) = read(&mut rig);
        assert!(
            (force - expected_force(time)).abs() < 1e-6,
            "after a pause {force} N is not {} N",
            expected_force(time)
        );
        (from, before) = (position, reached);
    }
}

/// 300 N at 2 % lose 6 N/(0.4 s + t) a second: 0.5 N/s is reached after 11.6 s, and the dwell reduces it further.
#[test]
fn a_rig_settles_when_the_logarithm_is_slow() {
    let settle = Settle {
        band: 1e-5,
        force_rate: 0.5,
        dwell: 0.0,
        timeout: 60.0,
    };
    let mut rig = rig_of(
        logarithmic(Behaviour::Elastic { stiffness: 3e5 }, 0.02),
        VirtualLink::default(),
        settle,
    );
    let (time, _) = go(&mut rig, 1e-3, 1.0);
    assert!((time - 11.6).abs() < 2e-3, "{time} s");
    let mut never = rig_of(
        logarithmic(Behaviour::Elastic { stiffness: 3e5 }, 0.02),
        VirtualLink::default(),
        Settle {
            timeout: 10.0,
            ..settle
        },
    );
    never.propose(&[1e-3], Some(1.0)).expect("a target");
    assert!(never.execute().is_err(), "0.5 N/s do not come within 10 s");
}

/// No specimen releases all of the work done on it, on any path and with any dwells.
#[test]
fn what_relaxes_gives_back_no_more_than_it_took() {
    let bases = [
        Behaviour::Elastic { stiffness: 1e6 },
        Behaviour::Bilinear {
            stiffness: 1e6,
            yield_force: 1500.0,
            post_yield_ratio: 0.05,
        },
        Behaviour::BoucWen {
            stiffness: 1e6,
            yield_force: 1500.0,
            post_yield_ratio: 0.0,
            sharpness: 2.0,
            beta: 0.5,
        },
    ];
    let turns = [
        3e-3, -2e-3, 4e-3, 1e-3, 3.5e-3, -4e-3, 0.5e-3, -3e-3, 2e-3, 0.0,
    ];
    for base in bases {
        for rest in [0.0, 0.3, 50.0, 1e5] {
            let behaviour = Behaviour::Logarithmic {
                of: Box::new(base.clone()),
                share: 0.03,
                reference_time: 0.4,
                longest: 4e6,
            };
            let (mut model, mut relaxation) =
                (SpecimenModel::new(&base), RelaxationState::new(&behaviour));
            let (mut at, mut own, mut force, mut work) = (0.0, 0.0, 0.0, 0.0);
            for turn in turns {
                let parts = 2000;
                let part = (turn - at) / f64::from(parts);
                for _ in 0..parts {
                    at += part;
                    let from = Deformed {
                        displacement: at - part,
                        force: own,
                    };
                    own =
                        relaxation.advance(&mut model, &Motion::even(part / 1e-3, 1e-3), from, at);
                    let measured = own + relaxation.force();
                    work += 0.5 * (force + measured) * part;
                    force = measured;
                    assert!(
                        work >= -1e-9,
                        "{base:?} gave back {work} J after rests of {rest} s"
                    );
                }
                let from = Deformed {
                    displacement: at,
                    force: own,
                };
                own = relaxation.advance(&mut model, &Motion::rest(rest), from, at);
                force = own + relaxation.force();
            }
        }
    }
}

/// A move in which it begins to yield relaxes equally in one evaluation and in many.
#[test]
fn a_kink_within_a_move_is_followed_however_many_looks_there_are() {
    let of = Behaviour::Bilinear {
        stiffness: 1e6,
        yield_force: 1000.0,
        post_yield_ratio: 0.0,
    };
    let lost = |looks: u32| {
        let mut rig = rig_of(
            logarithmic(of.clone(), 0.01),
            VirtualLink::default(),
            AT_ONCE,
        );
        let mut last = 0.0;
        for look in 1..=looks {
            last = go(&mut rig, 3e-3 * f64::from(look) / f64::from(looks), 3e-3).1;
        }
        1000.0 - last
    };
    let exact = 10.0
        * RelaxationLaw::Logarithmic
            .timed(0.4)
            .lost(2.0 / 3.0, 1.0 / 3.0);
    for looks in [1, 4, 10, 1000] {
        assert!(
            (lost(looks) - exact).abs() < 2e-5 * exact,
            "in {looks} looks {} N of {exact} N",
            lost(looks)
        );
    }
}
