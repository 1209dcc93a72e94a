//! A block whose fields are declared once. A declaration lists the fields of a block as `NAME: TYPE = FIELD`, where FIELD is a
//! constructor of `schema::Field` without its first argument, the name. A parameter with another name than its field gives both, as in
//! `return_path as "return"`. Four macros read the same declaration: `parameters` makes the struct of the plan, `fields` the entries of
//! the schema, `names` the names of the fields for checks and messages, `reader` the check from a block to the struct. The type of a
//! parameter has its reader: it implements `language::check::expressions::read_field::ReadField`. `move` is an example:
//!
//! ```text
//! macro_rules! move_fields {
//!     ($into:ident) => {
//!         $into! {
//!             /// The actuator moves to a displacement.
//!             #[derive(Clone, Debug)]
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
//! move_fields!(names);                             // schema
//! move_fields!(reader);                            // procedures
//! ```

/// The parameters as a struct of the plan.
#[macro_export]
macro_rules! parameters {
    (
        $(#[$about:meta])*
        struct $name:ident {
            $(
                $(#[$unit:meta])*
                $field:ident $(as $written:literal)?: $type:ty =
                    $constructor:ident($($argument:expr),*) $(.$refine:ident($($value:expr),*))*,
            )*
        }
    ) => {
        $(#[$about])*
        pub struct $name {
            $(
                $(#[$unit])*
                pub $field: $type,
            )*
        }
    };
}

/// The fields as entries of the schema.
#[macro_export]
macro_rules! fields {
    (
        $(#[$about:meta])*
        struct $name:ident {
            $(
                $(#[$unit:meta])*
                $field:ident $(as $written:literal)?: $type:ty =
                    $constructor:ident($($argument:expr),*) $(.$refine:ident($($value:expr),*))*,
            )*
        }
    ) => {
        &[$(
            Field::$constructor(NAMES.$field $(, $argument)*) $(.$refine($($value),*))*,
        )*]
    };
}

/// The names of the fields as the constant `NAMES`.
#[macro_export]
macro_rules! names {
    (
        $(#[$about:meta])*
        struct $name:ident {
            $(
                $(#[$unit:meta])*
                $field:ident $(as $written:literal)?: $type:ty =
                    $constructor:ident($($argument:expr),*) $(.$refine:ident($($value:expr),*))*,
            )*
        }
    ) => {
        /// The names of the fields of this block.
        pub struct Names {
            $(pub $field: &'static str,)*
        }

        pub const NAMES: Names = Names {
            $($field: $crate::name!($field $(as $written)?),)*
        };
    };
}

/// The name of one field: that of its parameter, or the one that is written after it.
#[macro_export]
macro_rules! name {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident as $written:literal) => {
        $written
    };
}

/// The reader of a block: it reads every field by the type of its parameter, in the order of the declaration. It reads all fields before
/// it fails, so that all errors are reported at once.
#[macro_export]
macro_rules! reader {
    (
        $(#[$about:meta])*
        struct $name:ident {
            $(
                $(#[$unit:meta])*
                $field:ident $(as $written:literal)?: $type:ty =
                    $constructor:ident($($argument:expr),*) $(.$refine:ident($($value:expr),*))*,
            )*
        }
    ) => {
        fn read(checker: &mut Checker<'_>, block: usize) -> Option<$name> {
            $(let $field = ReadField::read(checker, block, NAMES.$field);)*
            Some($name { $($field: $field?,)* })
        }
    };
}
