//! The acceleration of the ground at any instant: linear between the samples of its record, at rest before and after. In:
//! times and accelerations. Out: one number. It knows no file and no unit.

/// m/s² at `time` \[s\], of samples at rising `times`.
#[must_use]
pub fn acceleration_at(times: &[f64], accelerations: &[f64], time: f64) -> f64 {
    let after = times.partition_point(|sample| *sample <= time);
    before_sample(times, accelerations, time, after)
}

/// The same, at times that rise from call to call: `passed` counts the samples up to the last one.
pub fn next_acceleration(
    times: &[f64],
    accelerations: &[f64],
    time: f64,
    passed: &mut usize,
) -> f64 {
    let later = times.iter().skip(*passed);
    *passed += later.take_while(|sample| **sample <= time).count();
    before_sample(times, accelerations, time, *passed)
}

/// m/s² at `time` \[s\], which is before the sample with this index and not before the one in front of it.
fn before_sample(times: &[f64], accelerations: &[f64], time: f64, after: usize) -> f64 {
    let Some(before) = after.checked_sub(1) else {
        return 0.0;
    };
    match accelerations.get(after) {
        Some(next) => {
            let share = (time - times[before]) / (times[after] - times[before]);
            accelerations[before] + share * (next - accelerations[before])
        }
        // The last sample itself, to the rounding of a time that was counted in steps.
        None if time <= times[before] * (1.0 + 1e-12) => accelerations[before],
        None => 0.0,
    }
}

/// Largest velocity of the ground, m/s, by size: the acceleration integrated from rest.
#[must_use]
pub fn peak_velocity(times: &[f64], accelerations: &[f64]) -> f64 {
    let steps = times.windows(2).zip(accelerations.windows(2));
    let (_, peak) = steps.fold(
        (0.0, 0.0),
        |(velocity, peak): (f64, f64), (time, acceleration)| {
            let velocity =
                velocity + 0.5 * (acceleration[0] + acceleration[1]) * (time[1] - time[0]);
            (velocity, peak.max(velocity.abs()))
        },
    );
    peak
}

#[cfg(test)]
mod tests {
    use super::{acceleration_at, peak_velocity};

    #[test]
    fn the_velocity_is_the_area_under_the_acceleration() {
        // 0.05 + (1 − 2)/2 · 0.3 = −0.1: down from 0.05, and from 0.1 at the turn in between.
        assert!((peak_velocity(&[0.0, 0.1, 0.4], &[0.0, 1.0, -2.0]) - 0.1).abs() < 1e-15);
    }

    #[test]
    fn is_linear_between_uneven_samples_and_nothing_outside_them() {
        let (times, accelerations) = ([0.0, 0.1, 0.4], [0.0, 1.0, -2.0]);
        for (time, expected) in [
            (-0.1, 0.0),
            (0.0, 0.0),
            (0.05, 0.5),
            (0.1, 1.0),
            (0.2, 0.0),
            (0.4, -2.0),
            (0.41, 0.0),
        ] {
            assert!(
                (acceleration_at(&times, &accelerations, time) - expected).abs() < 1e-15,
                "{time} s"
            );
        }
    }
}
