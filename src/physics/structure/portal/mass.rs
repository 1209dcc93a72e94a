//! The mass that moves with a portal: its members and their masses, reduced to the displacement on which the load does work. In: a portal
//! with stated masses. Out: its equivalent masses, from its deflected shapes. It does not determine the load or the yielding.

use crate::structure::beam::{EquivalentMasses, partly_built_in_mass_factor};
use crate::structure::portal::{Mechanism, Portal, Sections, elastic_stiffnesses};

/// Displacements of midspan (δ) and of the beam's level (Δ) for a unit displacement of the load.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Travel {
    deflection: f64,
    sway: f64,
}

/// Masses of a frame that deflects by 1 at midspan, and of one that sways by 1. One shape is symmetric and the other antisymmetric: in a
/// combined motion their kinetic energies add, without a mixed term.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Parts {
    deflecting: f64,
    swaying: f64,
}

impl Parts {
    fn moved(self, travel: Travel) -> f64 {
        self.deflecting * travel.deflection * travel.deflection
            + self.swaying * travel.sway * travel.sway
    }
}

/// The masses that the load has to accelerate; None for a portal without stated masses.
#[must_use]
pub fn equivalent_masses(portal: &Portal) -> Option<EquivalentMasses> {
    let masses = portal.masses?;
    let beam = masses.per_length.beam * portal.span;
    let column = masses.per_length.column * portal.height;
    let elastic = elastic_travel(portal);
    // Midspan moves down and sideways, the corners only sideways.
    let carried = Parts {
        deflecting: masses.midspan,
        swaying: masses.midspan + 2.0 * masses.corner,
    };
    let with = |members: Parts| Parts {
        deflecting: members.deflecting + carried.deflecting,
        swaying: members.swaying + carried.swaying,
    };
    let rigid = Parts {
        deflecting: beam / 3.0,
        swaying: beam + 2.0 * column / 3.0,
    };
    let lumps = Parts {
        deflecting: beam / 2.0,
        swaying: beam + column,
    };
    Some(EquivalentMasses {
        elastic: with(bent(portal, masses.per_length)).moved(elastic),
        plastic: Some(with(rigid).moved(mechanism_travel(portal))),
        lumped: with(lumps).moved(elastic),
        whole: beam + 2.0 * column + masses.midspan + 2.0 * masses.corner,
    })
}

/// EI of beam and columns, or their ratio if the stiffness is given instead: all members then have the same section.
fn bending(portal: &Portal) -> Sections {
    portal.bending_stiffness.unwrap_or(Sections::same(1.0))
}

/// A load P = 1, of which W deflects midspan and H sways the frame, is displaced by u = W·δ + H·Δ.
fn elastic_travel(portal: &Portal) -> Travel {
    let each = elastic_stiffnesses(portal.span, portal.height, bending(portal));
    let (on_beam, on_sway) = portal.loads.shares();
    let (deflection, sway) = (on_beam / each.beam, on_sway / each.sway);
    let work_travel = on_beam * deflection + on_sway * sway;
    Travel {
        deflection: deflection / work_travel,
        sway: sway / work_travel,
    }
}

/// For a rotation θ of a column or half-beam: δ = θL/2, Δ = θh.
fn mechanism_travel(portal: &Portal) -> Travel {
    let governs = portal.mechanism();
    let deflection = if governs == Mechanism::Sway {
        0.0
    } else {
        portal.span / 2.0
    };
    let sway = if governs == Mechanism::Beam {
        0.0
    } else {
        portal.height
    };
    let (on_beam, on_sway) = portal.loads.shares();
    let work_travel = on_beam * deflection + on_sway * sway;
    Travel {
        deflection: deflection / work_travel,
        sway: sway / work_travel,
    }
}

/// ∫m φ² ds of the members bent by end moments and by the load at midspan. All shapes are cubic; k = (EI_b/L)/(EI_c/h), ξ from 0 to 1
/// along a member.
///
/// Sway by Δ: θ = tΔ/h, t = 3/(2 + 3k). The deflection of a column is Δ[3ξ² − 2ξ³ + t(ξ³ − ξ²)]. The integral of its square is Δ²(13/35 −
/// 11t/105 + t²/105): 33/140 if no beam restrains its head (t = 3/2), 13/35 if its head cannot rotate. The beam moves sideways by Δ and
/// vertically by θL(ξ − 3ξ² + 2ξ³), ∫ = (θL)²/210.
///
/// Deflection by δ at midspan: the beam has partly built-in ends, r = k_θL/EI_b with k_θ = 4EI_c/h: r = 4/k. The rotation of its ends
/// contributes θL/4 = δ·3k/(2 + 4k) to δ, and a column bows by θh(ξ³ − ξ²), ∫ = (θh)²/105.
fn bent(portal: &Portal, per_length: Sections) -> Parts {
    let Portal { span, height, .. } = *portal;
    let sections = bending(portal);
    let k = sections.beam / sections.column * (height / span);
    let (beam, column) = (per_length.beam * span, per_length.column * height);
    let turn = 3.0 / (2.0 + 3.0 * k);
    let of_beam = turn * span / height;
    let bow = 4.0 * height / span * 3.0 * k / (2.0 + 4.0 * k);
    Parts {
        deflecting: beam * partly_built_in_mass_factor(4.0 / k) + 2.0 * column * bow * bow / 105.0,
        swaying: beam * (1.0 + of_beam * of_beam / 210.0)
            + 2.0 * column * (13.0 / 35.0 - 11.0 / 105.0 * turn + turn * turn / 105.0),
    }
}
