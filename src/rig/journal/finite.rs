//! Whether a body reads back as it was written: an object of finite 64-bit numbers, not too deep. In: any value that serde
//! can walk. Out: the first refusal. It writes nothing: `serde_json` alone would write NaN as null.

use serde::ser::{self, Serialize, Serializer};

use super::Refusal;
use super::fault::DEEPEST;

/// Gives the reason why a body must not be written.
///
/// # Errors
/// It is not an object, or a part of it would be read back differently.
pub fn check(body: &impl Serialize) -> Result<(), Refusal> {
    let mut walk = Walk { depth: 0 };
    body.serialize(&mut walk)
        .map_err(|Refused(refusal)| refusal)
}

/// Checks a value recursively. Objects and lists count their depth; at depth 0 only an object is allowed.
struct Walk {
    depth: usize,
}

#[derive(Debug, thiserror::Error)]
#[error(transparent)]
struct Refused(Refusal);

impl ser::Error for Refused {
    fn custom<T: std::fmt::Display>(message: T) -> Self {
        Self(Refusal::NotJson(message.to_string()))
    }
}

type Walked = Result<(), Refused>;

impl Walk {
    const fn leaf(&self) -> Walked {
        if self.depth == 0 {
            Err(Refused(Refusal::NotAnObject))
        } else {
            Ok(())
        }
    }

    const fn open(&mut self) -> Walked {
        if self.depth == DEEPEST {
            return Err(Refused(Refusal::TooDeep));
        }
        self.depth += 1;
        Ok(())
    }

    fn list(&mut self) -> Result<Parts<'_>, Refused> {
        self.leaf()?;
        self.object()
    }

    fn object(&mut self) -> Result<Parts<'_>, Refused> {
        self.open()?;
        Ok(Parts(self))
    }

    /// The content of a variant: inside an object that names it.
    fn variant(&mut self) -> Result<Variant<'_>, Refused> {
        self.open()?;
        self.open()?;
        Ok(Variant(self))
    }
}

/// Inside a list or an object.
struct Parts<'a>(&'a mut Walk);

/// Inside the content of a variant, two levels down.
struct Variant<'a>(&'a mut Walk);

macro_rules! leaves {
    ($($name:ident: $type:ty),*) => {
        $(fn $name(self, _: $type) -> Walked {
            self.leaf()
        })*
    };
}

impl<'a> Serializer for &'a mut Walk {
    type Ok = ();
    type Error = Refused;
    type SerializeSeq = Parts<'a>;
    type SerializeTuple = Parts<'a>;
    type SerializeTupleStruct = Parts<'a>;
    type SerializeTupleVariant = Variant<'a>;
    type SerializeMap = Parts<'a>;
    type SerializeStruct = Parts<'a>;
    type SerializeStructVariant = Variant<'a>;

    leaves!(serialize_bool: bool, serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64, serialize_u8: u8,
        serialize_u16: u16, serialize_u32: u32, serialize_u64: u64, serialize_char: char, serialize_str: &str);

    fn serialize_i128(self, _: i128) -> Walked {
        Err(Refused(Refusal::TooWide))
    }

    fn serialize_u128(self, _: u128) -> Walked {
        Err(Refused(Refusal::TooWide))
    }

    fn serialize_f32(self, value: f32) -> Walked {
        self.serialize_f64(value.into())
    }

    fn serialize_f64(self, value: f64) -> Walked {
        if value.is_finite() {
            self.leaf()
        } else {
            Err(Refused(Refusal::NotFinite))
        }
    }

    fn serialize_bytes(self, _: &[u8]) -> Walked {
        ser::SerializeSeq::end(self.list()?)
    }

    fn serialize_none(self) -> Walked {
        self.leaf()
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Walked {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Walked {
        self.leaf()
    }

    fn serialize_unit_struct(self, _: &'static str) -> Walked {
        self.leaf()
    }

    fn serialize_unit_variant(self, _: &'static str, _: u32, _: &'static str) -> Walked {
        self.leaf()
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Walked {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        value: &T,
    ) -> Walked {
        self.open()?;
        value.serialize(&mut *self)?;
        self.depth -= 1;
        Ok(())
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Parts<'a>, Refused> {
        self.list()
    }

    fn serialize_tuple(self, _: usize) -> Result<Parts<'a>, Refused> {
        self.list()
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Parts<'a>, Refused> {
        self.list()
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Variant<'a>, Refused> {
        self.variant()
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Parts<'a>, Refused> {
        self.object()
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Parts<'a>, Refused> {
        self.object()
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Variant<'a>, Refused> {
        self.variant()
    }
}

/// The functions that serde requires for a list or an object: check each part, then return.
macro_rules! parts {
    ($($kind:ident::$part:ident($($name:ty)?) of $target:ty, up $levels:literal;)*) => {
        $(impl ser::$kind for $target {
            type Ok = ();
            type Error = Refused;

            fn $part<T: Serialize + ?Sized>(&mut self, $(_: $name,)? value: &T) -> Walked {
                value.serialize(&mut *self.0)
            }

            fn end(self) -> Walked {
                self.0.depth -= $levels;
                Ok(())
            }
        })*
    };
}

parts! {
    SerializeSeq::serialize_element() of Parts<'_>, up 1;
    SerializeTuple::serialize_element() of Parts<'_>, up 1;
    SerializeTupleStruct::serialize_field() of Parts<'_>, up 1;
    SerializeStruct::serialize_field(&'static str) of Parts<'_>, up 1;
    SerializeTupleVariant::serialize_field() of Variant<'_>, up 2;
    SerializeStructVariant::serialize_field(&'static str) of Variant<'_>, up 2;
}

impl ser::SerializeMap for Parts<'_> {
    type Ok = ();
    type Error = Refused;

    /// A key becomes text, or `serde_json` refuses it.
    fn serialize_key<T: Serialize + ?Sized>(&mut self, _: &T) -> Walked {
        Ok(())
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Walked {
        value.serialize(&mut *self.0)
    }

    fn end(self) -> Walked {
        self.0.depth -= 1;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use serde::Serialize;
    use serde_json::{Value, json};

    use super::super::Refusal;
    use super::super::fault::DEEPEST;
    use super::check;

    #[derive(Serialize)]
    enum Shape {
        Point,
        Circle(f64),
        Line(f64, f64),
        Box { width: f64 },
    }

    #[derive(Serialize)]
    struct Body<T> {
        part: T,
    }

    #[test]
    fn finite_objects_pass_in_every_shape_serde_knows() {
        assert_eq!(check(&json!({})), Ok(()));
        assert_eq!(
            check(&json!({"a": [1, -2, 0.5, null, true, "nan"], "b": {"c": {}}})),
            Ok(())
        );
        assert_eq!(
            check(&Some(Body {
                part: (1_u8, 'x', f32::MIN, Some(f64::MAX), ())
            })),
            Ok(())
        );
        assert_eq!(
            check(&Body {
                part: [
                    Shape::Point,
                    Shape::Circle(1.0),
                    Shape::Line(0.0, -0.0),
                    Shape::Box { width: 5e-324 }
                ]
            }),
            Ok(())
        );
        assert_eq!(
            check(&Shape::Line(1.0, 2.0)),
            Ok(()),
            "a variant with content is an object"
        );
    }

    #[test]
    fn no_invalid_number_passes_in_any_field() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for shape in [
                Shape::Circle(bad),
                Shape::Line(0.0, bad),
                Shape::Box { width: bad },
            ] {
                assert_eq!(check(&shape), Err(Refusal::NotFinite));
            }
            assert_eq!(check(&Body { part: bad }), Err(Refusal::NotFinite));
            assert_eq!(
                check(&Body {
                    part: vec![Some((0, bad))]
                }),
                Err(Refusal::NotFinite)
            );
            assert_eq!(
                check(&std::collections::BTreeMap::from([("a", bad)])),
                Err(Refusal::NotFinite)
            );
        }
        assert_eq!(check(&Body { part: f32::NAN }), Err(Refusal::NotFinite));
        assert_eq!(check(&Body { part: u128::MAX }), Err(Refusal::TooWide));
        assert_eq!(check(&Body { part: -1_i128 }), Err(Refusal::TooWide));
    }

    #[test]
    fn only_objects_are_bodies() {
        for body in [
            json!(null),
            json!(1),
            json!("text"),
            json!([]),
            json!([{}]),
            json!(true),
            json!(0.5),
        ] {
            assert_eq!(check(&body), Err(Refusal::NotAnObject), "{body}");
        }
        assert_eq!(check(&None::<Body<u8>>), Err(Refusal::NotAnObject));
        assert_eq!(check(&Shape::Point), Err(Refusal::NotAnObject));
        assert_eq!(check(&(1, 2)), Err(Refusal::NotAnObject));
    }

    #[test]
    fn depth_is_bounded_and_counts_what_is_open_only() {
        let deep = |levels: usize| (1..levels).fold(json!({}), |inside, _| json!({ "a": inside }));
        assert_eq!(check(&deep(DEEPEST)), Ok(()));
        assert_eq!(check(&deep(DEEPEST + 1)), Err(Refusal::TooDeep));
        assert_eq!(
            check(&Value::from_iter([(
                "a",
                Value::from(vec![deep(DEEPEST - 2); 3])
            )])),
            Ok(())
        );
        assert_eq!(
            check(&Value::from_iter([(
                "a",
                Value::from(vec![deep(DEEPEST - 1)])
            )])),
            Err(Refusal::TooDeep)
        );
        let variants = (0..DEEPEST)
            .map(|_| Shape::Box { width: 1.0 })
            .collect::<Vec<_>>();
        assert_eq!(
            check(&Body { part: variants }),
            Ok(()),
            "a closed variant is closed"
        );
    }
}
