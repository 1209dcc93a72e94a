//! Measurement uncertainty. An uncertain number is a sum of contributions, one per source, and
//! sources are independent: numbers that share a source are correlated accordingly (JCGM 100:2008,
//! 5.2 and F.1.2.3). In: contributions. Out: standard uncertainties, and results with one source
//! perturbed.

mod cost;
mod degrees;
pub mod engine;
mod instruments;
mod threads;

use crate::plan::formula::{Part, ProcedureId, ResultReference, ResultValue, Results};
pub use degrees::{FEW, Known, MOST_DRAWS, known, known_entries};
pub use instruments::InstrumentUncertainty;

/// Something that is not known exactly, independent of every other source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Source {
    /// What a procedure's own scatter leaves open of a result; of one fitted together with others, what goes beyond those
    /// before it.
    Fit {
        procedure: ProcedureId,
        result: &'static str,
    },
    /// The same of one entry of a list of results.
    FitEntry {
        procedure: ProcedureId,
        result: &'static str,
        entry: usize,
    },
    /// By its place among the plan's strikers.
    StrikerMass(usize),
    StrikerVelocity(usize),
    /// By its place among the plan's specimens.
    SpecimenMass(usize),
    /// The mass of one floor of a frame, both from 0.
    StoreyMass {
        specimen: usize,
        storey: usize,
    },
    /// The stiffness of one storey of a frame, as the plan states it.
    StoreyStiffness {
        specimen: usize,
        storey: usize,
    },
    /// The factor on the matrix of the masses of a frame, as a whole.
    MassMatrix(usize),
    /// The factor on the matrix of its stiffnesses, as a whole.
    StiffnessMatrix(usize),
    /// The computed damping ratio of one mode of a frame, from 0; of Rayleigh damping the one ratio that it has.
    DampingRatio {
        procedure: ProcedureId,
        mode: usize,
    },
    /// The factor on a record of the ground, by its place among the plan's grounds.
    GroundScale(usize),
    /// The factor between newtons and those of the load cell of an axis, by its place; each axis has a cell of its own.
    ForceScale(usize),
    /// The factor between metres and those of the transducer of an axis, by its place.
    DisplacementScale(usize),
    /// What the load cell of an axis, by its place, reads of no force.
    ForceZero(usize),
    /// Noise and resolution of a procedure's readings: one of the draws by which they are sampled.
    Readings {
        procedure: ProcedureId,
        draw: u16,
    },
    /// The same, with the inputs of which there is one a floor, a mode or an axis drawn together with them.
    Drawn {
        procedure: ProcedureId,
        draw: u16,
    },
    /// One of the readings by which the place was found where a specimen rests after a blow of a procedure, from 0, or after
    /// none.
    RestReading {
        procedure: ProcedureId,
        blow: u16,
        reading: u16,
    },
    /// What it still carries there beyond what readings can tell from none.
    RestLoad {
        procedure: ProcedureId,
        blow: u16,
    },
    /// The resolution of a procedure's readings in a fitted result, or in an entry of a list, beyond what its scatter shows.
    Rounding {
        procedure: ProcedureId,
        result: &'static str,
        entry: usize,
    },
    /// The error by their resolution that all readings of a fit have in common.
    CommonRounding {
        procedure: ProcedureId,
    },
    /// The stiffness of the strokes of a damping sweep, which brings readings of a lagging actuator to one place.
    StrokeStiffness {
        procedure: ProcedureId,
    },
    /// The points of the loops of a procedure: what lies between them is not known.
    LoopSampling {
        procedure: ProcedureId,
    },
    /// The time step of an integration, and that times are told to a whole one: the run is integrated again in finer steps.
    TimeStep {
        procedure: ProcedureId,
    },
}

/// What one source does to one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    pub source: Source,
    /// Which number of a list it is of, from 0; 0 of a result that is one number.
    pub entry: usize,
    /// Change of the number when the source moves by its standard uncertainty, in the number's own unit.
    pub amount: f64,
    /// Whether the number follows the source smoothly there. Where it does not, `amount` is the largest change seen.
    pub smooth: bool,
}

impl Contribution {
    #[must_use]
    pub const fn new(source: Source, amount: f64) -> Self {
        Self {
            source,
            entry: 0,
            amount,
            smooth: true,
        }
    }
}

/// What several contributions of one source do to one number is their sum: adds `part` to what `parts` have of its source
/// already.
pub fn share(parts: &mut Vec<Contribution>, part: Contribution) {
    match parts
        .iter_mut()
        .find(|known| known.source == part.source && known.entry == part.entry)
    {
        Some(known) => {
            known.amount += part.amount;
            known.smooth &= part.smooth;
        }
        None => parts.push(part),
    }
}

/// u of each of `count` entries of a list; None where nothing of an entry is uncertain.
#[must_use]
pub fn combined_entries(contributions: &[Contribution], count: usize) -> Vec<Option<f64>> {
    let mut squares = vec![None; count];
    for part in contributions {
        if let Some(square) = squares.get_mut(part.entry) {
            *square = Some(square.unwrap_or(0.0) + part.amount * part.amount);
        }
    }
    squares
        .into_iter()
        .map(|square: Option<f64>| square.map(f64::sqrt))
        .collect()
}

/// u = √Σ cᵢ² of independent contributions to one number (JCGM 100:2008, eq. 10); None of nothing.
#[must_use]
pub fn combined(contributions: &[Contribution]) -> Option<f64> {
    let variance = contributions
        .iter()
        .map(|part| part.amount * part.amount)
        .reduce(|sum, square| sum + square)?;
    Some(variance.sqrt())
}

/// Results as they would be with one source moved.
pub struct Moved<'a> {
    pub results: &'a dyn Results,
    pub source: Source,
    /// In standard uncertainties of the source.
    pub by: f64,
}

impl Results for Moved<'_> {
    fn result(&self, reference: ResultReference) -> Option<ResultValue> {
        let found = self.results.result(reference)?;
        if reference.part != Part::Value {
            return Some(found);
        }
        let parts = self.results.contributions(reference);
        let mine = parts.iter().filter(|part| part.source == self.source);
        Some(match found {
            ResultValue::Number {
                value: Some(value),
                uncertainty,
            } => {
                let value = mine.fold(value, |value, part| value + self.by * part.amount);
                ResultValue::Number {
                    value: Some(value),
                    uncertainty,
                }
            }
            ResultValue::List(mut values) => {
                for part in mine {
                    if let Some(value) = values.get_mut(part.entry) {
                        *value += self.by * part.amount;
                    }
                }
                ResultValue::List(values)
            }
            none @ ResultValue::Number { .. } => none,
        })
    }

    fn moved(&self, source: Source) -> f64 {
        self.results.moved(source) + if source == self.source { self.by } else { 0.0 }
    }

    fn contributions(&self, reference: ResultReference) -> Vec<Contribution> {
        self.results.contributions(reference)
    }

    fn degrees(&self, source: Source) -> f64 {
        self.results.degrees(source)
    }

    fn no_uncertainty(&self, reference: ResultReference) -> Option<String> {
        self.results.no_uncertainty(reference)
    }
}

/// Every source of the results that are read, each once, in the order they are met.
#[must_use]
pub fn sources_of(references: &[ResultReference], results: &dyn Results) -> Vec<Source> {
    let mut sources = Vec::new();
    for reference in references
        .iter()
        .filter(|reference| reference.part == Part::Value)
    {
        for part in results.contributions(*reference) {
            if part.amount != 0.0 && !sources.contains(&part.source) {
                sources.push(part.source);
            }
        }
    }
    sources
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::formula::{Formula, Operator};

    /// Slope and intercept of one line, and a number of its own.
    struct OneLine;

    const CORRELATION: f64 = -0.8;

    const fn reference(name: &'static str) -> ResultReference {
        ResultReference {
            procedure: ProcedureId(0),
            name,
            part: Part::Value,
        }
    }

    const fn source(result: &'static str) -> Source {
        Source::Fit {
            procedure: ProcedureId(0),
            result,
        }
    }

    impl Results for OneLine {
        fn result(&self, reference: ResultReference) -> Option<ResultValue> {
            let (value, uncertainty) = match reference.name {
                "stiffness" => (100.0, 2.0),
                "intercept_force" => (5.0, 0.5),
                _ => (7.0, 0.3),
            };
            Some(ResultValue::Number {
                value: Some(value),
                uncertainty: Some(uncertainty),
            })
        }

        fn contributions(&self, reference: ResultReference) -> Vec<Contribution> {
            match reference.name {
                "stiffness" => vec![Contribution::new(source("stiffness"), 2.0)],
                "intercept_force" => vec![
                    Contribution::new(source("stiffness"), 0.5 * CORRELATION),
                    Contribution::new(source("intercept_force"), 0.5 * 0.6),
                ],
                name => vec![Contribution::new(source(name), 0.3)],
            }
        }
    }

    /// R = K·x + R₀ at x: u² = x²u(K)² + u(R₀)² + 2x·r·u(K)·u(R₀) (JCGM 100:2008, eq. 16), not their plain sum.
    #[test]
    fn numbers_of_one_fit_are_correlated() {
        let line = |x: f64| {
            let slope = Formula::Binary(
                Operator::Multiply,
                Box::new(Formula::Result(reference("stiffness"))),
                Box::new(Formula::Constant(x)),
            );
            Formula::Binary(
                Operator::Add,
                Box::new(slope),
                Box::new(Formula::Result(reference("intercept_force"))),
            )
        };
        for x in [0.0, 0.1, 0.2, 1.0] {
            let by_hand = (4.0 * x * x + 0.25 + 2.0 * x * CORRELATION * 2.0 * 0.5_f64).sqrt();
            let u = line(x)
                .evaluate(&OneLine, None)
                .unwrap()
                .uncertainty
                .unwrap();
            assert!((u - by_hand).abs() < 1e-12, "at {x}: {u} {by_hand}");
        }
        // And independent of others.
        let other = Formula::Binary(
            Operator::Add,
            Box::new(line(0.0)),
            Box::new(Formula::Result(reference("mass"))),
        );
        let u = other.evaluate(&OneLine, None).unwrap().uncertainty.unwrap();
        assert!((u - 0.5_f64.hypot(0.3)).abs() < 1e-12);
    }

    /// Σ over one source before the square, each entry of a list for itself.
    #[test]
    fn what_shares_a_source_adds_up_entry_by_entry() {
        let of = |entry, amount| Contribution {
            entry,
            ..Contribution::new(source("stiffness"), amount)
        };
        let mut parts = Vec::new();
        for part in [
            of(0, 3.0),
            of(1, 1.0),
            of(0, 1.0),
            Contribution::new(source("mass"), 3.0),
        ] {
            share(&mut parts, part);
        }
        assert_eq!(parts.len(), 3);
        assert_eq!(combined_entries(&parts, 3), [Some(5.0), Some(1.0), None]);
    }

    #[test]
    fn a_moved_source_moves_what_it_is_in_and_nothing_else() {
        let moved = Moved {
            results: &OneLine,
            source: source("stiffness"),
            by: -0.5,
        };
        let value = |name| match moved.result(reference(name)) {
            Some(ResultValue::Number {
                value: Some(value), ..
            }) => value,
            other => panic!("{other:?}"),
        };
        assert_eq!(
            (value("stiffness"), value("intercept_force"), value("mass")),
            (99.0, 5.2, 7.0)
        );
        assert_eq!(
            sources_of(
                &[reference("intercept_force"), reference("stiffness")],
                &OneLine
            )
            .len(),
            2
        );
        assert_eq!(combined(&[]), None);
    }
}
