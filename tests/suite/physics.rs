//! The numerics against closed forms, an independent event-driven solution and the reference results.

mod contact;
mod frame;
mod identification;
mod methods;
mod reference;
mod support;
