//! Reduces a case that breaks a law. In: a case, the law. Out: a case that breaks the same law with fewer sessions, faults and moves.

use super::case::{Case, Devices};
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
    // An amendment names a leg by its index.
    if case.legs.len() > 1 {
        without(&|case| _ = case.legs.pop());
    }
    for index in 0..case.legs.len() {
        without(&|case| case.legs[index].inspected = false);
        without(&|case| case.legs[index].speed = None);
    }
    without(&|case| case.noise = 0.0);
    without(&|case| case.samples = 1);
    without(&|case| case.turned = false);
    without(&|case| case.unloads = false);
    without(&|case| (case.devices, case.here) = (Devices::Native, None));
    without(&|case| {
        if matches!(
            case.devices,
            Devices::Native | Devices::Instron | Devices::Modbus(_)
        ) {
            case.here = None;
        }
    });
    found
}
