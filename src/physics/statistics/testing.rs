//! Noise for tests of fits. In: a seed. Out: the same numbers on every machine. No run uses it.

/// Knuth's congruential generator (MMIX), its upper half, from 0 to 1.
pub(crate) fn uniform(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    f64::from(u32::try_from(*state >> 32).expect("a half")) / f64::from(u32::MAX)
}

/// The sum of twelve of them minus six: unit variance.
pub(crate) fn normal(state: &mut u64) -> f64 {
    (0..12).map(|_| uniform(state)).sum::<f64>() - 6.0
}
