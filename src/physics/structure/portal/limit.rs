//! The largest load for which a dynamically loaded portal stays in its mechanism. In: a portal under one load, with the masses of its
//! members. Out: the load up to which only the hinges of the mechanism form. It does not calculate later effects (travelling hinges,
//! waves).
//!
//! Statically the hinges are at the loads and at the corners (Melo et al. 2006, Fig. 3). The inertia of the members bends them too. Under
//! a high load it forms other hinges nearer to the load (Fig. 4: the paper draws them without a rule). The rule here is derived for a
//! rigid–plastic frame at rest. Beyond collapse the mechanism rotates with the acceleration α from the work of load, hinges and inertia.
//! This solution applies as long as no moment exceeds the plastic moment of the section (both bounds of plastic theory then agree).

use crate::structure::portal::{FrameMasses, Loads, Portal, Sections};

/// The largest such load \[N\]; infinite if the rotating members have no mass between the hinges. None under two loads together, whose
/// mechanisms change into one another first, and without stated masses of the frame.
#[must_use]
pub fn mechanism_limit(portal: &Portal) -> Option<f64> {
    let masses = portal.masses?;
    match portal.loads {
        Loads::Sway => Some(sway(portal, masses)),
        Loads::Beam => Some(beam(portal, masses)),
        Loads::Combined { .. } => None,
    }
}

/// A column rotates about its foot: with y from there, its inertia −m α y bends it to M(y) = −M_c + V y + m α y³/6, and M(h) = m_corner
/// gives V h = M_c + m_corner − m α h³/6. M falls below −M_c as soon as V < 0: at m α h³/6 = M_c + m_corner. Then H h = 2(M_c + m_corner)
/// + α(⅔ m h³ + mass at the beam's level · h²).
fn sway(portal: &Portal, masses: FrameMasses) -> f64 {
    let Portal { span, height, .. } = *portal;
    let hinges = portal.plastic_moment.column + portal.plastic_moment.corner();
    let column = masses.per_length.column * height;
    if column == 0.0 {
        return f64::INFINITY;
    }
    let carried = masses.per_length.beam * span + masses.midspan + 2.0 * masses.corner;
    (2.0 * hinges + 4.0 * hinges + 6.0 * hinges * carried / column) / height
}

/// A half-beam of l = L/2 turns about its corner: M(x) = −m_corner + V x + m α x³/6, M(l) = M_b, V l = m_corner + M_b − q with q = m α
/// l³/6. Where V < 0, M is least at (x/l)² = (q − S)/3q, S = m_corner + M_b: −m_corner − ⅔(q − S)√((q − S)/3q), which is −M_b at the
/// limit. Then W l = 2S + 4q + 6q · carried/(m l).
fn beam(portal: &Portal, masses: FrameMasses) -> f64 {
    let half = portal.span / 2.0;
    let own = masses.per_length.beam * half;
    if own == 0.0 {
        return f64::INFINITY;
    }
    let Sections { beam, .. } = portal.plastic_moment;
    let (corner, hinges) = (
        portal.plastic_moment.corner(),
        portal.plastic_moment.corner() + beam,
    );
    let dip = |q: f64| 2.0 / 3.0 * (q - hinges) * ((q - hinges) / (3.0 * q)).sqrt();
    let q = hinges + excess(|more| dip(hinges + more), beam - corner, hinges);
    (2.0 * hinges + 4.0 * q + 6.0 * q * masses.midspan / own) / half
}

/// The argument at which a function that grows from 0 without bound equals `wanted`, by bisection; `scale` is the size of its argument.
fn excess(of: impl Fn(f64) -> f64, wanted: f64, scale: f64) -> f64 {
    if wanted <= 0.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, scale);
    while of(high) < wanted {
        high *= 2.0;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if of(middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
