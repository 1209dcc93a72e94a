//! Reduces a case that breaks a law. In: a case, the law. Out: a case that breaks the same law with fewer sessions, faults and moves.

use super::case::{Case, Devices, Leg, Test};
use super::frame::FrameTest;
use super::laws::Law;
use super::life::live;

/// Most lives that a reduction takes.
const MOST: usize = 400;

/// The smallest case found that breaks this law.
pub(super) fn shrunk(case: &Case, law: Law) -> Case {
    let mut smallest = case.clone();
    let mut lives = 0;
    'smaller: loop {
        for candidate in smaller(&smallest) {
            lives += 1;
            if lives > MOST {
                return smallest;
            }
            if live(&candidate)
                .breaches
                .iter()
                .any(|breach| breach.law == law)
            {
                smallest = candidate;
                continue 'smaller;
            }
        }
        return smallest;
    }
}

/// Cases with one thing less.
fn smaller(case: &Case) -> Vec<Case> {
    let mut found = Vec::new();
    let mut without = |change: &dyn Fn(&mut Case)| {
        let mut candidate = case.clone();
        change(&mut candidate);
        if candidate != *case {
            found.push(candidate);
        }
    };
    for index in (1..case.sessions.len()).rev() {
        without(&|case| drop(case.sessions.remove(index)));
    }
    for (index, session) in case.sessions.iter().enumerate() {
        for at in 0..session.faults.len() {
            without(&|case| drop(case.sessions[index].faults.remove(at)));
        }
        for at in 0..session.before.len() {
            without(&|case| _ = case.sessions[index].before.remove(at));
        }
        for at in 0..session.amended.len() {
            without(&|case| _ = case.sessions[index].amended.remove(at));
        }
        without(&|case| case.sessions[index].operator.waits = 0);
        without(&|case| case.sessions[index].operator.notes = false);
    }
    // An amendment names a leg or a load by its index.
    match &case.test {
        Test::Moves(legs) => {
            for index in 0..legs.len() {
                let leg = |case: &mut Case, change: &dyn Fn(&mut Leg)| {
                    if let Test::Moves(legs) = &mut case.test {
                        change(&mut legs[index]);
                    }
                };
                without(&|case| leg(case, &|leg| leg.inspected = false));
                without(&|case| leg(case, &|leg| leg.speed = None));
            }
            if legs.len() > 1 {
                without(&|case| {
                    if let Test::Moves(legs) = &mut case.test {
                        legs.pop();
                    }
                });
            }
        }
        Test::Frame(test) => {
            let frame = |case: &mut Case, change: &dyn Fn(&mut FrameTest)| {
                if let Test::Frame(test) = &mut case.test {
                    change(test);
                }
            };
            if test.loads.len() > 1 {
                without(&|case| frame(case, &|test| _ = test.loads.pop()));
            }
            without(&|case| frame(case, &|test| test.weights = false));
            if test.axial.is_some() {
                without(&|case| {
                    frame(case, &|test| *test = test.without_axial());
                    case.axes.pop();
                });
            }
            without(&|case| {
                frame(case, &|test| {
                    test.members
                        .iter_mut()
                        .for_each(|member| member.yields = false);
                });
            });
            without(&|case| frame(case, &|test| *test = test.at_full_scale()));
        }
    }
    for index in 0..case.axes.len() {
        without(&|case| case.axes[index].turned = false);
        without(&|case| case.axes[index].farthest = None);
    }
    without(&|case| case.noise = 0.0);
    without(&|case| case.samples = 1);
    without(&|case| case.unloads = false);
    without(&|case| case.devices = Devices::Native);
    let is_homed = case.axes.iter().any(|axis| axis.start < 0.0);
    if case.devices == Devices::Native || !is_homed {
        without(&|case| {
            case.here = false;
            case.axes.iter_mut().for_each(|axis| axis.start = 0.0);
        });
    }
    found
}
