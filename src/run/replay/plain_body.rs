//! Bodies of targets, readings and steps, read in the plain form that psd writes. In: the JSON of an entry. Out: its body; None for another
//! form, which the general reader reads or refuses. A full run log has three of them for each step.

use serde::de::DeserializeOwned;

use super::entry::{
    AmendBody, AxisBody, DigestBody, EndBody, FaultBody, Header, HeldBody, IntentBody,
    OperatorBody, OperatorEntry, PlanBody, RecoverBody, ResumeBody, RigBody, SampleBody, StepBody,
    StrokeBody,
};
use psd_plan::record::Event;
use psd_rig::LineStatistics;
use psd_rig::journal::Plain;

/// The body of an entry.
pub(super) trait Body: DeserializeOwned {
    /// The body in its plain form.
    fn of_plain(_: Plain<'_>) -> Option<Self> {
        None
    }
}

macro_rules! general {
    ($($body:ty),+) => { $(impl Body for $body {})+ };
}

general!(
    AmendBody,
    DigestBody,
    EndBody,
    Event,
    FaultBody,
    Header,
    HeldBody,
    LineStatistics,
    OperatorBody,
    OperatorEntry,
    PlanBody,
    RecoverBody,
    ResumeBody,
    RigBody,
    StrokeBody
);

/// A field that can be absent, after its name.
macro_rules! optional {
    ($json:expr, $name:literal, $read:expr) => {
        if $json.skip($name) {
            Some($read($json)?)
        } else {
            None
        }
    };
}

impl Body for IntentBody {
    fn of_plain(mut json: Plain<'_>) -> Option<Self> {
        let json = &mut json;
        json.expect("{\"n\":")?;
        let n = json.whole()?;
        json.expect(",\"t\":")?;
        let t = json.number()?;
        json.expect(",\"to\":")?;
        let to = json.numbers()?;
        json.expect(",\"speed\":")?;
        let speed = if json.skip("null") {
            None
        } else {
            Some(json.number()?)
        };
        let encoded = optional!(json, ",\"encoded\":", Plain::numbers);
        json.expect(",\"rate\":")?;
        let rate = json.number()?;
        let wire = optional!(json, ",\"wire\":", Plain::string);
        let id = optional!(json, ",\"id\":", Plain::whole);
        let own = optional!(json, ",\"own\":", Plain::numbers);
        let samples = optional!(json, ",\"samples\":", Plain::whole);
        let samples = samples.map(usize::try_from).transpose().ok()?;
        let wall = optional!(json, ",\"wall\":", Plain::string);
        json.expect("}")?;
        json.end()?;
        Some(Self {
            n,
            t,
            to,
            speed,
            encoded,
            rate,
            wire,
            id,
            own,
            path: None,
            samples,
            wall,
        })
    }
}

impl Body for SampleBody {
    fn of_plain(mut json: Plain<'_>) -> Option<Self> {
        let json = &mut json;
        json.expect("{\"t\":")?;
        let t = json.number()?;
        json.expect(",\"x\":")?;
        let x = json.numbers()?;
        json.expect(",\"r\":")?;
        let r = json.numbers()?;
        let raw = optional!(json, ",\"raw\":", Plain::strings).unwrap_or_default();
        let moved = optional!(json, ",\"moved\":", Plain::numbers);
        let moved = moved.map(TryInto::try_into).transpose().ok()?;
        let wall = optional!(json, ",\"wall\":", Plain::string);
        json.expect("}")?;
        json.end()?;
        Some(Self {
            t,
            x,
            r,
            raw,
            moved,
            wall,
        })
    }
}

impl Body for StepBody {
    fn of_plain(mut json: Plain<'_>) -> Option<Self> {
        let json = &mut json;
        json.expect("{\"step\":")?;
        let step = json.whole()?;
        json.expect(",\"time\":")?;
        let time = json.number()?;
        json.expect(",\"u\":")?;
        let u = json.number()?;
        json.expect(",\"x\":")?;
        let x = json.number()?;
        let v = optional!(json, ",\"v\":", Plain::number);
        let a = optional!(json, ",\"a\":", Plain::number);
        json.expect(",\"r\":")?;
        let r = json.number()?;
        let e = optional!(json, ",\"e\":", Plain::number);
        let axes = optional!(json, ",\"axes\":", |json: &mut Plain<'_>| json
            .list(1, axis))
        .unwrap_or_default();
        json.expect("}")?;
        json.end()?;
        Some(Self {
            step,
            time,
            u,
            x,
            v,
            a,
            r,
            e,
            axes,
        })
    }
}

fn axis(json: &mut Plain<'_>) -> Option<AxisBody> {
    let mut number = |name: &str| {
        json.expect(name)?;
        json.number()
    };
    let (u, x) = (number("{\"u\":")?, number(",\"x\":")?);
    let (v, a) = (number(",\"v\":")?, number(",\"a\":")?);
    let r = number(",\"r\":")?;
    json.expect("}")?;
    Some(AxisBody { u, x, v, a, r })
}

#[cfg(test)]
mod tests {
    use std::fmt::Debug;

    use serde::Serialize;
    use serde_json::{Value, json};

    use super::super::entry::{IntentBody, SampleBody, StepBody};
    use super::Body;
    use psd_rig::journal::Plain;

    /// The plain reader gives what the general one gives, for the body and for each body without one of its fields.
    fn same<T: Body + Serialize + Debug + PartialEq>(whole: &Value) {
        let plain = |json: &str| T::of_plain(Plain::of(json));
        let read: T = serde_json::from_value(whole.clone()).unwrap();
        let json = serde_json::to_string(&read).unwrap();
        assert_eq!(plain(&json), Some(read), "{json}");
        for name in whole.as_object().unwrap().keys() {
            let mut body = whole.clone();
            body.as_object_mut().unwrap().shift_remove(name);
            let general = serde_json::from_value::<T>(body.clone()).ok();
            let read = plain(&body.to_string());
            assert!(
                read.is_none() || read == general,
                "without {name}: {read:?}"
            );
        }
        let at = json.find(':').unwrap() + 1;
        for other in [
            json.replacen(':', ": ", 1),
            format!("{json} "),
            json.replacen('{', "{\"more\":1,", 1),
            format!("{}1e400{}", &json[..at], &json[at + 1..]),
        ] {
            assert_eq!(plain(&other), None, "left to the general reader: {other}");
        }
    }

    #[test]
    fn both_readers_give_the_same_bodies() {
        same::<IntentBody>(&json!({
            "n": 1, "t": 0.5, "to": [1e-3, -2e-3], "speed": -1e-3, "encoded": [1e-3], "rate": 1e-3,
            "wire": "MOVE 1\\r\\n", "id": 5, "own": [0.051], "samples": 9, "wall": "08:00"
        }));
        let without_speed = json!({"n": 1, "t": 0.5, "to": [], "speed": null, "rate": 1.0});
        let read: IntentBody = serde_json::from_value(without_speed.clone()).unwrap();
        let json = without_speed.to_string();
        assert_eq!(IntentBody::of_plain(Plain::of(&json)), Some(read));
        same::<SampleBody>(&json!({
            "t": 1.0, "x": [1e-3], "r": [10.0], "raw": ["X 1\\n", "\"R\""], "moved": [0.5, 0.9],
            "wall": "08:00"
        }));
        same::<StepBody>(&json!({
            "step": 1, "time": 1e-3, "u": 1e-3, "x": 1e-3, "v": 0.5, "a": 2.0, "r": 10.0,
            "e": 1e-4, "axes": [{"u": 1e-3, "x": 1e-3, "v": 0.5, "a": 2.0, "r": 10.0}]
        }));
    }
}
