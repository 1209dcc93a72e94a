//! A finished run made by hand: a ramp, a sweep and a rigid impact by the paper's eqs. 2–5 on a linear structure. Outputs are thus tested
//! without a rig.

use psd::report::{Provenance, Run};
use psd::verdict::{Assessment, Bound, ConditionOutcome, RequirementOutcome, Verdict};
use psd_physics::contact::state::StepState;
use psd_physics::identification::LineFit;
use psd_physics::impact::energy::Energies;
use psd_physics::tracking::monitor::Tracking;
use psd_plan::formula::{
    Estimate, Formula, ProcedureId, ResultPart, ResultReference, ResultValue, UncertaintyStatus,
};
use psd_plan::record::{
    BroughtTogether, DampingSweepHistory, Event, EventKind, History, ImpactHistory, ImpactStep,
    NamedResult, Outcome, ProcedureRecord, RampStep, Record, StiffnessRampHistory, SweepStep,
};
use psd_plan::{
    Annex, Behaviour, Calibration, Comparison, Condition, Contact, DampingSweep, DecisionRule,
    Figure, FigureKind, Impact, ImpactTarget, InspectTrigger, Integrator, Interval, Limits, Link,
    Mode, Parameter, Plan, PlanFile, PointTarget, Procedure, ProcedureKind, RampFit, Report,
    Requirement, RigPlan, Settle, Specimen, Stepping, StiffnessRamp, Striker, Test, Until,
    VirtualLink,
};
use psd_rig::Identity;
use psd_text::units::Dimension;

/// Owns the data that a [`Run`] borrows.
pub struct Finished {
    pub plan: Plan,
    pub record: Record,
    pub assessment: Assessment,
    pub provenance: Provenance,
}

impl Finished {
    pub fn run(&self) -> Run<'_> {
        Run {
            plan: &self.plan,
            record: &self.record,
            assessment: &self.assessment,
            provenance: &self.provenance,
        }
    }
}

const MASS: f64 = 1.0;
const STRIKER_MASS: f64 = 10.0;
const STIFFNESS: f64 = 327.65;
const TIME_STEP: f64 = 0.001;

/// The paper's Example 1 at a step of 1 ms, with everything a report can show.
pub fn finished() -> Finished {
    let steps = impact_steps();
    let largest = steps.iter().map(|step| step.command).fold(0.0, f64::max);
    let peak = steps
        .iter()
        .map(|step| step.contact_force)
        .fold(0.0, f64::max);
    let impulse = steps
        .iter()
        .map(|step| step.contact_force * TIME_STEP)
        .sum();
    let error = steps.last().map_or(0.0, |step| step.energies.error) / 5.0;
    let stop = steps
        .iter()
        .find(|step| step.striker_velocity <= 0.0)
        .map(|step| step.time);
    let number = |name, value, uncertainty, dimension| NamedResult {
        name,
        value: ResultValue::Number { value, uncertainty },
        dimension,
        contributions: Vec::new(),
        withheld: None,
    };
    let ramp = ProcedureRecord {
        name: "k0".into(),
        kind: "stiffness ramp",
        complete: true,
        inputs: vec![(
            "pause",
            Estimate {
                value: 2.0,
                uncertainty: None,
            },
            Dimension::TIME,
        )],
        results: vec![
            number("stiffness", Some(327.72), Some(0.41), Dimension::STIFFNESS),
            number(
                "intercept_force",
                Some(-0.012),
                Some(0.035),
                Dimension::FORCE,
            ),
            number("r_squared", Some(0.999_98), None, Dimension::NUMBER),
        ],
        history: History::StiffnessRamp(StiffnessRampHistory {
            before: Vec::new(),
            steps: ramp_steps(),
            fit: Some(line(327.72, 0.41, -0.012, 0.035)),
            bilinear: None,
            multilinear: None,
            holds: Vec::new(),
            relaxation: None,
            reached: None,
        }),
        axial: Vec::new(),
    };
    let sweep = ProcedureRecord {
        name: "c".into(),
        kind: "damping sweep",
        complete: true,
        inputs: vec![(
            "stiffness",
            Estimate {
                value: 327.72,
                uncertainty: Some(0.41),
            },
            Dimension::STIFFNESS,
        )],
        results: vec![
            number("damping", Some(4.02), Some(0.08), Dimension::DAMPING),
            number("coulomb_force", Some(0.31), Some(0.02), Dimension::FORCE),
        ],
        history: History::DampingSweep(DampingSweepHistory {
            pairs: sweep_pairs(&sweep_steps()),
            together: BroughtTogether::default(),
            own_stiffness: None,
            steps: sweep_steps(),
            fit: Some(line(4.02, 0.08, 0.31, 0.02)),
        }),
        axial: Vec::new(),
    };
    let hit = ProcedureRecord {
        name: "hit".into(),
        kind: "impact",
        complete: true,
        inputs: vec![
            (
                "mass",
                Estimate {
                    value: MASS,
                    uncertainty: None,
                },
                Dimension::MASS,
            ),
            (
                "stiffness",
                Estimate {
                    value: STIFFNESS,
                    uncertainty: Some(0.41),
                },
                Dimension::STIFFNESS,
            ),
            (
                "time_step",
                Estimate {
                    value: TIME_STEP,
                    uncertainty: None,
                },
                Dimension::TIME,
            ),
        ],
        results: vec![
            number("max_displacement", Some(largest), None, Dimension::LENGTH),
            number("stop_time", stop, None, Dimension::TIME),
            number("max_contact_force", Some(peak), None, Dimension::FORCE),
            number("impulse", Some(impulse), None, Dimension::IMPULSE),
            number("contacts", Some(6.0), None, Dimension::NUMBER),
            number("restitution", None, None, Dimension::NUMBER),
            number("energy_error", Some(error), None, Dimension::NUMBER),
        ],
        history: History::Impact(ImpactHistory {
            steps: steps.into_iter().collect(),
            frame: None,
            time_step: TIME_STEP,
            critical_time_step: 0.0347,
            ending: psd_physics::impact::summary::ImpactEnding::default(),
        }),
        axial: Vec::new(),
    };
    Finished {
        plan: plan(),
        record: Record {
            rig: Identity {
                name: "ideal".into(),
                model: "virtual".into(),
                serial: String::new(),
                firmware: "0.1.0".into(),
                boot: None,
                simulated: true,
            },
            procedures: vec![ramp, sweep, hit],
            events: vec![
                event(
                    EventKind::Remark,
                    31.0,
                    "the peak contact force depends on the time step under the rigid law",
                ),
                event(
                    EventKind::Inspection,
                    12.5,
                    "no visible crack <b>at</b> the support",
                ),
            ],
            outcome: Outcome::Completed,
            drift: None,
        },
        assessment: assessment(largest, error),
        provenance: Provenance {
            run_id: "0123456789abcdef".into(),
            psd_version: "0.1.0".into(),
            plan_sha256: "ab".repeat(32),
            ..Provenance::default()
        },
    }
}

fn event(kind: EventKind, time: f64, text: &str) -> Event {
    Event {
        time,
        procedure: Some("hit".into()),
        step: Some(20),
        kind,
        text: text.into(),
    }
}

const fn line(slope: f64, slope_error: f64, intercept: f64, intercept_error: f64) -> LineFit {
    LineFit {
        slope,
        slope_error,
        intercept,
        intercept_error,
        correlation: 0.0,
        r_squared: 0.999_98,
        degrees: 8.0,
        shown: 1.0,
    }
}

/// Eqs. 4 and 5 for a linear structure without damping, one row a step.
fn impact_steps() -> Vec<ImpactStep> {
    let (m, ms, k, dt) = (MASS, STRIKER_MASS, STIFFNESS, TIME_STEP);
    let mut now = ImpactStep {
        step: 0,
        time: 0.0,
        wall_time: 40.0,
        state: StepState::Free,
        command: 0.0,
        computed: 0.0,
        displacement: 0.0,
        velocity: 0.0,
        acceleration: 0.0,
        restoring_force: 0.0,
        contact_force: 0.0,
        striker_displacement: 0.0,
        striker_velocity: 1.0,
        tangent_stiffness: k,
        indentation: 0.0,
        energies: Energies {
            striker: 0.5 * ms,
            ..Energies::default()
        },
        tracking: Tracking::default(),
    };
    let mut steps = vec![now];
    while now.striker_velocity > 0.0 || now.velocity > 0.0 {
        let predicted = dt * now.velocity + 0.25 * dt * dt * now.acceleration;
        let free = -now.restoring_force - k * predicted;
        let mut a1 =
            (free - ms / dt * (now.velocity - now.striker_velocity) - 0.5 * ms * now.acceleration)
                / (m + 0.25 * dt * dt * k + 0.5 * ms);
        let mut v1 = now.velocity + 0.5 * dt * (now.acceleration + a1);
        let mut vs1 = v1;
        let mut force = ms / dt * (now.striker_velocity - vs1);
        let mut state = StepState::Contact;
        if now.striker_displacement < now.command || force < 0.0 {
            a1 = free / (m + 0.25 * dt * dt * k);
            v1 = now.velocity + 0.5 * dt * (now.acceleration + a1);
            (vs1, force, state) = (now.striker_velocity, 0.0, StepState::Free);
        }
        let x1 = now.command + 0.5 * dt * (now.velocity + v1);
        let xs1 = now.striker_displacement + 0.5 * dt * (now.striker_velocity + vs1);
        let (dx, dxs) = (x1 - now.command, xs1 - now.striker_displacement);
        let mut energies = Energies {
            striker: 0.5 * ms * vs1 * vs1,
            structure: 0.5 * m * v1 * v1,
            restoring: now.energies.restoring + 0.5 * (now.restoring_force + k * x1) * dx,
            contact_loss: now.energies.contact_loss + force * dxs
                - 0.5 * (now.contact_force + force) * dx,
            ..Energies::default()
        };
        energies.error = 0.5 * ms
            - energies.striker
            - energies.structure
            - energies.restoring
            - energies.contact_loss;
        now = ImpactStep {
            step: now.step + 1,
            time: now.time + dt,
            wall_time: now.wall_time + 0.6,
            state,
            command: x1,
            computed: x1,
            displacement: x1 + 1e-6 / 3.0,
            velocity: v1,
            acceleration: a1,
            restoring_force: k * x1,
            contact_force: force,
            striker_displacement: xs1,
            striker_velocity: vs1,
            tangent_stiffness: k,
            indentation: 0.0,
            energies,
            tracking: Tracking::default(),
        };
        steps.push(now);
    }
    steps
}

fn ramp_steps() -> Vec<RampStep> {
    (0..21_u32)
        .map(|index| {
            let x = 0.002 * f64::from(if index <= 10 { index } else { 20 - index });
            let scatter = 0.15 * f64::from(index * 7 % 5) - 0.3;
            RampStep {
                step: u64::from(index),
                wall_time: 2.0 * f64::from(index),
                command: x,
                displacement: x,
                restoring_force: STIFFNESS * x + scatter,
                force_scatter: 0.1,
                relaxation: 0.01,
                tangent_stiffness: (index > 0).then_some(STIFFNESS),
                returning: index > 10,
            }
        })
        .collect()
}

fn sweep_steps() -> Vec<SweepStep> {
    let velocities = [0.005, -0.005, 0.02, -0.02, 0.05, -0.05, 0.1, -0.1];
    (0..400_u32)
        .map(|index| {
            let velocity: f64 = velocities[(index / 50) as usize];
            let scatter = 0.02 * (f64::from(index * 37 % 19) - 9.0);
            let damping_force = 4.0 * velocity + 0.3 * velocity.signum() + 0.3 * scatter;
            SweepStep {
                step: u64::from(index),
                wall_time: 50.0 + 0.02 * f64::from(index),
                velocity,
                displacement: 0.001,
                restoring_force: 0.327_65 + damping_force,
                damping_force,
                steady: index % 50 >= 5,
            }
        })
        .collect()
}

/// Half the difference of out and back, as in the fit.
fn sweep_pairs(steps: &[SweepStep]) -> Vec<(f64, f64)> {
    let strokes = steps.chunks(100).map(|stroke| stroke.split_at(50));
    let pairs = strokes.flat_map(|(out, back)| out.iter().zip(back));
    let steady = pairs.filter(|(out, back)| out.steady && back.steady);
    steady
        .map(|(out, back)| (out.velocity, 0.5 * (out.damping_force - back.damping_force)))
        .collect()
}

fn plan() -> Plan {
    let constant = Formula::Constant;
    let figure = |procedure, kind| Figure {
        kind,
        procedure: ProcedureId(procedure),
        beside: Vec::new(),
    };
    let result = |procedure, name| {
        Formula::Result(ResultReference {
            procedure: ProcedureId(procedure),
            name,
            part: ResultPart::Value,
        })
    };
    let compare = |text: &str, value, limit, dimension| Condition {
        text: text.into(),
        value,
        test: Test::Compare {
            comparison: Comparison::LessEqual,
            limit: constant(limit),
        },
        dimension,
    };
    let procedures = vec![
        (
            "k0",
            ProcedureKind::StiffnessRamp(StiffnessRamp {
                specimen: 0,
                displacements: (1..=10).map(|i| constant(0.002 * f64::from(i))).collect(),
                pause: constant(2.0),
                samples: 10,
                repeats: 1,
                return_path: true,
                fit: RampFit::Linear,
                relaxation: None,
                speed: None,
            }),
        ),
        (
            "c",
            ProcedureKind::DampingSweep(DampingSweep {
                specimen: 0,
                velocities: vec![
                    constant(0.005),
                    constant(0.02),
                    constant(0.05),
                    constant(0.1),
                ],
                stroke: constant(0.01),
                about: None,
                stiffness: result(0, "stiffness"),
                rate: None,
            }),
        ),
        (
            "hit",
            ProcedureKind::Impact(Impact {
                specimen: 0,
                striker: 0,
                target: ImpactTarget::Point(PointTarget {
                    mass: constant(MASS),
                    mass_uncertainty: 0.0,
                    stiffness: result(0, "stiffness"),
                    damping: constant(0.0),
                }),
                contact: Contact::Rigid,
                stepping: Stepping {
                    integrator: Integrator::Tangent,
                    allow_unstable: false,
                    i_modification: false,
                    mode: Mode::RampAndHold,
                    time_step: constant(TIME_STEP),
                    pause: constant(0.5),
                    max_tangent_ratio: constant(1.5),
                    inspect: vec![InspectTrigger::Every(20)],
                },
                duration: constant(0.4),
                until: Until::StrikerStop,
            }),
        ),
    ];
    let mut figures = vec![
        figure(0, FigureKind::ForceDisplacement),
        figure(1, FigureKind::DampingFit),
    ];
    figures.extend(
        [
            FigureKind::Displacement,
            FigureKind::Velocity,
            FigureKind::StrikerVelocity,
            FigureKind::ContactForce,
            FigureKind::ForceDisplacement,
            FigureKind::Energy,
        ]
        .map(|kind| figure(2, kind)),
    );
    Plan {
        title: "Simply supported beam, midspan impact".into(),
        particulars: vec![
            ("standard", "In-house procedure 12".into()),
            ("specimen_id", "GFRP-0147".into()),
        ],
        parameters: vec![Parameter {
            name: "impact_speed".into(),
            value: 1.0,
            dimension: Dimension::VELOCITY,
            set: true,
        }],
        specimens: vec![Specimen {
            damping: 4.0,
            coulomb: 0.3,
            ..Specimen::new(
                "beam",
                MASS,
                Some(Behaviour::Elastic {
                    stiffness: STIFFNESS,
                }),
            )
        }],
        strikers: vec![Striker::new("pendulum", STRIKER_MASS, 1.0)],
        grounds: Vec::new(),
        rig: RigPlan {
            name: "simulated".into(),
            link: Link::Virtual(VirtualLink {
                noise: 0.1,
                resolution: 1e-6,
                lag: 0.002,
                seed: 7,
                ..VirtualLink::default()
            }),
            settle: Settle {
                band: 1e-5,
                force_rate: 5.0,
                dwell: 0.3,
                timeout: 10.0,
            },
            polarity: 1.0,
            calibration: Calibration::default(),
            zero_drift: None,
            simulated_axes: Vec::new(),
        },
        limits: Limits {
            displacement: Interval {
                low: -0.01,
                high: 0.2,
            },
            force: Interval {
                low: f64::NEG_INFINITY,
                high: 12_000.0,
            },
            ..Limits::NONE
        },
        procedures: procedures
            .into_iter()
            .map(|(name, kind)| Procedure {
                name: name.into(),
                kind,
            })
            .collect(),
        reproductions: Vec::new(),
        decision_rule: DecisionRule::Simple,
        requirements: vec![
            Requirement {
                label: "stays in travel".into(),
                conditions: vec![compare(
                    "hit.max_displacement <= 170 mm",
                    result(2, "max_displacement"),
                    0.17,
                    Dimension::LENGTH,
                )],
            },
            Requirement {
                label: "energy closes".into(),
                conditions: vec![compare(
                    "abs(hit.energy_error) <= 0.01",
                    result(2, "energy_error"),
                    0.01,
                    Dimension::NUMBER,
                )],
            },
        ],
        report: Report {
            title: None,
            figures,
            figures_named: true,
            formats: Vec::new(),
            sign: vec!["Test engineer".into(), "Quality".into()],
            annexes: Annex::ALL.to_vec(),
            results: None,
            logo: None,
            photos: Vec::new(),
        },
        golden: psd_plan::Golden::default(),
        check_run_of: None,
        studies: psd_plan::Studies::default(),
        files: vec![
            PlanFile {
                name: "beam.psd".into(),
                text: "plan \"Beam\" {}\nuse \"lib/frame.psd\"  # <script>alert(1)</script>\n"
                    .into(),
            },
            PlanFile {
                name: "lib/frame.psd".into(),
                text: "rig simulated { link = virtual }\n".into(),
            },
        ],
        settings: vec![("impact_speed".into(), "1 m/s".into())],
    }
}

fn assessment(largest: f64, error: f64) -> Assessment {
    let outcome = |label: &str, text: &str, value: f64, limit: f64, uncertainty, dimension| {
        RequirementOutcome {
            label: label.into(),
            verdict: Verdict::Pass,
            conditions: vec![ConditionOutcome {
                text: text.into(),
                verdict: Verdict::Pass,
                dimension,
                percent: text.contains("energy_error"),
                value: Some(value),
                uncertainty,
                degrees: f64::INFINITY,
                bound: Some(Bound::Compare {
                    comparison: Comparison::LessEqual,
                    limit,
                }),
                margin: Some(limit - value),
                guard_band: None,
                margin_degrees: f64::INFINITY,
                // Far below its limit.
                status: uncertainty.map_or(UncertaintyStatus::Exact, |_| UncertaintyStatus::Known),
                conforms: uncertainty.map(|_| 1.0),
                wider_than_tolerance: false,
                reason: None,
                in_finer_steps: None,
            }],
        }
    };
    Assessment {
        verdict: Verdict::Pass,
        rule: DecisionRule::Simple,
        reproductions: Vec::new(),
        requirements: vec![
            outcome(
                "stays in travel",
                "hit.max_displacement <= 170 mm",
                largest,
                0.17,
                Some(0.000_2),
                Dimension::LENGTH,
            ),
            outcome(
                "energy closes",
                "abs(hit.energy_error) <= 0.01",
                error.abs(),
                0.01,
                None,
                Dimension::NUMBER,
            ),
        ],
    }
}
