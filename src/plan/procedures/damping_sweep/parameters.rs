//! The fields of a `damping sweep`, declared once: its parameters here, its schema in `block.rs`, its reader in
//! `procedures::damping_sweep::check`.

use crate::formula::Formula;
use crate::parameters;

#[macro_export]
macro_rules! damping_sweep_fields {
    ($into:ident) => {
        $into! {
            /// Constant-velocity passes at increasing velocities (Melo et al. 2006, sec. 6 (b)).
            #[derive(Clone, Debug)]
            struct DampingSweep {
                /// Index into `Plan::specimens`.
                specimen: usize = specimen(),
                /// \[m/s\]
                velocities: Vec<Formula> = quantities(Dimension::VELOCITY, "velocities of the strokes")
                    .required("velocities = [0.5, 1, 2, 5, 10] mm/s")
                    .above_zero(),
                /// \[m\]
                stroke: Formula = quantity(Dimension::LENGTH, "length of each stroke")
                    .required("stroke = 1 mm")
                    .above_zero(),
                /// The middle of the passes \[m\]. None: they begin at the present position of the actuator.
                about: Option<Formula> = quantity(Dimension::LENGTH, "centre of the strokes")
                    .default_in_words("the start position of the actuator"),
                /// K of F_d = R − K·X \[N/m\].
                stiffness: Formula = quantity(Dimension::STIFFNESS, "K of the damping force R − K·X")
                    .required("stiffness = 300 kN/m")
                    .above_zero(),
                /// Sampling rate \[Hz\]. None: at least 50 samples in the steady part of each ramp.
                rate: Option<Formula> = quantity(Dimension::FREQUENCY, "sampling rate")
                    .above_zero()
                    .default_in_words("at least 50 samples on the steady part"),
            }
        }
    };
}

damping_sweep_fields!(parameters);
