//! Readings that instruments with different errors would have given. In: a reading of the record. Out: the reading with the scale
//! factors, zero offsets and simulated errors of a re-run. It knows no path, no procedure and no plan.

/// The instruments of one axis in a re-run; each load cell and each transducer is a separate instrument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instruments {
    /// Newtons in one newton of the record.
    pub force_scale: f64,
    /// Metres in one metre of the record.
    pub displacement_scale: f64,
    /// Added to every force \[N\].
    pub zero_offset: f64,
    pub force_below: BelowRange,
    pub displacement_below: BelowRange,
    pub errors: ReadingErrors,
}

impl Instruments {
    /// Those that change no reading.
    const UNCHANGED: Self = Self {
        force_scale: 1.0,
        displacement_scale: 1.0,
        zero_offset: 0.0,
        force_below: BelowRange::NONE,
        displacement_below: BelowRange::NONE,
        errors: ReadingErrors::NONE,
    };

    /// The reading of a displacement of the record \[m\].
    #[must_use]
    pub fn displaced(&self, position: f64) -> f64 {
        self.displacement_scale * position + self.displacement_below.error_of(position)
    }

    /// The reading of a force of the record \[N\].
    #[must_use]
    pub fn loaded(&self, force: f64) -> f64 {
        self.force_scale * force + self.force_below.error_of(force) + self.zero_offset
    }
}

/// Error of the readings below the lower end of a calibrated range, beside the scale factor. An absolute error that holds at the end
/// holds for them as well, so that the error of a reading grows with its distance from the end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BelowRange {
    /// Lower end of the range \[N\] or \[m\].
    pub end: f64,
    /// Readings up to this size cannot be distinguished from zero \[N\] or \[m\].
    pub zero: f64,
    /// Error of a reading as a fraction of its distance from the end.
    pub error: f64,
}

impl BelowRange {
    const NONE: Self = Self {
        end: 0.0,
        zero: 0.0,
        error: 0.0,
    };

    /// The error of a reading just above zero \[N\] or \[m\].
    #[must_use]
    pub const fn of_end(self) -> f64 {
        self.error * self.end
    }

    /// The same end with a multiple of the error.
    #[must_use]
    pub const fn times(self, by: f64) -> Self {
        Self {
            error: by * self.error,
            ..self
        }
    }

    /// The error of a reading, for a positive fraction away from zero. A reading of zero has no direction and no error:
    /// otherwise its noise would decide the sign.
    #[must_use]
    pub fn error_of(self, reading: f64) -> f64 {
        if self.error == 0.0 || reading.abs() <= self.zero {
            return 0.0;
        }
        self.error * (self.end - reading.abs()).max(0.0) * reading.signum()
    }
}

/// Errors of a reading.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReadingErrors {
    /// Standard deviation of one force \[N\].
    pub noise: f64,
    /// Quantization step of the displacement \[m\].
    pub resolution: f64,
    /// Quantization step of the force \[N\].
    pub force_resolution: f64,
}

impl ReadingErrors {
    const NONE: Self = Self {
        noise: 0.0,
        resolution: 0.0,
        force_resolution: 0.0,
    };

    /// Whether there are any.
    #[must_use]
    pub fn any(&self) -> bool {
        self.noise > 0.0 || self.force_resolution > 0.0 || self.resolution > 0.0
    }

    /// Standard uncertainty of one reading by quantization: force \[N\] and displacement \[m\], q/√12 (JCGM 100:2008, F.2.2.1).
    #[must_use]
    pub fn quantization(&self) -> [f64; 2] {
        [self.force_resolution, self.resolution].map(|step| step / 12.0_f64.sqrt())
    }
}

/// All readings of a re-run.
#[derive(Clone, Debug, PartialEq)]
pub struct Perturbation {
    /// One per axis.
    pub axes: Vec<Instruments>,
    /// The Monte Carlo trial whose errors the readings have.
    pub trial: Option<u16>,
    /// Steps for each of the record, 1 or more.
    pub finer: u8,
}

impl Perturbation {
    /// The unchanged readings.
    #[must_use]
    pub fn none(axes: usize) -> Self {
        Self {
            axes: vec![Instruments::UNCHANGED; axes],
            trial: None,
            finer: 1,
        }
    }

    /// Whether the readings of an axis are those of the record.
    #[must_use]
    pub fn leaves_unchanged(&self, axis: usize) -> bool {
        self.trial.is_none() && self.axes[axis] == Instruments::UNCHANGED
    }

    /// A velocity or a small motion of the re-run, in metres of the record.
    #[must_use]
    #[inline]
    pub fn recorded(&self, axis: usize, value: f64) -> f64 {
        let scale = self.axes[axis].displacement_scale;
        // Most re-runs leave it unchanged, and each step would wait for the division.
        if scale == 1.0 { value } else { value / scale }
    }

    /// The position of the record that these instruments read as this displacement \[m\].
    #[must_use]
    #[inline]
    pub fn recorded_position(&self, axis: usize, reading: f64) -> f64 {
        let Instruments {
            displacement_scale: scale,
            displacement_below: BelowRange { end, zero, error },
            ..
        } = self.axes[axis];
        if error == 0.0 || reading.abs() <= scale * zero || reading.abs() >= scale * end {
            return self.recorded(axis, reading);
        }
        ((reading.abs() - error * end) / (scale - error)).max(0.0) * reading.signum()
    }

    /// Displacement \[m\] and force \[N\] of an axis as these instruments read them. `reading` numbers the readings of the run; each is
    /// the mean of so many samples. Every reading has its own errors: noise, which a mean averages, and q/√12. All readings of an axis
    /// have q/√12 in common.
    #[must_use]
    #[inline]
    pub fn read(&self, reading: u64, axis: usize, samples: u32, read: (f64, f64)) -> (f64, f64) {
        let (displacement, force) = read;
        let instruments = &self.axes[axis];
        let (displacement, force) = (
            instruments.displaced(displacement),
            instruments.loaded(force),
        );
        let Some(trial) = self.trial else {
            return (displacement, force);
        };
        let errors = instruments.errors;
        let [of_force, of_displacement] = errors.quantization();
        let own = (errors.noise / f64::from(samples.max(1)).sqrt()).hypot(of_force);
        let [force_sign, displacement_sign] = signs(trial, reading, axis);
        let [common_force, common_displacement] = common(trial, axis);
        (
            displacement + of_displacement * (displacement_sign + common_displacement),
            force + own * force_sign + of_force * common_force,
        )
    }
}

/// Numbers that do not belong to any reading.
const COMMON: u64 = u64::MAX >> 16;

/// Signs of an input in a Monte Carlo trial, by its index among the inputs.
#[must_use]
pub fn sign_of_input(trial: u16, input: usize) -> f64 {
    signs(trial, COMMON - 1 - input as u64, 0)[0]
}

/// Two signs of a reading of an axis in a trial: two bits per axis; after the last bits of a word, a new word.
fn signs(trial: u16, reading: u64, axis: usize) -> [f64; 2] {
    let bits = drawn(trial, reading ^ (axis as u64 / 32) << 40) >> (2 * (axis % 32));
    [1, 2].map(|bit| if bits & bit == 0 { 1.0 } else { -1.0 })
}

/// The errors that all readings of an axis have in common in a trial, in standard deviations: rectangular, from −√3 to √3.
fn common(trial: u16, axis: usize) -> [f64; 2] {
    let bits = drawn(trial, COMMON ^ (axis as u64) << 40);
    let even = |bits: u32| {
        3.0_f64.sqrt() * (2.0 * (f64::from(bits) + 0.5) / (f64::from(u32::MAX) + 1.0) - 1.0)
    };
    #[expect(clippy::cast_possible_truncation, reason = "either half")]
    let halves = [bits as u32, (bits >> 32) as u32];
    halves.map(even)
}

/// Bits of a reading in a trial, the same in every run: the finaliser of `SplitMix64`.
fn drawn(trial: u16, reading: u64) -> u64 {
    let mut bits = (u64::from(trial) << 48 ^ reading)
        .wrapping_add(1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trials_differ_and_have_both_signs_alike() {
        let sum = |trial: u16| {
            (0..1000)
                .map(|reading| signs(trial, reading, 0)[0])
                .sum::<f64>()
        };
        for trial in 0..8 {
            assert!(sum(trial).abs() < 110.0, "trial {trial}: {}", sum(trial));
        }
        let both: f64 = (0..1000)
            .map(|reading| signs(3, reading, 0)[0] * signs(4, reading, 0)[0])
            .sum();
        assert!(both.abs() < 110.0, "{both}");
    }

    /// 1 % at 10 mm is 0.1 mm at every smaller displacement: 0.01·4 mm + 0.01·(10 − 4) mm. The path is passed where the transducer then
    /// shows the target. Beyond the end the factor alone is left.
    #[test]
    fn below_its_range_a_reading_has_the_absolute_error_of_the_end() {
        for sign in [1.0, -1.0] {
            let mut readings = Perturbation::none(1);
            readings.axes[0].displacement_scale = 1.0 + sign * 0.01;
            readings.axes[0].displacement_below = BelowRange {
                end: 10.0,
                zero: 0.5,
                error: sign * 0.01,
            };
            for (position, by_hand) in [(4.0, 0.1), (-4.0, -0.1), (9.999, 0.1), (20.0, 0.2)] {
                let (read, _) = readings.read(0, 0, 1, (position, 0.0));
                assert!((read - position - sign * by_hand).abs() < 1e-12, "{read}");
                assert!((readings.recorded_position(0, read) - position).abs() < 1e-12);
            }
            let (zero, _) = readings.read(0, 0, 1, (0.4, 0.0));
            assert_eq!(zero, 0.4 * (1.0 + sign * 0.01));
            assert!((readings.recorded_position(0, zero) - 0.4).abs() < 1e-12);
        }
    }

    /// Over many trials: σ²/n + q²/12 of each reading, and q²/12 of two readings together.
    #[test]
    fn readings_scatter_by_noise_and_quantization() {
        let errors = ReadingErrors {
            noise: 2.0,
            resolution: 0.0,
            force_resolution: 3.0,
        };
        let mut all = Perturbation::none(1);
        all.axes[0].errors = errors;
        let mut sums = [0.0; 2];
        for trial in 0..4000 {
            let perturbed = Perturbation {
                trial: Some(trial),
                ..all.clone()
            };
            let [one, other] = [1, 2].map(|reading| perturbed.read(reading, 0, 4, (0.0, 0.0)).1);
            sums[0] += one * one / 4000.0;
            sums[1] += one * other / 4000.0;
        }
        assert!(
            (sums[0] / (1.0 + 2.0 * 9.0 / 12.0) - 1.0).abs() < 0.06,
            "{sums:?}"
        );
        assert!((sums[1] / (9.0 / 12.0) - 1.0).abs() < 0.12, "{sums:?}");
    }
}
