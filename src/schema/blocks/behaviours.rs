//! The restoring-force models of a specimen: the variants of `behaviour`.

use crate::schema::types::{Field, Variant};
use crate::units::Dimension;

pub(crate) const STIFFNESS: Field =
    Field::quantity("stiffness", Dimension::STIFFNESS, "force over displacement")
        .required("stiffness: 300 kN/m")
        .above_zero();

const YIELD_FORCE: Field = Field::quantity("yield_force", Dimension::FORCE, "force at first yield")
    .required("yield_force: 4 kN")
    .above_zero();

const HARDENING: Field = Field::quantity(
    "hardening",
    Dimension::NUMBER,
    "stiffness past yield over the initial one",
)
.or(0.0, "")
.within(0.0, 1.0);

const YOUNGS_MODULUS: Field = Field::quantity(
    "youngs_modulus",
    Dimension::PRESSURE,
    "modulus of elasticity",
)
.above_zero();

const SECOND_MOMENT: Field = Field::quantity(
    "second_moment",
    Dimension::SECOND_MOMENT,
    "second moment of area",
)
.above_zero();

const ENDS: &[Variant] = &[
    Variant::word(
        "cantilever",
        "one end built in, struck at the free one: 3EI/L³",
    ),
    Variant::word("simply_supported", "struck at midspan: 48EI/L³"),
    Variant::word(
        "built_in",
        "both ends built in, struck at midspan: 192EI/L³",
    ),
    Variant::with(
        "partly_built_in",
        &[Field::quantity(
            "rotational_stiffness",
            Dimension::ENERGY,
            "moment over rotation of each end, N*m/rad",
        )
        .required("rotational_stiffness: 5 kN*m/rad")
        .at_least_zero()],
        "between simply supported and built in: (192EI/L³)(r+2)/(r+8), r = k_θL/EI",
    ),
    Variant::with(
        "fixity",
        &[Field::quantity(
            "factor",
            Dimension::NUMBER,
            "0 pinned, 1 built in: p = 1/(1 + 3EI/(k_θL))",
        )
        .required("factor: 60 %")
        .within(0.0, 1.0)],
        "the same by its fixity factor: r = 3p/(1−p)",
    ),
];

const ENERGY_CAPACITY: Field = Field::quantity(
    "energy_capacity",
    Dimension::NUMBER,
    "γ: energy that takes all its strength, over F_y x_y",
)
.above_zero()
.or_said("its strength is kept");

const UNLOADING_CAPACITY: Field = Field::quantity(
    "unloading_capacity",
    Dimension::NUMBER,
    "γ of the unloading stiffness",
)
.above_zero()
.or_said("it is kept");

const DETERIORATION_EXPONENT: Field = Field::quantity(
    "deterioration_exponent",
    Dimension::NUMBER,
    "c of what is lost in each mode",
)
.or(1.0, "")
.within(0.5, 4.0);

const RESIDUAL_STRENGTH: Field = Field::quantity(
    "residual_strength",
    Dimension::NUMBER,
    "strength that is never lost, over the first one",
)
.or(0.05, "")
.within(0.01, 1.0);

const UNLOADING: &[Variant] = &[
    Variant::word(
        "initial_stiffness",
        "parallel to the steepest stretch of the table; what it flowed stays",
    ),
    Variant::word("along_curve", "back the way it came: elastic"),
];

const LOADS: &[Variant] = &[
    Variant::word("sway", "a load at the level of the beam, along it"),
    Variant::word("beam", "a load at midspan, across the beam"),
    Variant::with(
        "combined",
        &[
            Field::quantity("beam_load", Dimension::FORCE, "W₀ at midspan")
                .required("beam_load: 20 kN")
                .above_zero(),
            Field::quantity("sway_load", Dimension::FORCE, "H₀ at the level of the beam")
                .required("sway_load: 10 kN")
                .above_zero(),
        ],
        "both, growing in this ratio; the specimen's force is their sum",
    ),
];

pub(crate) const BEHAVIOURS: &[Variant] = &[
    Variant::with("elastic", &[STIFFNESS], "a linear spring"),
    Variant::with(
        "bilinear",
        &[STIFFNESS, YIELD_FORCE, HARDENING, ENERGY_CAPACITY, UNLOADING_CAPACITY, DETERIORATION_EXPONENT, RESIDUAL_STRENGTH],
        "elastic–plastic with kinematic hardening; wears with the energy it takes where a capacity is stated",
    ),
    Variant::with(
        "multilinear",
        &[
            Field::quantities("displacements", Dimension::LENGTH, "corners of the first loading, from the first yield on")
                .required("displacements: [1, 3, 8] mm"),
            Field::quantities("forces", Dimension::FORCE, "the forces there, each stretch softer than the one before")
                .required("forces: [10, 20, 25] kN"),
        ],
        "piecewise linear with kinematic hardening; the last slope goes on",
    ),
    Variant::with(
        "bouc_wen",
        &[
            STIFFNESS,
            YIELD_FORCE,
            HARDENING,
            Field::quantity("n", Dimension::NUMBER, "sharpness of the knee").or(1.0, "").within(1.0, 100.0),
            Field::quantity("beta", Dimension::NUMBER, "shape of unloading: straight at 0.5; γ is 1 − β")
                .or(0.5, "")
                .within(0.5, 1.0),
        ],
        "smooth hysteresis after Bouc and Wen",
    ),
    Variant::with(
        "pinching",
        &[
            STIFFNESS,
            YIELD_FORCE,
            HARDENING,
            Field::quantity("force_factor", Dimension::NUMBER, "κ_F: force at the break point over that of no pinching")
                .or(0.25, "")
                .within(0.0, 1.0),
            Field::quantity(
                "displacement_factor",
                Dimension::NUMBER,
                "κ_D: 1 − break point over the largest permanent displacement",
            )
            .or(0.5, "")
            .within(0.0, 1.0),
            Field::quantity("unloading_exponent", Dimension::NUMBER, "a of the unloading stiffness K (x_y/x_max)^a")
                .or(0.0, "")
                .within(0.0, 1.0),
            ENERGY_CAPACITY,
            UNLOADING_CAPACITY,
            Field::quantity("reloading_capacity", Dimension::NUMBER, "γ of the peak that it reloads to, which moves out")
                .above_zero()
                .or_said("it is kept"),
            Field::quantity("capping_displacement", Dimension::LENGTH, "x_c from which on its strength falls")
                .above_zero()
                .or_said("it never falls"),
            Field::quantity("capping_slope", Dimension::NUMBER, "how steeply it falls there, over the initial stiffness")
                .or(0.1, "")
                .above_zero_up_to(10.0),
            Field::quantity("capping_capacity", Dimension::NUMBER, "γ of the falling line, which moves in")
                .above_zero()
                .or_said("it is kept"),
            DETERIORATION_EXPONENT,
            RESIDUAL_STRENGTH,
        ],
        "pinched hysteresis that reloads towards its peaks, after Ibarra, Medina and Krawinkler",
    ),
    Variant::with(
        "degrading",
        &[
            STIFFNESS,
            Field::quantity("half_displacement", Dimension::LENGTH, "largest displacement at which half of the loss is there")
                .required("half_displacement: 5 mm")
                .above_zero(),
            Field::quantity("residual", Dimension::NUMBER, "stiffness that is never lost, over the initial one")
                .or(0.0, "")
                .within(0.0, 1.0),
        ],
        "stiffness that falls with the largest displacement; unloads to the origin",
    ),
    Variant::with(
        "bolted",
        &[
            STIFFNESS,
            Field::quantity("bearing_force", Dimension::FORCE, "force at which a hole yields and grows")
                .required("bearing_force: 5 kN")
                .above_zero(),
            Field::quantity("clearance", Dimension::LENGTH, "way from the middle to bearing").or(0.0, "mm").at_least_zero(),
            Field::quantity("slip_force", Dimension::FORCE, "friction of the clamped faces").or(0.0, "N").at_least_zero(),
        ],
        "a bolted joint: friction, clearance, bearing, holes that grow",
    ),
    Variant::with(
        "table",
        &[
            Field::text("file", "file of points in the plan's folder, header `displacement_m,force_n` (also `_mm`, `_kn`)")
                .required("file: \"loop.csv\""),
            Field::choice("unloading", UNLOADING, "how it unloads").or_said("initial_stiffness"),
        ],
        "measured points from a file; one-sided points hold both ways, and the last force holds beyond them",
    ),
    Variant::with(
        "fracture",
        &[
            Field::inner("of", "what breaks").required("of: elastic(stiffness: 300 kN/m)"),
            Field::quantity("displacement", Dimension::LENGTH, "breaks there, either way; or `force`").above_zero(),
            Field::quantity("force", Dimension::FORCE, "breaks there, either way").above_zero(),
        ],
        "whole until it breaks, no force after",
    ),
    Variant::with(
        "series",
        &[Field::inners("of", "what stands one behind the other")
            .required("of: [elastic(stiffness: 300 kN/m), elastic(stiffness: 1 MN/m)]")],
        "one force, displacements add",
    ),
    Variant::with(
        "parallel",
        &[Field::inners("of", "what stands side by side")
            .required("of: [elastic(stiffness: 300 kN/m), elastic(stiffness: 1 MN/m)]")],
        "one displacement, forces add",
    ),
    Variant::with(
        "rate",
        &[
            Field::inner("of", "what resists more the faster it is moved").required("of: elastic(stiffness: 300 kN/m)"),
            Field::quantity("reference_velocity", Dimension::VELOCITY, "velocity at which the force is twice the slow one")
                .required("reference_velocity: 1 m/s")
                .above_zero(),
            Field::quantity("exponent", Dimension::NUMBER, "1/q of Cowper and Symonds").or(0.2, "").above_zero_up_to(1.0),
        ],
        "the load cell reads R (1 + (v/v₀)^exponent) while the actuator moves; stands outermost",
    ),
    Variant::with(
        "maxwell",
        &[
            Field::inner("of", "what stands beside it; may be another `maxwell`, or a `logarithmic`")
                .required("of: elastic(stiffness: 300 kN/m)"),
            STIFFNESS,
            Field::quantity("time_constant", Dimension::TIME, "τ in which its force falls to 1/e at rest")
                .required("time_constant: 2 s")
                .above_zero(),
        ],
        "a spring and a dashpot one behind the other, beside the rest: force that relaxes; stands outermost",
    ),
    Variant::with(
        "logarithmic",
        &[
            Field::inner("of", "what relaxes").required("of: bilinear(stiffness: 300 kN/m, yield_force: 6 kN)"),
            Field::quantity("share", Dimension::NUMBER, "a: of the reached force, lost each time that 1 + t/t₀ has grown e-fold")
                .required("share: 1 %")
                .above_zero_up_to(1.0),
            Field::quantity("reference_time", Dimension::TIME, "t₀ of ln(1 + t/t₀)").required("reference_time: 1 s").above_zero(),
            Field::quantity("longest", Dimension::TIME, "time after which nothing more is lost")
                .above_zero()
                .or_said("a million times the `reference_time`"),
        ],
        "the reached force falls by a ln(1 + t/t₀) of itself, each step's by its own time; stands outermost, or in a `maxwell`",
    ),
    Variant::with(
        "beam",
        &[
            Field::quantity("length", Dimension::LENGTH, "span").required("length: 1.4 m").above_zero(),
            YOUNGS_MODULUS.required("youngs_modulus: 26 GPa"),
            SECOND_MOMENT.required("second_moment: 12e4 mm^4"),
            Field::choice("ends", ENDS, "how the ends are held").required("ends: simply_supported"),
            Field::quantity("shear_modulus", Dimension::PRESSURE, "G, with `shear_area`: adds the deflection by shear")
                .above_zero(),
            Field::quantity("shear_area", Dimension::AREA, "κA, the area that carries shear").above_zero(),
        ],
        "an elastic beam by its geometry; shear adds L/(4κGA) to the flexibility, L/(κGA) to a cantilever's",
    ),
    Variant::with(
        "portal",
        &[
            Field::quantity("span", Dimension::LENGTH, "L between the columns").required("span: 4 m").above_zero(),
            Field::quantity("height", Dimension::LENGTH, "h of the columns").required("height: 3 m").above_zero(),
            Field::quantity(
                "plastic_moment",
                Dimension::ENERGY,
                "Mp of the section, of the beam where the columns have their own",
            )
            .required("plastic_moment: 20 kN*m")
            .above_zero(),
            Field::choice("loads", LOADS, "what the frame carries").required("loads: sway"),
            YOUNGS_MODULUS,
            SECOND_MOMENT,
            Field::quantity("stiffness", Dimension::STIFFNESS, "in place of `youngs_modulus` and `second_moment`").above_zero(),
            Field::quantity("column_plastic_moment", Dimension::ENERGY, "Mp of the columns")
                .above_zero()
                .or_said("as the beam's"),
            Field::quantity("column_second_moment", Dimension::SECOND_MOMENT, "second moment of area of the columns")
                .above_zero()
                .or_said("as the beam's"),
            Field::quantity(
                "mass_per_length",
                Dimension::MASS_PER_LENGTH,
                "of the beam; gives the specimen its mass where it states none",
            )
            .above_zero()
            .or_said("density * area of the specimen"),
            Field::quantity("column_mass_per_length", Dimension::MASS_PER_LENGTH, "of the columns")
                .above_zero()
                .or_said("as the beam's"),
            Field::quantity("midspan_mass", Dimension::MASS, "carried at midspan").or(0.0, "kg").at_least_zero(),
            Field::quantity("corner_mass", Dimension::MASS, "carried at each corner").or(0.0, "kg").at_least_zero(),
        ],
        "a portal frame with fixed feet by plastic hinges: elastic up to the least collapse load",
    ),
];
