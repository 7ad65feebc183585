//! Loads by wind, and the same as forces.

use fastrand::Rng;
use serde_json::json;

use crate::tree::{Tree, numbers};

/// Density of air in the formula of the language, kg/m³.
const AIR: f64 = 1.25;

/// Writes the force of a load as wind, by its pressure or its speed, or wind as the force that it is; returns whether it has one of the two,
/// in numbers.
pub fn exchange(load: &mut Tree, rng: &mut Rng) -> bool {
    let Some(entries) = load.as_object_mut() else { return false };
    if let Some(wind) = entries.remove("wind") {
        let number = |key: &str| wind[key].as_f64();
        let pressure = number("pressure").or_else(|| number("speed").map(|speed| 0.5 * AIR * speed * speed));
        let (Some(pressure), Some(area), Some(shape)) = (pressure, number("area"), number("shape_factor")) else {
            entries.insert("wind".to_owned(), wind);
            return false;
        };
        let direction = numbers(&wind["direction"]);
        let share = pressure * area * shape / norm(&direction);
        entries.insert("force".to_owned(), json!(direction.iter().map(|x| share * x).collect::<Vec<_>>()));
        return true;
    }
    let force = entries.get("force").and_then(Tree::as_array);
    let Some(direction) = force.and_then(|force| force.iter().map(Tree::as_f64).collect::<Option<Vec<_>>>()) else {
        return false;
    };
    let (area, shape_factor) = (0.5 + rng.f64(), 1.0 + rng.f64());
    let pressure = norm(&direction) / (area * shape_factor);
    let mut wind = json!({"area": area, "shape_factor": shape_factor, "direction": direction});
    if rng.bool() {
        wind["pressure"] = json!(pressure);
    } else {
        wind["speed"] = json!((2.0 * pressure / AIR).sqrt());
    }
    entries.remove("force");
    entries.insert("wind".to_owned(), wind);
    true
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}
