//! Self-test: cases whose answers were derived independently, computed by the code of a run. In: nothing. Out: computed and expected
//! values, and the parts of the program that each case goes through. A report prints the cases of the parts that its run used, and
//! names the parts without a case.
//!
//! The answers. Melo et al. 2006, examples 1 and 2 and Fig. 11, to the digits of an event-driven solution and of the scheme itself at the
//! printed step; the critical time step is eq. (7). Free vibration by explicit Newmark is cos nθ with cos θ = 1 − (ωΔt)²/2. By α-OS with
//! `K_I` = K it is that of the implicit α-method (Hilber, Hughes and Taylor 1977), computed separately. A frame on ground of constant
//! acceleration is the sum of its modes, `u_st`(1 − cos nθ), with θ of each as above, and tan ½θ = ½ωΔt in the tangent form. The hard
//! collisions of `restitution` are those of the event-driven solution; the peak force of `hertz` between free masses is
//! k^0.4 (1.25 μ v²)^0.6. Explicit Newmark and α-OS with a contact were stepped separately, by the equations in the head of
//! `integrator/step_form.rs`.

mod cases;
mod runs;

use std::sync::OnceLock;

use cases::{fits, frames, one_degree, papers};

/// A part of the program that a run may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelfTestPart {
    /// Integrators of one degree of freedom.
    Tangent,
    Explicit,
    AlphaOs,
    /// Its contact laws.
    Rigid,
    Limit,
    Restitution,
    Hertz,
    /// Integrators of a frame.
    FrameTangent,
    FrameExplicit,
    FrameAlphaOs,
    /// Contact laws on one of its storeys.
    FrameRigid,
    FrameLimit,
    FrameRestitution,
    FrameHertz,
    LineFit,
    CurveFit,
    DampingFit,
    Loops,
    Unloading,
    IModification,
    Continuous,
}

impl SelfTestPart {
    /// Its name in a report.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tangent => "tangent integrator",
            Self::Explicit => "explicit Newmark",
            Self::AlphaOs => "α-operator splitting",
            Self::Rigid => "rigid contact",
            Self::Limit => "contact with a limit force",
            Self::Restitution => "contact by restitution",
            Self::Hertz => "Hertz contact",
            Self::FrameTangent => "tangent integrator of a frame",
            Self::FrameExplicit => "explicit Newmark of a frame",
            Self::FrameAlphaOs => "α-operator splitting of a frame",
            Self::FrameRigid => "rigid contact on a storey",
            Self::FrameLimit => "contact with a limit force on a storey",
            Self::FrameRestitution => "contact by restitution on a storey",
            Self::FrameHertz => "Hertz contact on a storey",
            Self::LineFit => "fit of a straight line",
            Self::CurveFit => "fit of several lines",
            Self::DampingFit => "fit of a damping sweep",
            Self::Loops => "loops of a cycle",
            Self::Unloading => "unloading to zero force",
            Self::IModification => "I-modification",
            Self::Continuous => "continuous motion",
        }
    }
}

/// The quantity of a result, which is in its SI unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    Number,
    /// \[m\]
    Length,
    /// \[s\]
    Time,
    /// \[N\]
    Force,
}

/// One result of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfTest {
    pub case: &'static str,
    pub result: &'static str,
    pub quantity: Quantity,
    /// SI.
    pub computed: f64,
    /// SI.
    pub expected: f64,
    /// Largest difference of the scheme at this step from the answer, else half a unit of its last digit. SI.
    pub tolerance: f64,
    /// The parts that it uses.
    pub parts: &'static [SelfTestPart],
}

impl SelfTest {
    /// Whether the computed value agrees with the expected one.
    #[must_use]
    pub fn passed(&self) -> bool {
        (self.computed - self.expected).abs() <= self.tolerance
    }
}

/// Every case. They take about ten thousand steps, a few milliseconds, once.
#[must_use]
pub fn all() -> &'static [SelfTest] {
    static ALL: OnceLock<Vec<SelfTest>> = OnceLock::new();
    ALL.get_or_init(|| [papers(), one_degree(), frames(), fits()].concat())
}

/// Whether every case agrees.
#[must_use]
pub fn passed() -> bool {
    all().iter().all(SelfTest::passed)
}

/// Whether one case uses all of these parts together.
#[must_use]
pub fn covers(parts: &[SelfTestPart]) -> bool {
    all()
        .iter()
        .any(|test| parts.iter().all(|part| test.parts.contains(part)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_passes_and_a_wrong_number_does_not() {
        let all = all();
        let failed: Vec<&SelfTest> = all.iter().filter(|case| !case.passed()).collect();
        assert!(all.len() >= 27 && passed(), "{failed:#?}");
        for case in all {
            let beyond = SelfTest {
                computed: case.expected + 1.01 * case.tolerance,
                ..*case
            };
            let nothing = SelfTest {
                computed: f64::NAN,
                ..*case
            };
            assert!(!beyond.passed() && !nothing.passed());
        }
    }

    #[test]
    fn every_integrator_has_its_case_with_every_contact_that_it_takes() {
        use SelfTestPart::{
            AlphaOs, Explicit, FrameAlphaOs, FrameExplicit, FrameHertz, FrameLimit,
            FrameRestitution, FrameRigid,
        };
        use SelfTestPart::{FrameTangent, Hertz, Limit, LineFit, Restitution, Rigid, Tangent};
        for integrator in [Tangent, Explicit, AlphaOs] {
            assert!(
                covers(&[integrator, Rigid]) && covers(&[integrator, Limit]),
                "{integrator:?}"
            );
        }
        for integrator in [FrameTangent, FrameExplicit, FrameAlphaOs] {
            assert!(
                covers(&[integrator, FrameRigid]) && covers(&[integrator, FrameLimit]),
                "{integrator:?}"
            );
            assert!(
                all().iter().any(|case| case.parts == [integrator]),
                "{integrator:?} without an impact"
            );
        }
        assert!(covers(&[Tangent, Restitution]) && covers(&[Tangent, Hertz]) && covers(&[LineFit]));
        assert!(covers(&[FrameTangent, FrameRestitution]) && covers(&[FrameTangent, FrameHertz]));
        assert!(!covers(&[SelfTestPart::DampingFit]) && !covers(&[Tangent, FrameRigid]));
        assert!(all().iter().all(|case| !case.parts.is_empty()));
    }
}
