//! Constant-velocity passes of a real rig: readings at equally spaced times, and the end of a pass.

use super::*;

#[test]
fn a_stroke_reads_at_equal_times_and_ends_at_its_target() {
    let mut stand = stand();
    let mut readings = Vec::new();
    let mut keep = |reading: Reading| {
        readings.push((reading.time, reading.displacement[0]));
        Ok(())
    };
    stand.rig.traverse(&[0.008], 0.001, 4, &mut keep).unwrap();
    let began = readings[0].0 - 2.0;
    for (sample, (time, x)) in (1..).zip(&readings) {
        let expected = 0.002 * f64::from(sample);
        assert!(
            (time - began - 2.0 * f64::from(sample)).abs() < 1e-6,
            "{readings:?}"
        );
        assert!((x - expected).abs() < 2e-5, "{readings:?}");
    }
    assert_eq!(stand.device.inside().position, 0.008);
    assert!(
        stand
            .rig
            .traverse(&[0.0], 0.001, 4, &mut |_| Ok(()))
            .is_err(),
        "away from the target"
    );
    assert!(
        stand
            .rig
            .traverse(&[0.0], -0.001, 0, &mut |_| Ok(()))
            .is_err()
    );
}

#[test]
fn a_stroke_stops_at_a_refused_reading() {
    let mut stand = stand();
    let mut count = 0;
    let refused = stand.rig.traverse(&[0.008], 0.001, 8, &mut |_| {
        count += 1;
        if count == 3 {
            Err(RigFault::Interrupted)
        } else {
            Ok(())
        }
    });
    assert_eq!((refused, count), (Err(RigFault::Interrupted), 3));
    let stopped_at = stand.device.inside().position;
    assert!((0.003..0.0031).contains(&stopped_at) && stand.device.inside().target == stopped_at);
    // The remaining travel begins there; at the end only the missing reading is made.
    let mut on = |done| {
        let mut positions = Vec::new();
        let cut_off = CutOff {
            from: &[0.0],
            to: &[0.008],
            samples: 8,
            done,
        };
        let rest = stand.rig.traverse_on(&cut_off, 0.001, &mut |reading| {
            positions.push(reading.displacement[0]);
            Ok(())
        });
        rest.map(|()| positions).unwrap()
    };
    let rest = on(2);
    assert!(
        rest.len() == 6 && rest[0] > stopped_at && rest.is_sorted() && rest[5] == 0.008,
        "{rest:?}"
    );
    assert_eq!((on(7), on(8)), (vec![0.008], Vec::new()));
}

#[test]
fn a_stroke_reads_as_often_as_the_line_carries_and_waits_until_it_rests() {
    let mut stand = stand();
    stand.device.inside().answer_time = 0.3;
    let mut readings = Vec::new();
    let mut keep = |reading: Reading| {
        readings.push((reading.time, reading.displacement[0]));
        Ok(())
    };
    // 100 readings in 8 s would be 0.08 s apart: one takes 0.3 s.
    stand.rig.traverse(&[0.008], 0.001, 100, &mut keep).unwrap();
    assert!((25..=27).contains(&readings.len()), "{}", readings.len());
    let began = readings[0].0 - readings[0].1 / 0.001;
    for (time, x) in &readings {
        assert!(
            (x - (0.001 * (time - began)).min(0.008)).abs() < 1e-6,
            "each with its own time and place: {readings:?}"
        );
    }
    assert_eq!(readings.last().unwrap().1, 0.008, "the last at the end");
    // A pass that ends before the first reply has only one reading.
    let late = stand
        .rig
        .traverse(&[0.0], -0.1, 8, &mut |_| Ok(()))
        .unwrap_err();
    assert!(
        late.to_string()
            .starts_with("the readings are too slow: 1 in a stroke of 0.080 s"),
        "{late}"
    );
}

#[test]
fn a_stroke_that_ends_elsewhere_is_a_following_error() {
    let mut stand = stand();
    stand.device.inside().reaches = 0.9;
    let short = stand
        .rig
        .traverse(&[0.008], 0.001, 8, &mut |_| Ok(()))
        .unwrap_err();
    assert!(
        matches!(short, RigFault::Following { error, .. } if (error - 0.0008).abs() < 1e-9),
        "{short:?}"
    );
    assert_eq!(stand.device.inside().holds, 1);
}
