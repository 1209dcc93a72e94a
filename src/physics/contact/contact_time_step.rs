//! The motion of a striker when it meets the structure, and the time step that a contact of finite stiffness then needs. In: masses,
//! speed, stiffnesses. Out: numbers in SI. It integrates nothing.

use super::ContactSpring;
use crate::integrator::newmark::critical_time_step;

/// A striker at the instant when it meets a structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// Ms \[kg\]
    pub striker_mass: f64,
    /// \[m/s\]
    pub speed: f64,
    /// Of a contact of finite stiffness.
    pub spring: Option<ContactSpring>,
}

/// A striker from its start until it meets the structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Ms \[kg\]
    pub striker_mass: f64,
    /// At the start \[m/s\].
    pub velocity: f64,
    /// Distance at the start \[m\].
    pub gap: f64,
    /// Acceleration along its path \[m/s²\].
    pub gravity: f64,
}

impl Approach {
    /// A striker after its flight, with its speed when the gap closes.
    #[must_use]
    pub fn after(flight: Flight, spring: Option<ContactSpring>) -> Self {
        let squared = flight.velocity * flight.velocity + 2.0 * flight.gravity * flight.gap;
        Self {
            striker_mass: flight.striker_mass,
            speed: squared.max(0.0).sqrt(),
            spring,
        }
    }

    /// The contact's tangent at its deepest \[N/m\]: `k_c = n k δⁿ⁻¹` with δ of an impact between free masses, whose energy ½μu² the
    /// spring then stores, k δⁿ⁺¹/(n + 1). `struck` is the effective mass at the struck point \[kg\]. None for a contact without stiffness,
    /// or one that never closes.
    #[must_use]
    pub fn contact_stiffness(&self, struck: f64) -> Option<f64> {
        let ContactSpring {
            stiffness,
            exponent,
        } = self.spring.filter(|_| self.speed > 0.0)?;
        let reduced_mass = super::reduced_mass(struck, self.striker_mass);
        let energy = 0.5 * (exponent + 1.0) * reduced_mass * self.speed * self.speed;
        let deepest = (energy / stiffness).powf(1.0 / (exponent + 1.0));
        Some(exponent * stiffness * deepest.powf(exponent - 1.0))
    }

    /// Critical time step of one struck degree of freedom \[s\]: a tenth of its period (Melo et al. 2006, eq. 7). For a contact of finite
    /// stiffness it is a tenth of the shorter period of mass \[kg\] and striker on the spring \[N/m\] and that of the contact: with a =
    /// (K + `k_c`)/M + `k_c`/Ms, ω² = (a + √(a² − 4 K `k_c`/(M Ms)))/2. A longer step would not resolve the impact.
    #[must_use]
    pub fn critical_time_step(&self, mass: f64, stiffness: f64) -> f64 {
        let alone = critical_time_step(mass, stiffness);
        let Some(contact) = self.contact_stiffness(mass) else {
            return alone;
        };
        let sum = (stiffness + contact) / mass + contact / self.striker_mass;
        let product = stiffness / mass * (contact / self.striker_mass);
        let highest = 0.5 * (sum + (sum * sum - 4.0 * product).max(0.0).sqrt());
        alone.min(critical_time_step(1.0, highest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::Damping;
    use crate::structure::frame::Frame;
    use crate::structure::frame_properties::FrameProperties;

    const fn hertz(stiffness: f64) -> ContactSpring {
        ContactSpring {
            stiffness,
            exponent: 1.5,
        }
    }

    const HARD: Approach = Approach {
        striker_mass: 10.0,
        speed: 1.0,
        spring: Some(hertz(1e9)),
    };

    #[test]
    fn without_a_stiffness_of_the_contact_it_is_that_of_the_structure() {
        for approach in [
            Approach {
                spring: None,
                ..HARD
            },
            Approach { speed: 0.0, ..HARD },
        ] {
            assert_eq!(
                approach.critical_time_step(1.0, 300.0),
                critical_time_step(1.0, 300.0)
            );
        }
    }

    /// A frame of one storey, whose modes are computed differently.
    #[test]
    fn of_one_degree_of_freedom_it_is_that_of_a_frame_of_one_storey() {
        for (mass, stiffness, approach) in [
            (1.0, 300.0, HARD),
            (
                2.0,
                4e5,
                Approach {
                    striker_mass: 0.5,
                    speed: 3.0,
                    spring: Some(hertz(2e8)),
                },
            ),
            (
                1.0,
                4e5,
                Approach {
                    striker_mass: 1.0,
                    speed: 1e-6,
                    spring: Some(hertz(1.0)),
                },
            ),
        ] {
            let frame = Frame::of_matrices(vec![vec![mass]], vec![vec![stiffness]]);
            let properties = FrameProperties::of(&frame, &Damping::None).unwrap();
            let of_frame = properties.critical_on_impact(0, &approach);
            let found = approach.critical_time_step(mass, stiffness);
            assert!((found / of_frame - 1.0).abs() < 1e-12, "{found} {of_frame}");
        }
    }

    /// An impact between free masses lasts 2.943 δ/u (Hertz), and `k_c` gives ω = √(15/8)·u/δ there. It contains 2.943·√(15/8)·200/2π =
    /// 128.3 steps of a twentieth.
    #[test]
    fn a_step_shows_an_impact_on_a_free_mass() {
        let critical = HARD.critical_time_step(1.0, 300.0);
        let reduced = 10.0 / 11.0;
        let lasts = 2.943 * (1.25_f64 * reduced / 1e9).powf(0.4);
        assert!(
            (lasts / (critical / 20.0) - 128.3).abs() < 0.2,
            "{lasts} {critical}"
        );
    }
}
