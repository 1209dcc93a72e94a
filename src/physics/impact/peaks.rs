//! Peak absolute values, interpolated between the ends of steps, so that they are smooth functions of the inputs. In: displacements and
//! velocities, or a force alone, at the ends of steps. Out: the peak absolute values.

/// Peak |x| of several displacements, each with its velocity: inside a step the velocity is linear from one end to the other,
/// the trapezoidal rule.
#[derive(Clone, Debug)]
pub struct PeakDisplacements {
    time_step: f64,
    largest: Vec<f64>,
    last: Vec<(f64, f64)>,
}

impl PeakDisplacements {
    /// For `count` displacements; `time_step` in \[s\].
    #[must_use]
    pub fn new(count: usize, time_step: f64) -> Self {
        Self {
            time_step,
            largest: vec![0.0; count],
            last: vec![(0.0, 0.0); count],
        }
    }

    /// Adds the end of a step: each displacement \[m\] with its velocity \[m/s\].
    pub fn take(&mut self, ends: impl Iterator<Item = (f64, f64)>) {
        for ((largest, last), (displacement, velocity)) in
            self.largest.iter_mut().zip(&mut self.last).zip(ends)
        {
            let (before, speed) = *last;
            if speed * velocity < 0.0 {
                let turned = before + 0.5 * speed * speed / (speed - velocity) * self.time_step;
                *largest = largest.max(turned.abs());
            }
            *largest = largest.max(displacement.abs());
            *last = (displacement, velocity);
        }
    }

    /// Peak absolute value of each displacement so far \[m\].
    #[must_use]
    pub fn largest(&self) -> &[f64] {
        &self.largest
    }
}

/// Largest |y| of a number without a velocity: the top of the parabola through three ends of steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Peak {
    largest: f64,
    last: [Option<f64>; 2],
}

impl Peak {
    /// Adds the end of a step.
    pub fn take(&mut self, now: f64) {
        if let [Some(before), Some(middle)] = self.last {
            let (rise, fall) = (middle - before, middle - now);
            if rise * fall > 0.0 {
                let top = middle + (rise - fall).powi(2) / (8.0 * (rise + fall));
                self.largest = self.largest.max(top.abs());
            }
        }
        self.largest = self.largest.max(now.abs());
        self.last = [self.last[1], Some(now)];
    }

    /// Peak absolute value so far, in the unit of the values.
    #[must_use]
    pub const fn largest(&self) -> f64 {
        self.largest
    }
}

/// The larger absolute value of a peak so far and another displacement \[m\]; NaN after any NaN.
#[must_use]
pub fn farther(most: f64, displacement: f64) -> f64 {
    if most.is_nan() || displacement.abs() <= most {
        most
    } else {
        displacement.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sines of every phase, sampled with 30 steps a period: ends of steps miss the top by up to 1 − cos(π/30), half a percent.
    #[test]
    fn tops_are_found_between_the_ends_of_steps() {
        let step = std::f64::consts::TAU / 30.0;
        for phase in (0..20).map(|phase| 0.01 * f64::from(phase)) {
            let (mut displacement, mut peak) = (PeakDisplacements::new(1, step), Peak::default());
            for at in (0..60).map(|at| step * f64::from(at) + phase - 0.3) {
                // Eq. (2d) is exact for a velocity that is linear between the ends: displacement and velocity agree to its order.
                displacement.take([(-2.0 * at.sin(), -2.0 * at.cos())].into_iter());
                peak.take(-2.0 * at.sin());
            }
            assert!(
                (displacement.largest()[0] / 2.0 - 1.0).abs() < 6e-4,
                "{}",
                displacement.largest()[0]
            );
            // A parabola misses a cubic's top by its third derivative, sin(step/2) at most, times step³/(9√3).
            let within = (0.5 * step).sin() * step.powi(3) / (9.0 * 3.0_f64.sqrt());
            assert!(
                (peak.largest() / 2.0 - 1.0).abs() < within,
                "{}",
                peak.largest()
            );
        }
    }
}
