//! Checks and simulations beside the loop, so that no answer waits for one. In: the plans and the documents of one moment. Out: what was
//! found, as events of the loop. Only the newest order is carried out.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, Sender};

use lsp_server::Message;
use psd_plan::Plan;

use crate::documents::Snapshot;
use crate::fixes::{self, Fix};
use crate::uri::file_name;
use crate::{Checked, Program, Simulation};

/// Bytes of the stack of a check: a walk over a value of the largest allowed size needs more than the default.
const STACK_BYTES: usize = 16 << 20;

/// An order to check plans.
pub struct Order {
    /// Number of changes of the documents before it.
    pub revision: u64,
    pub plans: Vec<String>,
    pub documents: Snapshot,
}

/// An order to simulate a plan.
pub struct SimulationOrder {
    pub plan_key: String,
    pub revision: u64,
    pub plan: Arc<Plan>,
}

/// What the loop waits for.
pub enum Event {
    Message(Message),
    Found(Found),
    /// The editor is gone.
    Closed,
}

/// What was found.
pub enum Found {
    Checked {
        plan_key: String,
        revision: u64,
        /// None if the check failed by a panic.
        checked: Option<Box<Checked>>,
    },
    /// The fixes of its diagnostics, which were tried.
    Fixes {
        plan_key: String,
        revision: u64,
        fixes: Vec<Fix>,
    },
    Simulated {
        plan_key: String,
        revision: u64,
        /// None if the simulation failed by a panic.
        simulation: Option<Simulation>,
    },
}

/// The two threads.
pub struct Background {
    checks: Sender<Order>,
    simulations: Sender<SimulationOrder>,
}

impl Background {
    /// Starts the threads; they end with it.
    pub fn start(program: &Arc<dyn Program>, found: &Sender<Event>) -> Self {
        let (checks, orders) = mpsc::channel();
        let (own, to) = (Arc::clone(program), found.clone());
        spawn(move || check_all(&orders, own.as_ref(), &to));
        let (simulations, orders) = mpsc::channel();
        let (own, to) = (Arc::clone(program), found.clone());
        spawn(move || simulate_all(&orders, own.as_ref(), &to));
        Self {
            checks,
            simulations,
        }
    }

    pub fn check(&self, order: Order) {
        let _ = self.checks.send(order);
    }

    pub fn simulate(&self, order: SimulationOrder) {
        let _ = self.simulations.send(order);
    }
}

fn spawn(work: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(STACK_BYTES);
    // Without the thread the server answers all that needs no check.
    let _ = thread.spawn(work);
}

fn check_all(orders: &Receiver<Order>, program: &dyn Program, found: &Sender<Event>) {
    let mut newer = None;
    while let Some(order) = newer.take().or_else(|| orders.recv().ok()) {
        let order = orders.try_iter().last().unwrap_or(order);
        let Order {
            revision,
            documents,
            plans,
        } = order;
        let mut tried = Vec::new();
        for plan_key in plans {
            let checked = protected(|| check(program, &documents, &plan_key)).flatten();
            let diagnostics = checked
                .as_ref()
                .map(|checked| (checked.diagnostics.clone(), checked.sources.clone()));
            tried.push((plan_key.clone(), diagnostics));
            let checked = checked.map(Box::new);
            let event = Found::Checked {
                plan_key,
                revision,
                checked,
            };
            if found.send(Event::Found(event)).is_err() {
                return;
            }
        }
        for (plan_key, diagnostics) in tried {
            let mut fixes = Vec::new();
            if let Some((diagnostics, sources)) = diagnostics {
                newer = newer.or_else(|| orders.try_recv().ok());
                if newer.is_some() {
                    break;
                }
                let name = file_name(&plan_key);
                let loader = |file: &str| documents.load(&plan_key, file);
                let plan = fixes::Plan {
                    name: &name,
                    diagnostics: &diagnostics,
                    sources: &sources,
                    loader: &loader,
                };
                let find = || fixes::tried_fixes(program, &plan);
                fixes = protected(find).unwrap_or_default();
            }
            let event = Found::Fixes {
                plan_key,
                revision,
                fixes,
            };
            let _ = found.send(Event::Found(event));
        }
    }
}

fn check(program: &dyn Program, documents: &Snapshot, plan_key: &str) -> Option<Checked> {
    let text = documents.text(plan_key)?;
    let loader = |file: &str| documents.load(plan_key, file);
    Some(program.check(&file_name(plan_key), &text, &loader))
}

fn simulate_all(orders: &Receiver<SimulationOrder>, program: &dyn Program, found: &Sender<Event>) {
    while let Ok(order) = orders.recv() {
        let order = orders.try_iter().last().unwrap_or(order);
        let event = Found::Simulated {
            simulation: protected(|| program.simulate(&order.plan)),
            plan_key: order.plan_key,
            revision: order.revision,
        };
        let _ = found.send(Event::Found(event));
    }
}

/// The outcome of a work that may panic.
pub fn protected<T>(work: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(work)).ok()
}
