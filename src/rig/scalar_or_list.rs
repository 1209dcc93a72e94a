//! A list that is written as a single number if it has one entry: run logs have always contained positions of one axis in this form. In:
//! numbers. Out: a number or a list. It knows no rig.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[derive(Deserialize)]
#[serde(untagged)]
enum OneOrSeveral {
    One(f64),
    Several(Vec<f64>),
}

pub fn serialize<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    match values {
        [one] => one.serialize(serializer),
        several => several.serialize(serializer),
    }
}

pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    Ok(match OneOrSeveral::deserialize(deserializer)? {
        OneOrSeveral::One(one) => vec![one],
        OneOrSeveral::Several(several) => several,
    })
}

#[cfg(test)]
mod tests {
    use crate::LastMove;

    #[test]
    fn one_axis_is_a_number_and_several_are_a_list_in_both_directions() {
        for (targets, text) in [
            (vec![1.25e-3], r#"{"id":7,"target":0.00125}"#),
            (vec![0.1, -0.2], r#"{"id":7,"target":[0.1,-0.2]}"#),
        ] {
            let last = LastMove { id: 7, targets };
            assert_eq!(serde_json::to_string(&last).unwrap(), text);
            assert_eq!(serde_json::from_str::<LastMove>(text).unwrap(), last);
        }
    }
}
