//! The mass that moves with a portal: its members and what they carry, reduced to the displacement that the load does work on. In: a
//! portal that says what it weighs. Out: its equivalent masses, by the shapes that it goes through. How it is loaded, and when
//! it yields, it does not decide.

use super::super::beam::partly_built_in_mass_factor;
use crate::structure::portal::{Mechanism, Portal, Sections, elastic_stiffnesses};

/// Masses of the single degree of freedom that stands for a beam or portal, kg: that which has its kinetic energy, M = ∫m φ² ds with a
/// shape φ that is 1 where the load does work. The load then needs no factor of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquivalentMasses {
    /// φ the elastic deflection under the static load: before any hinge forms.
    pub elastic: f64,
    /// φ that of the mechanism which governs, its links rigid between the hinges: after the last one formed. None of what has none.
    pub plastic: Option<f64>,
    /// Half of each member at either end of it (of the beam: at midspan and corners, half and half), moved elastically: Melo et al. 2006,
    /// Fig. 5, where a swaying frame has the mass of its beam and of one column, and a beam half its own.
    pub lumped: f64,
    /// All that moves or bends.
    pub whole: f64,
}

/// How far midspan (δ) and the beam's level (Δ) go while the point of the load goes 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Travel {
    deflection: f64,
    sway: f64,
}

/// Masses of a frame that deflects by 1 at midspan, and of one that sways by 1. One is symmetric and the other antisymmetric: moved
/// together their kinetic energies add, without a mixed part.
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

/// What its load has to accelerate; None of a portal that does not say what it weighs.
#[must_use]
pub fn equivalent_masses(portal: &Portal) -> Option<EquivalentMasses> {
    let masses = portal.masses?;
    let beam = masses.per_length.beam * portal.span;
    let column = masses.per_length.column * portal.height;
    let elastic = elastic_travel(portal);
    // Midspan goes down and sideways, the corners sideways alone.
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

/// EI of beam and columns, or their ratio where the stiffness was given in its place: then one section is meant throughout.
fn bending(portal: &Portal) -> Sections {
    portal.bending_stiffness.unwrap_or(Sections::same(1.0))
}

/// A load P = 1, of which W deflects midspan and H sways the frame, goes u = W·δ + H·Δ.
fn elastic_travel(portal: &Portal) -> Travel {
    let each = elastic_stiffnesses(portal.span, portal.height, bending(portal));
    let (on_beam, on_sway) = portal.loads.shares();
    let (deflection, sway) = (on_beam / each.beam, on_sway / each.sway);
    let way = on_beam * deflection + on_sway * sway;
    Travel {
        deflection: deflection / way,
        sway: sway / way,
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
    let way = on_beam * deflection + on_sway * sway;
    Travel {
        deflection: deflection / way,
        sway: sway / way,
    }
}

/// ∫m φ² ds of the members bent by end moments and the load at midspan, cubics all; k = (EI_b/L)/(EI_c/h), ξ from 0 to 1 along a member.
///
/// Swayed by Δ, θ = tΔ/h, t = 3/(2 + 3k). A column is Δ[3ξ² − 2ξ³ + t(ξ³ − ξ²)], whose square has the integral
/// Δ²(13/35 − 11t/105 + t²/105): 33/140 where no beam holds its head (t = 3/2), 13/35 where it cannot turn. The beam goes Δ
/// sideways and θL(ξ − 3ξ² + 2ξ³) up and down, ∫ = (θL)²/210.
///
/// Deflected by δ at midspan, the beam is one with partly built-in ends, r = k_θL/EI_b with k_θ = 4EI_c/h: r = 4/k. Of δ the rotation
/// of its ends makes θL/4 = δ·3k/(2 + 4k), and a column bows by θh(ξ³ − ξ²), ∫ = (θh)²/105.
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
