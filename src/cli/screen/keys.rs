//! Keys as a terminal tells them → what they mean to the dialogue. Ctrl-C comes as a key here, since the terminal is in
//! raw mode, and means what the signal means.

use ratatui::crossterm::event::{Event, KeyCode, KeyEventKind, KeyModifiers};

/// A key that means something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    Character(char),
    Enter,
    Escape,
    /// Takes the last character back.
    Erase,
    /// Takes the whole line back: Ctrl-U.
    EraseLine,
    /// Ctrl-C
    Interrupt,
    /// The end of what is typed: Ctrl-D.
    End,
}

/// None for what means nothing here: a resize, the mouse, a key let go.
pub fn key(event: &Event) -> Option<Key> {
    let Event::Key(pressed) = event else { return None };
    if pressed.kind == KeyEventKind::Release {
        return None;
    }
    let modified = pressed.modifiers.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT | KeyModifiers::SUPER);
    match pressed.code {
        KeyCode::Char(character) if pressed.modifiers.contains(KeyModifiers::CONTROL) => match character.to_ascii_lowercase() {
            'c' => Some(Key::Interrupt),
            'd' => Some(Key::End),
            'h' => Some(Key::Erase),
            'u' => Some(Key::EraseLine),
            _ => None,
        },
        KeyCode::Char(character) if !modified => Some(Key::Character(character)),
        KeyCode::Enter if !modified => Some(Key::Enter),
        KeyCode::Esc => Some(Key::Escape),
        KeyCode::Backspace => Some(Key::Erase),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use ratatui::crossterm::event::KeyEvent;

    use super::*;

    #[test]
    fn a_modified_letter_is_no_letter() {
        let pressed = |code, modifiers| key(&Event::Key(KeyEvent::new(code, modifiers)));
        let (none, control) = (KeyModifiers::NONE, KeyModifiers::CONTROL);
        assert_eq!(pressed(KeyCode::Char('y'), none), Some(Key::Character('y')));
        assert_eq!(pressed(KeyCode::Char('Y'), KeyModifiers::SHIFT), Some(Key::Character('Y')));
        assert_eq!(pressed(KeyCode::Char('c'), control), Some(Key::Interrupt));
        assert_eq!(pressed(KeyCode::Char('y'), control), None);
        assert_eq!(pressed(KeyCode::Char('y'), KeyModifiers::ALT), None);
        assert_eq!(pressed(KeyCode::F(1), none), None);
        let released = KeyEvent { kind: KeyEventKind::Release, ..KeyEvent::new(KeyCode::Char('y'), none) };
        assert_eq!(key(&Event::Key(released)), None);
    }
}
