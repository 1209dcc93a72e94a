//! The recorded way taken again, against the specimens that were recorded.

use super::*;
use crate::mechanics::specimen::{Bilinear, BoucWen, Degrading, Multilinear, RestoringForce, SpecimenModel};
use crate::plan::{Behaviour, Pinching};

fn path(force: impl Fn(f64) -> f64, targets: &[f64]) -> RecordedPath {
    let reading = |target: &f64| Reading { target: *target, displacement: target + 1e-4, force: force(*target) };
    RecordedPath::new(targets.iter().map(reading).collect(), 1000.0, 0.0, 0.0).unwrap()
}

/// Out, back and out again, with a pause at the start.
const TARGETS: [f64; 9] = [0.0, 0.0, 0.1, 0.3, 0.35, 0.2, 0.05, 0.1, 0.4];

#[test]
fn at_the_recorded_targets_the_recorded_readings_come_back_to_the_bit() {
    let path = path(|x| 1000.0 * x + 5.0 * (1e3 * x).sin(), &TARGETS);
    let mut again = path.again(Distortion::NONE);
    assert_eq!(again.start(), (TARGETS[0], path.readings[0].displacement, path.readings[0].force));
    for (target, reading) in TARGETS.iter().zip(&path.readings).skip(1) {
        assert_eq!(again.move_to(*target), (reading.displacement, reading.force));
    }
}

/// Wherever it is taken, and past its end, an elastic specimen stays elastic.
#[test]
fn an_elastic_way_taken_off_its_targets_is_elastic() {
    let path = path(|x| 1000.0 * x, &TARGETS);
    let mut again = path.again(Distortion { displacement_scale: 1.25, force_scale: 2.0, zero: 3.0, ..Distortion::NONE });
    for (step, target) in (0..).zip(TARGETS.iter().chain(&[0.5, 0.6, -0.2])).skip(1) {
        let off = target + 0.02 * f64::from(step).cos();
        let (displacement, force) = again.move_to(off);
        assert!((force - (1600.0 * off + 3.0)).abs() < 1e-9, "step {step}: {force}");
        assert!((displacement - off - 1.25e-4).abs() < 1e-12);
    }
}

/// Yield at 0.2 m, 100 N/m past it, back with 1000 N/m: turned elsewhere, it comes back along R = `R_m` − K(`X_m` − X) of
/// the new turning point.
#[test]
fn turned_elsewhere_a_yielding_specimen_comes_back_on_its_own_line() {
    let loading = |x: f64| if x < 0.2 { 1000.0 * x } else { 200.0 + 100.0 * (x - 0.2) };
    let back = |x: f64| loading(0.5) - 1000.0 * (0.5 - x);
    let readings = [
        (0.0, loading(0.0)),
        (0.2, loading(0.2)),
        (0.4, loading(0.4)),
        (0.5, loading(0.5)),
        (0.45, back(0.45)),
        (0.4, back(0.4)),
    ];
    let readings = readings.map(|(target, force)| Reading { target, displacement: target, force }).to_vec();
    let path = RecordedPath::new(readings, 1000.0, 0.0, 0.0).unwrap();
    for turned in [0.49, 0.5, 0.51, 0.53] {
        let mut again = path.again(Distortion::NONE);
        for target in [0.21, 0.41, turned] {
            assert!((again.move_to(target).1 - loading(target)).abs() < 1e-9, "{turned}");
        }
        for target in [0.46, 0.39] {
            let by_hand = loading(turned) - 1000.0 * (turned - target);
            let (_, force) = again.move_to(target);
            assert!((force - by_hand).abs() < 1e-9, "{turned}: {force} {by_hand}");
        }
    }
}

/// Noise on short pieces makes no stiffness: past the end it goes on with the slope of what spans enough.
#[test]
fn noise_makes_no_tangent() {
    let readings = |step: u32| {
        let target = 1e-3 * f64::from(step);
        let noise = if step.is_multiple_of(2) { 1.0 } else { -1.0 };
        Reading { target, displacement: target, force: 1000.0 * target + noise }
    };
    let path = RecordedPath::new((0..200).map(readings).collect(), 1000.0, 1.0, 0.0).unwrap();
    let mut again = path.again(Distortion::NONE);
    for step in 1..200 {
        again.move_to(1e-3 * f64::from(step));
    }
    let (_, force) = again.move_to(0.3);
    assert!((force - 300.0).abs() < 12.0, "{force}");
}

#[test]
fn draws_differ_and_have_both_signs_alike() {
    let sum = |draw: u16| (0..1000).map(|step| if drawn(draw, step) & 1 == 0 { 1 } else { -1 }).sum::<i32>();
    for draw in 0..8 {
        assert!(sum(draw).abs() < 110, "draw {draw}: {}", sum(draw));
    }
    let both: i32 = (0..1000).map(|step| if (drawn(3, step) ^ drawn(4, step)) & 1 == 0 { 1 } else { -1 }).sum();
    assert!(both.abs() < 110, "{both}");
}

/// Steps of `step` (m) from turn to turn.
fn way(turns: &[f64], step: f64) -> Vec<f64> {
    let mut places = vec![turns[0]];
    for ends in turns.windows(2) {
        let count = ((ends[1] - ends[0]).abs() / step).round();
        let mut taken = 0.0;
        while taken < count {
            taken += 1.0;
            places.push(ends[0] + (ends[1] - ends[0]) * taken / count);
        }
    }
    places
}

fn recorded(mut model: impl RestoringForce, targets: &[f64]) -> RecordedPath {
    let reading = |target: &f64| Reading { target: *target, displacement: *target, force: model.move_to(*target) };
    RecordedPath::new(targets.iter().map(reading).collect(), 1000.0, 0.0, 0.0).unwrap()
}

/// The largest force that the way taken again reads wrongly.
fn worst(path: &RecordedPath, mut model: impl RestoringForce, targets: &[f64]) -> f64 {
    let mut again = path.again(Distortion::NONE);
    model.move_to(targets[0]);
    targets[1..].iter().map(|target| (again.move_to(*target).1 - model.move_to(*target)).abs()).fold(0.0, f64::max)
}

/// Yields, comes a little back and yields on; back through a yield the other way, and out again past all of it.
const LOOPS: [f64; 6] = [0.0, 0.4, 0.3, 0.6, -0.2, 0.8];
const MOVED: [f64; 6] = [0.0, 0.41, 0.305, 0.62, -0.19, 0.83];
/// m
const STEP: f64 = 2e-3;

/// Every knee is where it is on the new way: exactly, where the record has a reading at it; between two recorded points a knee
/// is cut by K·step/4 at most, and where a loop closes there may be one of each of two curves.
#[test]
fn elements_side_by_side_are_told_wherever_they_are_turned() {
    let bilinear = || Bilinear::new(1000.0, 200.0, 0.1);
    let cut = 0.5 * 1000.0 * STEP;
    let path = recorded(bilinear(), &way(&LOOPS, STEP));
    assert_eq!(path.rules(), [Rule::Shifted, Rule::Anchored], "too few curves, and too short");
    let off = worst(&path, bilinear(), &way(&MOVED, STEP));
    assert!(off < 1e-9, "{off} N");
    let multilinear = || Multilinear::new(&[[0.1, 100.0], [0.25, 200.0], [0.7, 300.0]]);
    let path = recorded(multilinear(), &way(&LOOPS, STEP));
    let off = worst(&path, multilinear(), &way(&MOVED, STEP));
    assert!(off <= cut, "{off} N");
}

/// And what is cut goes with the step.
#[test]
fn finer_steps_cut_less() {
    let bilinear = || Bilinear::new(1000.0, 200.0, 0.1);
    for step in [7e-3, 1.9e-3, 5.3e-4] {
        let off = worst(&recorded(bilinear(), &way(&LOOPS, step)), bilinear(), &way(&MOVED, step));
        assert!(off > 1e-3 * 1000.0 * step && off <= 0.5 * 1000.0 * step, "{step} m: {off} N");
    }
}

/// A loop that is not made is left out, one that is made a few steps early or late is that loop.
#[test]
fn turns_are_its_own() {
    let bilinear = || Bilinear::new(1000.0, 200.0, 0.1);
    let path = recorded(bilinear(), &way(&[0.0, 0.4, 0.38, 0.6, 0.5], STEP));
    let straight = way(&[0.0, 0.61, 0.5], STEP);
    let off = worst(&path, bilinear(), &straight);
    assert!(off <= 0.5 * 1000.0 * STEP, "{off} N");
    for turn in [0.39, 0.41] {
        let off = worst(&path, bilinear(), &way(&[0.0, turn, turn - 0.02, 0.6, 0.5], STEP));
        assert!(off <= 0.5 * 1000.0 * STEP, "{off} N");
    }
}

/// Back where the record never went: as stiffly as at first, and it says so.
#[test]
fn a_turn_that_was_not_recorded_is_told() {
    let bilinear = || Bilinear::new(1000.0, 200.0, 0.1);
    let path = recorded(bilinear(), &way(&[0.0, 0.6], STEP));
    let targets = way(&[0.0, 0.4, 0.35, 0.6], STEP);
    let off = worst(&path, bilinear(), &targets);
    assert!(off <= 0.5 * 1000.0 * STEP, "{off} N");
    let mut again = path.again(Distortion::NONE);
    for target in &targets {
        again.move_to(*target);
    }
    assert!((again.unseen() - 0.05).abs() < 1e-9);
    assert_eq!(path.again(Distortion::NONE).unseen(), 0.0);
}

/// R = K(x_m)·X: exact if it is supposed to pivot about its origin, and on a smooth curve interpolation is off by R''·step²/8.
#[test]
fn what_comes_back_to_the_origin_pivots_about_it() {
    let degrading = || Degrading::new(1000.0, 0.2, 0.0);
    let path = recorded(degrading(), &way(&LOOPS[..5], STEP));
    assert!(path.rules().contains(&Rule::Pivoted));
    let targets = way(&MOVED[..5], STEP);
    let shifted = worst(&path, degrading(), &targets);
    let pivoted = worst(&path.supposing(Rule::Pivoted), degrading(), &targets);
    assert!(pivoted < 0.05 && shifted > 1.0, "{pivoted} {shifted}");
}

/// What is elastic leaves nothing to suppose, and a loop of Bouc and Wen's that drifts past its turn says so.
#[test]
fn the_record_tells_what_is_open() {
    let elastic = path(|x| 1000.0 * x + 800.0 * x.powi(3), &way(&LOOPS, STEP));
    assert_eq!(elastic.rules(), [Rule::Shifted]);
    assert!(!elastic.swung_back());
    let smooth = recorded(BoucWen::new(1000.0, 200.0, 0.1, 1.0, 0.5), &way(&LOOPS[..4], STEP));
    assert_eq!(smooth.rules(), [Rule::Shifted, Rule::Kept]);
    assert!(recorded(Bilinear::new(1000.0, 200.0, 0.1), &way(&LOOPS, STEP)).swung_back());
}

/// Sixty turns forth and back that grow and fade, `more` of them larger, m.
fn swings(more: f64) -> Vec<f64> {
    let turn = |turn: u32| {
        let phase = f64::from(turn);
        let size = 0.5 * (1.0 + 0.4 * (0.37 * phase).sin()) * (0.15 * phase).min(1.0) + 0.05 * (1.3 * phase).sin();
        let size = size * (1.0 + more * (0.9 * phase).cos());
        if turn.is_multiple_of(2) { size } else { -size }
    };
    (0..60).map(turn).collect()
}

/// A record of many curves leaves what is so of the specimen and refutes the rest: elements side by side keep their shapes, and
/// one that flows forgets where it turned.
#[test]
fn the_record_refutes_what_its_own_curves_contradict() {
    let targets = way(&swings(0.0), STEP);
    let left = |rules: &[Rule]| rules.iter().copied().filter(|rule| *rule != Rule::Kept).collect::<Vec<Rule>>();
    let bilinear = recorded(Bilinear::new(1000.0, 200.0, 0.1), &targets);
    let multilinear = recorded(Multilinear::new(&[[0.1, 100.0], [0.25, 200.0], [0.7, 300.0]]), &targets);
    for path in [bilinear, multilinear] {
        assert!(path.possible().contains(&Rule::Anchored) && path.possible().contains(&Rule::Flowing));
        assert_eq!(left(path.rules()), [Rule::Shifted]);
    }
    for (sharpness, beta) in [(1.0, 0.5), (2.0, 0.5), (1.0, 0.7)] {
        let path = recorded(BoucWen::new(1000.0, 200.0, 0.1, sharpness, beta), &targets);
        assert!(path.possible().len() > 3);
        assert_eq!(path.rules(), [Rule::Flowing]);
    }
    let elastic = path(|x| 1000.0 * x + 800.0 * x.powi(3), &targets);
    assert_eq!(elastic.rules(), [Rule::Shifted]);
}

/// What comes back to a place of its own does not keep the shape that its curve had from another.
#[test]
fn a_pinched_record_refutes_curves_that_keep_their_shape() {
    let pinched = SpecimenModel::new(&Behaviour::Pinching(Pinching {
        stiffness: 1000.0,
        yield_force: 200.0,
        hardening: 0.05,
        force_factor: 0.4,
        displacement_factor: 0.5,
        unloading_exponent: 0.0,
        capping: None,
        deterioration: None,
    }));
    let path = recorded(pinched, &way(&swings(0.0), STEP));
    assert!(path.possible().contains(&Rule::Shifted));
    assert!(path.rules().contains(&Rule::Anchored) && !path.rules().contains(&Rule::Shifted), "{:?}", path.rules());
}

/// As Bouc's and Wen's element flows, it comes to where it would have come from any turn; in a few per cent of what the shape of its
/// curve, kept, makes of it.
#[test]
fn what_flows_forgets_where_it_turned() {
    let smooth = || BoucWen::new(1000.0, 200.0, 0.1, 2.0, 0.5);
    let (record, moved) = (way(&swings(0.0), STEP), way(&swings(0.02), STEP));
    let path = recorded(smooth(), &record);
    let kept = worst(&path.clone().keeping_to(Rule::Shifted), smooth(), &moved);
    let flowing = worst(&path.supposing(Rule::Shifted), smooth(), &moved);
    assert!(flowing < 0.1 * kept, "{flowing} N, {kept} N");
}
