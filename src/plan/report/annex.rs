//! The annexes of a report, as a plan requests them.

/// An annex of the report, in the order of a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Annex {
    Results,
    Budgets,
    Figures,
    Equipment,
    Provenance,
    Plan,
}

impl Annex {
    pub const ALL: [Self; 6] = [
        Self::Results,
        Self::Budgets,
        Self::Figures,
        Self::Equipment,
        Self::Provenance,
        Self::Plan,
    ];
    /// The annexes of a report that names none: the text of the plan is in the run folder, and attached to the PDF.
    pub const DEFAULT: [Self; 5] = [
        Self::Results,
        Self::Budgets,
        Self::Figures,
        Self::Equipment,
        Self::Provenance,
    ];

    /// The name in the language.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Results => "results",
            Self::Budgets => "budgets",
            Self::Figures => "figures",
            Self::Equipment => "equipment",
            Self::Provenance => "provenance",
            Self::Plan => "plan",
        }
    }
}
