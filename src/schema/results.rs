//! What each procedure leaves, in the order of the tables and of `summary.json`.

use super::curves;
use super::types::ResultKind;
use crate::quantity::Dimension;

pub(super) const STIFFNESS_RAMP: &[ResultKind] = &[
    ResultKind::measured(
        "stiffness",
        Dimension::STIFFNESS,
        "slope of the straight line fitted to force on displacement; of a bilinear or multilinear fit that of the first stretch",
    ),
    ResultKind::measured("secant_stiffness", Dimension::STIFFNESS, "force over displacement of the first increment"),
    ResultKind::measured("intercept_force", Dimension::FORCE, "force of the fitted line at no displacement"),
    ResultKind::new("r_squared", Dimension::NUMBER, "coefficient of determination of the fit"),
    ResultKind::measured(
        "max_force",
        Dimension::FORCE,
        "largest size of the restoring force, less what noise adds to the largest of many readings",
    ),
    ResultKind::measured("max_displacement", Dimension::LENGTH, "largest size of the measured displacement"),
    ResultKind::measured("loop_energy", Dimension::ENERGY, "energy of the hysteresis loop, with `return = true`"),
    ResultKind::measured("relaxation", Dimension::FORCE, "mean loss of force during a pause"),
    ResultKind::measured(
        "tangent_stiffness",
        Dimension::STIFFNESS,
        "secant of the last outward step: the tangent where the ramp ended",
    ),
    ResultKind::measured(
        "yield_force",
        Dimension::FORCE,
        "force at the knee of a bilinear fit, or where a multilinear one first softens",
    ),
    ResultKind::measured("yield_displacement", Dimension::LENGTH, "displacement there"),
    ResultKind::measured("hardened_stiffness", Dimension::STIFFNESS, "slope past the knee, or of the last stretch"),
    ResultKind::measured("hardening", Dimension::NUMBER, "that slope over the first one"),
    curves::RESULTS[0],
    curves::RESULTS[1],
    curves::RESULTS[2],
    curves::RESULTS[3],
    curves::RESULTS[4],
    curves::RESULTS[5],
    ResultKind::measured("time_constant", Dimension::TIME, "τ of the relaxation, with `relaxation`"),
    ResultKind::measured("relaxed_stiffness", Dimension::STIFFNESS, "slope of the forces when all has relaxed"),
    ResultKind::measured("branch_stiffness", Dimension::STIFFNESS, "what relaxes of a standard linear solid"),
    ResultKind::measured("remaining_relaxation", Dimension::FORCE, "largest force that a pause left to relax"),
    ResultKind::measured(
        "needed_pause",
        Dimension::TIME,
        "pause that leaves no more to relax than the accuracy asked for, or ends at the rate asked for",
    ),
    ResultKind::measured(
        "relaxation_share",
        Dimension::NUMBER,
        "a or g: what the law takes of a reached force, with a law of it",
    ),
    ResultKind::measured("reference_time", Dimension::TIME, "t₀ of the logarithm of time"),
    ResultKind::measured("relaxation_rate", Dimension::FORCE_RATE, "how fast the worst pause was losing force at its end"),
    ResultKind::new(
        "bic_margin",
        Dimension::NUMBER,
        "BIC of the exponential less that of the logarithm, with `either`: above zero it is the logarithm",
    ),
];

pub(super) const DAMPING_SWEEP: &[ResultKind] = &[
    ResultKind::measured("damping", Dimension::DAMPING, "slope of damping force on velocity"),
    ResultKind::measured("coulomb_force", Dimension::FORCE, "friction: damping force of the fit at no velocity"),
    ResultKind::new("r_squared", Dimension::NUMBER, "coefficient of determination of the fit"),
    ResultKind::measured("damping_ratio", Dimension::NUMBER, "damping over critical damping, c / (2 sqrt(K M))"),
    ResultKind::new("max_velocity", Dimension::VELOCITY, "largest velocity of the sweep"),
];

pub(super) const IMPACT: &[ResultKind] = &[
    ResultKind::measured("max_displacement", Dimension::LENGTH, "largest displacement of the structure over the run"),
    ResultKind::measured("time_of_max_displacement", Dimension::TIME, "virtual time of the largest displacement"),
    ResultKind::measured("stop_time", Dimension::TIME, "virtual time at which the striker first stood still"),
    ResultKind::measured(
        "final_displacement",
        Dimension::LENGTH,
        "displacement at the last step of the run, under whatever load it then carries",
    ),
    ResultKind::measured("max_velocity", Dimension::VELOCITY, "largest size of the structure's velocity"),
    ResultKind::measured(
        "max_contact_force",
        Dimension::FORCE,
        "largest mean contact force of a step; grows as 1/Δt under `rigid`, `restitution` and a `limit` that is not reached",
    ),
    ResultKind::measured("impulse", Dimension::IMPULSE, "contact force integrated over the run"),
    ResultKind::count("contacts", "number of blows: contacts that began, also those inside a step"),
    ResultKind::measured("restitution", Dimension::NUMBER, "separation over closing speed of the first blow"),
    ResultKind::measured("indentation", Dimension::LENGTH, "permanent indentation of the contact surface"),
    ResultKind::measured("indentation_energy", Dimension::ENERGY, "limit force times indentation"),
    ResultKind::measured("absorbed_energy", Dimension::ENERGY, "restoring force integrated up to the largest displacement"),
    ResultKind::measured(
        "restoring_energy",
        Dimension::ENERGY,
        "restoring force integrated over the run, with what a damper adds to it in continuous mode",
    ),
    ResultKind::measured("damping_energy", Dimension::ENERGY, "energy that the computed `damping` took over the run"),
    ResultKind::measured("striker_energy", Dimension::ENERGY, "kinetic energy of the striker at the start"),
    ResultKind::new("energy_error", Dimension::NUMBER, "what the energy balance misses, over the input energy"),
    FOLLOWED[0],
    FOLLOWED[1],
    FOLLOWED[2],
    FOLLOWED[3],
    ResultKind::new("time_step", Dimension::TIME, "time step of the run"),
    ResultKind::measured(
        "critical_time_step",
        Dimension::TIME,
        "critical time step (Melo et al. 2006, eq. 7; under `hertz` of the closed contact)",
    ),
    ResultKind::count("steps", "number of steps"),
    ResultKind::measured("contact_duration", Dimension::TIME, "virtual time of the first blow, in whole steps").of_storey(),
    ResultKind::measured("rebound_velocity", Dimension::VELOCITY, "speed of the striker on its way back at the end of the run")
        .of_storey(),
    ResultKind::measured_list("floor_displacement", Dimension::LENGTH, "largest size of each floor's displacement").of_storey(),
    ResultKind::measured_list("max_drift", Dimension::LENGTH, "largest size of each storey's drift").of_storey(),
    ResultKind::measured_list("final_drift", Dimension::LENGTH, "each storey's drift at the last step of the run").of_storey(),
    ResultKind::measured_list("storey_energy", Dimension::ENERGY, "shear of each storey integrated over its drift, over the run")
        .of_storey(),
    ResultKind::measured(
        "max_base_shear",
        Dimension::FORCE,
        "largest size of the restoring force of the lowest storey, less what noise adds to it",
    )
    .of_storey(),
    ResultKind::measured_list("periods", Dimension::TIME, "natural periods, longest first").of_storey(),
    FLOORS_FOLLOWED[0].of_storey(),
    FLOORS_FOLLOWED[1].of_storey(),
    FLOORS_FOLLOWED[2].of_storey(),
    FLOORS_FOLLOWED[3].of_storey(),
];

/// How the actuators of a specimen were followed; of several, energies and areas add, of the others the largest counts.
const FOLLOWED: [ResultKind; 4] = [
    ResultKind::new(
        "tracking_energy_error",
        Dimension::NUMBER,
        "energy that following wrongly took out of the test (put in: negative), over the input energy, at its largest",
    ),
    ResultKind::new(
        "tracking_indicator",
        Dimension::AREA,
        "area that command against measurement encloses; falling: the actuator lags",
    ),
    ResultKind::new("nrms_error", Dimension::NUMBER, "tracking error over command, root mean squares"),
    ResultKind::new("peak_error", Dimension::LENGTH, "largest measured less commanded displacement, by size"),
];

/// The same of the actuator of each floor.
const FLOORS_FOLLOWED: [ResultKind; 4] = [
    ResultKind::list(
        "floor_tracking_energy_error",
        Dimension::NUMBER,
        "of each floor's actuator: energy that following wrongly took out (put in: negative), over the input energy, at its largest",
    ),
    ResultKind::list("floor_tracking_indicator", Dimension::AREA, "of each floor's actuator: the tracking indicator"),
    ResultKind::list("floor_nrms_error", Dimension::NUMBER, "of each floor's actuator: tracking error over command"),
    ResultKind::list("floor_peak_error", Dimension::LENGTH, "of each floor's actuator: largest tracking error, by size"),
];

pub(super) const SHAKE: &[ResultKind] = &[
    ResultKind::measured_list(
        "max_displacement",
        Dimension::LENGTH,
        "largest size of each floor's displacement, relative to the ground",
    ),
    ResultKind::measured_list("max_drift", Dimension::LENGTH, "largest size of each storey's drift"),
    ResultKind::measured_list("final_drift", Dimension::LENGTH, "each storey's drift at the last step of the run"),
    ResultKind::measured_list("periods", Dimension::TIME, "natural periods, longest first"),
    ResultKind::measured(
        "max_base_shear",
        Dimension::FORCE,
        "largest size of the restoring force of the lowest storey, less what noise adds to it",
    ),
    ResultKind::new("energy_error", Dimension::NUMBER, "what the energy balance misses, over the input energy"),
    ResultKind::count("steps", "number of steps"),
    FOLLOWED[0],
    FOLLOWED[1],
    FOLLOWED[2],
    FOLLOWED[3],
    FLOORS_FOLLOWED[0],
    FLOORS_FOLLOWED[1],
    FLOORS_FOLLOWED[2],
    FLOORS_FOLLOWED[3],
];
