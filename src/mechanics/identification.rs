//! Identification: straight lines fitted to measured forces, with standard errors.

/// Straight line with standard errors: y = intercept + slope·x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineFit {
    pub slope: f64,
    pub slope_error: f64,
    pub intercept: f64,
    pub intercept_error: f64,
    pub r_squared: f64,
}
