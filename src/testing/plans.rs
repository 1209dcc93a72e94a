//! Plans built without text, for tests of the stages after `check`.

use psd_plan::formula::{Formula, ProcedureId, ResultPart, ResultReference, ResultValue};
use psd_plan::record::{NamedResult, Record};
use psd_plan::uncertainty::Source;
use psd_plan::{
    Annex, Behaviour, Calibration, Contact, Datum, DecisionRule, DeviceLink, Dialect, Frame,
    Impact, ImpactTarget, Integrator, Interval, Limits, Link, Mode, Plan, PointTarget, PortPlan,
    PretestCheck, Procedure, ProcedureKind, RampFit, ReadingRules, RealLink, Report, RigPlan,
    SafeState, Settle, ShakeDamping, Specimen, Stepping, StiffnessRamp, Storey, StoreyTarget,
    Striker, Studies, Until, VirtualLink,
};

/// Time without a reply after which a frame is sent again \[s\].
pub const REPLY_TIMEOUT: f64 = 0.1;

/// An ideal virtual rig only.
pub fn empty_plan() -> Plan {
    Plan {
        title: "by hand".to_owned(),
        particulars: Vec::new(),
        parameters: Vec::new(),
        specimens: Vec::new(),
        strikers: Vec::new(),
        grounds: Vec::new(),
        rig: RigPlan {
            name: "ideal".to_owned(),
            link: Link::Virtual(VirtualLink::default()),
            settle: Settle {
                band: 0.0,
                force_rate: 0.0,
                dwell: 0.0,
                timeout: 60.0,
            },
            polarity: 1.0,
            calibration: Calibration::default(),
            zero_drift: None,
            simulated_axes: Vec::new(),
        },
        limits: Limits::NONE,
        procedures: Vec::new(),
        requirements: Vec::new(),
        reproductions: Vec::new(),
        decision_rule: DecisionRule::Simple,
        report: Report {
            title: None,
            figures: Vec::new(),
            figures_named: false,
            formats: Vec::new(),
            sign: Vec::new(),
            annexes: Annex::DEFAULT.to_vec(),
            results: None,
            logo: None,
            photos: Vec::new(),
        },
        golden: psd_plan::Golden::default(),
        check_run_of: None,
        studies: Studies::default(),
        files: Vec::new(),
        settings: Vec::new(),
    }
}

/// An elastic specimen of 1 kg, a striker of 10 kg at 1 m/s, and these procedures, named `p0`, `p1`, …
pub fn elastic_plan(stiffness: f64, procedures: Vec<ProcedureKind>) -> Plan {
    let named = |(index, kind)| Procedure {
        name: format!("p{index}"),
        kind,
    };
    Plan {
        specimens: vec![Specimen::new(
            "beam",
            1.0,
            Some(Behaviour::Elastic { stiffness }),
        )],
        strikers: vec![Striker::new("pendulum", 10.0, 1.0)],
        procedures: procedures.into_iter().enumerate().map(named).collect(),
        ..empty_plan()
    }
}

/// The same on a rig `frame`: an actuator of the dialect `native` that measures its force, three readings each.
pub fn real_plan(stiffness: f64, procedures: Vec<ProcedureKind>) -> Plan {
    let mut plan = elastic_plan(stiffness, procedures);
    "frame".clone_into(&mut plan.rig.name);
    plan.rig.settle = Settle {
        band: 5e-6,
        force_rate: 0.0,
        dwell: 0.05,
        timeout: 0.5,
    };
    plan.rig.link = Link::Real(RealLink {
        actuator: device_link(Dialect::Native),
        load_cell: None,
        safe_state: SafeState::Hold,
        datum: Datum::Machine,
        pretest_check: PretestCheck {
            zero: 5.0,
            probe: 5e-5,
            stiffness: Interval {
                low: 5e4,
                high: 2e5,
            },
        },
        readings: ReadingRules {
            samples: 3,
            rate: 50.0,
            resolution: 1e-6,
            noise: 0.0,
            force_range: Interval {
                low: -2000.0,
                high: 2000.0,
            },
            frozen_after: 6,
        },
        watchdog: 3.0,
        own_speed: 0.01,
        axes: Vec::new(),
    });
    plan.limits = Limits {
        displacement: Interval {
            low: -0.002,
            high: 0.01,
        },
        force: Interval {
            low: -1500.0,
            high: 1500.0,
        },
        speed: Interval {
            low: 0.0,
            high: 0.01,
        },
        ..Limits::NONE
    };
    plan
}

/// A device on a serial line.
pub const fn device_link(dialect: Dialect) -> DeviceLink {
    let port = PortPlan::Serial {
        path: String::new(),
        baud: 115_200,
    };
    DeviceLink {
        port,
        dialect,
        reply_timeout: REPLY_TIMEOUT,
        serial_number: None,
    }
}

/// A frame of two storeys of 1 kg. A striker of 10 kg at 1 m/s hits the upper one, in steps of 10 ms.
pub fn struck_frame() -> Plan {
    let storey = |stiffness, yield_force| {
        Storey::new(
            1.0,
            stiffness,
            Behaviour::Bilinear {
                stiffness,
                yield_force,
                post_yield_ratio: 0.05,
            },
        )
    };
    let frame = Frame::of_storeys(vec![storey(500.0, 20.0), storey(300.0, 15.0)]);
    let struck = Impact {
        specimen: 0,
        striker: 0,
        target: ImpactTarget::Storey(StoreyTarget {
            storey: 1,
            damping: ShakeDamping::Rayleigh(Formula::Constant(0.02)),
            damping_uncertainty: 0.0,
        }),
        contact: Contact::Restitution {
            coefficient: Formula::Constant(0.5),
        },
        stepping: Stepping {
            max_tangent_ratio: Formula::Constant(2.0),
            ..every(0.01)
        },
        duration: Formula::Constant(0.25),
        until: Until::Duration,
    };
    let mut plan = elastic_plan(1.0, vec![ProcedureKind::Impact(struck)]);
    plan.specimens[0].frame = Some(frame);
    plan.specimens[0].behaviour = None;
    plan.specimens[0].mass = 2.0;
    plan
}

/// Ten outward steps of `step` \[m\], one sample each, no pause.
pub fn ramp(step: f64) -> StiffnessRamp {
    StiffnessRamp {
        specimen: 0,
        displacements: (1..=10)
            .map(|index| Formula::Constant(f64::from(index) * step))
            .collect(),
        pause: Formula::Constant(0.0),
        samples: 1,
        repeats: 1,
        return_path: false,
        fit: RampFit::Linear,
        relaxation: None,
        speed: None,
    }
}

/// Example 1 of Melo et al. 2006: M 1 kg, Ms 10 kg, V0 1 m/s, Δt 10 ms; K there is 327.65 N/m.
pub fn impact(stiffness: Formula) -> Impact {
    Impact {
        specimen: 0,
        striker: 0,
        target: ImpactTarget::Point(PointTarget {
            mass: Formula::Constant(1.0),
            mass_uncertainty: 0.0,
            stiffness,
            damping: Formula::Constant(0.0),
        }),
        contact: Contact::Rigid,
        stepping: every(0.01),
        duration: Formula::Constant(0.5),
        until: Until::StrikerStop,
    }
}

/// Changes of what an impact strikes.
pub trait ChangeTarget: Sized {
    /// The struck degree of freedom; panics where a storey is struck.
    fn point_mut(&mut self) -> &mut PointTarget;
    /// The struck storey; panics where one degree of freedom is struck.
    fn storey_mut(&mut self) -> &mut StoreyTarget;

    #[must_use]
    fn with_point(mut self, change: impl FnOnce(&mut PointTarget)) -> Self {
        change(self.point_mut());
        self
    }

    #[must_use]
    fn with_storey(mut self, change: impl FnOnce(&mut StoreyTarget)) -> Self {
        change(self.storey_mut());
        self
    }
}

impl ChangeTarget for Impact {
    fn point_mut(&mut self) -> &mut PointTarget {
        match &mut self.target {
            ImpactTarget::Point(point) => point,
            ImpactTarget::Storey(_) => panic!("a storey is struck"),
        }
    }

    fn storey_mut(&mut self) -> &mut StoreyTarget {
        match &mut self.target {
            ImpactTarget::Storey(storey) => storey,
            ImpactTarget::Point(_) => panic!("one degree of freedom is struck"),
        }
    }
}

/// Results as if from a different procedure: durations in its time steps are then the source.
pub fn as_of(procedure: usize, results: &[NamedResult]) -> Vec<NamedResult> {
    let mut results = results.to_vec();
    for part in results
        .iter_mut()
        .flat_map(|result| &mut result.contributions)
    {
        if let Source::WholeSteps { procedure: own } = &mut part.source {
            *own = ProcedureId(procedure);
        }
    }
    results
}

/// Steps of `time_step` \[s\] by the tangent form, with no pause.
pub fn every(time_step: f64) -> Stepping {
    Stepping {
        integrator: Integrator::Tangent,
        allow_unstable: false,
        i_modification: false,
        mode: Mode::RampAndHold,
        time_step: Formula::Constant(time_step),
        pause: Formula::Constant(0.0),
        max_tangent_ratio: Formula::Constant(10.0),
        inspect: Vec::new(),
    }
}

pub fn result_of(procedure: usize, name: &'static str) -> Formula {
    Formula::Result(ResultReference {
        procedure: ProcedureId(procedure),
        name,
        part: ResultPart::Value,
    })
}

/// Value and uncertainty of a result of the procedure `p0`, `p1`, …
pub fn number(record: &Record, procedure: usize, name: &str) -> (Option<f64>, Option<f64>) {
    match record.procedures[procedure]
        .result(name)
        .map(|result| &result.value)
    {
        Some(ResultValue::Number { value, uncertainty }) => (*value, *uncertainty),
        other => panic!("{name} is {other:?}"),
    }
}

/// Entries of a result that is a list, of the procedure `p0`, `p1`, …
pub fn list(record: &Record, procedure: usize, name: &str) -> Vec<f64> {
    match record.procedures[procedure]
        .result(name)
        .map(|result| &result.value)
    {
        Some(ResultValue::List(values)) => values.clone(),
        other => panic!("{name} is {other:?}"),
    }
}

/// Uniform numbers in (0, 1), the same in every run: a Lehmer generator.
pub struct Uniform(pub u64);

impl Uniform {
    pub fn number(&mut self) -> f64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        f64::from(u32::try_from(self.0).unwrap()) / 2_147_483_647.0
    }

    /// Standard normal by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let (radius, angle) = (
            (-2.0 * self.number().ln()).sqrt(),
            std::f64::consts::TAU * self.number(),
        );
        radius * angle.cos()
    }
}

/// Standard deviation of numbers about their mean.
pub fn scatter(values: &[f64]) -> f64 {
    let count = f64::from(u32::try_from(values.len()).unwrap());
    let mean = values.iter().sum::<f64>() / count;
    (values
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum::<f64>()
        / (count - 1.0))
        .sqrt()
}
