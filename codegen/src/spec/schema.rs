//! The JSON Schema of the spec language, from the types that read it.

use serde_json::{Map, Value, json};

use super::Crane;
use crate::node::{Definition, Form, FromNode, Key, Limit, Measure, Variant};

/// JSON Schema of the spec language, for editors that complete and check a spec.
#[must_use]
pub fn json_schema() -> String {
    let Form::Defined { definition } = Crane::FORM else { return String::new() };
    let mut definitions = Map::new();
    let mut schema = describe_form(definition.form, &Measure::NONE, &mut definitions);
    // A spec that extends another contains only the differences.
    let whole = schema["required"].take();
    schema["anyOf"] = json!([{ "required": whole }, { "required": ["extends"] }]);
    if let Some(object) = schema.as_object_mut() {
        object.remove("required");
    }
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!(definition.name);
    schema["description"] = json!(definition.about);
    schema["$defs"] = Value::Object(definitions);
    format!("{schema:#}\n")
}

/// The schema of a form; forms with a name are added to the definitions.
fn describe_form(form: Form, measure: &Measure, definitions: &mut Map<String, Value>) -> Value {
    match form {
        Form::Text | Form::Word => json!({ "type": "string" }),
        Form::Flag => json!({ "type": "boolean" }),
        Form::Number => json!({ "type": "number" }),
        Form::Integer { least, most } => json!({ "type": "integer", "minimum": least, "maximum": most }),
        Form::Pattern { pattern } => json!({ "type": "string", "pattern": pattern }),
        Form::Words { words } => json!({ "enum": words }),
        Form::List { item, count } => {
            let mut list = json!({ "type": "array", "items": describe_form(*item, measure, definitions) });
            if let Some(count) = count {
                list["minItems"] = json!(count);
                list["maxItems"] = json!(count);
            }
            list
        }
        Form::Entries { value } => {
            json!({ "type": "object", "additionalProperties": describe_form(*value, measure, definitions) })
        }
        Form::AnyOf { forms } => {
            let forms: Vec<Value> = forms.iter().map(|form| describe_form(*form, measure, definitions)).collect();
            json!({ "anyOf": forms })
        }
        Form::Mapping { keys } => describe_mapping(keys, definitions),
        Form::Choice { variants } => {
            let bare: Vec<&str> =
                variants.iter().filter(|variant| variant.is_bare).map(|variant| variant.word).collect();
            let variants = variants.iter().map(|variant| describe_variant(variant, definitions));
            let mut forms: Vec<Value> = variants.collect();
            if !bare.is_empty() {
                forms.push(json!({ "enum": bare }));
            }
            json!({ "oneOf": forms })
        }
        Form::Defined { definition } => {
            if !definitions.contains_key(definition.name) {
                definitions.insert(definition.name.to_owned(), Value::Null);
                let schema =
                    with_description(describe_form(definition.form, &Measure::NONE, definitions), definition.about);
                definitions.insert(definition.name.to_owned(), schema);
            }
            let mut schema = json!({ "$ref": format!("#/$defs/{}", definition.name) });
            if is_number(definition.form) {
                add_measure(&mut schema, measure);
            } else if has_unit_of_owner(definition.form, &Measure::INHERITED) {
                schema["x-unit"] = json!(measure.unit);
            }
            schema
        }
    }
}

fn is_number(form: Form) -> bool {
    matches!(form, Form::AnyOf { forms: [Form::Number, ..] })
}

/// Whether some number of a form has the unit of the key at which it stands: references to it say which.
fn has_unit_of_owner(form: Form, measure: &Measure) -> bool {
    match form {
        Form::List { item: inner, .. } | Form::Entries { value: inner } => has_unit_of_owner(*inner, measure),
        Form::AnyOf { forms } => forms.iter().any(|form| has_unit_of_owner(*form, measure)),
        Form::Mapping { keys } => keys.iter().any(|key| has_unit_of_owner(key.form, key.measure)),
        Form::Choice { variants } => variants.iter().any(|one| has_unit_of_owner(one.content, one.measure)),
        Form::Defined { definition: Definition { form, .. } } => {
            measure.unit.starts_with('…') && (is_number(*form) || has_unit_of_owner(*form, measure))
        }
        _ => false,
    }
}

fn describe_mapping(keys: &[Key], definitions: &mut Map<String, Value>) -> Value {
    let required: Vec<&str> = keys.iter().filter(|key| key.is_required).map(|key| key.name).collect();
    let property = |key: &Key| {
        let about = format!("{} {}", key.about, key.measure.describe());
        (key.name.to_owned(), with_description(describe_form(key.form, key.measure, definitions), about.trim_end()))
    };
    let properties: Map<String, Value> = keys.iter().map(property).collect();
    let mut schema = json!({ "type": "object", "properties": properties, "additionalProperties": false });
    if !required.is_empty() {
        schema["required"] = json!(required);
    }
    schema
}

/// A word, or a mapping with it as its only key.
fn describe_variant(variant: &Variant, definitions: &mut Map<String, Value>) -> Value {
    let schema = match variant.content {
        Form::Word => json!({ "type": "string", "const": variant.word }),
        content => json!({
            "type": "object",
            "properties": { variant.word: describe_form(content, variant.measure, definitions) },
            "required": [variant.word],
            "additionalProperties": false,
        }),
    };
    let about = format!("{} {}", variant.about, variant.measure.describe());
    with_description(schema, about.trim_end())
}

/// The unit and the limit of a number; a name of a parameter and a number with a unit have their own checks.
fn add_measure(schema: &mut Value, measure: &Measure) {
    schema["x-unit"] = json!(measure.unit);
    if measure.usual != Measure::ALL {
        schema["x-usual"] = json!(measure.usual);
    }
    match measure.limit {
        Limit::Any => {}
        Limit::Positive => schema["exclusiveMinimum"] = json!(0),
        Limit::NotNegative | Limit::Mass | Limit::MassOfMoments => schema["minimum"] = json!(0),
        Limit::Whole(most) => (schema["minimum"], schema["maximum"]) = (json!(1), json!(most)),
    }
}

fn with_description(mut schema: Value, about: &str) -> Value {
    if !about.is_empty() {
        schema["description"] = json!(about);
    }
    schema
}
