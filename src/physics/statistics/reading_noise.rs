//! The errors of a reading that an instrument declares. In: numbers in SI. Out: data. It knows no instrument.

/// Errors of a reading that are known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReadingNoise {
    /// Standard deviation of a force \[N\].
    pub force: f64,
    /// Resolution of a displacement \[m\].
    pub resolution: f64,
}
