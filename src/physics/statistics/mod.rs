//! Statistics of readings: Student's t, quantization, the maximum of noisy values. In: numbers.
//! Out: numbers. It knows no instrument.

pub mod noisy_largest;
pub mod samples;
pub mod student_t;
#[cfg(test)]
pub(crate) mod testing;
