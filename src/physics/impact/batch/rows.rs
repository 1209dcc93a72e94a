//! The numbers of sixteen impacts, one row for each kind of number. In: nothing. Out: rows of zeros. It steps nothing.

/// Impacts side by side: with fewer, vector units wait for the divisions before them.
pub const LANES: usize = 16;

pub(super) type Row = [f64; LANES];

/// 1 for true: a number is selected without a branch.
pub(super) const YES: f64 = 1.0;
pub(super) const NO: f64 = 0.0;

/// Declares rows of all lanes.
macro_rules! rows {
    ($(#[$about:meta])* $rows:ident { $($(#[$doc:meta])* $name:ident),* $(,)? }) => {
        $(#[$about])*
        #[derive(Clone, Debug)]
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
        /// Ms, g, Δt/Ms, the limit force.
        striker_mass, gravity, striker_compliance, force_limit,
        /// ½MsV0²
        striker_energy,
    }
}

rows! {
    /// The end of a step, and the results so far.
    States {
        step,
        /// `K_t` and M̂ of the next step.
        tangent, effective,
        displacement, velocity, acceleration, force,
        striker_displacement, striker_velocity, contact_force, touching, indentation,
        restoring_energy, damping_energy, contact_loss, indentation_energy, weight, input,
        max_displacement, time_of_max_displacement, absorbed_energy, max_velocity, max_contact_force, impulse,
        /// Infinite before the striker stops.
        stop_time,
        /// The reach, beside the largest displacement.
        least_displacement, least_force, largest_force, largest_increment,
    }
}

rows! {
    /// The number of contacts, and of the first one: begun, ended, closing speed before it, closing speed after it.
    Contacts { count, begun, ended, closing, separating }
}

/// When an impact ends.
#[derive(Clone, Copy)]
pub struct End {
    /// As soon as structure and striker move back.
    pub ends_at_stop: bool,
    /// Its last step.
    pub last: f64,
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
