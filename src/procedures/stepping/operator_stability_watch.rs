//! Observes a specimen that is stiffer than its integrator assumes (`docs/method/equations.md`): α-OS is stable for every step only while the
//! specimen is not stiffer than `K_I`, and explicit Newmark up to 2/ω of its largest stiffness. In: the readings, step by step. Out: one
//! observation. It stops nothing.

use crate::codes::W718;
use crate::procedures::damping_sweep::rate_separated_stiffness::RateSeparatedFit;
use crate::run::session::{Session, first};
use psd_physics::impact::ImpactInput;
use psd_physics::integrator::stability::{Met, longest_stable_step};
use psd_physics::structure::assemblies::StoreyReadings;
use psd_physics::structure::elements::ElementReading;
use psd_physics::structure::frame_properties::FrameProperties;
use psd_physics::structure::{Matrices, drifts, shears, storeys_of};
use psd_plan::record::EventKind;
use psd_plan::{Integrator, Mode, Stepping};
use psd_rig::Reading;
use psd_text::units::Dimension;
use psd_text::units::display::readable;

use super::setting::Start;

/// A secant counts if its change of displacement is this many standard deviations of the readings, and exceeds `K_I` by as many of its
/// own. With fewer, the noise of many steps appears as a stiffness.
const SURE: f64 = 5.0;

/// An alternating response is judged where every other position is farther out by more than this fraction of a step. With less, creep or
/// relaxation appears as a stiffness. Explicit Newmark, one hundredth beyond its limit, grows by more.
const GROWN: f64 = 0.05;

/// The quantities by which the steps of one spring, or of one storey, are judged.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judged {
    pub integrator: Integrator,
    /// `K_I` \[N/m\]
    pub operator_stiffness: f64,
    /// P/h of a storey that carries weight \[N/m\]; it is neither measured nor in `K_I`.
    pub gravity: f64,
    /// 1/M of one degree of freedom; for a storey the sum of 1/M of the floors that it joins \[1/kg\].
    pub mobility: f64,
    /// \[s\]
    pub time_step: f64,
    /// Standard deviation of a force \[N\] and of a displacement \[m\].
    pub noise: (f64, f64),
    /// Whether it is read in motion: the force then includes dampers.
    pub moving: bool,
}

/// Relative rounding error of a reading.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

#[derive(Debug)]
pub(crate) struct Stiffer {
    judged: Judged,
    last: (f64, f64),
    /// The reading before it.
    before: (f64, f64),
    /// The last step \[m\]; 0 before the first.
    moved: f64,
    /// Whether the last step reversed.
    turned: bool,
    in_motion: RateSeparatedFit,
    observed: bool,
}

impl Stiffer {
    /// `first` is the reading before the first step \[m\], \[N\].
    pub(crate) fn new(judged: Judged, first: (f64, f64)) -> Self {
        Self {
            judged,
            last: first,
            before: first,
            moved: 0.0,
            turned: false,
            in_motion: RateSeparatedFit::default(),
            observed: false,
        }
    }

    /// Adds a reading, m and N; records once that the specimen, called `name`, is stiffer than the stability of the step allows. In a step
    /// with contact (`struck`) the readings give no velocity.
    pub(crate) fn take(
        &mut self,
        reading: (f64, f64),
        struck: bool,
        name: &str,
        session: &mut Session<'_>,
    ) {
        if struck {
            self.in_motion.restart();
        }
        let text = self.assess(reading, name);
        if let Some(text) = text {
            session.event(EventKind::Remark, text);
        }
    }

    fn assess(&mut self, reading: (f64, f64), name: &str) -> Option<String> {
        let Judged {
            integrator,
            operator_stiffness,
            gravity,
            mobility,
            time_step,
            ..
        } = self.judged;
        if integrator == Integrator::Tangent || self.observed {
            return None;
        }
        let (measured, spread) = if self.judged.moving {
            self.in_motion.add(reading, self.judged.noise)
        } else {
            let stable = match integrator {
                Integrator::Explicit => 0.0,
                Integrator::Tangent | Integrator::AlphaOs { .. } => operator_stiffness,
            };
            self.secant(reading, stable)
        }?;
        // The secant of a very small move is rounding; in motion the velocities are differences too.
        let rounding = if self.judged.moving { 1e-4 } else { 1e-9 } * operator_stiffness;
        let stiffness = |value| readable(value, Dimension::STIFFNESS);
        let time = |value| readable(value, Dimension::TIME);
        let limit = |stiffness: f64| {
            longest_stable_step(
                integrator,
                &Met::one(
                    &Matrices {
                        mass: 1.0 / mobility,
                        damping: 0.0,
                        stiffness: stiffness - gravity,
                        gravity: None,
                    },
                    operator_stiffness - gravity,
                ),
            )
        };
        // The stiffness of the specimen, not the assumed one, limits explicit Newmark.
        if integrator == Integrator::Explicit {
            let sure = measured - SURE * spread - rounding;
            if sure <= 0.0 || time_step <= limit(sure) {
                return None;
            }
            self.observed = true;
            let limit = time(limit(measured));
            return Some(format!(
                "{}: {name} reached {}: explicit Newmark is then stable up to {limit}, but the time step is {}",
                W718,
                stiffness(measured),
                time(time_step),
            ));
        }
        if measured - operator_stiffness <= SURE * spread + rounding {
            return None;
        }
        let limit = limit(measured);
        // Numerical damping can compensate: then every step is stable.
        if limit == f64::INFINITY {
            return None;
        }
        self.observed = true;
        let so = if time_step > limit {
            "exceeded here"
        } else {
            "not exceeded here"
        };
        Some(format!(
            "{}: {name} is stiffer than assumed in α-OS, {} measured, K_I = {}: time step stable up to {} only, {so} ({})",
            W718,
            stiffness(measured),
            stiffness(operator_stiffness),
            time(limit),
            time(time_step),
        ))
    }
}

impl Stiffer {
    /// Secant stiffness of the last step with its standard deviation \[N/m\]; None if the move is too small, or reversed: friction
    /// reverses with it. In a response that reverses at every step, as an unstable one does, the last reading but one has the same
    /// friction: both were reached in the same direction, if the amplitude has grown enough. None also up to the `stable` stiffness
    /// \[N/m\].
    fn secant(&mut self, reading: (f64, f64), stable: f64) -> Option<(f64, f64)> {
        let noise = self.judged.noise;
        let moved = reading.0 - self.last.0;
        let first = self.moved == 0.0;
        let turned = moved * self.moved <= 0.0;
        let alternates = turned && self.turned && !first;
        let from = if alternates { self.before } else { self.last };
        let change = reading.0 - from.0;
        // The position is beyond that of the last reversal but one: each step is longer than the one before.
        let counts = if alternates {
            change * moved > 0.0 && change.abs() > GROWN * moved.abs()
        } else {
            !turned
        };
        let measured = (reading.1 - from.1) / change;
        (self.before, self.last, self.moved, self.turned) =
            (self.last, reading, moved, turned && !first);
        if !(counts && measured.is_finite() && change.abs() > SURE * noise.1 && measured > stable) {
            return None;
        }
        // A reading has at least the error of its last digits.
        let rounded =
            |noise: f64, read: f64, other: f64| noise.max(ROUNDING * read.abs().max(other.abs()));
        let force = rounded(noise.0, reading.1, from.1);
        let spread = std::f64::consts::SQRT_2
            * force.hypot(measured * rounded(noise.1, reading.0, from.0))
            / change.abs();
        Some((measured, spread))
    }
}

/// Every spring of a structure: the specimen of one degree of freedom, every storey of a frame by its shear and drift, or every element of
/// a frame of matrices; none for a matrix on the rig. If one storey is stiffer by ΔK, M⁻¹(K − `K_I`) is a matrix of rank one; its squared frequency is ΔK times the
/// sum of 1/M of the floors that the storey joins.
pub(crate) struct StifferSprings {
    springs: Vec<(String, Stiffer)>,
    /// Of the last reading \[m\], \[N\].
    drift: Vec<f64>,
    shear: Vec<f64>,
}

impl StifferSprings {
    /// The spring of one degree of freedom.
    pub(crate) fn of_specimen(input: &ImpactInput, plan: &Stepping, start: &Start) -> Self {
        let judged = Judged {
            integrator: plan.integrator,
            operator_stiffness: input.operator_stiffness,
            gravity: 0.0,
            mobility: 1.0 / input.mass,
            time_step: input.time_step,
            noise: noise_of(&start.resolved[0]),
            moving: plan.mode != Mode::RampAndHold,
        };
        Self::of(vec![(
            "the specimen".to_owned(),
            Stiffer::new(judged, first(&start.reading)),
        )])
    }

    fn of(springs: Vec<(String, Stiffer)>) -> Self {
        let nothing = || vec![0.0; springs.len()];
        Self {
            drift: nothing(),
            shear: nothing(),
            springs,
        }
    }

    /// The storeys of a frame.
    pub(crate) fn of_storeys(
        properties: &FrameProperties,
        plan: &Stepping,
        time_step: f64,
        start: &Start,
    ) -> Self {
        let (matrices, first) = (&properties.matrices, &start.reading);
        let floor = |floor: usize| 1.0 / matrices.mass.entry(floor, floor);
        if let Some(elements) = &properties.elements {
            let judged = |element: usize| {
                let ends = elements.ends[element].into_iter().flatten();
                let read = start.elements[element];
                let judged = Judged {
                    integrator: plan.integrator,
                    operator_stiffness: elements.operator_stiffness[element],
                    gravity: 0.0,
                    moving: plan.mode != Mode::RampAndHold,
                    mobility: ends.map(floor).sum(),
                    time_step,
                    noise: noise_of(&start.resolved[element]),
                };
                (
                    format!("element {}", element + 1),
                    Stiffer::new(judged, (read.deformation, read.force)),
                )
            };
            return Self::of((0..start.elements.len()).map(judged).collect());
        }
        let storeys = storeys_of(&properties.operator).unwrap_or_default();
        let weights = matrices.gravity.as_ref().and_then(storeys_of);
        let gravity = |storey: usize| weights.as_ref().map_or(0.0, |weights| weights[storey]);
        let nothing = || vec![0.0; storeys.len()];
        let (mut drift, mut shear) = (nothing(), nothing());
        drifts(&first.displacement, &mut drift);
        shears(&first.force, &mut shear);
        let judged = |(storey, operator_stiffness): (usize, f64)| {
            let judged = Judged {
                integrator: plan.integrator,
                operator_stiffness,
                gravity: gravity(storey),
                moving: plan.mode != Mode::RampAndHold,
                mobility: floor(storey) + if storey == 0 { 0.0 } else { floor(storey - 1) },
                time_step,
                noise: noise_of(&start.resolved[storey]),
            };
            (
                format!("storey {}", storey + 1),
                Stiffer::new(judged, (drift[storey], shear[storey])),
            )
        };
        Self::of(storeys.into_iter().enumerate().map(judged).collect())
    }

    pub(crate) fn take(
        &mut self,
        reading: &Reading,
        elements: &[ElementReading],
        struck: bool,
        session: &mut Session<'_>,
    ) {
        if elements.is_empty() {
            drifts(&reading.displacement, &mut self.drift);
            shears(&reading.force, &mut self.shear);
        } else {
            let read = self.drift.iter_mut().zip(&mut self.shear).zip(elements);
            for ((drift, shear), element) in read {
                (*drift, *shear) = (element.deformation, element.force);
            }
        }
        let readings = self.drift.iter().copied().zip(self.shear.iter().copied());
        for ((name, storey), reading) in self.springs.iter_mut().zip(readings) {
            storey.take(reading, struck, name, session);
        }
    }
}

/// Standard deviation of the shear \[N\] and of the drift \[m\] of a storey. A resolution q has u = q/√12.
fn noise_of(readings: &StoreyReadings) -> (f64, f64) {
    let position = readings.noise.resolution / 12_f64.sqrt();
    let positions = if readings.is_difference {
        std::f64::consts::SQRT_2
    } else {
        1.0
    };
    (readings.shear_noise(), position * positions)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(noise: (f64, f64)) -> Judged {
        let integrator = Integrator::AlphaOs { alpha: 0.0 };
        Judged {
            integrator,
            operator_stiffness: 300.0,
            gravity: 0.0,
            mobility: 0.5,
            time_step: 0.1,
            noise,
            moving: false,
        }
    }

    /// 500 N/m on 2 kg: 2√(2/200) s = 0.2 s.
    #[test]
    fn a_stiffer_specimen_is_reported_once_with_the_remaining_limit() {
        let mut stiffer = Stiffer::new(judged((0.0, 0.0)), (0.0, 0.0));
        assert_eq!(
            stiffer.assess((0.000_5, 0.15), "the specimen"),
            None,
            "as stiff as K_I"
        );
        assert_eq!(
            stiffer.assess((0.001, 0.3), "the specimen"),
            None,
            "as stiff as K_I"
        );
        assert_eq!(
            stiffer.assess((0.000_5, 0.0), "the specimen"),
            None,
            "a turn, where friction turns too"
        );
        assert_eq!(
            stiffer.assess((0.001, 0.3), "the specimen"),
            None,
            "and back"
        );
        let text = stiffer
            .assess((0.002, 0.8), "the specimen")
            .expect("a remark");
        assert!(
            text.contains("500.0 N/m measured, K_I = 300.0 N/m") && text.contains("up to 0.2000 s"),
            "{text}"
        );
        assert!(
            text.starts_with("W718") && text.contains("not exceeded here (0.1000 s)"),
            "{text}"
        );
        assert_eq!(stiffer.assess((0.003, 1.5), "the specimen"), None, "once");
        let tangent = Judged {
            integrator: Integrator::Tangent,
            ..judged((0.0, 0.0))
        };
        assert_eq!(
            Stiffer::new(tangent, (0.0, 0.0)).assess((0.001, 9.0), "the specimen"),
            None
        );
    }

    /// 800 N/m on 2 kg: ω = 20 rad/s, 2/ω = 0.1 s; of 500 N/m 0.126 s.
    #[test]
    fn explicit_newmark_is_bound_by_the_stiffness_that_is_measured() {
        let explicit = Judged {
            integrator: Integrator::Explicit,
            ..judged((0.0, 0.0))
        };
        let mut stiffer = Stiffer::new(explicit, (0.0, 0.0));
        assert_eq!(
            stiffer.assess((0.001, 0.5), "the specimen"),
            None,
            "beyond K_I, and stable"
        );
        assert_eq!(
            stiffer.assess((0.002, 1.3), "the specimen"),
            None,
            "at its limit"
        );
        let text = stiffer
            .assess((0.003, 2.2), "the specimen")
            .expect("a remark");
        assert!(
            text.starts_with("W718")
                && text.contains("900.0 N/m")
                && text.contains("up to 94.28 ms"),
            "{text}"
        );
        assert_eq!(stiffer.assess((0.004, 3.2), "the specimen"), None, "once");
    }

    /// The response reverses at every step from the first: 900 N/m and friction of 0.1 N, each position −1.3 times the one before. Two
    /// readings reached in the same direction have the same friction. A response that alternates without growing gives no result.
    #[test]
    fn a_response_that_turns_at_every_step_is_judged_by_every_other_reading() {
        let of = |integrator: Integrator, growth: f64, stiffness: f64| {
            let mut stiffer = Stiffer::new(
                Judged {
                    integrator,
                    ..judged((0.0, 0.0))
                },
                (0.0, 0.0),
            );
            let mut displacement = 0.001;
            let remarks = (0..12).filter_map(|_| {
                let text = stiffer.assess(
                    (
                        displacement,
                        stiffness * displacement + 0.1 * displacement.signum(),
                    ),
                    "the specimen",
                );
                displacement *= -growth;
                text
            });
            remarks.collect::<Vec<String>>()
        };
        let splitting = Integrator::AlphaOs { alpha: 0.0 };
        let remarks = of(splitting, 1.3, 900.0);
        assert!(
            remarks.len() == 1 && remarks[0].contains("900.0 N/m measured, K_I = 300.0 N/m"),
            "{remarks:?}"
        );
        let remarks = of(Integrator::Explicit, 1.3, 900.0);
        assert!(
            remarks.len() == 1
                && remarks[0].contains("reached 900.0 N/m")
                && remarks[0].contains("94.28 ms"),
            "{remarks:?}"
        );
        for (integrator, growth, stiffness) in [
            (splitting, 1.3, 300.0),
            (Integrator::Explicit, 1.3, 790.0),
            (splitting, 1.01, 900.0),
            (splitting, 0.9, 900.0),
        ] {
            assert_eq!(
                of(integrator, growth, stiffness),
                Vec::<String>::new(),
                "{integrator:?}, {growth}, {stiffness} N/m"
            );
        }
    }

    /// Beside friction of 10 kN an increment of 0.1 µm has rounding of 10⁻¹² N/0.1 µm = 10⁻⁵ N/m in its secant, more than 10⁻⁹ of `K_I`.
    #[test]
    fn rounding_is_no_stiffness() {
        for from in [0.1, 0.3, 1.7] {
            let friction = 1e4;
            let read = |displacement: f64| (displacement, 300.0 * displacement + friction);
            let mut stiffer = Stiffer::new(judged((0.0, 0.0)), read(from));
            for step in 1..2000 {
                assert_eq!(
                    stiffer.assess(read(from + 1e-7 * f64::from(step)), "the specimen"),
                    None,
                    "step {step} from {from} m"
                );
            }
        }
    }

    /// 0.1 N and 1 µm over 1 mm: a secant of 360 N/m has a deviation of 142 N/m; five of them are not 60.
    #[test]
    fn noise_is_no_stiffness() {
        let mut stiffer = Stiffer::new(judged((0.1, 1e-6)), (-0.001, -0.3));
        assert_eq!(
            stiffer.assess((0.0, 0.0), "the specimen"),
            None,
            "the first move has no direction before it"
        );
        assert_eq!(stiffer.assess((0.001, 0.36), "the specimen"), None);
        assert_eq!(
            stiffer.assess((0.001_004, 0.5), "the specimen"),
            None,
            "a move of four quanta gives no stiffness"
        );
        assert!(
            stiffer.assess((0.02, 8.0), "the specimen").is_some(),
            "395 N/m over 19 mm"
        );
    }
}
