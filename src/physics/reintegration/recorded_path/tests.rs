//! Re-runs along the recorded path, compared with the specimens that were recorded.

use super::*;
use crate::specimen::{Behaviour, Pinching};
use crate::specimen::{
    Bilinear, BilinearCurve, BoucWen, Degrading, DegradingCurve, Multilinear, RestoringForce,
    SpecimenModel,
};

impl Retrace<'_> {
    /// The reading at a target at which the actuator stops \[m\].
    fn move_to(&mut self, target: f64) -> (f64, f64) {
        self.pass(target, 0.0)
    }
}

fn path(force: impl Fn(f64) -> f64, targets: &[f64]) -> RecordedPath {
    let reading = |target: &f64| Reading {
        target: *target,
        displacement: target + 1e-4,
        force: force(*target),
    };
    RecordedPath::new(
        targets.iter().map(reading).collect::<Vec<_>>(),
        None,
        1000.0,
        DeclaredNoise::NONE,
    )
    .unwrap()
}

/// Out, back and out again, with a pause at the start.
const TARGETS: [f64; 9] = [0.0, 0.0, 0.1, 0.3, 0.35, 0.2, 0.05, 0.1, 0.4];

#[test]
fn at_the_recorded_targets_the_recorded_readings_come_back_to_the_bit() {
    let path = path(|x| 1000.0 * x + 5.0 * (1e3 * x).sin(), &TARGETS);
    let mut retrace = path.retrace(1);
    assert_eq!(
        retrace.start(),
        Reading {
            target: TARGETS[0],
            ..path.readings[0]
        }
    );
    for (target, reading) in TARGETS.iter().zip(&*path.readings).skip(1) {
        assert_eq!(
            retrace.move_to(*target),
            (reading.displacement, reading.force)
        );
    }
}

/// An elastic specimen stays elastic at all targets and past the end of the path.
#[test]
fn an_elastic_path_off_its_targets_is_elastic() {
    let path = path(|x| 1000.0 * x, &TARGETS);
    let mut retrace = path.retrace(1);
    for (step, target) in (0..).zip(TARGETS.iter().chain(&[0.5, 0.6, -0.2])).skip(1) {
        let off = target + 0.02 * f64::from(step).cos();
        let (displacement, force) = retrace.move_to(off);
        assert!((force - 1000.0 * off).abs() < 1e-9, "step {step}: {force}");
        assert!((displacement - off - 1e-4).abs() < 1e-12);
    }
}

/// Yield at 0.2 m, 100 N/m past it, unloading with 1000 N/m. If it reverses at a different point, it unloads along R = `R_m` − K(`X_m` −
/// X) of the new reversal point.
#[test]
fn turned_elsewhere_a_yielding_specimen_comes_back_on_its_own_line() {
    let loading = |x: f64| {
        if x < 0.2 {
            1000.0 * x
        } else {
            200.0 + 100.0 * (x - 0.2)
        }
    };
    let back = |x: f64| loading(0.5) - 1000.0 * (0.5 - x);
    let readings = [
        (0.0, loading(0.0)),
        (0.2, loading(0.2)),
        (0.4, loading(0.4)),
        (0.5, loading(0.5)),
        (0.45, back(0.45)),
        (0.4, back(0.4)),
    ];
    let readings = readings
        .map(|(target, force)| Reading {
            target,
            displacement: target,
            force,
        })
        .to_vec();
    let path = RecordedPath::new(readings, None, 1000.0, DeclaredNoise::NONE).unwrap();
    for turned in [0.49, 0.5, 0.51, 0.53] {
        let mut retrace = path.retrace(1);
        for target in [0.21, 0.41, turned] {
            assert!(
                (retrace.move_to(target).1 - loading(target)).abs() < 1e-9,
                "{turned}"
            );
        }
        for target in [0.46, 0.39] {
            let by_hand = loading(turned) - 1000.0 * (turned - target);
            let (_, force) = retrace.move_to(target);
            assert!(
                (force - by_hand).abs() < 1e-9,
                "{turned}: {force} {by_hand}"
            );
        }
    }
}

/// Noise on short pieces gives no stiffness: past the end the re-run continues with the slope of a long enough piece.
#[test]
fn noise_makes_no_tangent() {
    let readings = |step: u32| {
        let target = 1e-3 * f64::from(step);
        let noise = if step.is_multiple_of(2) { 1.0 } else { -1.0 };
        Reading {
            target,
            displacement: target,
            force: 1000.0 * target + noise,
        }
    };
    let path = RecordedPath::new(
        (0..200).map(readings).collect::<Vec<_>>(),
        None,
        1000.0,
        DeclaredNoise {
            force: 1.0,
            resolution: 0.0,
        },
    )
    .unwrap();
    let mut retrace = path.retrace(1);
    for step in 1..200 {
        retrace.move_to(1e-3 * f64::from(step));
    }
    let (_, force) = retrace.move_to(0.3);
    assert!((force - 300.0).abs() < 12.0, "{force}");
}

/// With and without noise, in finer steps, near the recorded targets and many steps away: the search that begins where the last one ended
/// finds the numbers of a search from the present reading, to the last bit. Without noise a step along a stretch rounds differently.
#[test]
fn a_search_from_the_last_place_finds_the_same_numbers() {
    for (noise, finer) in [(0.0, 1), (0.0, 4), (3.0, 1), (3.0, 2)] {
        let targets = motion(&LOOPS, STEP);
        let reading = |(step, target): (u32, &f64)| Reading {
            target: *target,
            displacement: target + 1e-5 * target.sin(),
            force: 1000.0 * target + noise * (1.7 * f64::from(step)).sin(),
        };
        let noise = DeclaredNoise {
            force: noise,
            resolution: 0.0,
        };
        let readings: Vec<_> = (0..).zip(&targets).map(reading).collect();
        let path = RecordedPath::new(readings, None, 1000.0, noise).unwrap();
        for (off, late) in [
            (0.0, 0),
            (0.3 * STEP, 0),
            (7.4 * STEP, 0),
            (0.0, 9),
            (-2.3 * STEP, 60),
        ] {
            let (mut retrace, mut afresh) = (path.retrace(finer), path.retrace(finer));
            let (mut along, mut farthest) = (0, 0);
            let moved = motion(&LOOPS.map(|turn| turn + off), STEP / f64::from(finer));
            let waiting = std::iter::repeat_n(moved[0], late * usize::from(finer));
            for target in waiting.chain(moved.iter().copied()) {
                (afresh.along, afresh.searched) = (None, Searched::default());
                let stays = retrace.along.is_some();
                let (found, searched) = (retrace.move_to(target), afresh.move_to(target));
                let near = |found: f64, searched: f64| {
                    (found - searched).abs()
                        <= if noise.force == 0.0 { 4e-16 } else { 0.0 } * searched.abs().max(1.0)
                };
                assert!(
                    near(found.0, searched.0) && near(found.1, searched.1),
                    "{off} m: {found:?}, not {searched:?}"
                );
                along += u32::from(stays && retrace.read_along(target).is_some());
                farthest = farthest.max(retrace.searched.0);
            }
            assert_eq!(retrace.departed(), afresh.departed());
            assert!(along > 400, "{along}");
            assert!(farthest > 2 || off.abs() < STEP, "{farthest}");
        }
    }
}

/// Where the record pauses, several readings have one target: there the present one counts, and beyond them the nearest of them.
#[test]
fn a_pause_in_the_record_is_passed_at_its_last_reading() {
    let readings = [
        (0.0, 0.0),
        (1.0, 10.0),
        (1.0, 12.0),
        (2.0, 20.0),
        (3.0, 30.0),
    ];
    let readings = readings.map(|(target, force)| Reading {
        target,
        displacement: target,
        force,
    });
    let path = RecordedPath::new(readings.to_vec(), None, 10.0, DeclaredNoise::NONE).unwrap();
    for (targets, forces) in [
        ([1.0, 1.0, 2.0, 3.0], [10.0, 12.0, 20.0, 30.0]),
        ([0.5, 1.0, 1.5, 2.5], [5.0, 12.0, 16.0, 25.0]),
        ([0.5, 1.5, 1.5, 1.75], [5.0, 16.0, 16.0, 18.0]),
    ] {
        let mut retrace = path.retrace(1);
        let read = targets.map(|target| retrace.move_to(target).1);
        assert_eq!(read, forces, "{targets:?}");
        assert!(!retrace.departed());
    }
}

/// A continuous motion is cut where its velocity changes its sign. Its positions may go back a little before that: a position is then
/// found between the first two readings that enclose it.
#[test]
fn a_continuous_motion_that_goes_back_early_is_read_between_neighbours() {
    let readings = [(0.0, 0.0), (1.0, 10.0), (2.0, 20.0), (1.9, 40.0)];
    let readings = readings.map(|(target, force)| Reading {
        target,
        displacement: target,
        force,
    });
    let motion = ContinuousMotion {
        velocities: &[0.0, 1.0, 1.0, 0.1][..],
        time_step: 1.0,
    };
    let path = RecordedPath::new(readings.to_vec(), Some(motion), 10.0, DeclaredNoise::NONE);
    let path = path.unwrap();
    let (_, force) = path.retrace(1).pass(1.95, 1.0);
    assert!((force - 19.5).abs() < 1e-12, "{force} N");
}

/// Steps of `step` \[m\] from reversal to reversal.
fn motion(turns: &[f64], step: f64) -> Vec<f64> {
    let mut positions = vec![turns[0]];
    for ends in turns.windows(2) {
        let count = ((ends[1] - ends[0]).abs() / step).round();
        let mut selected = 0.0;
        while selected < count {
            selected += 1.0;
            positions.push(ends[0] + (ends[1] - ends[0]) * selected / count);
        }
    }
    positions
}

fn recorded(mut model: impl RestoringForce, targets: &[f64]) -> RecordedPath {
    let reading = |target: &f64| Reading {
        target: *target,
        displacement: *target,
        force: model.move_to(*target),
    };
    RecordedPath::new(
        targets.iter().map(reading).collect::<Vec<_>>(),
        None,
        1000.0,
        DeclaredNoise::NONE,
    )
    .unwrap()
}

/// The largest force error of the re-run.
fn worst(path: &RecordedPath, mut model: impl RestoringForce, targets: &[f64]) -> f64 {
    let mut retrace = path.retrace(1);
    model.move_to(targets[0]);
    targets[1..]
        .iter()
        .map(|target| (retrace.move_to(*target).1 - model.move_to(*target)).abs())
        .fold(0.0, f64::max)
}

/// It yields, unloads a little and yields further; it then yields in the other direction, and reloads past all of it.
const LOOPS: [f64; 6] = [0.0, 0.4, 0.3, 0.6, -0.2, 0.8];
const MOVED: [f64; 6] = [0.0, 0.41, 0.305, 0.62, -0.19, 0.83];
/// \[m\]
const STEP: f64 = 2e-3;

/// Every yield point has its correct position on the new path: exactly, if the record has a reading there. Between two recorded points a
/// yield point is cut by K·step/4 at most. Where a loop closes, two curves may each have such a cut.
#[test]
fn parallel_elements_are_identified_from_any_reversal() {
    let bilinear = || {
        Bilinear::new(BilinearCurve {
            stiffness: 1000.0,
            yield_force: 200.0,
            post_yield_ratio: 0.1,
        })
    };
    let cut = 0.5 * 1000.0 * STEP;
    let path = recorded(bilinear(), &motion(&LOOPS, STEP));
    assert!(path.keeps_masing);
    let off = worst(&path, bilinear(), &motion(&MOVED, STEP));
    assert!(off < 1e-9, "{off} N");
    let multilinear = || Multilinear::new(&[[0.1, 100.0], [0.25, 200.0], [0.7, 300.0]]);
    let path = recorded(multilinear(), &motion(&LOOPS, STEP));
    let off = worst(&path, multilinear(), &motion(&MOVED, STEP));
    assert!(off <= cut, "{off} N");
}

/// The cut is proportional to the step.
#[test]
fn finer_steps_cut_less() {
    let bilinear = || {
        Bilinear::new(BilinearCurve {
            stiffness: 1000.0,
            yield_force: 200.0,
            post_yield_ratio: 0.1,
        })
    };
    for step in [7e-3, 1.9e-3, 5.3e-4] {
        let off = worst(
            &recorded(bilinear(), &motion(&LOOPS, step)),
            bilinear(),
            &motion(&MOVED, step),
        );
        assert!(
            off > 1e-3 * 1000.0 * step && off <= 0.5 * 1000.0 * step,
            "{step} m: {off} N"
        );
    }
}

/// A loop that is not made is left out. A loop that is made a few steps early or late is matched to the recorded one.
#[test]
fn turns_are_its_own() {
    let bilinear = || {
        Bilinear::new(BilinearCurve {
            stiffness: 1000.0,
            yield_force: 200.0,
            post_yield_ratio: 0.1,
        })
    };
    let path = recorded(bilinear(), &motion(&[0.0, 0.4, 0.38, 0.6, 0.5], STEP));
    let straight = motion(&[0.0, 0.61, 0.5], STEP);
    let off = worst(&path, bilinear(), &straight);
    assert!(off <= 0.5 * 1000.0 * STEP, "{off} N");
    for reversal in [0.39, 0.41] {
        let off = worst(
            &path,
            bilinear(),
            &motion(&[0.0, reversal, reversal - 0.02, 0.6, 0.5], STEP),
        );
        assert!(off <= 0.5 * 1000.0 * STEP, "{off} N");
    }
}

/// Unloading where the record never unloaded: with the initial stiffness, and the departure is reported.
#[test]
fn an_unrecorded_reversal_is_reported() {
    let bilinear = || {
        Bilinear::new(BilinearCurve {
            stiffness: 1000.0,
            yield_force: 200.0,
            post_yield_ratio: 0.1,
        })
    };
    let path = recorded(bilinear(), &motion(&[0.0, 0.6], STEP));
    let targets = motion(&[0.0, 0.4, 0.35, 0.6], STEP);
    let off = worst(&path, bilinear(), &targets);
    assert!(off <= 0.5 * 1000.0 * STEP, "{off} N");
    let mut retrace = path.retrace(1);
    for target in &targets {
        retrace.move_to(*target);
    }
    assert!(retrace.departed() && !path.retrace(1).departed());
}

/// Sixty reversals, first with growing amplitude; `more` adds a relative variation of the amplitude.
fn swings(more: f64) -> Vec<f64> {
    let reversal = |reversal: u32| {
        let phase = f64::from(reversal);
        let size = 0.5 * (1.0 + 0.4 * (0.37 * phase).sin()) * (0.15 * phase).min(1.0)
            + 0.05 * (1.3 * phase).sin();
        let size = size * (1.0 + more * (0.9 * phase).cos());
        if reversal.is_multiple_of(2) {
            size
        } else {
            -size
        }
    };
    (0..60).map(reversal).collect()
}

/// Elements in parallel keep Masing's rule and never depart from their record. Specimens that pinch, degrade or follow the Bouc–Wen
/// equation depart as soon as they reverse elsewhere. For an elastic specimen the rule has no effect.
#[test]
fn a_record_shows_whether_it_follows_masings_rule() {
    let pinching = SpecimenModel::new(&Behaviour::Pinching(Pinching {
        stiffness: 1000.0,
        yield_force: 200.0,
        post_yield_ratio: 0.05,
        force_factor: 0.4,
        displacement_factor: 0.5,
        unloading_exponent: 0.0,
        capping: None,
        deterioration: None,
    }));
    let bouc_wen = |sharpness, beta| {
        SpecimenModel::BoucWen(Box::new(BoucWen::new(
            BilinearCurve {
                stiffness: 1000.0,
                yield_force: 200.0,
                post_yield_ratio: 0.1,
            },
            sharpness,
            beta,
        )))
    };
    let specimens = [
        (
            SpecimenModel::new(&Behaviour::Elastic { stiffness: 1000.0 }),
            true,
        ),
        (
            SpecimenModel::Bilinear(Bilinear::new(BilinearCurve {
                stiffness: 1000.0,
                yield_force: 200.0,
                post_yield_ratio: 0.1,
            })),
            true,
        ),
        (
            SpecimenModel::Multilinear(Multilinear::new(&[
                [0.1, 100.0],
                [0.25, 200.0],
                [0.7, 300.0],
            ])),
            true,
        ),
        (
            SpecimenModel::Degrading(Box::new(Degrading::new(DegradingCurve {
                stiffness: 1000.0,
                half_displacement: 0.2,
                residual: 0.0,
            }))),
            false,
        ),
        (bouc_wen(1.0, 0.5), false),
        (bouc_wen(2.0, 0.5), false),
        (bouc_wen(1.0, 0.7), false),
        (pinching, false),
    ];
    for (model, keeps) in specimens {
        // One swing, and sixty.
        for (turns, elsewhere) in [
            (vec![0.0, 0.6, -0.4], vec![0.0, 0.61, -0.4]),
            (swings(0.0), swings(0.02)),
        ] {
            let path = recorded(model.clone(), &motion(&turns, STEP));
            assert_eq!(path.keeps_masing, keeps, "{model:?}");
            let departed = |turns: &[f64]| {
                let mut retrace = path.retrace(1);
                motion(turns, STEP)[1..].iter().for_each(|target| {
                    retrace.move_to(*target);
                });
                retrace.departed()
            };
            assert!(!departed(&turns), "{model:?}");
            assert_eq!(departed(&elsewhere), !keeps, "{model:?}");
        }
    }
    let curved = path(|x| 1000.0 * x + 800.0 * x.powi(3), &motion(&LOOPS, STEP));
    assert!(curved.keeps_masing);
}
