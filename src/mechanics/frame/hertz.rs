//! Hunt and Crossley's contact of finite stiffness on one floor of a frame (`law::HertzContact`), followed in parts of a
//! step by the midpoint rule with vectors: it keeps the energy balance to rounding whatever the force is. In: a frame at a
//! step's start. Out: frame and striker at its end.

use super::passage::{Passage, Passed, Start, Striker};
use super::schemes::Course;
use crate::mechanics::contact::StepState;
use crate::mechanics::law::{Closing, HertzContact};

/// The step from `from`, whose end goes into `to`.
pub(super) fn pass(
    law: &HertzContact,
    passage: &mut Passage,
    striker: Striker,
    start: &Start,
    from: Course,
    to: &mut Course,
) -> Passed {
    apart(passage, striker, start, &from, to).unwrap_or_else(|| follow(law, passage, striker, start, from, to))
}

/// Eq. (5), if the surfaces stay apart.
fn apart(passage: &mut Passage, striker: Striker, start: &Start, from: &Course, to: &mut Course) -> Option<Passed> {
    let time_step = passage.frame.time_step;
    if start.displacement + start.indentation - start.striker_displacement < 0.0 {
        return None;
    }
    passage.follow(from, time_step, 1.0, None, to);
    let striker_velocity = start.striker_velocity + striker.gravity * time_step;
    let striker_displacement = start.striker_displacement + 0.5 * time_step * (start.striker_velocity + striker_velocity);
    if to.displacement[striker.struck] + start.indentation - striker_displacement < 0.0 {
        return None;
    }
    let mean: Vec<f64> = from.velocity.iter().zip(&to.velocity).map(|(from, to)| 0.5 * (from + to)).collect();
    Some(Passed {
        structure: (),
        striker_displacement,
        striker_velocity,
        state: StepState::Free,
        contact_force: 0.0,
        indentation: start.indentation,
        contact_loss: 0.0,
        damping_work: passage.damped(&mean, time_step),
        indentation_work: 0.0,
        contacts: 0,
    })
}

fn follow(law: &HertzContact, passage: &mut Passage, striker: Striker, start: &Start, from: Course, to: &mut Course) -> Passed {
    let Striker { struck, mass, gravity } = striker;
    let time_step = passage.frame.time_step;
    let parts = law.parts(time_step);
    let duration = time_step / parts;
    let half = 0.5 * duration;
    passage.prepare(duration, None);
    // M̂⁻¹ e_s: how the floors yield to a force on the struck one.
    let mut response = vec![0.0; passage.push.len()];
    response[struck] = 1.0;
    passage.solve(&mut response);
    let yielding = duration * half * (1.0 / mass + response[struck]);
    let mut now = from;
    let mut mean = vec![0.0; response.len()];
    let mut passed = Passed {
        structure: (),
        striker_displacement: start.striker_displacement,
        striker_velocity: start.striker_velocity,
        state: StepState::Free,
        contact_force: 0.0,
        indentation: start.indentation,
        contact_loss: 0.0,
        damping_work: 0.0,
        indentation_work: 0.0,
        contacts: 0,
    };
    let (mut impulse, mut limited, mut done) = (0.0, false, 0.0);
    let mut closing = Closing::new(start.striker_displacement - now.displacement[struck] - start.indentation);
    while done < parts {
        let middle = (done + 0.5) / parts;
        done += 1.0;
        let depth = passed.striker_displacement - now.displacement[struck] - passed.indentation;
        // M̂ v = M Ẋ + ½h(f − R): the velocity in the middle of the part, before the contact pushes.
        passage.frame.matrices.mass.mul_into(&now.velocity, &mut mean);
        for (degree, (mean, force)) in mean.iter_mut().zip(&now.force).enumerate() {
            *mean += half * (passage.load(degree, middle) - force);
        }
        passage.solve(&mut mean);
        let falling = passed.striker_velocity + half * gravity;
        let way = duration * (falling - mean[struck]);
        let (force, over) = law.force(depth, way, yielding, duration);
        limited |= over;
        let mean_striker = falling - half * force / mass;
        for (degree, mean) in mean.iter_mut().enumerate() {
            *mean += half * force * response[degree];
            to.displacement[degree] = now.displacement[degree] + duration * *mean;
            to.velocity[degree] = 2.0 * *mean - now.velocity[degree];
        }
        passage.spring(&now, to);
        std::mem::swap(&mut now, to);
        passed.striker_displacement += duration * mean_striker;
        passed.striker_velocity = 2.0 * mean_striker - passed.striker_velocity;
        impulse += force * duration;
        passed.contact_loss += force * duration * (mean_striker - mean[struck]);
        passed.damping_work += passage.damped(&mean, duration);
        if over {
            passed.indentation = passed.indentation.max(law.dent(passed.striker_displacement - now.displacement[struck]));
        }
        closing.take(force, passed.striker_displacement - now.displacement[struck] - passed.indentation);
    }
    passed.contacts = closing.contacts;
    let depth = passed.striker_displacement - now.displacement[struck] - passed.indentation;
    let force = law.instant(depth, passed.striker_velocity - now.velocity[struck]);
    std::mem::swap(&mut now, to);
    passage.settle(struck, force, 1.0, to);
    passed.state = match (limited, impulse > 0.0) {
        (true, _) => StepState::Limit,
        (false, true) => StepState::Contact,
        (false, false) => StepState::Free,
    };
    passed.contact_force = law.bounded(impulse / time_step);
    passed.indentation_work = if limited { law.bounded(f64::INFINITY) * (passed.indentation - start.indentation) } else { 0.0 };
    passed
}
