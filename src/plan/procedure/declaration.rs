//! A block whose fields are declared once. A declaration lists the fields of a block as `NAME: TYPE = FIELD`, where FIELD is a
//! constructor of `schema::Field` without its first argument, the name. Three macros read the same declaration: `parameters` makes the
//! struct of the plan, `fields` the entries of the schema, `reader` the check from a block to the struct. `move` is an example:
//!
//! ```text
//! macro_rules! move_fields {
//!     ($into:ident) => {
//!         $into! {
//!             /// The actuator moves to a displacement.
//!             struct Move {
//!                 /// m, absolute.
//!                 to: Formula = quantity(Dimension::LENGTH, "absolute target").required("to = 0 mm"),
//!                 /// m/s
//!                 speed: Option<Formula> = speed(),
//!             }
//!         }
//!     };
//! }
//! move_fields!(parameters);                        // plan
//! fields: move_fields!(fields),                    // schema
//! move_fields!(reader);                            // procedures
//! ```

/// The parameters as a struct of the plan.
macro_rules! parameters {
    (
        $(#[$about:meta])*
        struct $name:ident {
            $(
                $(#[$unit:meta])*
                $field:ident: $type:ty =
                    $constructor:ident($($argument:expr),*) $(.$refine:ident($($value:expr),*))*,
            )*
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Debug)]
        pub struct $name {
            $(
                $(#[$unit])*
                pub $field: $type,
            )*
        }
    };
}

/// The fields as entries of the schema.
macro_rules! fields {
    (
        $(#[$about:meta])*
        struct $name:ident {
            $(
                $(#[$unit:meta])*
                $field:ident: $type:ty =
                    $constructor:ident($($argument:expr),*) $(.$refine:ident($($value:expr),*))*,
            )*
        }
    ) => {
        &[$(
            Field::$constructor(stringify!($field) $(, $argument)*) $(.$refine($($value),*))*,
        )*]
    };
}

/// The reader of a block: it reads every field by the type of its parameter, in the order of the declaration. It reads all fields before
/// it fails, so that all errors are reported at once.
macro_rules! reader {
    (
        $(#[$about:meta])*
        struct $name:ident {
            $(
                $(#[$unit:meta])*
                $field:ident: $type:ty =
                    $constructor:ident($($argument:expr),*) $(.$refine:ident($($value:expr),*))*,
            )*
        }
    ) => {
        fn read(checker: &mut Checker<'_>, block: usize) -> Option<$name> {
            $(let $field = ReadField::read(checker, block, stringify!($field));)*
            Some($name { $($field: $field?,)* })
        }
    };
}

pub(crate) use {fields, parameters, reader};
