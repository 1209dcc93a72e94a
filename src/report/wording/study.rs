//! The words of a study's figures and report. In: values as text. Out: sentences. A test report has its words in `english.rs`.

phrases! {
    KIND = "Report of a study";
    HEADING = "STUDY (SIMULATION)";
    WATERMARK = "SIMULATION";
    END = "— End of report ";
    SIMULATED = "Every run of this study is simulated. It describes the model with scattered inputs, not a specimen.";
    fn outcome(heading, outcome) = "{heading}: {outcome}";
    fn undecided(count, total) = "{count} of {total} requirements undecided";
    fn incomplete(runs, at_most) = "INCOMPLETE: {runs} of up to {at_most} runs. An incomplete study decides nothing.";
    fn curve(median, dispersion) = "Median θ = {median}, dispersion β = {dispersion}.";
    NO_STUDIED = "The plan has no requirement on a probability of this study.";

    // The first page.
    PLAN = "Plan";
    STUDY = "Study";
    RUNS = "Runs";
    SEED = "Seed";
    SAMPLING = "Sampling";
    ENDS = "Ends";
    CONFIDENCE = "Confidence";
    fn runs_of(runs, at_most) = "{runs} of at most {at_most}";
    ENDS_FIXED = "after a fixed number of runs";
    ENDS_DECIDED = "when every requirement on the study is decided";
    fn ends_half_width(width) = "when half of every interval is at most {width}";
    fn ends_levels(replicates, points) = "when {replicates} replicates with {points} runs a level have reached the limit";
    fn ends_stripes(stripes, runs) = "{stripes} intensities with {runs} runs each";
    RANDOM = "independent random runs";
    LATIN_HYPERCUBE = "Latin hypercube";
    fn sobol(replicates) = "scrambled Sobol' sequences, {replicates} replicates";
    SUBSET = "subset simulation";
    fn level_intervals(confidence) = "The interval has a confidence of {confidence} (Student's t, of the replicates of the subset \
        simulation). The requirement is met or not met if the whole interval is on one side of the limit, otherwise undecided.";
    STATEMENTS = "Requirements on the study";
    STATEMENT_COLUMNS = ["Requirement", "Probability", "Interval", "Limit", "Statement"];
    MET = "MET";
    NOT_MET = "NOT MET";
    UNDECIDED = "UNDECIDED";
    fn after_runs(runs) = " after {runs} runs";
    fn intervals(confidence) = "Intervals have a confidence of {confidence} (Clopper–Pearson). A requirement is met or not met if its \
        whole interval is on one side of the limit, otherwise undecided.";
    BY_LOOKS = "The study chose its own end. Its intervals are those of its last look, which are wider than those of a fixed number \
        of runs: so they hold with this confidence.";
    SERIES = "Here the condition of a series of impacts is decided on its value alone. A run outside of a study decides it with U: its \
        series ends earlier where U is withheld, or where the value is inside the guard band.";
    NOT_EXACT = "The runs are not independent of each other: the interval is computed as if they were.";

    // Requirements of the plan.
    REQUIREMENTS = "Requirements of the plan, run by run";
    REQUIREMENT_COLUMNS = ["Requirement", "Met", "Not met", "No result", "P(not met)", "Interval"];
    fn below(bound) = "below {bound}";
    fn above(bound) = "above {bound}";
    fn between(low, high) = "{low} to {high}";
    NO_FAILURE = "A requirement that no run failed has an upper bound, not the probability 0.";
    NO_RESULT_BOUNDS = "Runs without a result are not dropped: the first number counts them as met, the second as not met, and the \
        interval holds for both.";

    // Results.
    RESULTS = "Results";
    RESULT_COLUMNS = ["Result", "Mean", "Standard deviation", "5 %", "50 %", "95 %"];
    fn kept(runs) = "Quantiles, histograms and cumulative curves use the first {runs} runs.";
    fn by_ranks(confidence) = "In brackets: interval with a confidence of {confidence}; of a quantile by ranks, which holds for any \
        distribution.";
    fn by_replicates(confidence) = "In brackets: interval with a confidence of {confidence}, from the scatter of the replicates.";
    NO_INTERVAL = "A Latin hypercube gives no interval: its runs depend on each other, and one hypercube shows no scatter.";
    UNBOUNDED = "∞";
    fn lost(count) = "{count} runs without it";

    // Sensitivities.
    SENSITIVITIES = "Sensitivities";
    SENSITIVITY_COLUMNS = ["Input", "First-order index", "Interval", "Rank correlation", "Interval"];
    fn of_result(name) = "Sensitivities of {name}";
    EXPLAINED = "The first-order index is the fraction of the variance of the result that the input explains alone, estimated by \
        ranks. Spearman's rank correlation gives the direction.";
    fn ranked(runs) = "From the first {runs} runs.";
    MAY_BE_ZERO = "*  not distinguishable from 0";
    CORRELATED = "The inputs are correlated: the variance of a result cannot be split among them. Rank correlations are given.";

    // Worst runs.
    WORST = "Worst runs";
    WORST_COLUMNS = ["Run", "Requirement", "Value", "Settings"];
    fn worst_of(label) = "Worst runs: {label}";
    REPRODUCE = "A run is reproduced bit for bit by ";
    REPRODUCE_SERIES = "A run whose series U does not end earlier is reproduced bit for bit by ";
    NO_WORST = "No run is listed: every run meets this requirement, and it does not compare a single result.";

    // Fragility.
    FRAGILITY = "Fragility";
    STRIPE_COLUMNS = ["Intensity", "Runs", "Exceeded", "No result", "Fraction", "Interval"];
    FIT_COLUMNS = ["Curve", "Median θ", "Interval", "Dispersion β", "Interval", "Goodness of fit"];
    CURVE = "P = Φ(ln(x/θ)/β)";
    CURVE_LOW = "no result = not exceeded";
    CURVE_HIGH = "no result = exceeded";
    fn no_fit(reason) = "No curve fits: {reason}.";
    FITTED = "Lognormal curve of the largest likelihood through all stripes (J. W. Baker, Earthquake Spectra 31 (2015) 579–599). \
        Intervals and band: profile likelihood.";
    GOODNESS = "Goodness of fit: probability of a deviance as large as this one if the curve is lognormal. Below 5 % the curve is \
        doubtful.";
    NO_MIDDLE = "No stripe has between 10 % and 90 % of exceedances: the dispersion is a guess. Add intensities between them.";
    SPLIT_COLUMNS = ["Records", "Record-to-record β", "Modelling β", "Between records", "Interval"];
    SPLIT = "Between records: fraction of β² that is record-to-record, with its profile likelihood (random effects of the records). \
        The rest is that of the other inputs.";
    MODELLING_ALONE = "The dispersion comes from the varied inputs (modelling).";
    RECORDS_ALONE = "The dispersion is record-to-record alone: nothing else varies. Curve and band hold for these records.";
    OF_THESE_RECORDS = "Curve and band hold for these records, with equal probabilities.";
    STEPPED = "stepped";

    // Levels of a subset simulation.
    LEVELS = "Levels of the subset simulation";
    LEVEL_COLUMNS = ["Level", "Threshold", "Replicates", "Beyond it", "Accepted moves"];
    LEVELS_EXPLAINED = "The probability of a replicate is the product of the fractions beyond its thresholds (S.-K. Au, J. L. Beck, \
        Prob. Eng. Mech. 16 (2001) 263–277). Each level starts from the 10 % of runs closest to the limit.";
    fn variation(fraction) = "Coefficient of variation of one replicate: {fraction}.";
    fn levels_without_result(runs) = "{runs} runs without a result count as failures, so the interval begins at 0.";

    // Looks.
    LOOKS = "Looks of the stopping rule";
    LOOK_COLUMNS = ["Look", "Runs", "Confidence"];
    SPENT = "The study looked at its runs several times. Look m uses the part α/(m(m + 1)) of the error probability α. The sum of all \
        parts is at most α, so the decision holds although the study chose its own end.";

    // Inputs, runs without result, provenance.
    INPUTS = "Inputs";
    INPUT_COLUMNS = ["Input", "Distribution", "Value of the plan"];
    CORRELATIONS = "Correlations: ";
    TABLE_ROWS = "Inputs from one table are drawn together, row by row.";
    REASONS = "Runs without a result";
    REASON_COLUMNS = ["Reason", "Runs", "First run"];
    PROVENANCE = "Provenance";
    VERSION = "Program";
    DIGEST = "SHA-256 of the plan and its settings";
    SETTINGS = "Settings on the command line";
    NO_SETTINGS = "none";
    DATA_SET = "Data set";
    fn data_set(runs) = "{runs} rows, one per run";
    REPORT = "Report, first digits of the SHA-256 of the data set's metadata";
    SAME_LEVELS = "A run depends on the seed and on the runs of the level before it. The same plan, seed and program give the same \
        data set, bit for bit.";
    SAME = "Run i depends on the seed and i alone. The same plan, seed and program give the same data set, bit for bit.";

    // Figures.
    RUNS_AXIS = "Runs";
    FRACTION_AXIS = "Fraction of runs not above";
    PROBABILITY_AXIS = "Probability of exceedance";
    FIRST_ORDER_AXIS = "First-order index";
    RANK_AXIS = "Rank correlation";
    QUANTILES = "quantiles 5, 50, 95 % with intervals";
    WORST_RUNS = "worst runs";
    STRIPES = "stripes with intervals";
    fn limit_of(label, limit) = "{label}: {limit}";
    fn interval(confidence) = "{confidence} interval";
    fn band(confidence) = "{confidence} band";
    fn runs_drawn(count) = "{count} runs";
    fn histogram(name, runs) = "{name}: histogram of {runs} runs.";
    fn cumulative(name) = "{name}: cumulative curve of the runs.";
    fn tornado(name) = "{name}: first-order sensitivities by ranks.";
    fn rank_tornado(name) = "{name}: rank correlations with the inputs.";
    fn scatter(result, input) = "{result} against {input}, one dot per run.";
    fn fragility(condition, intensity) = "Probability of {condition} by {intensity}.";
    EXTRAPOLATED = " Beyond the stripes the curve is dashed.";
    fn described(caption, x, y) = "{caption} x: {x}; y: {y}.";
}

/// The answers in the box of the first page.
pub(crate) mod in_the_box {
    phrases! {
        fn name(requirement) = "{requirement}: ";
        MET = "met";
        NOT_MET = "not met";
        UNDECIDED = "undecided";
        fn answer(decision, probability, confidence, interval, limit) = "{decision}. Probability {probability} ({confidence} \
            interval: {interval}), limit {limit}.";
        fn without_probability(decision, limit) = "{decision}. No probability is known; limit {limit}.";
        fn more(count) = "{count} more requirements are in the table below.";
    }
}

/// The name of a fitted curve, by what runs without a result count as.
pub(crate) fn curve_label(no_result_as: &str) -> &'static str {
    match no_result_as {
        "not_exceeded" => CURVE_LOW,
        "exceeded" => CURVE_HIGH,
        _ => CURVE,
    }
}
