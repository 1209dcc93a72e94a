//! Every fixed heading, label and sentence of the report, in English: one module per section, in the order of the report.
//! In: numbers and names as strings. Out: strings. It knows no plan and no record.

use super::Labels;

wording! {
    mod common {
        NO_VALUE = "no value";
        NOT_GIVEN = "not given";
        NRMS_TRACKING_ERROR = "NRMS tracking error";
        MARKED = "† Estimate: the response to one input is strongly non-linear, or the measured path does not \
            determine it. U is then the largest change found, and its coverage may differ from 95\u{a0}%.";
    }

    mod terminal {
        MARKED = "† estimate: strongly non-linear, or not determined by the measured path; U is the largest change found";
    }

    mod title_page {
        KIND = "Test report: pseudo-dynamic test";
        KIND_SIMULATION = "Simulation of a pseudo-dynamic test";
        END = "— End of report ";
        NO_DATE = "date of the test not given";
        fn tested(date) = "Tested {date}";
        fn simulated(date) = "Simulated {date}";
    }

    mod particulars {
        PLAN = "Plan";
        SUBSTRUCTURES = "Substructures";
        NUMBERS = "Numbers";
        LABORATORY = "Laboratory";
        ADDRESS = "Address";
        PLACE = "Location of the test";
        OPERATOR = "Operator";
        AUTHORISED_BY = "Authorised by";
        CUSTOMER = "Customer";
        CONTACT = "Contact";
        PROJECT = "Project";
        ITEM = "Item tested";
        MATERIAL = "Material";
        CONDITION = "Condition";
        RECEIVED = "Item received";
        DATE = "Date of the test";
        ISSUED = "Date of issue";
        METHOD = "Method";
        fn revision(revision) = ", revision {revision}";
        fn first_to_last(first, last) = "{first} to {last}";
        fn received_after_test(received, tested) = "days in their order (received {received}, tested {tested})";
        fn received_is_no_day(received) = "a valid day of receipt (found “{received}”)";
        fn issued_before_test(tested, issued) = "days in their order (tested {tested}, issued {issued})";
    }

    mod verdict {
        NO_REQUIREMENT = "The plan states no requirement; no statement of conformity is made.";
        THE_REQUIREMENT_IS_MET = "The requirement is met.";
        BLOCKED = "The run could not continue with a value that it found. The report covers the run until then.";
        ZERO_DRIFT = "The zero drift of the rig exceeds its limit. No statement is made on results that depend on it.";
        ABORTED = "The run was stopped before its end. The report covers the run until then.";
        RIG_FAILED = "The rig failed. The report covers the run until then.";
        SIMULATED_RIG = "Nothing moved and no physical specimen was tested. The results describe a model.";
        EMULATED_RIG = "The controller on the line is an emulator. Nothing moved and no physical specimen was tested.";
        CHECK_RUN = "Only the pre-test check and the leading stiffness ramps ran on the rig. This is not the test of \
            the plan, and no requirement is assessed.";
        COMPLETED = "completed";
        REQUIREMENT_MET = "requirement met";
        REQUIREMENT_NOT_MET = "requirement not met";
        THE_REQUIREMENT_IS_NOT_MET = "The requirement is not met.";
        INCONCLUSIVE = "inconclusive";
        STOPPED = "stopped before its end";
        FAULT = "stopped by a fault of the rig";
        fn simulation(outcome) = "SIMULATION: {outcome}";
        fn check_run(outcome) = "CHECK RUN: {outcome}";
        fn not_issuable(outcome) = "NOT ISSUABLE: {outcome}";
        fn requirements_met(total) = "all {total} requirements met";
        fn requirements_not_met(count, total) = "{count} of {total} requirements not met";
        fn requirements_inconclusive(count, total) = "{count} of {total} requirements inconclusive";
        fn all_met(total) = "All {total} requirements are met.";
        fn undecided(count, total) = "{count} of {total} requirements are inconclusive.";
        fn not_met(count, total) = "{count} of {total} requirements are not met.";
        fn reason(reason) = " Reason: {reason}.";
        fn outside_limit(value, limit) = "{value}, limit {limit}";
        fn failed(names) = "Not met: {names}.";
        fn inconclusive(names) = "Inconclusive: {names}.";
        fn more(count) = "; and {count} more";
    }

    mod headline {
        TITLE = "Results";
        NO_PROCEDURE = "No procedure was run.";
        NO_RESULT = "The run has no result.";
        RESULT = "Result";
        PROCEDURE = "Procedure";
        VALUE = "Value ± U";
        VALUE_WITH_U = "Value (u)";
        FACTOR = "k";
        EXPANDED = "± is the expanded uncertainty U = k·u, about 95\u{a0}% coverage, k = 2 unless stated. A value \
            without ± has no uncertainty evaluation.";
        STANDARD = "The standard uncertainty u in parentheses is partial, without the calibrations of force and \
            displacement. No expanded uncertainty is stated.";
        fn entry(kind, number) = ", {kind} {number}";
    }

    mod annexes {
        RESULTS = "Results in full";
        BUDGETS = "Uncertainty budgets";
        FIGURES = "Figures";
        EQUIPMENT = "Equipment, calibration and conditions";
        PROVENANCE = "Provenance";
        PLAN = "Plan as run";
        fn title(letter, name) = "Annex {letter}. {name}";
    }

    mod deviations {
        TITLE = "Deviations";
        OBSERVATIONS = "Observations";
        NOTES = "Notes of the run";
        STATED_NONE = "none";
        NO_DEVIATION = "None recorded.";
        LIMIT_BREACH = "Limit reached";
        HOLD = "Hold";
        UNLOADED = "After the stop the rig moved back towards its start position.";
        AFTER_THE_STOP = "After the stop";
        NOT_HELD = "The rig";
        RIG_FAULT = "Rig fault";
        RECOVERED = "Communication recovered";
        INTERRUPTION = "Interruption";
        AMENDMENT = "Amendment";
        LINE = "Line";
        BEYOND = "above";
        BELOW = "below";
        fn parameter_set(name, value) = "Parameter {name} was set to {value} for this run.";
        fn check_run(text) = "Check run: {text}.";
        fn not_distinct(procedure, result, value) = "In {procedure}: {result} {value} is not distinguishable from zero.";
        /// `reason` is empty, or begins with a colon.
        fn stopped(reason) = "The run was stopped{reason}.";
        fn not_released(reason) = "The rig was not released{reason}.";
        fn blocked(reason) = "The run could not continue{reason}.";
        fn rig_failed(reason) = "The rig failed{reason}.";
        fn zero_drift(reason) = "Zero drift: {reason}; no statement is made on results that depend on it.";
        fn not_run(procedure) = "Procedure {procedure} was not run.";
        fn not_to_its_end(procedure) = "Procedure {procedure} did not run to its end.";
        fn of_axis(axis) = " of axis {axis}";
        fn outside_calibration(channel, reached, side, low, high) = "The largest {channel}, {reached}, is {side} its \
            calibrated range, {low} to {high}.";
        fn clock_jump(jump, time) = "The wall clock jumped by {jump} at {time} of rig time. Durations are from a \
            monotonic clock.";
        fn in_step(procedure, step) = " in {procedure}, step {step}";
        fn in_procedure(procedure) = " in {procedure}";
    }

    mod prediction {
        TITLE = "Prediction of the whole run";
        ANY = "any";
        LIMIT_COLUMNS = ["Limit", "Allowed", "Reached", "Margin"];
        PROCEDURE_COLUMNS = ["Procedure", "Kind", "Displacement", "Force", "Fastest", "Steps", "Rig time"];
        REQUIREMENT_COLUMNS = ["Requirement, as predicted", "Verdict"];
        OF_THE_RIG = "Displacement, force and speed are numbers of the rig. Requirements are those of the prototype.";
        fn model(model) = "{model}. The following values were not measured.";
        AND_NOT_AGAIN = "and not again";
        fn and_again(between) = "and again {between} later";
        fn zeros(over, again, drift, allowed) = "The zeros of the rig would be read over {over} before the test {again}. \
            A steady zero drift of up to {drift} per second keeps within the limit of {allowed}.";
        fn range(low, high) = "{low} to {high}";
    }

    mod results {
        NOT_COMPLETE = " · not complete";
        NONE = "none";
        RESULT = "Result";
        VALUE = "Value";
        STANDARD = "u (partial)";
        EXPANDED = "± U = k·u";
        EXPANDED_BY_TWO = "± U (k = 2)";
        FACTOR = "k (ν)";
        UNIT = "Unit";
        U_IN_BRACKETS = " (u in parentheses)";
        fn run_with(kind, inputs) = "Inputs{kind}: {inputs}.";
        fn next_impact_while(condition) = "next impact while {condition}";
    }

    mod budget {
        BUDGET = "Uncertainty budget";
        PARTIAL_BUDGET = "Partial uncertainty budget";
        COLUMNS = ["Input (u)", "Sensitivity", "Contribution", "Of u²"];
        OWN_SCATTER = "scatter of the readings of its fit";
        METHOD = "Method";
        PARTIAL = "The budget is partial: the calibrations of force and displacement are not declared.";
        STUDENT_T = "k is Student's t for ν effective degrees of freedom (Welch–Satterthwaite; JCGM 100, G.4). ν of a \
            fit: number of observations − number of fitted parameters; of Monte Carlo trials: their number; \
            otherwise infinite.";
        SAMPLED = "Reading errors: Monte Carlo (JCGM 101).";
        REST_LOAD = "remaining load";
        READINGS = "noise and resolution of the readings";
        READINGS_AND_INPUTS = "noise and resolution of the readings, and the inputs of each floor, mode and axis";
        LOOP_POINTS = "points of the loops";
        WHOLE_STEPS = "duration in whole time steps";
        TIME_STEP = "time step";
        fn finer_steps(ends, half, quarter) = "time step, not in U: {ends} in finer steps ({half} at Δt/2, {quarter} at Δt/4)";
        FORCE_CALIBRATION = "force calibration";
        DISPLACEMENT_CALIBRATION = "displacement calibration";
        fn below(calibration, end) = "{calibration} below {end}";
        LOAD_CELL_ZERO = "zero offset of the load cell";
        fn factor_on(name) = "factor on {name}";
        fn resolution_of(procedure) = "resolution of the readings of {procedure}";
        fn stroke_stiffness_of(procedure) = "stiffness along the strokes of {procedure}";
        fn of_axis(channel, axis) = "{channel} of axis {axis}";
        fn budget_of(kind, result, entry) = "{kind} of {result}{entry}";
        fn small(names) = "below 0.1\u{a0}% each: {names}";
        fn combined(value, unit, k, degrees) = "combined: {value}\u{a0}{unit}, U = {k}\u{a0}u{degrees}";
        fn combined_without_calibrations(value) = "combined, without the calibrations: {value}, u in parentheses";
        fn sampled(draws) = " · Monte Carlo, {draws} trials";
        fn per(change, unit) = "{change} per {unit}";
        fn not_declared(inputs) = "Not included in the budget (not declared in the plan): {inputs}.";
        fn few_trials(draws, accuracy) = "With {draws} trials their fraction of u is known to {accuracy}.";
        LINEARISED = "First-order propagation (JCGM 100, 5.1.2).";
        fn only_of(procedures, text) = "{procedures}: {text}";
    }

    mod line_fit {
        /// `errors` is empty, or begins with a space.
        fn fitted(line, slope, intercept, errors, r_squared) = "Least-squares line {line}: {slope}, {intercept}{errors}, R² = \
            {r_squared:.6}.";
        STANDARD_ERRORS = " (standard error in parentheses)";
    }

    mod actuators {
        I_MODIFICATION = "The force was corrected to the commanded displacement, r* = r − K(d measured − d commanded), \
            with the initial stiffness (I-modification).";
        fn continuous(time_scale) = "Continuous motion at {time_scale} times the simulated time: the measured force \
            contains the damping of the specimen at that speed.";
        fn at_every_target(subject) = "{subject} reached every target.";
        fn tracking(peak, nrms, energy) = "Tracking errors: at most {peak}, NRMS {nrms}{energy}.";
        PUT_IN = "added";
        REMOVED = "removed";
        fn energy(direction, percent) = "; they {direction} at most {percent} of the input energy";
        THE_ACTUATORS = "The actuators";
        COLUMNS = ["Actuator of floor", "Largest error", "NRMS error",
            "Largest tracking-error energy / input (− added)", "Tracking indicator at the end"];
        OF_ELEMENT = "Actuator of element";
        LARGEST_IN_PROTOTYPE = "Largest error, in the prototype";
    }

    mod photos {
        TITLE = "Photographs";
        LOGO = "Logo";
        fn caption(number, file) = "Photograph {number}: {file}";
        fn logo_of(laboratory) = "Logo of {laboratory}";
    }

    mod figures {
        ONE_MORE = "One more figure of this run is in the folder figures.";
        fn more(count) = "{count} more figures of this run are in the folder figures.";
        fn more_limits(label, count) = "{label} (and {count} more limits)";
        fn axes(y, x) = "{y} against {x}.";
        fn curve(name, low, high) = " {name}: {low} to {high}.";
    }

    mod opinions {
        TITLE = "Opinions and interpretations";
        NOT_RESULTS = "Not results of the test: opinions of the issuer, with their basis (ISO/IEC 17025:2017, 7.8.7).";
    }

    mod equipment {
        TITLE = "Rig and calibration";
        CALIBRATION_COLUMNS = ["Channel", "Range", "Class", "Factor", "Calibration certificate",
            "Calibrated range, absolute", "Valid until", "State"];
        NO_DUE_DATE = "no due date";
        OVERDUE = "OVERDUE";
        VALID = "valid";
        DAY_NOT_KNOWN = "day of the test not known";
        RIG = "Rig";
        KIND = "Kind";
        REAL = "real";
        SIMULATED_CONTROLLER = "emulator on a real port; no physical specimen was tested";
        SIMULATED = "simulation; no physical specimen was tested";
        MODEL = "Model";
        MODEL_AND_FIRMWARE = "Model, firmware";
        SERIAL_NUMBER = "Serial number";
        FIRMWARE = "Firmware";
        OTHER_EQUIPMENT = "Other equipment";
        BOOT = "Boot identifier of the controller";
        ACTUATOR = "Actuator";
        LOAD_CELL = "Load cell";
        READ_BY_THE_CONTROLLER = "read by the actuator's controller";
        ZERO_OFFSET = "Zero offset, in counts";
        DECLARED = "Declared resolution and noise";
        CALIBRATION_UNCERTAINTY = "Standard uncertainty of its calibration";
        CALIBRATION_TERMS = ["force", "displacement", "zero offset of the force", "its allowed zero drift"];
        READING = "Reading";
        SETTLING = "Settling";
        AXIAL_AXIS = "Axial axis";
        WATCHDOG = "Watchdog";
        SAFE_STATE = "Safe state";
        PRETEST_CHECK_LIMITS = "Pre-test check: limits";
        PRETEST_CHECK_RESULT = "Pre-test check: results";
        AXIS = "Axis";
        POLARITY = "Polarity";
        POSITIVE = "positive";
        NEGATIVE = "negative";
        TCP = "TCP";
        SIMULATED_ERRORS = "Simulated errors";
        ERROR_TERMS = ["load-cell noise", "displacement resolution", "force resolution", "actuator lag",
            "undershoot", "load-cell drift"];
        NO_ERRORS = "none: an ideal rig";
        fn on_day(day) = " on {day}";
        fn per_count(factor) = "{factor} per count";
        fn watchdog(time) = "holds after {time} without communication";
        fn serial_port(baud) = "serial, {baud} baud";
        fn dialect(port) = "{port}, protocol ";
        fn only_serial_number(serial) = ", only serial number {serial}";
        fn displacement_to(resolution) = "displacement to {resolution}";
        fn force_noise(noise) = "noise of one force reading {noise}";
        fn cell_from(range) = "cell from {range}";
        fn pretest_check(zero, stiffness, probe) = "at most {zero} at rest; {stiffness} in a move of {probe}";
        fn of_axis(axis) = ", of axis {axis}";
        fn of_axes(axes) = ", of axes {axes}";
        ONE_READING = "one settled reading";
        fn median_of(samples) = "median of {samples} settled readings";
        fn reading(reading_text, rate, frozen_after) = "{reading_text} at {rate}; frozen sensor after {frozen_after} equal forces in motion";
    }

    mod zero_drift {
        TITLE = "Zero drift";
        NOT_READ_AGAIN = "The zeros of this rig were not read after the test. Zero drift is not evaluated.";
        COLUMNS = ["Channel", "Before", "After", "Change", "Allowed", "Slope before", "In dwells", "State"];
        NOT_JUDGED = "not assessed";
        WITHIN = "within";
        BEYOND = "BEYOND";
        AFTER_AT_START = "after the last, back at the start with the specimen on";
        AFTER_FREE = "after the last, without motion, with the specimen removed from the load cell";
        NOT_AFTER = "not after the last";
        fn force(of_axis) = "force{of_axis}";
        fn displacement(of_axis) = "displacement{of_axis}";
        fn growth(grown, allowed) = " In dwells beyond all earlier displacements, where a force can only relax, it grew \
            by at most {grown} (limit {allowed}).";
        fn method(over, after, holds, growth) = "A zero is the mean of readings over {over}, before the first move \
            and {after}; that of the displacement is reading minus target. {holds}{growth} If a zero drift exceeds \
            its limit, no statement is made on results that depend on it.";
        fn no_hold(over) = "No dwell was as long as {over}.";
        fn one_hold(over) = "One dwell was as long as {over}; its slope contains zero drift and relaxation.";
        fn several_holds(count, over) = "{count} dwells were as long as {over}; their fastest slopes contain zero \
            drift and relaxation.";
    }

    mod conditions {
        TITLE = "Conditions";
        STRUCTURE = "The structure: tested storeys (solid), computed storeys (dashed), floors with their masses, axes of the rig.";
        STRUCTURE_OF_ELEMENTS = "The structure: tested elements (solid), computed elements and stiffness matrix K (dashed), degrees of freedom with their masses, axes of the rig.";
        NOT_MEASURED = " · stated, not measured";
        FROM_A_FILE = " · from a file of the plan";
        LIMITS = "Limits";
        LIMITS_OF_THE_RIG = "Limits, in numbers of the rig";
        NO_LIMIT = "No limit applied.";
        PARAMETERS = "Parameters";
        SET_FOR_THIS_RUN = " (set for this run)";
        AS_THE_PLAN_STATES = " (stated)";
        FROM = " from ";
        EQUIVALENT_MASS = "equivalent mass";
        DAMPING = "damping on the load cell";
        FRICTION = "friction on the load cell";
        MASS = "mass";
        VELOCITY = "velocity at the start";
        ENERGY = "energy";
        GAP = "gap at the start";
        ACCELERATION = "acceleration along its path";
        NO_SETTLING = "none";
        fn specimen(name) = "Specimen {name}";
        fn ground(name) = "Ground {name}";
        fn striker(name) = "Striker {name}";
        fn time_scale_of(procedure) = "Time scale of {procedure}";
        fn u_in_brackets(value) = "{value}, u in parentheses";
        fn settling(band, force_rate, dwell, timeout) = "within {band} of the target and under {force_rate} for \
            {dwell}, at most {timeout}";
        fn comma_axis(axis) = ", axis {axis}";
        fn range(low, high) = "{low} to {high}";
        fn slower(ratio) = " ({ratio:.0} times slower)";
        fn time_scale(virtual_time, rig_time, slower) = "{virtual_time} of simulated time in {rig_time} on the rig{slower}";
        PROGRAM = "Program";
        fn program(version, self_test) = "psd {version}. {self_test}";
        TEMPERATURE = "Temperature";
        HUMIDITY = "Humidity";
        SAMPLING = "Sampling";
        EXTERNAL = "Results of external providers";
        NOTES = "Remarks";
    }

    mod statements {
        TITLE = "Statements";
        fn signature(name) = "{name}: name, date and signature";
        SIMULATION = "This is the report of a simulation, not a test report. It states the behaviour of a model, not that of a \
            specimen.";
        ITEMS = "The results relate only to the items tested.";
        AS_RECEIVED = "They apply to the items as received.";
        STATED_VALUES = "Values marked “stated” are from the plan or the customer and were not measured; they can affect \
            the validity of the results. The laboratory is responsible for all other information (ISO/IEC \
            17025:2017, 7.8.2.2).";
        PSEUDO_DYNAMIC = "A pseudo-dynamic test loads the specimen slowly: the measured force contains no effect of \
            strain rate, and no inertia beyond the equivalent mass.";
        REPRODUCTION = "The report must not be reproduced except in full without approval of the laboratory.";
        FORM = "It is structured after ISO/IEC 17025:2017, clause 7.8; this is not a claim of accreditation.";
    }

    mod plan {
        IN_THE_FOLDER = " in the folder of the run.";
        OF_THE_DOCUMENT = "These are the blocks of the plan, with the line numbers of the document. The whole document is ";
        fn more_lines(count) = "and {count} more lines; the whole file is ";
    }

    mod provenance {
        FILES = "Files";
        MANIFEST_REAL = "The file manifest.sha256 beside this report holds the SHA-256 of every file of the run. The \
            run log journal.psdj holds every target, reading and reply; ";
        VERIFIES = " replays the run from it and requires the same targets, bit for bit.";
        MANIFEST_SIMULATED = "manifest.sha256 has the SHA-256 of every file. The same plan, seed, settings and \
            program give identical results; only the date of the run and its run log differ.";
        NOT_RECORDED = "not recorded";
        REPORT = "Report";
        REPORT_AND_RUN = "Report and run";
        ISSUED = "Issued";
        RUN = "Run";
        PROGRAM = "Program";
        SOURCES = "SHA-256 of its sources";
        BUILT_FOR = "Built for";
        SETTINGS = "Settings on the command line";
        SEED = "Seed";
        CLOCKS = "Clocks";
        REAL_CLOCKS = "dates: UTC of the machine's clock; rig time: a monotonic clock from the start of the run";
        FILE_COLUMNS = ["File in the folder of the run", "SHA-256"];
        OPERATOR = "Operator";
        MACHINE = "Machine";
        BEGAN = "Began, UTC";
        LAST_RECORDED = "Last recorded, UTC";
        RECORDS = "Entries of the run log";
        HEAD = "Hash of its last entry";
    }

    mod validation {
        TITLE = "Validation of the program";
        COLUMNS = ["Failed self-test case", "Computed", "Reference", "Verdict"];
        FAIL = "fail";
        TOGETHER_WITH = " with ";
        BY_THE_PROGRAM = "References of the self-test: Melo et al. 2006, closed forms, independent solutions. ";
        WHOLE_PLANS = " compares whole plans.";
        COVERS_NOTHING = "The self-test covers no part of this run: nothing was integrated or fitted.";
        fn by_the_laboratory(text) = "Validation by the laboratory: {text}";
        fn covers(parts) = "Covered in this run: {parts}.";
        fn does_not_cover(parts) = "Not covered: {parts}.";
        fn all_pass(cases) = "Self-test: {cases} of {cases} cases pass.";
        fn some_fail(cases, failed) = "Self-test: {failed} of {cases} cases FAIL.";
    }
}

/// The text that the layout of a page adds.
pub(crate) const LABELS: Labels = Labels {
    report: "Report",
    amendment_to: "Amendment to report",
    not_given: "Not given:",
    figure: "Figure",
    page: "Page",
    page_of: "of",
    attachment: "The plan as it was run",
};
