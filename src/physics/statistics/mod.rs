//! Statistics of readings: least squares, Student's t, the maximum of noisy values. In: numbers.
//! Out: numbers. It knows no instrument.

pub mod least_squares;
pub mod noisy_largest;
mod reading_noise;
pub mod samples;
pub mod student_t;
#[cfg(test)]
pub(crate) mod testing;

pub use reading_noise::ReadingNoise;
