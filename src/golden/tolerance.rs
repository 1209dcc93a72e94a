//! Tolerances of a comparison. In: the plan's `golden` block. Out: a [`Rule`] for each result, column and figure.

use psd_plan::formula::ProcedureId;
use psd_plan::{Golden, Plan, Tolerance};
use psd_text::units::Dimension;

/// Smallest difference that is detected, SI: a picometre, a piconewton, a picosecond, and 10⁻¹² for a plain number. A value that should
/// be 0 is rarely exactly 0. With `tolerance = 0` there is no such floor.
pub const FLOOR: f64 = 1e-12;

/// A difference is within tolerance if it satisfies either bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    /// Relative to the absolute value of the number; for a column, to its largest.
    pub relative: f64,
    /// SI.
    pub absolute: f64,
}

impl Rule {
    /// The largest allowed difference of a number of this scale, SI.
    #[must_use]
    pub fn bound(self, scale: f64) -> f64 {
        self.absolute.max(self.relative * scale)
    }

    /// The rule for numbers of this scale, SI.
    #[must_use]
    pub fn at_scale(self, scale: f64) -> ScaledRule {
        ScaledRule {
            bound: self.bound(scale),
        }
    }

    fn or(self, other: Self) -> Self {
        Self {
            relative: self.relative.max(other.relative),
            absolute: self.absolute.max(other.absolute),
        }
    }
}

/// A rule for numbers of one scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledRule {
    /// The largest allowed difference, SI.
    bound: f64,
}

impl ScaledRule {
    /// Whether two numbers are within the tolerance. NaN matches only NaN.
    #[must_use]
    pub fn is_near(self, was: f64, is: f64) -> bool {
        was == is || (was.is_nan() && is.is_nan()) || (was - is).abs() <= self.bound
    }
}

/// The tolerances of one plan, by the names of its procedures.
#[derive(Clone, Debug, Default)]
pub struct Tolerances {
    golden: Golden,
    procedures: Vec<String>,
}

impl Tolerances {
    #[must_use]
    pub fn of(plan: &Plan) -> Self {
        Self {
            golden: plan.golden.clone(),
            procedures: plan.procedures.iter().map(|p| p.name.clone()).collect(),
        }
    }

    /// The rule of every number without a separate tolerance.
    #[must_use]
    pub fn general(&self) -> Rule {
        let relative = self.golden.tolerance;
        Rule {
            relative,
            absolute: if relative > 0.0 { FLOOR } else { 0.0 },
        }
    }

    fn rule(&self, tolerance: Tolerance) -> Rule {
        let general = self.general();
        match tolerance {
            Tolerance::Absolute(absolute) => Rule {
                absolute: absolute.max(general.absolute),
                ..general
            },
            Tolerance::Relative(relative) => Rule {
                relative,
                ..general
            },
        }
    }

    fn is(&self, procedure: ProcedureId, name: &str) -> bool {
        let Some(known) = self.procedures.get(procedure.0) else {
            return false;
        };
        // A procedure may have a second table, for example `loop_cycles` beside `loop`.
        let second = || {
            name.strip_prefix(known.as_str())
                .is_some_and(|rest| rest.starts_with('_'))
        };
        known == name || (second() && !self.procedures.iter().any(|other| other == name))
    }

    #[must_use]
    pub fn result(&self, procedure: &str, name: &str) -> Rule {
        let near = self
            .golden
            .results
            .iter()
            .find(|near| near.name == name && self.is(near.procedure, procedure));
        near.map_or_else(|| self.general(), |near| self.rule(near.tolerance))
    }

    /// The rule for a column of one procedure has priority over the rule for all.
    #[must_use]
    pub fn column(&self, procedure: &str, name: &str) -> Rule {
        let named = || self.golden.columns.iter().filter(|near| near.name == name);
        let own = named().find(|near| near.procedure.is_some_and(|of| self.is(of, procedure)));
        let near = own.or_else(|| named().find(|near| near.procedure.is_none()));
        near.map_or_else(|| self.general(), |near| self.rule(near.tolerance))
    }

    /// The rule of values that follow from results: the widest tolerance of a result of this dimension.
    #[must_use]
    pub fn follows(&self, dimension: Dimension) -> Rule {
        let of = self
            .golden
            .results
            .iter()
            .filter(|near| near.dimension == dimension);
        of.fold(self.general(), |rule, near| {
            rule.or(self.rule(near.tolerance))
        })
    }

    /// An axis of a figure shows columns and results: the widest tolerance of those of its procedure and dimension.
    #[must_use]
    pub fn axis(&self, procedure: &str, dimension: Dimension) -> Rule {
        let results = self
            .golden
            .results
            .iter()
            .filter(|near| near.dimension == dimension && self.is(near.procedure, procedure));
        let columns = self
            .golden
            .columns
            .iter()
            .filter(|near| near.dimension == dimension);
        let columns = columns.filter(|near| near.procedure.is_none_or(|of| self.is(of, procedure)));
        let tolerances = results
            .map(|near| near.tolerance)
            .chain(columns.map(|near| near.tolerance));
        tolerances.fold(self.general(), |rule, tolerance| {
            rule.or(self.rule(tolerance))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_plan::{ColumnTolerance, ResultTolerance};

    fn tolerances(tolerance: f64) -> Tolerances {
        let force = |procedure, tolerance| ColumnTolerance {
            procedure,
            name: "restoring_force_n",
            dimension: Dimension::FORCE,
            tolerance,
        };
        let golden = Golden {
            tolerance,
            results: vec![ResultTolerance {
                procedure: ProcedureId(1),
                name: "max_force",
                dimension: Dimension::FORCE,
                tolerance: Tolerance::Absolute(2.0),
            }],
            columns: vec![
                force(None, Tolerance::Absolute(0.1)),
                force(Some(ProcedureId(0)), Tolerance::Relative(1e-3)),
            ],
        };
        Tolerances {
            golden,
            procedures: vec!["k0".to_owned(), "hit".to_owned()],
        }
    }

    #[test]
    fn near_is_what_is_near_by_either_measure() {
        let rule = Rule {
            relative: 1e-3,
            absolute: 0.5,
        };
        assert!(
            rule.at_scale(1001.0).is_near(1000.0, 1001.0)
                && !rule.at_scale(1001.1).is_near(1000.0, 1001.1)
        );
        assert!(rule.at_scale(0.5).is_near(0.0, -0.5) && !rule.at_scale(0.51).is_near(0.0, 0.51));
        assert!(
            rule.at_scale(0.0).is_near(f64::NAN, f64::NAN)
                && !rule.at_scale(1.0).is_near(f64::NAN, 0.0)
        );
        let exact = tolerances(0.0).general();
        assert!(
            exact.at_scale(1.0).is_near(1.0, 1.0)
                && !exact.at_scale(1.0).is_near(1.0, 1.0 + f64::EPSILON)
        );
    }

    #[test]
    fn a_name_of_one_procedure_goes_before_that_of_all_and_a_figure_takes_the_widest() {
        let tolerances = tolerances(1e-9);
        assert_eq!(
            tolerances.column("k0", "restoring_force_n"),
            Rule {
                relative: 1e-3,
                absolute: FLOOR
            }
        );
        assert_eq!(
            tolerances.column("hit", "restoring_force_n"),
            Rule {
                relative: 1e-9,
                absolute: 0.1
            }
        );
        assert_eq!(tolerances.column("hit", "time_s"), tolerances.general());
        assert_eq!(tolerances.result("hit", "max_force").absolute, 2.0);
        assert_eq!(tolerances.result("k0", "max_force"), tolerances.general());
        assert_eq!(
            tolerances.axis("k0", Dimension::FORCE),
            Rule {
                relative: 1e-3,
                absolute: 0.1
            }
        );
        assert_eq!(
            tolerances.axis("hit", Dimension::FORCE),
            Rule {
                relative: 1e-9,
                absolute: 2.0
            }
        );
        assert_eq!(
            tolerances.axis("hit", Dimension::LENGTH),
            tolerances.general()
        );
        assert_eq!(tolerances.follows(Dimension::FORCE).absolute, 2.0);
    }
}
