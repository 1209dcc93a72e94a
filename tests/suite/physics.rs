//! The numerical methods, compared with closed forms, an independent event-driven solution and the reference results.

mod contact;
mod falling;
mod frame;
mod identification;
mod methods;
mod portal;
mod portal_limit;
mod portal_mass;
mod reference;
mod relaxation;
mod specimens;
mod support;
mod tracking;
