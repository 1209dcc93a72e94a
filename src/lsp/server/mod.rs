//! The loop of the server: one message after the other, in order. In: messages, and what the checks beside it found. Out: answers and
//! notifications. A request that panics is answered with an error, and the next one is read.

mod background;
mod capabilities;
mod dispatch;
mod publish;
mod state;

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use lsp_server::{Connection, Message};

use crate::Program;
use background::{Background, Event};
pub(crate) use capabilities::SIMULATE;
pub use state::Ended;
use state::Server;

/// Pause in the messages after which the plans are checked.
const PAUSE: Duration = Duration::from_millis(80);

/// Serves one editor over a connection until it says `exit` or is gone.
#[must_use]
pub fn run(connection: Connection, program: Arc<dyn Program>) -> Ended {
    let Connection { sender, receiver } = connection;
    let (to_loop, events) = mpsc::channel();
    let found = to_loop.clone();
    std::thread::spawn(move || {
        for message in receiver {
            if to_loop.send(Event::Message(message)).is_err() {
                return;
            }
        }
        let _ = to_loop.send(Event::Closed);
    });
    let background = Background::start(&program, &found);
    let send = move |message: Message| {
        // An editor that is gone gets no answer.
        let _ = sender.send(message);
    };
    let mut server = Server::new(Box::new(send), program, background);
    let mut queue: VecDeque<Event> = VecDeque::new();
    loop {
        queue.extend(events.try_iter());
        let event = match queue.pop_front() {
            Some(event) => event,
            None if server.changed => match events.recv_timeout(PAUSE) {
                Ok(event) => event,
                Err(RecvTimeoutError::Timeout) => {
                    server.check();
                    continue;
                }
                Err(RecvTimeoutError::Disconnected) => return server.ended(),
            },
            None => match events.recv() {
                Ok(event) => event,
                Err(_) => return server.ended(),
            },
        };
        match event {
            Event::Closed => return server.ended(),
            Event::Found(found) => server.found(found),
            Event::Message(Message::Notification(last)) if last.method == "exit" => {
                return server.ended();
            }
            Event::Message(message) => {
                let waiting = queue.iter().filter_map(|event| match event {
                    Event::Message(Message::Notification(one)) => Some(one),
                    _ => None,
                });
                if !server.is_cancelled(&message, waiting) {
                    server.receive(message);
                }
            }
        }
    }
}
