//! The straight part of the unloading branch of one storey. In: its storey drift and load after each move. Out: the slope of the last moves that
//! agree. It moves nothing.

use crate::integrator::tangent::NOISE_MULTIPLE;

/// Two slopes agree if they differ by no more than this fraction, beside the noise of their readings.
const BENT: f64 = 0.02;
/// Standard deviations of the readings that may hide a bend: at three, one of ten branches of forty moves would show a false one.
const NOISE: f64 = 4.0;

/// The last readings of an unloading branch that lie on one line: storey drift \[m\] and load \[N\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    from: (f64, f64),
    last: (f64, f64),
    /// Whether two moves agree.
    straight: bool,
}

impl Line {
    pub const fn new(at: (f64, f64)) -> Self {
        Self {
            from: at,
            last: at,
            straight: false,
        }
    }

    /// The reading after the last move.
    pub const fn last(&self) -> (f64, f64) {
        self.last
    }

    /// Distance over which the moves agree \[m\].
    pub const fn length(&self) -> f64 {
        (self.last.0 - self.from.0).abs()
    }

    /// Adds the reading after a move. `noise`: standard deviations of the load \[N\] and of the storey drift \[m\].
    pub fn learn(&mut self, at: (f64, f64), noise: (f64, f64)) {
        let (shown, travel) = (self.last.0 - self.from.0, at.0 - self.last.0);
        if travel == 0.0 {
            return;
        }
        if shown != 0.0 {
            let slope = (self.last.1 - self.from.1) / shown;
            let ratio = travel / shown;
            // The load expected from the readings a and b at the ends of the line is b + r(b − a): the noise of three readings.
            let scatter = noise.0.hypot(slope * noise.1)
                * (1.0 + (1.0 + ratio).powi(2) + ratio.powi(2)).sqrt();
            let bend = at.1 - self.last.1 - slope * travel;
            self.straight = bend.abs() <= BENT * (slope * travel).abs() + NOISE * scatter;
            if !self.straight {
                self.from = self.last;
            }
        }
        self.last = at;
    }

    /// The slope \[N/m\] if two moves agree over more than `least` \[m\], and if the load changed by more than noise does.
    pub fn slope(&self, noise: (f64, f64), least: f64) -> Option<f64> {
        let change = self.last.1 - self.from.1;
        let slope = change / (self.last.0 - self.from.0);
        let shown =
            self.length() > least && change.abs() > NOISE_MULTIPLE * noise.0.hypot(slope * noise.1);
        (self.straight && shown && slope > 0.0).then_some(slope)
    }
}
