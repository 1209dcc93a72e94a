//! The fields of a `move`, declared once: its parameters here, its schema in `block.rs`, its reader in
//! `procedures::move_to::check`.

use crate::formula::Formula;
use crate::parameters;

#[macro_export]
macro_rules! move_fields {
    ($into:ident) => {
        $into! {
            /// The actuator moves to a displacement.
            #[derive(Clone, Debug)]
            struct Move {
                /// \[m\], absolute.
                to: Formula = quantity(Dimension::LENGTH, "absolute target").required("to = 0 mm"),
                /// \[m/s\]
                speed: Option<Formula> = speed(),
            }
        }
    };
}

move_fields!(parameters);
