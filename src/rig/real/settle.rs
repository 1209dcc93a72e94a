//! The settling criterion of a real rig. In: readings with their times, after the motion. Out: whether they have met the plan's criterion
//! for the dwell. It reads no clock and no rig.

use std::collections::VecDeque;

use super::median::representative;
use psd_plan::Settle;

/// One axis of a rig after its motion.
pub(super) struct SettlingReading {
    /// \[s\]
    pub time: f64,
    /// Displacement \[m\], or the force in force control \[N\].
    pub controlled: f64,
    /// \[N\]
    pub force: f64,
    /// The device is at rest and reports no objection to its reading.
    pub steady: bool,
}

/// Readings of the last dwell, all in position.
#[derive(Clone, Debug)]
pub(super) struct Settling {
    settle: Settle,
    /// \[m\] or \[N\], as the band of `settle`.
    target: f64,
    /// \[s\] and \[N\]
    window: VecDeque<(f64, f64)>,
}

impl Settling {
    pub(super) const fn new(settle: Settle, target: f64) -> Self {
        Self {
            settle,
            target,
            window: VecDeque::new(),
        }
    }

    /// Whether the controlled quantity is at its target. A zero band requires nothing.
    pub(super) fn in_position(&self, controlled: f64) -> bool {
        self.settle.band == 0.0 || (controlled - self.target).abs() <= self.settle.band
    }

    /// Start of the dwell \[s\] and its median force \[N\]; None before its first reading.
    pub(super) fn rested(&self) -> Option<(f64, f64)> {
        let began = self.window.front()?.0;
        Some((
            began,
            representative(self.window.iter().map(|(_, force)| *force).collect()),
        ))
    }

    /// Adds a reading. Gives whether the rig has settled: in position and |dF/dt| within its bound over the whole dwell.
    pub(super) fn add_reading(&mut self, reading: &SettlingReading) -> bool {
        let SettlingReading {
            time,
            controlled,
            force,
            steady,
        } = *reading;
        if !steady || !self.in_position(controlled) {
            self.window.clear();
            return false;
        }
        self.window.push_back((time, force));
        // The window is the shortest that still covers the dwell.
        while self
            .window
            .get(1)
            .is_some_and(|(second, _)| time - second >= self.settle.dwell)
            && self.window.len() > 2
        {
            self.window.pop_front();
        }
        if !self
            .window
            .front()
            .is_some_and(|(first, _)| time - first >= self.settle.dwell)
        {
            return false;
        }
        self.settle.force_rate == 0.0
            || slope(&self.window).is_some_and(|rate| rate.abs() <= self.settle.force_rate)
    }
}

/// Why the rig is not settled any more.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disturbed {
    /// The first axis that left its band, by index. None: a device reports that it moves, or that its reading has not
    /// settled.
    pub(super) astray: Option<usize>,
}

/// dF/dt \[N/s\] by least squares: with times t and their mean m, Σ(t − m)·F / Σ(t − m)². None for fewer than two times.
fn slope(window: &VecDeque<(f64, f64)>) -> Option<f64> {
    #[expect(clippy::cast_precision_loss, reason = "far fewer readings than 2^53")]
    let mean = window.iter().map(|(time, _)| time).sum::<f64>() / window.len() as f64;
    let spread: f64 = window.iter().map(|(time, _)| (time - mean).powi(2)).sum();
    let product: f64 = window
        .iter()
        .map(|(time, force)| (time - mean) * force)
        .sum();
    (window.len() >= 2 && spread > 0.0).then(|| product / spread)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTLE: Settle = Settle {
        band: 1e-5,
        force_rate: 2.0,
        dwell: 0.5,
        timeout: 10.0,
    };

    /// First time at which readings every 0.1 s settle.
    fn settled(
        settle: Settle,
        displacement: impl Fn(f64) -> f64,
        force: impl Fn(f64) -> f64,
    ) -> Option<f64> {
        let mut settling = Settling::new(settle, 0.001);
        (0..100).map(|i| f64::from(i) * 0.125).find(|time| {
            settling.add_reading(&SettlingReading {
                time: *time,
                controlled: displacement(*time),
                force: force(*time),
                steady: true,
            })
        })
    }

    #[test]
    fn the_slope_is_that_of_a_line_whatever_its_noise_is_symmetric_about() {
        let on_line = |time: f64, noise: f64| (time, 3.0 + 2.0 * time + noise);
        let line = |noise: [f64; 4]| {
            [0.0, 1.0, 2.0, 3.0]
                .into_iter()
                .zip(noise)
                .map(|(time, noise)| on_line(time, noise))
                .collect()
        };
        assert!((slope(&line([0.0; 4])).unwrap() - 2.0).abs() < 1e-12);
        assert!((slope(&line([1.0, -1.0, -1.0, 1.0])).unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(slope(&VecDeque::from([(1.0, 1.0)])), None);
    }

    #[test]
    fn it_settles_one_dwell_after_band_and_force_rate_are_met() {
        assert_eq!(settled(SETTLE, |_| 0.001, |_| 7.0), Some(0.5));
        // In the band from 1 s on.
        assert_eq!(
            settled(SETTLE, |time| if time < 1.0 { 0.0 } else { 0.001 }, |_| 7.0),
            Some(1.5)
        );
        // 16·exp(−t) N: over a window of 0.5 s that ends at t its slope falls below 2 N/s near t − 0.25 = ln 8.
        let relaxed = settled(SETTLE, |_| 0.001, |time| 16.0 * (-time).exp()).unwrap();
        assert!((relaxed - (8_f64.ln() + 0.25)).abs() <= 0.15, "{relaxed}");
        assert_eq!(settled(SETTLE, |_| 0.001, |time| 3.0 * time), None);
        assert_eq!(
            settled(
                Settle {
                    force_rate: 0.0,
                    ..SETTLE
                },
                |_| 0.001,
                |time| 3.0 * time
            ),
            Some(0.5)
        );
        assert_eq!(settled(SETTLE, |_| 0.0011, |_| 7.0), None);
        assert_eq!(settled(SETTLE, |_| f64::NAN, |_| 7.0), None);
        assert_eq!(
            settled(
                Settle {
                    dwell: 0.0,
                    ..SETTLE
                },
                |_| 0.001,
                |_| 7.0
            ),
            Some(0.125),
            "a rate needs two readings"
        );
    }

    #[test]
    fn a_device_that_moves_restarts_the_dwell() {
        let mut settling = Settling::new(SETTLE, 0.001);
        assert!(!settling.add_reading(&SettlingReading {
            time: 0.0,
            controlled: 0.001,
            force: 1.0,
            steady: true
        }));
        assert!(!settling.add_reading(&SettlingReading {
            time: 0.5,
            controlled: 0.001,
            force: 1.0,
            steady: false
        }));
        assert!(!settling.add_reading(&SettlingReading {
            time: 0.75,
            controlled: 0.001,
            force: 1.0,
            steady: true
        }));
        assert!(settling.add_reading(&SettlingReading {
            time: 1.25,
            controlled: 0.001,
            force: 1.0,
            steady: true
        }));
    }
}
