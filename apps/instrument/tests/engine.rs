//! What the page asks, without a page.

use crane_instrument::Engine;
use serde_json::{Value, json};

fn spec(name: &str) -> &'static str {
    crane_specs::spec(name).expect("a shipped crane")
}

fn ask(engine: &mut Engine, request: &Value) -> Value {
    let answer = engine.answer(request.to_string().as_bytes());
    serde_json::from_str(&answer).expect("JSON")
}

/// An engine with a crane.
fn opened(text: &str) -> (Engine, Value) {
    let mut engine = Engine::default();
    let crane = ask(&mut engine, &json!({"ask": "open", "name": "crane.yaml", "text": text}));
    (engine, crane)
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("numbers").iter().filter_map(Value::as_f64).collect()
}

#[test]
fn a_spec_with_mistakes_leaves_no_crane() {
    let (mut engine, said) = opened("format: 1\nname: x\nlinks:\n  - {name: a, joint: revolut}\n");
    let mistake = &said["diagnostics"][0];
    assert_eq!((&mistake["line"], &mistake["severity"]), (&json!(4), &json!("error")), "{said}");
    let rest = ask(&mut engine, &json!({"ask": "rest"}));
    assert!(rest["error"].as_str().is_some_and(|words| words.contains("mistakes")), "{rest}");
}

#[test]
fn a_spec_may_extend_a_shipped_crane() {
    let (_, said) = opened("extends: knuckle_boom\nname: mine\n");
    assert_eq!(said["name"], "mine", "{said}");
    let (_, said) = opened("extends: knuckle_bom\nname: mine\n");
    assert_eq!(said["diagnostics"][0]["line"], 1, "{said}");
}

#[test]
fn a_request_that_does_not_exist_is_answered() {
    let mut engine = Engine::default();
    for words in ["", "{}", "{\"ask\": \"everything\"}", "\u{0}"] {
        assert!(engine.answer(words.as_bytes()).starts_with("{\"error\":"), "{words}");
    }
    assert!(engine.answer(&[0xff]).starts_with("{\"error\":"));
}

/// Fields take numbers with units, by the reader of the command; they need no crane.
#[test]
fn what_is_typed_may_have_a_unit() {
    let mut engine = Engine::default();
    let mut read =
        |text: &str, unit: &str| ask(&mut engine, &json!({"ask": "number", "text": text, "unit": unit, "of": "it"}));
    assert_eq!(read("1.5 t", "kg"), json!({"value": 1500.0}));
    assert_eq!(read("320 bar", "Pa"), json!({"value": 32e6}));
    let wrong = read("320 bar", "kg");
    assert!(
        wrong["error"]
            .as_str()
            .is_some_and(|words| words.starts_with("it is in kg, and `320 bar` is a pressure (Pa); ")),
        "{wrong}"
    );
}

/// Statics do not wait for modes: these are of the crane as it rested last.
#[test]
fn modes_follow_statics() {
    let (mut engine, _) = opened(spec("knuckle_boom"));
    let early = ask(&mut engine, &json!({"ask": "modes"}));
    assert!(early["error"].is_string(), "{early}");
    let frequency = |engine: &mut Engine, request: &Value| {
        let rest = ask(engine, request);
        assert_eq!(rest["cranes"][0]["modes"], json!([]), "no modes with statics");
        let found = ask(engine, &json!({"ask": "modes"}));
        assert_eq!(found["figures"][0]["key"], "lowest_frequency", "{found}");
        found["modes"][0]["frequency"].as_f64().expect("a frequency")
    };
    let written = frequency(&mut engine, &json!({"ask": "rest"}));
    // Another pose swings otherwise.
    let moved = frequency(&mut engine, &json!({"ask": "rest", "positions": [-0.6, 1.2, 0.2]}));
    assert!((moved - written).abs() > 1e-6 * written, "{moved} Hz, {written} Hz");
    opened_again(&mut engine, spec("cantilever"));
    assert!(ask(&mut engine, &json!({"ask": "modes"}))["error"].is_string(), "another crane has not rested yet");
}

fn opened_again(engine: &mut Engine, text: &str) {
    ask(engine, &json!({"ask": "open", "name": "crane.yaml", "text": text}));
}

/// With the drives where their motions begin, the crane with levers rests as that of the spec.
#[test]
fn sliders_at_their_starts_change_nothing() {
    for name in ["knuckle_boom", "eight_link_flexible", "eight_link_hydraulic"] {
        let (mut engine, crane) = opened(spec(name));
        let starts: Vec<&Value> =
            crane["drives"].as_array().expect("drives").iter().map(|drive| &drive["start"]).collect();
        let written = numbers(&ask(&mut engine, &json!({"ask": "rest"}))["rest"]["q"]);
        let posed = numbers(&ask(&mut engine, &json!({"ask": "rest", "positions": starts}))["rest"]["q"]);
        assert_eq!(written.len(), posed.len());
        for (one, other) in written.iter().zip(&posed) {
            // Newton's method ends at a relative residual of 1e-10.
            assert!((one - other).abs() < 1e-9, "{name}: {one} {other}");
        }
    }
}

/// Two coordinates of a crane at a time while it is driven, by name.
fn driven(answer: &Value, crane: &Value, name: &str) -> f64 {
    let columns = crane["cranes"][0]["run"]["columns"].as_array().expect("columns");
    let index = columns.iter().position(|column| column["name"] == name).expect("a column");
    answer["row"][index].as_f64().expect("a number")
}

/// A lever sets the speed of a drive: after the ramp of half a second the joint turns at 0.2 rad/s, and stops when the lever is let go.
#[test]
fn a_lever_sets_a_speed() {
    let (mut engine, crane) = opened(spec("knuckle_boom"));
    let drives = crane["drives"].as_array().expect("drives").len();
    let begun = ask(&mut engine, &json!({"ask": "drive"}));
    let mut advance = |to: f64, lever: f64| {
        let mut levers = vec![0.0; drives];
        levers[0] = lever;
        let said = ask(&mut engine, &json!({"ask": "advance", "to": to, "levers": levers, "tolerance": 1e-5}));
        assert!(said["error"].is_null(), "{said}");
        said
    };
    let name = format!("{}_prescribed", crane["drives"][0]["name"].as_str().expect("a name"));
    let at = |said: &Value| driven(said, &begun, &name);
    let start = at(&advance(0.0, 0.0));
    let ramped = at(&advance(0.5, 1.0));
    // Half of the way at full speed.
    assert!((ramped - start - 0.05).abs() < 1e-9, "{}", ramped - start);
    let moved = at(&advance(1.5, 1.0));
    assert!((moved - ramped - 0.2).abs() < 1e-9, "{}", moved - ramped);
    let stopped = at(&advance(2.0, 0.0));
    assert!((stopped - moved - 0.05).abs() < 1e-9, "{}", stopped - moved);
    assert!((at(&advance(3.0, 0.0)) - stopped).abs() < 1e-9);
}

/// A lever opens a valve: the spool follows with its lag, and oil moves the boom.
#[test]
fn a_lever_opens_a_valve() {
    let (mut engine, crane) = opened(spec("eight_link_hydraulic"));
    let levers: Vec<&Value> = crane["drives"].as_array().expect("drives").iter().map(|drive| &drive["lever"]).collect();
    assert_eq!(levers, ["speed", "valve", "valve", "valve", "speed"]);
    let begun = ask(&mut engine, &json!({"ask": "drive"}));
    let mut advance = |to: f64, lever: f64| {
        let said =
            ask(&mut engine, &json!({"ask": "advance", "to": to, "levers": [0, lever, 0, 0, 0], "tolerance": 1e-4}));
        assert!(said["error"].is_null(), "{said}");
        said
    };
    let start = driven(&advance(0.02, 0.0), &begun, "boom_psi");
    let said = advance(0.5, 0.5);
    let opening = driven(&said, &begun, "boom_cylinder_valve");
    // 16 time constants of the spool.
    assert!((opening - 0.5).abs() < 1e-4, "{opening}");
    let lifted = driven(&advance(1.5, 0.5), &begun, "boom_psi");
    assert!(lifted - start > 0.02, "{start} {lifted}");
    assert!(said["margins"].as_array().is_some_and(|lines| lines.len() >= 3), "{}", said["margins"]);
}

#[test]
fn runs_and_charts_are_refused_in_words() {
    let (mut engine, _) = opened(spec("knuckle_boom"));
    for request in [
        json!({"ask": "run", "duration": -1}),
        json!({"ask": "rest", "parameters": [1, 2, 3, 4, 5, 6, 7]}),
        json!({"ask": "rest", "positions": [1]}),
        json!({"ask": "chart", "ranges": []}),
        json!({"ask": "chart", "ranges": [{"drive": 99, "from": 0, "to": 1, "count": 3}]}),
        json!({"ask": "advance", "to": 1, "levers": [], "tolerance": 1e-3}),
    ] {
        let said = ask(&mut engine, &request);
        assert!(said["error"].is_string(), "{request}: {said}");
    }
}
