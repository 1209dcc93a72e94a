//! Modes of uniform shear buildings, compared with their closed form (a chain of equal masses, fixed below and free above).

use psd_physics::structure::modes;

use super::support::{uniform, uniform_frequency, uniform_shape};

#[test]
fn uniform_buildings_have_the_frequencies_and_shapes_of_the_closed_form() {
    for storeys in [1, 2, 5, 20, 60] {
        let frame = uniform(storeys, 1500.0, 2e6);
        let found = modes(&frame.mass, &frame.stiffness).expect("modes");
        for mode in 0..storeys {
            let expected = uniform_frequency(storeys, mode + 1, 1500.0, 2e6);
            let frequency = found.angular_frequency(mode);
            assert!(
                (frequency / expected - 1.0).abs() < 1e-12,
                "{storeys} storeys, mode {mode}: {frequency}, {expected}"
            );
            let shape = uniform_shape(storeys, mode + 1);
            let largest = shape
                .iter()
                .copied()
                .fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
            let sign = if (found.shapes[mode][0] > 0.0) == (shape[0] / largest > 0.0) {
                1.0
            } else {
                -1.0
            };
            for (entry, exact) in found.shapes[mode].iter().zip(&shape) {
                assert!(
                    (entry - sign * exact / largest).abs() < 1e-10,
                    "{storeys} storeys, mode {mode}"
                );
            }
        }
        assert!(
            found.periods.windows(2).all(|pair| pair[0] > pair[1]),
            "longest first"
        );
        assert!((found.critical_time_step() - found.periods[storeys - 1] / 10.0).abs() < 1e-18);
    }
}

#[test]
fn modes_are_orthogonal_and_their_effective_masses_are_the_whole_mass() {
    for storeys in [2, 5, 20] {
        let frame = uniform(storeys, 1500.0, 2e6);
        let found = modes(&frame.mass, &frame.stiffness).expect("modes");
        for a in 0..storeys {
            assert!(
                (found.shapes[a].iter().copied().fold(0.0, f64::max) - 1.0).abs() < 1e-15,
                "its largest entry is +1"
            );
            for b in 0..a {
                let scale = frame.mass.form(&found.shapes[a], &found.shapes[a]);
                assert!(frame.mass.form(&found.shapes[a], &found.shapes[b]).abs() < 1e-12 * scale);
                let scale = frame.stiffness.form(&found.shapes[a], &found.shapes[a]);
                assert!(
                    frame
                        .stiffness
                        .form(&found.shapes[a], &found.shapes[b])
                        .abs()
                        < 1e-12 * scale
                );
            }
        }
        assert!((found.effective_mass.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        // ι = Σ Γ φ.
        for floor in 0..storeys {
            let sum: f64 = (0..storeys)
                .map(|mode| found.participation[mode] * found.shapes[mode][floor])
                .sum();
            assert!((sum - 1.0).abs() < 1e-11);
        }
    }
}
