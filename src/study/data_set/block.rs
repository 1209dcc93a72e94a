//! Rows of a data set. In: what one run had and gave. Out: the row, and many rows column by column. It knows no file.

/// How a run ends for one requirement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Its condition holds.
    Met,
    NotMet,
    /// The run has no value to compare.
    NoResult,
}

impl Outcome {
    const ALL: [Self; 3] = [Self::Met, Self::NotMet, Self::NoResult];

    /// The word in the file.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Met => "met",
            Self::NotMet => "not_met",
            Self::NoResult => "no_result",
        }
    }

    pub(super) fn of_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|outcome| outcome.word() == word)
    }
}

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyRow {
    pub run: u64,
    /// In the order of the metadata, SI.
    pub inputs: Vec<f64>,
    /// None: the result does not exist in this run.
    pub results: Vec<Option<f64>>,
    /// One for each requirement.
    pub outcomes: Vec<Outcome>,
    /// Why a result does not exist, or the run is invalid.
    pub reason: Option<String>,
}

/// Consecutive runs, column by column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    /// Number of the first run.
    pub first: u64,
    /// One list for each input.
    pub inputs: Vec<Vec<f64>>,
    pub results: Vec<Vec<Option<f64>>>,
    pub outcomes: Vec<Vec<Outcome>>,
    /// One for each run.
    pub reasons: Vec<Option<String>>,
}

impl Block {
    /// Without rows, and with as many columns as the other one.
    #[must_use]
    pub(super) fn like(first: u64, inputs: usize, results: usize, requirements: usize) -> Self {
        Self {
            first,
            inputs: vec![Vec::new(); inputs],
            results: vec![Vec::new(); results],
            outcomes: vec![Vec::new(); requirements],
            reasons: Vec::new(),
        }
    }

    /// Number of runs.
    #[must_use]
    pub fn len(&self) -> usize {
        self.reasons.len()
    }

    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.reasons.is_empty()
    }

    /// Number of the run after the last one.
    #[must_use]
    pub fn end(&self) -> u64 {
        self.first + self.len() as u64
    }

    /// The rows of the block.
    pub fn rows(&self) -> impl Iterator<Item = StudyRow> + '_ {
        (0..self.len()).map(|at| self.row(at))
    }

    /// One row of the block.
    ///
    /// # Panics
    /// If the block has no such row.
    #[must_use]
    pub fn row(&self, at: usize) -> StudyRow {
        StudyRow {
            run: self.first + at as u64,
            inputs: self.inputs.iter().map(|column| column[at]).collect(),
            results: self.results.iter().map(|column| column[at]).collect(),
            outcomes: self.outcomes.iter().map(|column| column[at]).collect(),
            reason: self.reasons[at].clone(),
        }
    }

    /// Why the row cannot follow, if it cannot.
    pub(super) fn refuses(&self, row: &StudyRow) -> Option<String> {
        let expected = self.end();
        if row.run != expected {
            return Some(format!("run {expected} is next, not run {}", row.run));
        }
        let found = [row.inputs.len(), row.results.len(), row.outcomes.len()];
        let columns = [self.inputs.len(), self.results.len(), self.outcomes.len()];
        if found != columns {
            return Some(format!(
                "run {} has {found:?} inputs, results and outcomes, the data set {columns:?}",
                row.run
            ));
        }
        let results = row.results.iter().flatten();
        let wrong = row.inputs.iter().chain(results).find(|v| !v.is_finite());
        wrong.map(|value| format!("run {} has the value {value}", row.run))
    }

    /// Adds a row that is not refused.
    pub(super) fn push(&mut self, row: &StudyRow) {
        fn add<T: Copy>(columns: &mut [Vec<T>], values: &[T]) {
            for (column, value) in columns.iter_mut().zip(values) {
                column.push(*value);
            }
        }
        add(&mut self.inputs, &row.inputs);
        add(&mut self.results, &row.results);
        add(&mut self.outcomes, &row.outcomes);
        self.reasons.push(row.reason.clone());
    }

    /// The next block, with room for as many rows, and this one without any.
    pub(super) fn clear(&mut self) {
        self.first = self.end();
        self.inputs.iter_mut().for_each(Vec::clear);
        self.results.iter_mut().for_each(Vec::clear);
        self.outcomes.iter_mut().for_each(Vec::clear);
        self.reasons.clear();
    }
}
