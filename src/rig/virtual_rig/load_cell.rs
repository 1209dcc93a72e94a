//! The virtual load cell. In: its force and the rig time. Out: its reading, with zero drift, noise and resolution. Its random generator
//! is PCG-64-MCG, so a seed gives the same readings in every version.

use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use psd_plan::VirtualLink;

#[derive(Clone, Debug)]
pub struct LoadCell {
    /// Standard deviation of one reading \[N\].
    noise: f64,
    /// \[N\]
    resolution: f64,
    /// Zero drift in rig time \[N/s\].
    drift: f64,
    generator: Pcg64Mcg,
}

impl LoadCell {
    pub fn new(link: &VirtualLink, seed: u64) -> Self {
        Self {
            noise: link.noise,
            resolution: link.force_resolution,
            drift: link.drift,
            generator: Pcg64Mcg::seed_from_u64(seed),
        }
    }

    /// One reading of `force` \[N\] at the rig time `time` \[s\].
    pub fn read(&mut self, force: f64, time: f64) -> f64 {
        let deviation: f64 = if self.noise > 0.0 {
            StandardNormal.sample(&mut self.generator)
        } else {
            0.0
        };
        to_quantum(
            force + self.drift * time + self.noise * deviation,
            self.resolution,
        )
    }
}

/// The nearest multiple of the resolution `quantum`; the value itself if the resolution is 0.
pub fn to_quantum(value: f64, quantum: f64) -> f64 {
    if quantum > 0.0 {
        (value / quantum).round() * quantum
    } else {
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drift_grows_with_rig_time_and_the_quantum_rounds_to_the_nearest() {
        let link = VirtualLink {
            force_resolution: 0.5,
            drift: 0.25,
            ..VirtualLink::default()
        };
        let mut cell = LoadCell::new(&link, 0);
        assert_eq!(cell.read(10.0, 0.0), 10.0);
        assert_eq!(cell.read(10.0, 4.0), 11.0);
        assert_eq!(cell.read(10.2, 0.0), 10.0);
        assert_eq!(cell.read(10.3, 0.0), 10.5);
    }

    #[test]
    fn noise_has_the_stated_deviation_no_mean_and_repeats_by_seed() {
        let readings = |seed| {
            let link = VirtualLink {
                noise: 2.0,
                ..VirtualLink::default()
            };
            let mut cell = LoadCell::new(&link, seed);
            (0..10_000).map(|_| cell.read(0.0, 0.0)).collect::<Vec<_>>()
        };
        let first = readings(7);
        let mean = first.iter().sum::<f64>() / 1e4;
        let deviation = (first.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 9999.0).sqrt();
        // Standard errors of mean and deviation are 0.02 and 0.014.
        assert!(mean.abs() < 0.08, "{mean}");
        assert!((deviation - 2.0).abs() < 0.06, "{deviation}");
        assert_eq!(first, readings(7));
        assert_ne!(first, readings(8));
    }
}
