//! The numerics against closed forms, an independent event-driven solution and the reference results.

mod contact;
mod falling;
mod identification;
mod reference;
mod support;
