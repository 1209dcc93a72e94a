//! Every fixed heading, label and sentence of the report, in English: one module per section, in the order of the report.
//! In: numbers and names as strings. Out: strings. It knows no plan and no record.

use super::Labels;

wording! {
    mod common {
        NO_VALUE = "no value";
        NOT_GIVEN = "not given";
        NRMS_TRACKING_ERROR = "NRMS tracking error";
    }

    mod title_page {
        KIND = "Report of a pseudo-dynamic test";
        END = "— End of report ";
    }

    mod particulars {
        PLAN = "Plan";
        LABORATORY = "Laboratory";
        ADDRESS = "Address";
        PLACE = "Place of the test";
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
        fn received_is_no_day(received) = "a day on which the item was received (“{received}” is none)";
        fn issued_before_test(tested, issued) = "days in their order (tested {tested}, issued {issued})";
    }

    mod verdict {
        REHEARSAL = "A rehearsal decides no requirement: it came to its end.";
        NO_REQUIREMENT = "The plan states no requirement: nothing was decided.";
        THE_REQUIREMENT_IS_MET = "The requirement is met.";
        BLOCKED = "The run could not go on with a value that it found; what follows is what was recorded until then.";
        ZERO_DRIFT = "The zeros of the rig drifted farther than it allows: nothing that its readings enter is \
            decided.";
        ABORTED = "The run was stopped before its end; what follows is what was recorded until then.";
        RIG_FAILED = "The rig failed; what follows is what was recorded until then.";
        fn all_met(total) = "All {total} requirements are met.";
        fn undecided(count, total) = "{count} of {total} requirements cannot be decided from this run.";
        fn not_met(count, total) = "{count} of {total} requirements are not met.";
        fn reason(reason) = " Reason: {reason}.";
    }

    mod status {
        REHEARSAL = "REHEARSAL";
        REHEARSAL_ON_A_SIMULATED_RIG = "REHEARSAL ON A SIMULATED RIG";
        NOT_CERTIFIABLE = "NOT CERTIFIABLE";
        INCOMPLETE = "INCOMPLETE";
        PARTICULARS_MISSING = "PARTICULARS MISSING";
        ON_A_SIMULATED_RIG = "Simulated rig: rehearsal, not a test of a specimen.";
        ONLY_THE_GATE = "Only the gate and the leading stiffness ramps ran on the rig: not the test of the plan.";
        NOT_TO_ITS_END = "The run did not come to its end.";
        fn lacks(missing) = "This report lacks {missing}.";
        fn lacks_particulars(missing) = "ISO/IEC 17025, 7.8.2.1, wants of a report and this one lacks: {missing}.";
        OPERATOR = "the operator's name";
        CERTIFICATE = "the calibration's reference";
        DAY_OF_THE_TEST = "the day of the test";
        PASSING_PROGRAM = "a program that passes its own test";
        CALIBRATION = "calibration";
        fn calibration_of(channel) = "calibration of the {channel}";
        fn calibrated_range(channel) = "the range over which the {channel} is calibrated";
        fn due_date(calibration) = "the day until which the {calibration} holds";
        fn overdue(calibration, due, day) = "a valid {calibration} (it held until {due}, the test ended on {day})";
    }

    mod amendment {
        TITLE = "Amendment";
        SAME_RECORD = "The record of the run is the same, and so is every measured and computed number. The report \
            named above is kept and no longer valid.";
        NOTHING = "nothing";
        NOTHING_ELSE = "nothing else";
        /// `date` is empty, or begins with a space.
        fn amendment(replaced, by, date, reason, changes) = "Amendment to report {replaced} by {by}{date}: {reason}. \
            Changed: {changes}.";
        fn on(date) = " on {date}";
        fn first_issue(date, by, replaced, stated) = "on {date} by {by}, from the report {replaced}; stated after \
            the test: {stated}";
        fn quoted(text) = "“{text}”";
        fn change(field, was, is) = "{field} (was {was}, is {is})";
    }

    mod requirements {
        TITLE = "Requirements";
        NONE = "No requirement: the verdict says only that the run came to its end.";
        COLUMNS = ["Requirement", "Value ± U", "Accepted", "Margin", "Conforms", "Verdict"];
        MARKED = "† U of this value is an estimate: it reads a result that does not follow an input smoothly, or of \
            which the record leaves something open. It need not hold about 95\u{a0}% of the cases.";
        SIMPLE_RULE = "Decision rule: simple acceptance (ILAC-G8:09/2019). The value alone is held against the \
            limit, whatever its uncertainty: for a value at its limit a wrong decision is as likely as a right one, \
            and where U exceeds the tolerance a value may be accepted that probably does not conform.";
        EXPANDED = "U = 2u is the expanded uncertainty (k = 2, about 95\u{a0}%) where a measured result carries one.";
        CONFORMS_AND_MARGIN = "Conforms is the probability that what was measured lies inside the limit, by that \
            uncertainty (JCGM 106). Margin is the distance inside the limit; a negative margin is the distance by \
            which it is missed.";
        fn guarded_rule(equation) = "Decision rule: guarded (after ILAC-G8:09/2019), guard band w = {equation} of \
            the distance between value and limit. A value passes if it keeps the limit by at least w, fails if it \
            misses it by more than w, and is inconclusive between. As far as the budgets go, a wrong pass or fail \
            has a probability below 2.5\u{a0}% at a limit on one side, and below 5\u{a0}% at limits on both. A \
            measured value of which no uncertainty is known is inconclusive; what is exact (counts, the energy \
            balance) is held against the limit as it is.";
        fn expanded_up_to(k) = "U = k·u is the expanded uncertainty where a measured result carries one: it holds \
            about 95\u{a0}% of the cases, with k from Student's t of the effective degrees of freedom (JCGM \
            100:2008, G.4), here up to {k}.";
        fn wider_than_tolerance(conforms) = "U exceeds the tolerance: the probability of conformity is {conforms}";
    }

    mod deviations {
        TITLE = "Deviations and remarks";
        NO_DEVIATION = "No deviation from the plan was recorded.";
        LIMIT_BREACH = "Limit reached";
        HOLD = "Hold";
        AFTER_THE_STOP = "After the stop";
        NOT_HELD = "The rig";
        RIG_FAULT = "Rig fault";
        RECOVERED = "Mended on the lines of the rig";
        INTERRUPTION = "Interruption";
        AMENDMENT = "Amendment";
        LINE = "Line";
        BEYOND = "beyond";
        BELOW = "below";
        fn parameter_set(name, value) = "Parameter {name} was set to {value} for this run.";
        fn rehearsal(text) = "Rehearsal: {text}.";
        fn stopped(reason) = "The run was stopped: {reason}.";
        fn not_released(reason) = "The rig was not released: {reason}.";
        fn blocked(reason) = "The run could not go on: {reason}.";
        fn rig_failed(reason) = "The rig failed: {reason}.";
        fn zero_drift(reason) = "Drift: {reason}; what its readings enter is not decided.";
        fn not_run(procedure) = "Procedure {procedure} was not run.";
        fn not_to_its_end(procedure) = "Procedure {procedure} did not run to its end.";
        fn of_axis(axis) = " of axis {axis}";
        fn outside_calibration(channel, reached, side, low, high) = "The largest {channel}, {reached}, is {side} the \
            range over which it is calibrated, {low} to {high}.";
        fn clock_jump(jump, time) = "The wall clock jumped by {jump} at {time} of rig time: durations are of a clock \
            that does not.";
        fn in_step(procedure, step) = " in {procedure}, step {step}";
        fn in_procedure(procedure) = " in {procedure}";
    }

    mod prediction {
        TITLE = "Prediction of the whole run";
        ANY = "any";
        LIMIT_COLUMNS = ["Limit", "Allowed", "Reached", "Margin"];
        PROCEDURE_COLUMNS = ["Procedure", "Kind", "Displacement", "Force", "Fastest", "Steps", "Rig time"];
        REQUIREMENT_COLUMNS = ["Requirement, as predicted", "Verdict"];
        fn model(model) = "{model}. Nothing below was measured on the specimen.";
        AND_NOT_AGAIN = "and not again";
        fn and_again(between) = "and again {between} later";
        fn zeros(over, again, drift, allowed) = "The zeros of the rig would be read over {over} before the test {again}. A \
            steady drift of up to {drift} a second keeps them within the {allowed} that are allowed.";
        fn range(low, high) = "{low} to {high}";
    }

    mod results {
        TITLE = "Results";
        NO_PROCEDURE = "No procedure was run.";
        NOT_COMPLETE = " · not complete";
        NONE_IN_THIS_RUN_OF = "None in this run: ";
        NONE_IN_THIS_RUN = "none in this run";
        NONE = "none";
        RESULT = "Result";
        VALUE = "Value";
        UNIT = "Unit";
        IN_THE_PLAN = "In the plan";
        NO_U_PARTIAL = "U: none, partial";
        U_IN_BRACKETS = " (u in brackets)";
        fn run_with(kind, inputs) = "Run with{kind}: {inputs}.";
    }

    mod budget {
        BUDGET = "Uncertainty budget";
        PARTIAL_BUDGET = "Partial uncertainty budget";
        COLUMNS = ["Input (u)", "Sensitivity", "Contribution", "Of u²"];
        OWN_SCATTER = "scatter of its own readings";
        MARKED = "† The result does not follow an input smoothly (the differences to either side, or at half the \
            size, disagree), or the record leaves open what the specimen would have done with it: the largest change \
            seen stands for it, and the uncertainty is an estimate.";
        PARTIAL = " A budget without the calibrations of force and displacement is partial: it tells noise, \
            resolution and what else is declared.";
        STUDENT_T = " U = k·u holds about 95\u{a0}% of the cases: k is Student's t of ν effective degrees of \
            freedom, ν = u⁴/Σ uᵢ⁴/νᵢ (Welch and Satterthwaite; JCGM 100:2008, G.4), of a fit its readings less its \
            numbers, of draws their number, of all else infinite.";
        SAMPLED = " Errors of the readings were drawn, and what they do is sampled.";
        REST_LOAD = "load that was left";
        READINGS = "noise and resolution of the readings";
        READINGS_AND_INPUTS = "noise and resolution of the readings, and the inputs of each floor, mode and axis";
        LOOP_POINTS = "points of the loops";
        TIME_STEP = "time step: integrated again in its half and quarter";
        FORCE_CALIBRATION = "force calibration";
        DISPLACEMENT_CALIBRATION = "displacement calibration";
        LOAD_CELL_ZERO = "zero of the load cell";
        fn factor_on(name) = "factor on {name}";
        fn resolution_of(procedure) = "resolution of the readings of {procedure}";
        fn stroke_stiffness_of(procedure) = "stiffness along the strokes of {procedure}";
        fn of_axis(channel, axis) = "{channel} of axis {axis}";
        fn budget_of(kind, result, entry) = "{kind} of {result}{entry}";
        fn small(names) = "under 0.1\u{a0}% each: {names}";
        fn combined(value, unit, k, degrees) = "combined: {value}\u{a0}{unit}, U = {k}\u{a0}u{degrees}";
        fn combined_without_calibrations(value) = "combined, without the calibrations: {value}, u in brackets";
        fn sampled(draws) = " · sampled, {draws} draws";
        fn per(change, unit) = "{change} per {unit}";
        fn not_declared(inputs) = " Not included in the budget (not declared in the plan): {inputs}.";
        fn few_trials(draws, accuracy) = " The run is long, and they were drawn {draws} times only: their share of u \
            is known to {accuracy}.";
        STUDENT_FACTOR = "k by Student's t";
        FACTOR_TWO = "k = 2";
        fn linearised(factor, method) = "Linearised, {factor}: {method}.";
    }

    mod line_fit {
        fn fitted(line, slope, intercept, r_squared) = "Least-squares line {line}: {slope}, {intercept} (in brackets \
            the standard error), R² = {r_squared:.6}.";
    }

    mod actuators {
        I_MODIFICATION = "The force was corrected to where the specimen was to be, r* = r − K(d measured − d \
            commanded), with the initial stiffness (I-modification).";
        fn continuous(time_scale) = "The actuator did not stop at the steps: it moved at {time_scale} times the \
            virtual time, and what a damper of the specimen does at that speed is in the restoring force.";
        fn at_every_target(subject) = "{subject} stood at every target.";
        fn tracking(peak, nrms, energy) = "Tracking: largest error {peak}, NRMS error {nrms}\u{a0}%{energy}.";
        PUT_IN = "put into the test";
        TAKEN_OUT = "taken out of it";
        fn energy(direction, percent) = ", energy {direction} by following wrongly {percent}\u{a0}% of the input";
        THE_ACTUATORS = "The actuators";
        COLUMNS = ["Actuator of floor", "Largest error", "NRMS error",
            "Energy taken out (put in: −), of the input, at its largest", "Tracking indicator at the end"];
    }

    mod figures {
        TITLE = "Figures";
    }

    mod opinions {
        TITLE = "Opinions and interpretations";
        NOT_RESULTS = "Not results of the test: what the issuer makes of them, and on which grounds.";
    }

    mod equipment {
        TITLE = "Equipment and calibration";
        CALIBRATION_COLUMNS = ["Channel", "Range", "Class", "Factor", "Calibration certificate",
            "Calibrated over, by size", "Holds until", "State"];
        NO_DUE_DATE = "no due date";
        OVERDUE = "OVERDUE";
        VALID = "valid";
        DAY_NOT_KNOWN = "day of the test not known";
        RIG = "Rig";
        KIND = "Kind";
        REAL = "real";
        SIMULATED_CONTROLLER = "a simulated controller on a real line: nothing real moved";
        SIMULATED = "simulated: nothing real moved, nothing was measured";
        MODEL = "Model";
        MODEL_AND_FIRMWARE = "Model, firmware";
        SERIAL_NUMBER = "Serial number";
        FIRMWARE = "Firmware";
        OTHER_EQUIPMENT = "Other equipment";
        BOOT = "Power-up of the controller";
        ACTUATOR = "Actuator";
        LOAD_CELL = "Load cell";
        READ_BY_THE_CONTROLLER = "read by the actuator's controller";
        ZERO_COUNT = "Count at no force";
        DECLARED = "Declared of its readings";
        CALIBRATION_UNCERTAINTY = "Standard uncertainty of its calibration";
        CALIBRATION_TERMS = ["force", "displacement", "zero of the force", "its drift, as far as it is allowed"];
        READING = "Taking a reading";
        SETTLING = "Settling";
        WATCHDOG = "Watchdog";
        SAFE_STATE = "Safe state";
        GATE_DEMANDED = "Gate, demanded";
        GATE_FOUND = "Gate, found";
        AXIS = "Axis";
        POLARITY = "Sign";
        POSITIVE = "positive";
        NEGATIVE = "negative";
        TCP = "TCP";
        SIMULATED_ERRORS = "Simulated errors";
        ERROR_TERMS = ["load-cell noise", "displacement quantum", "force quantum", "actuator lag",
            "increment not reached", "load-cell drift"];
        NO_ERRORS = "none: an ideal rig";
        fn on_day(day) = " on {day}";
        fn per_count(factor) = "{factor} a count";
        fn watchdog(time) = "the rig holds by itself after {time} without a sign of life";
        fn serial_port(baud) = "serial, {baud} baud";
        fn dialect(port) = "{port}, dialect ";
        fn only_serial_number(serial) = ", only serial number {serial}";
        fn displacement_to(resolution) = "displacement to {resolution}";
        fn force_noise(noise) = "noise of one force reading {noise}";
        fn cell_from(range) = "cell from {range}";
        fn gate(zero, stiffness, probe) = "at most {zero} at rest; {stiffness} in a move of {probe}";
        fn of_axis(axis) = ", of axis {axis}";
        fn of_axes(axes) = ", of axes {axes}";
        ONE_READING = "one settled reading";
        fn median_of(samples) = "median of {samples} settled readings";
        fn reading(taken, rate, frozen_after) = "{taken}, read at {rate}; frozen after {frozen_after} equal forces in \
            motion";
    }

    mod zero_drift {
        TITLE = "Zeros before and after the test";
        NOT_READ_AGAIN = "The zeros of this rig were not read again after the test: that they did not drift is not \
            shown by this record.";
        COLUMNS = ["Channel", "Before", "After", "Change", "Allowed", "Slope before", "In holds", "State"];
        NOT_JUDGED = "not judged";
        WITHIN = "within";
        BEYOND = "BEYOND";
        AFTER_AT_START = "after it back where it began, with the specimen on";
        AFTER_FREE = "after it where the rig stood, when a person had taken the specimen off the load cell";
        NOT_AFTER = "not again after it";
        fn force(of_axis) = "force{of_axis}";
        fn displacement(of_axis) = "displacement{of_axis}";
        fn growth(grown, allowed) = " In those farther out than the specimen had been, where a force can only relax, \
            it grew by at most {grown} ({allowed} is allowed).";
        fn method(over, after, holds, growth) = "A zero is the mean of readings over {over}, before the first move \
            and {after}; that of the displacement is reading less target. {holds}{growth} A drift beyond what is \
            allowed leaves undecided what its readings enter.";
        fn no_hold(over) = "No hold was as long as {over}.";
        fn one_hold(over) = "One hold was as long as {over}; its slope has drift and relaxation in it.";
        fn several_holds(count, over) = "{count} holds were as long as {over}; their fastest slopes have drift and \
            relaxation in them.";
    }

    mod conditions {
        TITLE = "Conditions of the test";
        PSEUDO_DYNAMIC = "A pseudo-dynamic test loads the specimen slowly: effects of strain rate, and of the \
            inertia of the specimen beyond the equivalent mass, are not in the measured force.";
        NOT_MEASURED = " · as the plan states, not measured in this run";
        FROM_A_FILE = " · from a file of the plan";
        LIMITS = "Limits";
        NO_LIMIT = "Nothing was limited.";
        PARAMETERS = "Parameters";
        SET_FOR_THIS_RUN = " (set for this run)";
        AS_THE_PLAN_STATES = " (as the plan states)";
        FROM = " from ";
        EQUIVALENT_MASS = "equivalent mass";
        DAMPING = "damping on the load cell";
        FRICTION = "friction on the load cell";
        MASS = "mass";
        VELOCITY = "velocity at the start";
        ENERGY = "energy";
        GAP = "gap at the start";
        ACCELERATION = "acceleration along its way";
        NO_SETTLING = "a reading counts at once";
        fn specimen(name) = "Specimen {name}";
        fn ground(name) = "Ground {name}";
        fn striker(name) = "Striker {name}";
        fn time_scale_of(procedure) = "Time scale of {procedure}";
        fn u_in_brackets(value) = "{value}, u in brackets";
        fn settling(band, force_rate, dwell, timeout) = "within {band} of the target and under {force_rate} for \
            {dwell}, at most {timeout}";
        fn comma_axis(axis) = ", axis {axis}";
        fn range(low, high) = "{low} to {high}";
        fn slower(ratio) = ", {ratio:.0} times as long";
        fn time_scale(virtual_time, rig_time, slower) = "{virtual_time} of virtual time took {rig_time} on the rig{slower}";
        TEMPERATURE = "Temperature";
        HUMIDITY = "Humidity";
        SAMPLING = "Sampling";
        EXTERNAL = "Results from others";
        NOTES = "Remarks";
    }

    mod statements {
        TITLE = "Statements";
        fn signature(name) = "{name}: name, date and signature";
        VIRTUAL_SPECIMEN = ", here a virtual specimen on a simulated rig";
        fn use_of_the_report(items) = "These results relate only to the items tested{items}. This report is not to be \
            reproduced except in full without the approval of the issuer. Data marked as the plan's were supplied with it \
            and not measured; the issuer answers for what was measured. The report is structured after ISO/IEC 17025:2017, \
            clause 7.8; that is a statement about its form and no claim of accreditation.";
    }

    mod plan {
        TITLE = "Plan as run";
        IN_THE_FOLDER = " in the folder of the run.";
        fn more_lines(count) = "and {count} more lines; the whole file is ";
    }

    mod provenance {
        TITLE = "Provenance";
        FILES = "Files";
        MANIFEST_REAL = "The file manifest.sha256 beside this report holds the SHA-256 of every file of the run. The \
            record journal.psdj holds every target, reading and answer; ";
        VERIFIES = " does the run again from it and asks for the same targets, bit for bit.";
        MANIFEST_SIMULATED = "The file manifest.sha256 beside this report holds the SHA-256 of every file of the \
            run. On a simulated rig the same plan, seed, settings and version give the same bytes.";
        NO_SETTINGS = "none";
        SIMULATED = " (simulated)";
        NOT_RECORDED = "not recorded";
        REPORT = "Report";
        ISSUED = "Issued";
        RUN = "Run";
        PROGRAM = "Program";
        SOURCES = "Its sources, SHA-256";
        BUILT_FOR = "Built for";
        PLAN_DIGEST = "SHA-256 of the plan";
        SETTINGS = "Settings on the command line";
        RIG = "Rig";
        FIRMWARE = "Firmware of the rig";
        SEED = "Seed";
        CLOCKS = "Clocks";
        SIMULATED_CLOCKS = "none: virtual time, and the time a rig would have taken";
        REAL_CLOCKS = "UTC of the machine's clock, as it was set; time on the rig from a clock that only goes \
            forward, begun with the run";
        FILE_COLUMNS = ["File in the folder of the run", "SHA-256"];
        OPERATOR = "Operator";
        MACHINE = "Machine";
        BEGAN = "Began, UTC";
        LAST_RECORDED = "Last recorded, UTC";
        RECORDS = "Records";
        HEAD = "Head of the record";
    }

    mod validation {
        TITLE = "Validation of the program";
        COLUMNS = ["Self-test", "Computed", "Reference", "Verdict"];
        PASS = "pass";
        FAIL = "fail";
        TOGETHER_WITH = " with ";
        BY_THE_PROGRAM = "The program that set this report passes or fails these cases by the code that reckoned the \
            run. The references are those of Melo et al. 2006, closed forms, and solutions made apart from the \
            program. ";
        WHOLE_PLANS = " holds whole plans against their blessed results.";
        COVERS_NOTHING = "The self-test covers no part of this run: nothing was integrated or fitted.";
        fn by_the_laboratory(text) = "Validation by the laboratory: {text}";
        fn covers(parts) = "The self-test covers of this run: {parts}.";
        fn does_not_cover(parts) = "It does not cover: {parts}.";
        fn all_pass(cases) = "All of its {cases} cases pass, also those of other parts.";
        fn some_fail(cases, failed) = "Of its {cases} cases {failed} fail.";
    }
}

/// The text that the layout of a page adds.
pub(crate) const LABELS: Labels = Labels {
    report: "Report",
    amendment_to: "Amendment to report",
    tested: "Tested",
    date_not_given: "date of the test not given",
    not_given: "Not given:",
    figure: "Figure",
    page: "Page",
    page_of: "of",
    attachment: "The plan as it was run",
};
