//! The restoring-force models of a specimen: the variants of `behaviour`.

use crate::schema::{Field, Variant};
use psd_physics::specimen::numbers;
use psd_text::units::Dimension;

/// The names of the arguments of models with other parameters than numbers.
pub mod argument {
    pub const YOUNGS_MODULUS: &str = "youngs_modulus";
    pub const SECOND_MOMENT: &str = "second_moment";
    pub const ROTATIONAL_STIFFNESS: &str = "rotational_stiffness";
    pub const FACTOR: &str = "factor";
    pub const BEAM_LOAD: &str = "beam_load";
    pub const SWAY_LOAD: &str = "sway_load";
    pub const DISPLACEMENTS: &str = "displacements";
    pub const FORCES: &str = "forces";
    pub const FILE: &str = "file";
    pub const UNLOADING: &str = "unloading";
    pub const OF: &str = "of";
    pub const DISPLACEMENT: &str = "displacement";
    pub const FORCE: &str = "force";
    pub const REFERENCE_VELOCITY: &str = "reference_velocity";
    pub const EXPONENT: &str = "exponent";
    pub const TIME_CONSTANT: &str = "time_constant";
    pub const SHARE: &str = "share";
    pub const REFERENCE_TIME: &str = "reference_time";
    pub const LONGEST: &str = "longest";
    pub const LENGTH: &str = "length";
    pub const ENDS: &str = "ends";
    pub const SHEAR_MODULUS: &str = "shear_modulus";
    pub const SHEAR_AREA: &str = "shear_area";
    pub const AT: &str = "at";
    pub const SPAN: &str = "span";
    pub const HEIGHT: &str = "height";
    pub const PLASTIC_MOMENT: &str = "plastic_moment";
    pub const LOADS: &str = "loads";
    pub const COLUMN_PLASTIC_MOMENT: &str = "column_plastic_moment";
    pub const COLUMN_SECOND_MOMENT: &str = "column_second_moment";
    pub const MASS_PER_LENGTH: &str = "mass_per_length";
    pub const COLUMN_MASS_PER_LENGTH: &str = "column_mass_per_length";
    pub const MIDSPAN_MASS: &str = "midspan_mass";
    pub const CORNER_MASS: &str = "corner_mass";
}

/// K
pub const STIFFNESS: Field = Field::quantity(
    numbers::STIFFNESS,
    Dimension::STIFFNESS,
    "initial stiffness",
)
.required("stiffness: 300 kN/m")
.above_zero();

/// `F_y`
const YIELD_FORCE: Field = Field::quantity(
    numbers::YIELD_FORCE,
    Dimension::FORCE,
    "force at first yield",
)
.required("yield_force: 4 kN")
.above_zero();

/// `K_p/K`
const POST_YIELD_RATIO: Field = Field::quantity(
    numbers::POST_YIELD_RATIO,
    Dimension::NUMBER,
    "post-yield stiffness over initial stiffness",
)
.or(0.0, "")
.within(0.0, 1.0);

const ENERGY_CAPACITY: Field = Field::quantity(
    numbers::ENERGY_CAPACITY,
    Dimension::NUMBER,
    "γ: energy at which all strength is lost, over F_y x_y",
)
.above_zero()
.default_in_words("no loss of strength");

const UNLOADING_CAPACITY: Field = Field::quantity(
    numbers::UNLOADING_CAPACITY,
    Dimension::NUMBER,
    "γ of the unloading stiffness",
)
.above_zero()
.default_in_words("no loss");

const DETERIORATION_EXPONENT: Field = Field::quantity(
    numbers::DETERIORATION_EXPONENT,
    Dimension::NUMBER,
    "exponent c of the deterioration in each mode",
)
.or(1.0, "")
.within(0.5, 4.0)
.advanced();

const RESIDUAL_STRENGTH: Field = Field::quantity(
    numbers::RESIDUAL_STRENGTH,
    Dimension::NUMBER,
    "strength that always remains, over the initial strength",
)
.or(0.05, "")
.within(0.01, 1.0);

pub const CAPPING_DISPLACEMENT: Field = Field::quantity(
    numbers::CAPPING_DISPLACEMENT,
    Dimension::LENGTH,
    "x_c, at which strength begins to fall",
)
.above_zero()
.default_in_words("never");

pub const CAPPING_SLOPE: Field = Field::quantity(
    numbers::CAPPING_SLOPE,
    Dimension::NUMBER,
    "slope of the falling branch over the initial stiffness",
)
.or(0.1, "")
.above_zero_up_to(10.0);

pub const CAPPING_CAPACITY: Field = Field::quantity(
    numbers::CAPPING_CAPACITY,
    Dimension::NUMBER,
    "γ of the falling branch, which moves inward",
)
.above_zero()
.default_in_words("no loss");

const YOUNGS_MODULUS: Field = Field::quantity(
    argument::YOUNGS_MODULUS,
    Dimension::PRESSURE,
    "modulus of elasticity",
)
.above_zero();

const SECOND_MOMENT: Field = Field::quantity(
    argument::SECOND_MOMENT,
    Dimension::SECOND_MOMENT,
    "second moment of area",
)
.above_zero();

const ENDS: &[Variant] = &[
    Variant::word("cantilever", "cantilever, struck at the free end: 3EI/L³"),
    Variant::word("simply_supported", "struck at midspan: 48EI/L³"),
    Variant::word("built_in", "both ends fixed, struck at midspan: 192EI/L³"),
    Variant::with(
        "partly_built_in",
        &[Field::quantity(
            argument::ROTATIONAL_STIFFNESS,
            Dimension::ROTATIONAL_STIFFNESS,
            "moment over rotation of each end",
        )
        .required("rotational_stiffness: 5 kN*m/rad")
        .at_least_zero()],
        "partly fixed: (192EI/L³)(r+2)/(r+8), r = k_θL/EI",
    ),
    Variant::with(
        "fixity",
        &[Field::quantity(
            argument::FACTOR,
            Dimension::NUMBER,
            "0 pinned, 1 fixed: p = 1/(1 + 3EI/(k_θL))",
        )
        .required("factor: 60 %")
        .within(0.0, 1.0)],
        "partly fixed, by fixity factor: r = 3p/(1−p)",
    ),
];

const UNLOADING: &[Variant] = &[
    Variant::word(
        "initial_stiffness",
        "parallel to the steepest segment of the table; plastic deformation remains",
    ),
    Variant::word(
        "along_curve",
        "back along the loading curve: nonlinear elastic",
    ),
];

const LOADS: &[Variant] = &[
    Variant::word("sway", "one load along the beam, at its level"),
    Variant::word("beam", "one load across the beam, at midspan"),
    Variant::with(
        "combined",
        &[
            Field::quantity(argument::BEAM_LOAD, Dimension::FORCE, "W₀ at midspan")
                .required("beam_load: 20 kN")
                .above_zero(),
            Field::quantity(
                argument::SWAY_LOAD,
                Dimension::FORCE,
                "H₀ at the level of the beam",
            )
            .required("sway_load: 10 kN")
            .above_zero(),
        ],
        "both loads, growing in this ratio; the force is their sum",
    ),
];

/// The models.
pub const BEHAVIOURS: &[Variant] = &[
    Variant::with("elastic", &[STIFFNESS], "linear spring"),
    Variant::with(
        "bilinear",
        &[
            STIFFNESS,
            YIELD_FORCE,
            POST_YIELD_RATIO,
            ENERGY_CAPACITY,
            UNLOADING_CAPACITY,
            DETERIORATION_EXPONENT,
            RESIDUAL_STRENGTH,
        ],
        "elastic–plastic with kinematic hardening; deteriorates if a capacity is given",
    ),
    Variant::with(
        "bouc_wen",
        &[
            STIFFNESS,
            YIELD_FORCE,
            POST_YIELD_RATIO,
            Field::quantity(numbers::SHARPNESS, Dimension::NUMBER, "sharpness of the yield transition").or(1.0, "").within(1.0, 100.0),
            Field::quantity(numbers::BETA, Dimension::NUMBER, "shape of unloading: straight at 0.5; γ is 1 − β")
                .or(0.5, "")
                .within(0.5, 1.0),
        ],
        "smooth hysteresis of Bouc and Wen",
    ),
    Variant::with(
        "pinching",
        &[
            STIFFNESS,
            YIELD_FORCE,
            POST_YIELD_RATIO,
            Field::quantity(numbers::FORCE_FACTOR, Dimension::NUMBER, "κ_F: force at the break point over the force without pinching")
                .or(0.25, "")
                .within(0.0, 1.0),
            Field::quantity(numbers::DISPLACEMENT_FACTOR, Dimension::NUMBER, "κ_D: 1 − break point over largest permanent displacement")
                .or(0.5, "")
                .within(0.0, 1.0),
            Field::quantity(numbers::UNLOADING_EXPONENT, Dimension::NUMBER, "exponent a of the unloading stiffness K (x_y/x_max)^a")
                .or(0.0, "")
                .within(0.0, 1.0),
            ENERGY_CAPACITY,
            UNLOADING_CAPACITY,
            Field::quantity(numbers::RELOADING_CAPACITY, Dimension::NUMBER, "γ of the reloading peak, which moves outward")
                .above_zero()
                .default_in_words("no loss"),
            CAPPING_DISPLACEMENT,
            CAPPING_SLOPE,
            CAPPING_CAPACITY,
            DETERIORATION_EXPONENT,
            RESIDUAL_STRENGTH,
        ],
        "pinched, peak-oriented hysteresis (Ibarra, Medina and Krawinkler)",
    ),
    Variant::with(
        "degrading",
        &[
            STIFFNESS,
            Field::quantity(numbers::HALF_DISPLACEMENT, Dimension::LENGTH, "peak displacement at which half of the loss has occurred")
                .required("half_displacement: 5 mm")
                .above_zero(),
            Field::quantity(numbers::RESIDUAL, Dimension::NUMBER, "stiffness that always remains, over the initial stiffness")
                .or(0.0, "")
                .within(0.0, 1.0),
        ],
        "stiffness falls with the peak displacement; unloads to the origin",
    ),
    Variant::with(
        "bolted",
        &[
            STIFFNESS,
            Field::quantity(numbers::BEARING_FORCE, Dimension::FORCE, "force at which a hole yields and elongates")
                .required("bearing_force: 5 kN")
                .above_zero(),
            Field::quantity(numbers::CLEARANCE, Dimension::LENGTH, "clearance: displacement from centre to bearing")
                .or(0.0, "mm")
                .at_least_zero(),
            Field::quantity(numbers::SLIP_FORCE, Dimension::FORCE, "friction of the clamped faces").or(0.0, "N").at_least_zero(),
        ],
        "bolted joint: friction, clearance, bearing, holes that elongate",
    ),
    Variant::with(
        "multilinear",
        &[
            Field::quantities(argument::DISPLACEMENTS, Dimension::LENGTH, "backbone points, from first yield on")
                .required("displacements: [1, 3, 8] mm"),
            Field::quantities(argument::FORCES, Dimension::FORCE, "forces at these points; each segment is softer than the one before")
                .required("forces: [10, 20, 25] kN"),
        ],
        "piecewise linear with kinematic hardening; the last slope continues",
    ),
    Variant::with(
        "table",
        &[
            Field::text(argument::FILE, "CSV file of points in the plan's folder, header `displacement_m,force_n` (also `_mm`, `_kn`)")
                .required("file: \"loop.csv\""),
            Field::choice(argument::UNLOADING, UNLOADING, "unloading rule").default_in_words("initial_stiffness"),
        ],
        "measured points from a file; one-sided points apply in both directions; constant force beyond the last point",
    ),
    Variant::with(
        "fracture",
        &[
            Field::inner(argument::OF, "model that breaks").required("of: elastic(stiffness: 300 kN/m)"),
            Field::quantity(argument::DISPLACEMENT, Dimension::LENGTH, "breaks at this displacement, in either direction; or give `force`").above_zero(),
            Field::quantity(argument::FORCE, Dimension::FORCE, "breaks at this force, in either direction").above_zero(),
        ],
        "intact until it breaks; zero force after that",
    ),
    Variant::with(
        "series",
        &[Field::inners(argument::OF, "models in series")
            .required("of: [elastic(stiffness: 300 kN/m), elastic(stiffness: 1 MN/m)]")],
        "in series: equal force, displacements add",
    ),
    Variant::with(
        "parallel",
        &[Field::inners(argument::OF, "models in parallel")
            .required("of: [elastic(stiffness: 300 kN/m), elastic(stiffness: 1 MN/m)]")],
        "in parallel: equal displacement, forces add",
    ),
    Variant::with(
        "rate",
        &[
            Field::inner(argument::OF, "model at slow loading").required("of: elastic(stiffness: 300 kN/m)"),
            Field::quantity(argument::REFERENCE_VELOCITY, Dimension::VELOCITY, "velocity at which the force doubles")
                .required("reference_velocity: 1 m/s")
                .above_zero(),
            Field::quantity(argument::EXPONENT, Dimension::NUMBER, "1/q of Cowper and Symonds").or(0.2, "").above_zero_up_to(1.0),
        ],
        "rate effect: the load cell reads R (1 + (v/v₀)^exponent) during motion; must be the outermost model",
    ),
    Variant::with(
        "maxwell",
        &[
            Field::inner(argument::OF, "model in parallel with it; may be another `maxwell` or a `logarithmic`")
                .required("of: elastic(stiffness: 300 kN/m)"),
            STIFFNESS,
            Field::quantity(argument::TIME_CONSTANT, Dimension::TIME, "τ: its force decays to 1/e in this time at rest")
                .required("time_constant: 2 s")
                .above_zero(),
        ],
        "spring and dashpot in series, in parallel with `of`: force relaxation; must be the outermost model",
    ),
    Variant::with(
        "logarithmic",
        &[
            Field::inner(argument::OF, "model whose force relaxes").required("of: bilinear(stiffness: 300 kN/m, yield_force: 6 kN)"),
            Field::quantity(argument::SHARE, Dimension::NUMBER, "a: fraction of the unrelaxed force lost for each e-fold growth of 1 + t/t₀")
                .required("share: 1 %")
                .above_zero_up_to(1.0),
            Field::quantity(argument::REFERENCE_TIME, Dimension::TIME, "t₀ of ln(1 + t/t₀)").required("reference_time: 1 s").above_zero(),
            Field::quantity(argument::LONGEST, Dimension::TIME, "time after which no more is lost")
                .above_zero()
                .default_in_words("10⁶ × `reference_time`")
                .advanced(),
        ],
        "the unrelaxed force falls by a ln(1 + t/t₀) of itself, superposed from each step; must be outermost, or inside a `maxwell`",
    ),
    Variant::with(
        "beam",
        &[
            Field::quantity(argument::LENGTH, Dimension::LENGTH, "span").required("length: 1.4 m").above_zero(),
            YOUNGS_MODULUS.required("youngs_modulus: 26 GPa"),
            SECOND_MOMENT.required("second_moment: 12e4 mm^4"),
            Field::choice(argument::ENDS, ENDS, "end supports").required("ends: simply_supported"),
            Field::quantity(argument::SHEAR_MODULUS, Dimension::PRESSURE, "G, with `shear_area`: adds the shear deflection")
                .above_zero(),
            Field::quantity(argument::SHEAR_AREA, Dimension::AREA, "κA, effective shear area").above_zero(),
            Field::quantity(argument::AT, Dimension::LENGTH, "distance of the struck section from a support, or from the fixed end of a cantilever")
                .above_zero()
                .default_in_words("middle; tip of a cantilever"),
        ],
        "elastic beam from its geometry; shear adds flexibility L/(4κGA); L/(κGA) for a cantilever",
    ),
    Variant::with(
        "portal",
        &[
            Field::quantity(argument::SPAN, Dimension::LENGTH, "L between the columns").required("span: 4 m").above_zero(),
            Field::quantity(argument::HEIGHT, Dimension::LENGTH, "h of the columns").required("height: 3 m").above_zero(),
            Field::quantity(
                argument::PLASTIC_MOMENT,
                Dimension::ENERGY,
                "Mp of the section; of the beam if the columns have their own",
            )
            .required("plastic_moment: 20 kN*m")
            .above_zero(),
            Field::choice(argument::LOADS, LOADS, "loads on the frame").required("loads: sway"),
            YOUNGS_MODULUS,
            SECOND_MOMENT,
            Field::quantity(STIFFNESS.name, Dimension::STIFFNESS, "initial stiffness, instead of `youngs_modulus` and `second_moment`").above_zero(),
            Field::quantity(argument::COLUMN_PLASTIC_MOMENT, Dimension::ENERGY, "Mp of the columns")
                .above_zero()
                .default_in_words("equal to the beam's"),
            Field::quantity(argument::COLUMN_SECOND_MOMENT, Dimension::SECOND_MOMENT, "second moment of area of the columns")
                .above_zero()
                .default_in_words("equal to the beam's"),
            Field::quantity(
                argument::MASS_PER_LENGTH,
                Dimension::MASS_PER_LENGTH,
                "of the beam; gives the mass of the specimen if `mass` is absent",
            )
            .above_zero()
            .default_in_words("density * area of the specimen"),
            Field::quantity(argument::COLUMN_MASS_PER_LENGTH, Dimension::MASS_PER_LENGTH, "of the columns")
                .above_zero()
                .default_in_words("equal to the beam's"),
            Field::quantity(argument::MIDSPAN_MASS, Dimension::MASS, "mass at midspan").or(0.0, "kg").at_least_zero(),
            Field::quantity(argument::CORNER_MASS, Dimension::MASS, "mass at each corner").or(0.0, "kg").at_least_zero(),
        ],
        "portal frame with fixed feet by plastic hinges: elastic up to the lowest collapse load",
    ),
];

/// The dimension of a number of a model.
pub fn dimension(model: &str, argument: &str) -> Dimension {
    let model = BEHAVIOURS.iter().find(|variant| variant.name == model);
    let mut arguments = model.iter().flat_map(|model| model.arguments);
    let named = arguments.find(|field| field.name == argument);
    named
        .and_then(Field::dimension)
        .unwrap_or(Dimension::NUMBER)
}
