//! Formulas: values, and uncertainty to first order.

use super::*;

struct One;
impl Results for One {
    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        (reference.name == "stiffness").then_some(ResultValue::Number {
            value: Some(100.0),
            uncertainty: Some(2.0),
        })
    }
}

fn stiffness() -> Formula {
    Formula::Result(ResultReference {
        procedure: ProcedureId(0),
        name: "stiffness",
        part: ResultPart::Value,
    })
}

#[test]
fn uncertainty_is_propagated_to_first_order() {
    let half = Formula::Binary(
        Operator::Divide,
        Box::new(stiffness()),
        Box::new(Formula::Constant(2.0)),
    );
    assert_eq!(
        half.evaluate(&One, None),
        Ok(Estimate {
            value: 50.0,
            uncertainty: Some(1.0)
        })
    );
    let root = Formula::Call(Function::Sqrt, vec![stiffness()])
        .evaluate(&One, None)
        .unwrap();
    assert!((root.uncertainty.unwrap() - 0.1).abs() < 1e-4);
    let difference = Formula::Binary(
        Operator::Subtract,
        Box::new(stiffness()),
        Box::new(stiffness()),
    );
    assert_eq!(
        difference.evaluate(&One, None),
        Ok(Estimate {
            value: 0.0,
            uncertainty: Some(0.0)
        })
    );
}

/// d(ln x) = dx/x, de^x = e^x dx, d√(x² + 75²) = x/√(x² + 75²) dx at 100 ± 2: 1/50, and 4/5 of 2.
#[test]
fn logarithm_and_hypotenuse_propagate_their_slopes() {
    let of = |function, arguments| {
        Formula::Call(function, arguments)
            .evaluate(&One, None)
            .unwrap()
    };
    let log = of(Function::Log, vec![stiffness()]);
    assert!((log.value - 100.0_f64.ln()).abs() < 1e-15);
    assert!((log.uncertainty.unwrap() - 0.02).abs() < 1e-5);
    let hypot = of(Function::Hypot, vec![stiffness(), Formula::Constant(75.0)]);
    assert_eq!(hypot.value, 125.0);
    assert!((hypot.uncertainty.unwrap() - 1.6).abs() < 1e-3);
    let one = |function, x: f64| of(function, vec![Formula::Constant(x)]).value;
    assert_eq!(one(Function::Exp, 0.0), 1.0);
    assert!((one(Function::Tan, std::f64::consts::FRAC_PI_4) - 1.0).abs() < 1e-15);
}

/// ½mv² of m = 20 ± 0.1 kg and v = 1 ± 0.01 m/s: u = √((½v²u_m)² + (mv·u_v)²). A number minus itself has zero uncertainty.
#[test]
fn a_stated_number_carries_its_uncertainty() {
    let of = |source, value, uncertainty| {
        Stated {
            source,
            value,
            uncertainty,
        }
        .formula()
    };
    let times =
        |a: Formula, b: Formula| Formula::Binary(Operator::Multiply, Box::new(a), Box::new(b));
    let (mass, velocity) = (
        of(Source::StrikerMass(0), 20.0, 0.1),
        of(Source::StrikerVelocity(0), 1.0, 0.01),
    );
    let energy = times(
        times(Formula::Constant(0.5), mass),
        times(velocity.clone(), velocity),
    );
    let found = energy.evaluate(&NoResults, None).unwrap();
    assert_eq!((found.value, energy.constant()), (10.0, Some(10.0)));
    assert!((found.uncertainty.unwrap() - 0.05_f64.hypot(0.2)).abs() < 1e-12);
    let nothing = Formula::Binary(
        Operator::Subtract,
        Box::new(energy.clone()),
        Box::new(energy),
    );
    assert_eq!(
        nothing.evaluate(&NoResults, None),
        Ok(Estimate {
            value: 0.0,
            uncertainty: Some(0.0)
        })
    );
    assert_eq!(
        of(Source::StrikerMass(0), 20.0, 0.0),
        Formula::Constant(20.0)
    );
}

/// abs(K − 99.9) with K = 100 ± 2: it increases by nearly 2 for either sign of the perturbation, and half of their difference is nearly zero.
#[test]
fn what_folds_within_its_uncertainty_is_as_uncertain_as_what_is_folded() {
    let off = |by: f64| {
        let off = Formula::Binary(
            Operator::Subtract,
            Box::new(stiffness()),
            Box::new(Formula::Constant(by)),
        );
        Formula::Call(Function::Abs, vec![off])
            .evaluate(&One, None)
            .unwrap()
            .uncertainty
            .unwrap()
    };
    assert!(
        (off(99.9) - 2.0).abs() < 1e-12
            && (off(100.0) - 2.0).abs() < 1e-12
            && (off(90.0) - 2.0).abs() < 1e-12
    );
}

#[test]
fn a_result_that_does_not_exist_is_an_error_and_so_is_a_division_by_zero() {
    assert_eq!(
        stiffness().evaluate(&NoResults, None),
        Err(FormulaError::Missing("stiffness"))
    );
    let zero = Formula::Binary(
        Operator::Divide,
        Box::new(stiffness()),
        Box::new(Formula::Constant(0.0)),
    );
    assert_eq!(zero.evaluate(&One, None), Err(FormulaError::NotFinite));
}
