//! `study` and `fragility`: many runs of the plan with scattered inputs. Their readers, in `language::check::declarations::study`, name
//! the fields by these constants.

use crate::schema::types::{BlockKind, Field, FieldType, Kind, Naming, Variant};
use crate::study::{MOST_RUNS, MOST_SEED, USUAL_RUNS, USUAL_SEED};
use psd_text::units::Dimension;

pub const LIMITS: Field = Field::of_type(
    "limits",
    FieldType::RangeOfInput,
    "smallest and largest value; or `sd` or `cv` around the mean",
);

pub const SD: Field = Field::of_type(
    "sd",
    FieldType::OfInput,
    "standard deviation, in the unit of the input",
)
.above_zero();

pub const CV: Field = Field::quantity(
    "cv",
    Dimension::NUMBER,
    "coefficient of variation, instead of `sd`",
)
.above_zero();

pub const MEAN: Field =
    Field::of_type("mean", FieldType::OfInput, "mean").default_in_words("the value of the plan");

pub const MODE: Field = Field::of_type("mode", FieldType::OfInput, "most probable value")
    .default_in_words("the value of the plan");

pub const BETWEEN: Field = Field::of_type(
    "between",
    FieldType::RangeOfInput,
    "truncates the distribution; mean and standard deviation are those before",
);

pub const FILE: Field = Field::text(
    "file",
    "CSV file with a header, one row for each specimen measured; columns of one file are drawn together, row by row",
)
.required("\"measured.csv\"");

pub const COLUMN: Field =
    Field::text("column", "column with the values").required("column: \"mass_kg\"");

pub const UNIT: Field = Field::of_type(
    "unit",
    FieldType::OfInput,
    "unit of the values, if the name of the column does not end in it, such as `mass_kg`, `speed_m_per_s`",
)
.default_in_words("the unit of the column")
.above_zero();

/// The word of the distribution of ground-motion records.
pub const ANY: &str = "any";

const BY_SPREAD: &[Field] = &[SD, CV, MEAN, BETWEEN];

/// The distributions of an input.
pub const DISTRIBUTIONS: &[Variant] = &[
    Variant::with("normal", BY_SPREAD, "normal distribution"),
    Variant::with(
        "lognormal",
        BY_SPREAD,
        "lognormal, by mean and scatter of the value itself",
    ),
    Variant::with(
        "uniform",
        &[LIMITS, SD, CV, MEAN, BETWEEN],
        "uniform (rectangular)",
    ),
    Variant::with(
        "triangular",
        &[LIMITS, MODE, SD, CV, MEAN, BETWEEN],
        "triangular",
    ),
    Variant::with(
        "weibull",
        BY_SPREAD,
        "Weibull, from 0 on: smallest strengths",
    ),
    Variant::with("gumbel", BY_SPREAD, "Gumbel: largest loads"),
    Variant::with(
        "from",
        &[FILE, COLUMN, UNIT],
        "measured values, each row with equal probability",
    ),
    Variant::word(
        ANY,
        "one ground-motion record of a list, each with equal probability; for `record_number`",
    ),
    Variant::word(
        "measured",
        "normal, with the standard uncertainty that the block states for the field (`mass_uncertainty` of `mass`), or of the result of an identification, as a simulated run gives it; so does an input without `~`",
    ),
];

pub const VARY: Field = Field::of_type(
    "vary",
    FieldType::Inputs(DISTRIBUTIONS),
    "inputs that differ from run to run: a `param`, a field such as `beam.mass`, an argument such as `beam.behaviour.stiffness`, the \
     result of an identification such as `k0.stiffness`",
)
.required("vary = [beam.mass ~ normal(cv: 2 %)]");

#[expect(clippy::cast_precision_loss, reason = "far below 2^53")]
pub const RUNS: Field = Field::count("runs", 1.0, MOST_RUNS as f64, "number of runs; or `until`")
    .or(USUAL_RUNS as f64, "");

pub const CONFIDENCE: Field = Field::quantity(
    "confidence",
    Dimension::NUMBER,
    "confidence of the intervals",
)
.within(0.5, 0.999_999)
.or(95.0, "%")
.advanced();

/// The confidence of a stopping rule.
pub const RULE_CONFIDENCE: Field = Field::quantity(
    "confidence",
    Dimension::NUMBER,
    "confidence over all looks at the runs",
)
.within(0.5, 0.999_999)
.default_in_words("the study's");

#[expect(clippy::cast_precision_loss, reason = "far below 2^53")]
pub const AT_MOST: Field = Field::count("at_most", 1.0, MOST_RUNS as f64, "largest number of runs")
    .required("at_most: 1000000");

pub const HALF_WIDTH: Field = Field::quantity(
    "width",
    Dimension::NUMBER,
    "largest half-width of the interval of a probability",
)
.required("0.5 %")
.above_zero_up_to(0.5);

/// Words of `until`.
pub const DECIDED: &str = "decided";
pub const UNTIL: Field = Field::choice(
    "until",
    &[
        Variant::with(
            DECIDED,
            &[RULE_CONFIDENCE, AT_MOST],
            "until every requirement on a probability of this study is met or not met",
        ),
        Variant::with(
            "half_width",
            &[HALF_WIDTH, RULE_CONFIDENCE, AT_MOST],
            "until the probability of failure of every requirement is known this well",
        ),
    ],
    "end of the study by its results",
);

const RANDOM: Variant = Variant::word(
    "random",
    "independent runs: exact intervals of probabilities",
);
const LATIN_HYPERCUBE: Variant = Variant::word(
    "latin_hypercube",
    "strata of every input: smoother means; the number of runs is fixed, probabilities have no interval",
);
const SOBOL: Variant = Variant::word(
    "sobol",
    "scrambled Sobol' sequences, 64 inputs at most: means and sensitivities with fewer runs",
);

pub const POINTS: Field = Field::count(
    "points",
    100.0,
    100_000.0,
    "runs of a level, a multiple of ten",
)
.or(1000.0, "");

pub const LEVEL_REPLICATES: Field = Field::count(
    "replicates",
    2.0,
    1000.0,
    "independent simulations: their scatter gives the interval",
)
.or(10.0, "");

/// Word of `sampling`.
pub const SUBSET: &str = "subset";

pub const SAMPLING: Field = Field::choice(
    "sampling",
    &[
        RANDOM,
        LATIN_HYPERCUBE,
        SOBOL,
        Variant::with(
            SUBSET,
            &[POINTS, LEVEL_REPLICATES],
            "subset simulation of a rare failure, level by level: for the one requirement on a probability of this study",
        ),
    ],
    "points of the runs",
)
.default_in_words("random");

pub const STRIPE_SAMPLING: Field = Field::choice(
    "sampling",
    &[RANDOM, LATIN_HYPERCUBE, SOBOL],
    "points of the runs",
)
.default_in_words("random");

#[expect(clippy::cast_precision_loss, reason = "2^53")]
pub const SEED: Field = Field::count(
    "seed",
    0.0,
    MOST_SEED as f64,
    "seed of the random numbers: same seed, same runs",
)
.or(USUAL_SEED as f64, "");

pub const COLLECT: Field = Field::of_type(
    "collect",
    FieldType::ResultNames,
    "results that are kept for every run, or numbers from them such as `max(quake.max_drift)`, beside those that a requirement reads",
)
.default_in_words("none");

pub const FIRST: Field =
    Field::of_type("first", FieldType::InputName, "an input of `vary`").required("impact_speed");

pub const OTHER: Field =
    Field::of_type("other", FieldType::InputName, "another one").required("beam.mass");

pub const CORRELATION: Field = Field::quantity(
    "correlation",
    Dimension::NUMBER,
    "rank correlation (Spearman's ρ) of the two, above -1 and below 1: both ends are refused",
)
.required("0.6")
.within(-1.0, 1.0);

pub const CORRELATE: Field = Field::choices(
    "correlate",
    &[Variant::with(
        "rank",
        &[FIRST, OTHER, CORRELATION],
        "rank correlation of two inputs",
    )],
    "rank correlations of inputs; the others are independent",
)
.default_in_words("none");

pub const INTENSITY: Field = Field::of_type(
    "intensity",
    FieldType::Intensity,
    "the input that is stepped, with its values, which increase from above 0",
)
.required("intensity = impact_speed in 0.5 .. 1.5 step 0.1 m/s");

pub const EXCEEDS: Field = Field::condition(
    "exceeds",
    "condition on the results of a run that counts as an exceedance, as in `require`",
)
.required("exceeds = hit.max_displacement > 50 mm");

pub const VARY_OTHERS: Field = Field::of_type(
    "vary",
    FieldType::Inputs(DISTRIBUTIONS),
    "other inputs, as in `study`: they differ from run to run at each intensity",
);

#[expect(clippy::cast_precision_loss, reason = "far below 2^53")]
pub const STRIPE_RUNS: Field = Field::count(
    "runs",
    1.0,
    MOST_RUNS as f64,
    "number of runs at each intensity",
)
.required("runs = 200");

pub const FAILS: Field = Field::of_type(
    "fails",
    FieldType::RequirementName,
    "requirement that is not met",
);

pub const HOLDS: Field = Field::of_type(
    "holds",
    FieldType::RequirementName,
    "requirement that is met, instead of `fails`",
);

/// `scatter.probability(fails: "stays in travel")`
pub const PROBABILITY: Variant = Variant::with(
    "probability",
    &[FAILS, HOLDS],
    "probability that a requirement is not met, or is met",
);

pub const STUDY: BlockKind = BlockKind {
    kind: Kind::Study,
    keyword: &["study"],
    naming: Naming::Named,
    fields: &[
        VARY, RUNS, UNTIL, SAMPLING, SEED, COLLECT, CORRELATE, CONFIDENCE,
    ],
    exports: &[],
    results: &[],
    example: "study scatter {\n  vary = [beam.mass ~ normal(cv: 2 %)]\n}",
    doc: "Many simulated runs of the plan with scattered inputs, by `psd study run`. A requirement reads their probability: \
          `require \"rarely too far\" NAME.probability(fails: \"stays in travel\") < 2 %`, or `holds:` for a requirement that is met",
};

pub const FRAGILITY: BlockKind = BlockKind {
    kind: Kind::Fragility,
    keyword: &["fragility"],
    naming: Naming::Named,
    fields: &[
        INTENSITY,
        EXCEEDS,
        VARY_OTHERS,
        STRIPE_RUNS,
        STRIPE_SAMPLING,
        SEED,
        CORRELATE,
        CONFIDENCE,
    ],
    exports: &[],
    results: &[],
    example: "fragility tip {\n  intensity = impact_speed in 0.5 .. 1.5 step 0.1 m/s\n  exceeds = hit.max_displacement > 50 mm\n  runs = 200\n}",
    doc: "Probability that a limit is exceeded, by intensity: runs at each of several values of one input, by `psd study run`",
};
