//! Random numbers by position. In: a seed, and the position of a number: the run, the input, the purpose. Out: the number. There is no
//! state, so run 7 of a study has the same numbers in any order, on any thread and in a study of any size.
//!
//! The generator is Philox 4×32-10 (J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, *Parallel random numbers: as easy as 1, 2, 3*,
//! Proc. SC11 (2011) 16:1–16:12): ten rounds of multiplication scramble a counter of 128 bits with a key of 64 bits.

use super::unit_interval;

const ROUNDS: u32 = 10;
const MULTIPLIERS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
/// Added to the key after every round: the golden ratio and √3 − 1, as fractions of 2³².
const KEY_STEPS: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];

/// The purpose of a number. Numbers of different purposes are independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The value of an input in a run.
    Value,
    /// The key of a Latin hypercube's permutation.
    Permutation,
    /// The key of a scramble.
    Scramble,
    /// The first points of a subset simulation.
    FirstLevel,
    /// The moves of a subset simulation within this level.
    Level(u16),
}

impl Purpose {
    const fn word(self) -> u32 {
        match self {
            Self::Value => 0,
            Self::Permutation => 1,
            Self::Scramble => 2,
            Self::FirstLevel => 3,
            Self::Level(level) => 1 << 16 | level as u32,
        }
    }
}

/// The random numbers of one seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Philox {
    key: [u32; 2],
}

impl Philox {
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self { key: halves(seed) }
    }

    /// 64 random bits.
    #[must_use]
    pub fn bits(self, purpose: Purpose, run: u64, input: u32) -> u64 {
        let [low, high] = halves(run);
        let [first, second, ..] = scrambled([low, high, input, purpose.word()], self.key);
        u64::from(second) << 32 | u64::from(first)
    }

    /// A number between 0 and 1, both excluded.
    #[must_use]
    pub fn uniform(self, purpose: Purpose, run: u64, input: u32) -> f64 {
        unit_interval(self.bits(purpose, run, input))
    }
}

/// The lower and the upper half.
#[expect(clippy::cast_possible_truncation, reason = "each is a half")]
const fn halves(bits: u64) -> [u32; 2] {
    [bits as u32, (bits >> 32) as u32]
}

/// The block of this counter under this key.
fn scrambled(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for _ in 0..ROUNDS {
        let [low_0, high_0] = halves(u64::from(MULTIPLIERS[0]) * u64::from(counter[0]));
        let [low_1, high_1] = halves(u64::from(MULTIPLIERS[1]) * u64::from(counter[2]));
        counter = [
            high_1 ^ counter[1] ^ key[0],
            low_1,
            high_0 ^ counter[3] ^ key[1],
            low_0,
        ];
        key = [
            key[0].wrapping_add(KEY_STEPS[0]),
            key[1].wrapping_add(KEY_STEPS[1]),
        ];
    }
    counter
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The known answers that the authors publish with their program Random123 (`kat_vectors`, philox4x32 with 10 rounds).
    #[test]
    fn it_gives_the_published_answers() {
        assert_eq!(
            scrambled([0; 4], [0; 2]),
            [0x6627_E8D5, 0xE169_C58D, 0xBC57_AC4C, 0x9B00_DBD8]
        );
        assert_eq!(
            scrambled([u32::MAX; 4], [u32::MAX; 2]),
            [0x408F_276D, 0x41C8_3B0E, 0xA20B_C7C6, 0x6D54_51FD]
        );
        assert_eq!(
            scrambled(
                [0x243F_6A88, 0x85A3_08D3, 0x1319_8A2E, 0x0370_7344],
                [0xA409_3822, 0x299F_31D0]
            ),
            [0xD16C_FE09, 0x94FD_CCEB, 0x5001_E420, 0x2412_6EA1]
        );
    }

    /// Each part of a position changes the number.
    #[test]
    fn every_position_has_its_own_number() {
        let stream = Philox::new(1);
        let first = stream.bits(Purpose::Value, 0, 0);
        for other in [
            Philox::new(2).bits(Purpose::Value, 0, 0),
            Philox::new(1 | 1 << 40).bits(Purpose::Value, 0, 0),
            stream.bits(Purpose::Value, 1, 0),
            stream.bits(Purpose::Value, 1 << 40, 0),
            stream.bits(Purpose::Value, 0, 1),
            stream.bits(Purpose::Scramble, 0, 0),
            stream.bits(Purpose::Level(0), 0, 0),
        ] {
            assert_ne!(first, other);
        }
        assert_ne!(
            stream.bits(Purpose::Level(1), 0, 0),
            stream.bits(Purpose::Level(2), 0, 0)
        );
    }

    /// Mean 1/2 and variance 1/12 within four standard errors of 100,000 numbers; no correlation between neighbouring runs.
    #[test]
    fn numbers_are_uniform_and_independent() {
        const COUNT: u32 = 100_000;
        let stream = Philox::new(7);
        let at = |run: u32| stream.uniform(Purpose::Value, u64::from(run), 3) - 0.5;
        let (mut sum, mut squares, mut products) = (0.0, 0.0, 0.0);
        for run in 0..COUNT {
            sum += at(run);
            squares += at(run).powi(2);
            products += at(run) * at(run + 1);
        }
        let count = f64::from(COUNT);
        assert!((sum / count).abs() < 4.0 * (1.0 / 12.0 / count).sqrt());
        // The variance of (u − ½)² is 1/80 − 1/144 = 1/180.
        assert!((squares / count - 1.0 / 12.0).abs() < 4.0 * (1.0 / 180.0 / count).sqrt());
        assert!((products / count).abs() < 4.0 / 12.0 / count.sqrt());
    }
}
