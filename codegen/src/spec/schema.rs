//! The JSON Schema of the spec language, from the types that read it.

use serde_json::{Value, json};

use super::Crane;

/// JSON Schema of the spec language, for editors that complete and check a spec.
///
/// # Panics
/// Never, because a schema is always printable.
#[must_use]
pub fn json_schema() -> String {
    let mut schema = schemars::schema_for!(Crane).to_value();
    forbid_null(&mut schema);
    // A spec that extends another contains only the differences.
    if let Some(object) = schema.as_object_mut() {
        let whole = object.remove("required").unwrap_or_default();
        object.insert("anyOf".to_owned(), json!([{ "required": whole }, { "required": ["extends"] }]));
    }
    format!("{schema:#}\n")
}

/// An optional key may be omitted but not left empty: removes the `null` that represents `Option`.
fn forbid_null(schema: &mut Value) {
    match schema {
        Value::Object(object) => {
            if let Some(kind) = object.get_mut("type")
                && let Some(single) = kind.as_array().and_then(|types| types.iter().find(|t| *t != "null"))
            {
                *kind = single.clone();
            }
            if let Some(Value::Array(forms)) = object.get_mut("anyOf") {
                forms.retain(|form| form.get("type").is_none_or(|t| t != "null"));
            }
            object.values_mut().for_each(forbid_null);
        }
        Value::Array(items) => items.iter_mut().for_each(forbid_null),
        _ => {}
    }
}
