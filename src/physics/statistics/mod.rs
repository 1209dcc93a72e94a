//! Statistics of readings: least squares, Student's t, the maximum of noisy values. In: numbers.
//! Out: numbers. It knows no instrument.

mod declared_noise;
pub mod least_squares;
pub mod noisy_largest;
pub mod samples;
pub mod student_t;
#[cfg(test)]
pub(crate) mod testing;

pub use declared_noise::DeclaredNoise;
