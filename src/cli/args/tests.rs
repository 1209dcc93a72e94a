//! Tests of the values of common flags.

use super::*;

#[test]
fn a_date_is_a_day_of_the_calendar() {
    assert_eq!(date("2024-02-29").as_deref(), Ok("2024-02-29"));
    assert!(date("2023-02-29").is_err());
    assert!(date("20240229").unwrap_err().contains("2024-02-29"));
    assert!(date("today").is_err());
}

#[test]
fn a_name_is_one_line_that_steers_nothing() {
    assert_eq!(name(" A. Engineer ").as_deref(), Ok("A. Engineer"));
    for wrong in [
        "",
        "  ",
        "A\nB",
        "A\u{1b}[2J",
        "A\u{202e}B",
        &"x".repeat(1024),
    ] {
        assert!(name(wrong).is_err(), "{wrong:?}");
    }
}

#[test]
fn a_setting_keeps_an_equals_sign_of_its_value() {
    assert_eq!(setting("v = 1.5 m/s"), Ok(("v".into(), "1.5 m/s".into())));
    assert_eq!(setting("a=b=c"), Ok(("a".into(), "b=c".into())));
    assert!(setting("v").is_err() && setting("=1").is_err() && setting("v=").is_err());
}
