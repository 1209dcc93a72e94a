//! `cycle`: displacement cycles, amplitude by amplitude. In: its block, a rig behind the guard.
//! Out: parameters, history, energies and stiffnesses of the cycles, tables, figures, report text.

pub(crate) mod check;
pub(crate) mod declared_cycles;
pub(crate) mod facts;
pub(crate) mod figures;
pub(crate) mod report;
pub(crate) mod results;
pub(crate) mod run;
pub(crate) mod tables;
pub(crate) mod uncertainty;
