//! A combination of weights and loads, and the same crane with its factors written out.

use crane_live::LiveCrane;
use crane_model::dyn_crane::Functions;
use crane_model::envelope::only_mass;
use fastrand::Rng;
use serde_json::{Value, json};

use crate::observe::{BETWEEN, Extent, differences, live, observe_live, rated};
use crate::tree::{Tree, gravity, set_gravity, source};

/// The name of the check.
pub const NAME: &str = "combinations and their factors written out";
/// Of loads of charts, relative: they are solved to rounding times the slopes of limits.
const CHART: f64 = 1e-6;

/// The preset that every third crane has, and its factors of the weight, of what is hoisted and of wind.
const PRESET: (&str, [f64; 3]) = ("with_wind", [1.16, 1.22 * (1.15 + 0.51 * 0.4), 1.22]);

/// What differs; `None` for a crane without weights and loads that are numbers, or that does not rest with them.
pub fn check_combined(tree: &Tree, seed: u64) -> Option<Vec<String>> {
    let mut rng = Rng::with_seed(seed);
    let mut factor = |least: f64, most: f64| least + (most - least) * rng.f64();
    let (mut combined, mut written) = (tree.clone(), tree.clone());
    let (preset, tabulated) = PRESET;
    let tabulated = seed.is_multiple_of(3).then_some(tabulated);
    let weight = tabulated.map_or_else(|| factor(0.8, 1.2), |[weight, ..]| weight);
    set_gravity(&mut written, &gravity(tree).iter().map(|g| weight * g).collect::<Vec<_>>());
    let (mut loads, mut masses) = (json!({}), json!({}));
    for load in written["loads"].as_array_mut().into_iter().flatten() {
        let of_load = tabulated.map_or_else(|| factor(0.5, 1.3), |[.., wind]| wind);
        loads[load["name"].as_str()?] = json!(of_load);
        if let Some(area) = load.pointer_mut("/wind/area") {
            *area = json!(of_load * area.as_f64()?);
        }
        for key in ["force", "moment"] {
            let Some(vector) = load.get_mut(key) else { continue };
            *vector =
                json!(vector.as_array()?.iter().map(|x| Some(of_load * x.as_f64()?)).collect::<Option<Vec<_>>>()?);
        }
    }
    for (name, parameter) in written["parameters"].as_object_mut().into_iter().flatten() {
        if parameter["unit"] == "kg" {
            let of_mass = tabulated.map_or_else(|| factor(0.8, 1.2), |[_, hoisted, _]| hoisted);
            masses[name] = json!(of_mass);
            parameter["value"] = json!(parameter["value"].as_f64()? * (of_mass / weight));
        }
    }
    let mut combination = json!({"name": "lifting"});
    combination[if tabulated.is_some() { "preset" } else { "weight" }] =
        tabulated.map_or(json!(weight), |_| json!(preset));
    for (key, listed, factors) in [("loads", "wind", loads), ("masses", "hoisted", masses)] {
        let Some(named) = factors.as_object().filter(|factors| !factors.is_empty()) else { continue };
        if tabulated.is_some() {
            combination[listed] = json!(named.keys().collect::<Vec<_>>());
        } else {
            combination[key] = factors;
        }
    }
    if combination.get("hoisted").is_some() {
        combination["hoisting"] = json!({"class": "hc3", "speed": 0.4});
    }
    combined["combinations"] = Value::Array(vec![combination]);
    combined["combination"] = json!("lifting");
    let combined = live(&source(&combined)).ok()?;
    let written = live(&source(&written)).ok()?;
    let second = observe_live(&written, Extent::default()).ok()?;
    let mut wrong = match observe_live(&combined, Extent::default()) {
        Ok(first) => differences([&first, &second], &|name| Some(name.to_owned()), &|_| 1.0),
        Err(refused) => vec![refused],
    };
    wrong.extend(loads_of_charts(&combined, &written));
    Some(wrong)
}

/// What differs between the loads of charts: those of a combination are without its factor.
fn loads_of_charts(combined: &LiveCrane, written: &LiveCrane) -> Option<String> {
    let load = only_mass(combined.description())?;
    let factor = written.parameters()[load] / combined.parameters()[load];
    let [first, second] = [factor * rated(combined)?.load?, rated(written)?.load?];
    // Where both searches end at the same bound, they are apart by the factor.
    let is_bound = |load: f64| load >= BETWEEN[1] || load <= factor.max(1.0) * BETWEEN[0];
    let off = (first - second).abs() > CHART * first;
    (off && ![first, second, first / factor].into_iter().any(is_bound))
        .then(|| format!("chart: {first:.9e} kg times its factor against {second:.9e}"))
}
