//! The digest of targets, readings, ends of strokes and steps, of which a simulation makes the same again. In: each of them, in order. Out: the
//! body of a DIGEST entry. The bytes are those of `docs/record.md`; it knows no run log.

use sha2::{Digest as _, Sha256};

use super::entry::{AxisBody, DigestBody, IntentBody};
use crate::run::{AxisReport, StepReport};
use psd_physics::tracking::trajectory::Path;
use psd_rig::Reading;
use psd_rig::journal::Refusal;
use psd_text::digest::hex;

/// Number of steps of a digest, unless another entry comes first.
pub(super) const DIGEST_STEPS: u64 = 1000;

/// Number of bytes that are collected before they are hashed.
const HASHED_BYTES: usize = 8 * 1024;

/// A target, as far as it is digested.
pub(super) struct DigestedTarget<'a> {
    /// \[m\]
    pub to: &'a [f64],
    /// As requested \[m/s\].
    pub speed: Option<f64>,
    /// \[m\]
    pub encoded: Option<&'a [f64]>,
    /// \[m/s\]
    pub rate: f64,
    pub id: Option<u64>,
    pub path: Option<&'a [Path]>,
    pub samples: Option<usize>,
}

impl<'a> From<&'a IntentBody> for DigestedTarget<'a> {
    fn from(intent: &'a IntentBody) -> Self {
        Self {
            to: &intent.to,
            speed: intent.speed,
            encoded: intent.encoded.as_deref(),
            rate: intent.rate,
            id: intent.id,
            path: intent.path.as_deref(),
            samples: intent.samples,
        }
    }
}

/// The digest since the last DIGEST entry.
#[derive(Default)]
pub(super) struct StepsDigest {
    hash: Sha256,
    /// Bytes that are not hashed yet: whole words of 8 bytes.
    bytes: Vec<u8>,
    /// Where the last of them begins in `bytes`.
    start: usize,
    /// Whether all its numbers are finite.
    finite: bool,
    pub entries: u64,
    pub steps: u64,
    targets: u64,
    /// Rig time of the last of them \[s\].
    pub time: f64,
}

impl StepsDigest {
    pub(super) fn target(&mut self, target: &DigestedTarget<'_>) -> Result<(), Refusal> {
        let given = [
            target.speed.is_some(),
            target.encoded.is_some(),
            target.id.is_some(),
            target.path.is_some(),
            target.samples.is_some(),
        ];
        self.begin(1, &given, target.to.len());
        self.numbers(target.to);
        if let Some(speed) = target.speed {
            self.number(speed);
        }
        self.number(target.rate);
        self.numbers(target.encoded.unwrap_or_default());
        if let Some(id) = target.id {
            self.word(id);
        }
        for path in target.path.unwrap_or_default() {
            self.numbers_of([
                path.from,
                path.to,
                path.start_velocity,
                path.end_velocity,
                path.seconds,
            ]);
        }
        if let Some(samples) = target.samples {
            self.word(samples as u64);
        }
        self.end()?;
        self.targets += 1;
        Ok(())
    }

    pub(super) fn reading(
        &mut self,
        reading: &Reading,
        moved: Option<[f64; 2]>,
    ) -> Result<(), Refusal> {
        self.begin(2, &[moved.is_some()], reading.displacement.len());
        self.number(reading.time);
        self.numbers(&reading.displacement);
        self.numbers(&reading.force);
        self.numbers(moved.as_ref().map_or(&[], |ends| ends.as_slice()));
        self.end()
    }

    /// The end of a stroke with this number of readings.
    pub(super) fn stroke(&mut self, samples: usize) -> Result<(), Refusal> {
        self.begin(3, &[], 0);
        self.word(samples as u64);
        self.end()
    }

    pub(super) fn step(&mut self, report: &StepReport) -> Result<(), Refusal> {
        let AxisReport {
            command,
            displacement,
            velocity,
            acceleration,
            force,
        } = report.axes[0];
        let energy_error = report.energy_error.filter(|error| error.is_finite());
        let given = [
            velocity.is_some(),
            acceleration.is_some(),
            energy_error.is_some(),
        ];
        self.begin(4, &given, report.axes.len());
        self.word(report.step);
        self.numbers_of([report.time, command, displacement, force]);
        let optional = [velocity, acceleration, energy_error];
        for number in optional.into_iter().flatten() {
            self.number(number);
        }
        for axis in &report.axes[1..] {
            let AxisBody { u, x, v, a, r } = AxisBody::of(axis);
            self.numbers_of([u, x, v, a, r]);
        }
        self.end()?;
        self.steps += 1;
        Ok(())
    }

    /// The entry of all of them; a new digest begins. None: there are none.
    pub(super) fn take(&mut self) -> Option<DigestBody> {
        if self.entries == 0 {
            return None;
        }
        self.hash.update(&self.bytes);
        let body = DigestBody {
            entries: self.entries,
            steps: self.steps,
            targets: self.targets,
            t: self.time,
            sha256: hex(&self.hash.finalize_reset()),
        };
        self.bytes.clear();
        (self.entries, self.steps, self.targets) = (0, 0, 0);
        Some(body)
    }

    /// The first word: the kind, a bit for each optional part, and the number of axes.
    fn begin<const N: usize>(&mut self, kind: u64, given: &[bool; N], axes: usize) {
        (self.start, self.finite) = (self.bytes.len(), true);
        let bits = given
            .iter()
            .rev()
            .fold(0, |bits, given| bits << 1 | u64::from(*given));
        self.word(kind | bits << 8 | (axes as u64) << 16);
    }

    fn word(&mut self, word: u64) {
        self.bytes.extend_from_slice(&word.to_le_bytes());
    }

    fn number(&mut self, number: f64) {
        self.numbers_of([number]);
    }

    fn numbers_of<const N: usize>(&mut self, numbers: [f64; N]) {
        for number in numbers {
            self.finite &= number.is_finite();
        }
        self.bytes
            .extend_from_slice(numbers.map(f64::to_le_bytes).as_flattened());
    }

    fn numbers(&mut self, numbers: &[f64]) {
        for number in numbers {
            self.number(*number);
        }
    }

    /// One of a number that is not finite has no effect.
    fn end(&mut self) -> Result<(), Refusal> {
        if !self.finite {
            self.bytes.truncate(self.start);
            return Err(Refusal::NotFinite);
        }
        if self.bytes.len() >= HASHED_BYTES {
            self.hash.update(&self.bytes);
            self.bytes.clear();
        }
        self.entries += 1;
        Ok(())
    }
}
