//! The numbers of the impacts of all lanes, one row for each kind of number. In: nothing. Out: rows of zeros. It steps nothing.

/// Impacts side by side: with fewer, vector units wait for the divisions before them.
pub const LANES: usize = 32;

pub(super) type Row = [f64; LANES];

/// Declares rows of all lanes.
macro_rules! rows {
    ($(#[$about:meta])* $rows:ident { $($(#[$doc:meta])* $name:ident),* $(,)? }) => {
        $(#[$about])*
        #[derive(Clone, Debug)]
        #[repr(align(64))] // No vector lies in two lines of the cache.
        pub(super) struct $rows {
            $($(#[$doc])* pub(super) $name: Row,)*
        }

        impl $rows {
            pub(super) const fn new() -> Self {
                Self { $($name: [0.0; LANES],)* }
            }

            pub(super) fn clear(&mut self, lane: usize) {
                $(self.$name[lane] = 0.0;)*
            }
        }
    };
}

rows! {
    /// What does not change.
    Inputs {
        /// M, C
        mass, damping,
        /// Δt
        time_step,
        /// The largest `K_t`.
        largest_tangent,
        /// K0, and the lines of a bilinear specimen.
        stiffness, hardened, half_band,
        /// Ms, its weight Ms·g, the velocity gΔt of a step of free fall, Δt/Ms, the limit force.
        striker_mass, weight, fall, striker_compliance, force_limit,
        /// ½MsV0²
        striker_energy,
    }
}

rows! {
    /// The end of a step, where the next one begins.
    States {
        /// `K_t` of the next step; without its contact, Ẍ; 1/M̂; the force that stops the closing.
        tangent, free_acceleration, response, needed,
        displacement, velocity, acceleration, force,
        striker_displacement, striker_velocity, contact_force, indentation,
        /// Of the largest displacement so far: the step, and ∫R dX.
        step_of_max_displacement, absorbed_energy,
    }
}

rows! {
    /// Sums and ranges of all steps so far.
    Sums {
        restoring_energy, damping_energy, contact_loss, indentation_energy, weight, input, impulse,
        max_displacement, max_velocity, max_contact_force,
        /// The reach, beside the largest displacement.
        least_displacement, least_force, largest_force, largest_increment,
    }
}

/// What the effective mass of a step consists of.
pub(super) struct Structure {
    pub mass: f64,
    pub damping: f64,
    pub tangent: f64,
}

impl Structure {
    /// M̂ = M + ½Δt(C + ½ΔtK_t).
    #[inline]
    pub fn effective_mass(&self, time_step: f64) -> f64 {
        (self.tangent * (0.5 * time_step) + self.damping) * (0.5 * time_step) + self.mass
    }
}
