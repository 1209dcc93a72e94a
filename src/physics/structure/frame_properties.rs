//! The properties of a frame from its masses, stiffness and damping before any motion: matrices, modes, the longest stable step. In: a
//! frame of the plan, damping. Out: numbers in SI. It integrates nothing.

use thiserror::Error;

use crate::contact::contact_time_step::Approach;
use crate::integrator::Integrator;
use crate::integrator::stability::{Met, longest_stable_step};
use crate::structure::BandFactor;
use crate::structure::elements::Elements;
use crate::structure::frame::{Frame, Member, Part, Storey};
use crate::structure::{
    Damping, DampingError, FrameMatrices, Modes, ModesError, RowsError, SymmetricBand,
    damping_matrix, modes, storey_stiffness, storeys_of,
};

/// A frame, ready to be integrated.
#[derive(Clone, Debug)]
pub struct FrameProperties {
    pub matrices: FrameMatrices,
    /// `K_I` of α-OS and of the I-modification \[N/m\]: K, with the largest tangent of every computed storey. Without G, as the readings:
    /// of a storey with an axial load on the rig, without the share of G that is in its reading.
    pub operator: SymmetricBand,
    /// Those of a frame of matrices; None without any.
    pub elements: Option<Elements>,
    /// Of K − G.
    pub modes: Modes,
}

/// The reason why the properties of a frame do not exist.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoProperties {
    #[error("{0}")]
    Rows(#[from] RowsError),
    #[error("{0}")]
    Modes(#[from] ModesError),
    #[error("{0}")]
    Damping(#[from] DampingError),
}

impl FrameProperties {
    /// # Errors
    /// A matrix is not positive definite, or no damping matrix has these ratios.
    pub fn of(frame: &Frame, damping: &Damping) -> Result<Self, NoProperties> {
        let mass = SymmetricBand::from_dense(&frame.mass)?;
        let stiffness = SymmetricBand::from_dense(&frame.stiffness)?;
        let unloaded = modes(&mass, &stiffness)?;
        let damping = damping_matrix(damping, &mass, &stiffness, &unloaded)?;
        let weights = frame.gravity_stiffness();
        let mut gravity = (!weights.is_empty()).then(|| storey_stiffness(&weights));
        let elements = frame.elements()?;
        let computes = frame.members().any(|member| member.part == Part::Computed);
        let mut operator = if computes {
            let members = frame.members().map(|member| member.operator_stiffness());
            frame.assembled(&members.collect::<Vec<f64>>())?
        } else {
            stiffness.clone()
        };
        let mut stiffness = stiffness;
        if frame.has_axial_load() {
            // The axial load lowers the readings of its storey, and the share of G that is computed: K − G remains.
            let on_the_rig: Vec<f64> = frame.storeys.iter().map(Storey::axial_stiffness).collect();
            let computed = weights.iter().zip(&on_the_rig).map(|(all, own)| all - own);
            let computed: Vec<f64> = computed.collect();
            let on_the_rig = storey_stiffness(&on_the_rig);
            stiffness.add(&on_the_rig, -1.0);
            operator.add(&on_the_rig, -1.0);
            let is_computed = computed.iter().any(|share| *share != 0.0);
            gravity = is_computed.then(|| storey_stiffness(&computed));
        }
        let matrices = FrameMatrices {
            mass,
            damping,
            stiffness,
            gravity,
        };
        let modes = if weights.is_empty() {
            unloaded
        } else {
            modes(&matrices.mass, &matrices.net(&matrices.stiffness))?
        };
        Ok(Self {
            matrices,
            operator,
            elements,
            modes,
        })
    }

    /// Whether the tangent of each storey or element can be followed: a full matrix on the rig keeps its initial stiffness.
    #[must_use]
    pub fn has_tangents(&self) -> bool {
        self.elements.is_some() || storeys_of(&self.matrices.stiffness).is_some()
    }

    /// A tenth of the shortest period \[s\] (Melo et al. 2006, sec. 5).
    #[must_use]
    pub fn critical_time_step(&self) -> f64 {
        self.modes.critical_time_step()
    }

    /// Effective mass of one floor, 1/(e_sᵀM⁻¹e_s) \[kg\]: the mass that an impulse meets there.
    #[must_use]
    pub fn struck_mass(&self, struck: usize) -> f64 {
        let mut push = vec![0.0; self.matrices.order()];
        push[struck] = 1.0;
        // A mass that is not positive definite has no modes, and no properties.
        if let Ok(factor) = BandFactor::new(&self.matrices.mass) {
            factor.solve_in_place(&mut push);
        }
        1.0 / push[struck]
    }

    /// A tenth of the shortest period while a striker touches a floor \[s\]. For a contact of finite stiffness it is the period of frame
    /// and striker with the contact's tangent at its deepest ([`Approach::contact_stiffness`]). A longer step would not resolve the
    /// impact. Without a contact stiffness it is that of the frame alone.
    #[must_use]
    pub fn critical_on_impact(&self, struck: usize, approach: &Approach) -> f64 {
        let alone = self.critical_time_step();
        let Some(contact) = approach.contact_stiffness(self.struck_mass(struck)) else {
            return alone;
        };
        let order = self.matrices.order();
        let mut mass = SymmetricBand::zero(order + 1, self.matrices.mass.half_bandwidth());
        let own = self.matrices.net(&self.matrices.stiffness);
        let mut stiffness =
            SymmetricBand::zero(order + 1, own.half_bandwidth().max(order - struck));
        for row in 0..order {
            for column in 0..=row {
                if row - column <= self.matrices.mass.half_bandwidth() {
                    mass.set(row, column, self.matrices.mass.entry(row, column));
                }
                if row - column <= own.half_bandwidth() {
                    stiffness.set(row, column, own.entry(row, column));
                }
            }
        }
        mass.set(order, order, approach.striker_mass);
        stiffness.set(struck, struck, stiffness.entry(struck, struck) + contact);
        stiffness.set(order, struck, -contact);
        stiffness.set(order, order, contact);
        modes(&mass, &stiffness).map_or(alone, |together| together.critical_time_step().min(alone))
    }

    /// Fraction of critical damping of each mode: `φᵀCφ / (2ω φᵀMφ)`.
    #[must_use]
    pub fn damping_ratios(&self) -> Vec<f64> {
        let ratio = |(mode, shape): (usize, &Vec<f64>)| {
            let FrameMatrices { mass, damping, .. } = &self.matrices;
            damping.form(shape, shape)
                / (2.0 * self.modes.angular_frequency(mode) * mass.form(shape, shape))
        };
        self.modes.shapes.iter().enumerate().map(ratio).collect()
    }

    /// Longest stable Δt \[s\]; infinite if there is no limit. For a simulated specimen the initial stiffness of its storeys is also
    /// known; it may exceed the stiffness with which the plan integrates.
    #[must_use]
    pub fn longest_stable_step(
        &self,
        integrator: Integrator,
        virtual_specimen: Option<&Frame>,
    ) -> f64 {
        let own = self.highest(&self.matrices.net(&self.operator));
        let mut met = Met {
            highest: own,
            shortfall: 0.0,
            share: 0.0,
            damping_ratio: 0.0,
        };
        let assembled = |frame: &Frame, members: &[f64]| frame.assembled(members).ok();
        if let Some(frame) = virtual_specimen.filter(|frame| !frame.is_matrix_on_the_rig()) {
            let members: Vec<Member<'_>> = frame.members().collect();
            let behaves: Vec<f64> = members
                .iter()
                .map(|member| {
                    let largest = member.largest_stiffness();
                    largest.unwrap_or(member.operator_stiffness())
                })
                .collect();
            let mut read = behaves.clone();
            let loaded = read.iter_mut().zip(&frame.storeys);
            loaded.for_each(|(read, storey)| *read -= storey.axial_stiffness());
            if let Some(behaving) = assembled(frame, &read) {
                met.highest = own.max(self.highest(&self.matrices.net(&behaving)));
            }
            let storeys = || members.iter().zip(&behaves);
            // G is in both stiffnesses, and cancels in their difference.
            let mut weights = frame.gravity_stiffness();
            weights.resize(members.len(), 0.0);
            met.share = storeys()
                .zip(weights)
                .map(|((storey, behaves), g)| {
                    1.0 - (storey.operator_stiffness() - g) / (behaves - g)
                })
                .fold(0.0, f64::max);
            if met.share > 0.0 {
                // The small stiffness added to softer storeys makes the bound slightly low, never high.
                let trifle = |behaves: f64| 1e-12 * behaves;
                let beyond: Vec<f64> = storeys()
                    .map(|(storey, b)| (b - storey.operator_stiffness()).max(trifle(*b)))
                    .collect();
                let beyond = match &self.elements {
                    // The stiffness of the files is what is assumed; a little of the whole keeps the matrix positive definite.
                    Some(elements) => {
                        let mut matrix = self.matrices.stiffness.clone();
                        matrix.scale(1e-12);
                        matrix.add_springs(elements.ends.iter().copied().zip(beyond));
                        matrix
                    }
                    None => storey_stiffness(&beyond),
                };
                met.shortfall = self.highest(&beyond);
            }
        }
        longest_stable_step(integrator, &met)
    }

    /// ω² of the highest mode with a different stiffness \[rad²/s²\].
    fn highest(&self, stiffness: &SymmetricBand) -> f64 {
        modes(&self.matrices.mass, stiffness).map_or(0.0, |modes| {
            (std::f64::consts::TAU / modes.shortest_period()).powi(2)
        })
    }
}
