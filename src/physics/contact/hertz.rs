//! Contact of finite stiffness: Hunt–Crossley's F = k δ^1.5 (1 + loss·δ̇), never in tension, with an optional limit force above which the
//! surface is indented.

use super::spring::{ContactPart, GAUSS, SpringForce};

/// The force of Hertz and of Hunt and Crossley.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzForce {
    /// k \[N/m^1.5\]
    stiffness: f64,
    /// λ \[s/m\]
    loss: f64,
    /// \[N\]; infinite if none.
    force_limit: f64,
}

impl HertzForce {
    /// k \[N/m^1.5\], λ \[s/m\] and the limit force \[N\].
    #[must_use]
    pub fn new(stiffness: f64, loss: f64, force_limit: Option<f64>) -> Self {
        Self {
            stiffness,
            loss,
            force_limit: force_limit.unwrap_or(f64::INFINITY),
        }
    }
}

impl SpringForce for HertzForce {
    fn elastic(&self, depth: f64) -> f64 {
        if depth > 0.0 {
            self.stiffness * depth * depth.sqrt()
        } else {
            0.0
        }
    }

    fn mean(&self, part: &ContactPart, to: f64) -> (f64, f64) {
        let ContactPart { from, duration, .. } = *part;
        let (mut force, mut slope) = (0.0, 0.0);
        for (node, weight) in GAUSS {
            let depth = from + node * (to - from);
            if depth > 0.0 {
                force += weight * self.elastic(depth);
                slope += weight * node * 1.5 * self.stiffness * depth.sqrt();
            }
        }
        let factor = 1.0 + self.loss * (to - from) / duration;
        if factor <= 0.0 {
            (0.0, 0.0)
        } else {
            (
                force * factor,
                slope * factor + force * self.loss / duration,
            )
        }
    }

    fn instant(&self, depth: f64, rate: f64) -> f64 {
        self.elastic(depth) * (1.0 + self.loss * rate)
    }

    /// 2.943 `δ_max/u`
    fn duration(&self, reduced_mass: f64, speed: f64) -> f64 {
        let deepest = (1.25 * reduced_mass * speed * speed / self.stiffness).powf(0.4);
        2.943 * deepest / speed
    }

    fn force_limit(&self) -> f64 {
        self.force_limit
    }

    fn overlap_at_limit(&self) -> f64 {
        (self.force_limit / self.stiffness).powf(2.0 / 3.0)
    }
}
