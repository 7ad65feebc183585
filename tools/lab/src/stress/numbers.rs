//! Numbers at the limits of double precision and of the spec language, in specs, parameters and options.

use super::{
    Specs,
    case::{Case, expect},
    spec::Spec,
    subject::{Subject, timing},
};
use crane_model::dynamics::Method;

use crane_cli::toolbox::{Step, Timing};

pub fn cases(specs: &Specs) -> Vec<Case> {
    let mut cases = Vec::new();
    for (number, code) in [
        ("1e300", "E033"),
        ("1.7976931348623157e308", "E033"),
        ("2e308", "E030"),
        ("5e-324", "E033"),
        ("1e-31", "E033"),
        (".inf", "E030"),
        ("-.inf", "E030"),
        (".nan", "E030"),
        ("0", "E031"),
        ("-1", "E031"),
    ] {
        cases.push(refused(number, code));
    }
    for number in ["1e18", "1e-30", "-1e18"] {
        cases.push(accepted(number));
    }
    for mass in [1e18, 1e-30] {
        cases.push(heavy(mass));
    }
    for load in [f64::MAX, f64::MIN_POSITIVE, 5e-324, 1e300, 1e150, 1e30, -1e30, 0.0] {
        cases.push(parameter(specs.shipped("knuckle_boom"), load));
    }
    for (name, of) in OPTIONS {
        for value in [f64::NAN, f64::INFINITY, -1.0, 0.0, 5e-324, 1e-300, 1e300, f64::MAX] {
            cases.push(option(specs.shipped("knuckle_boom"), name, of, value));
        }
    }
    cases
}

/// Sets an option of a run.
type Set = fn(&mut Timing, f64);

/// Names of options of a run, and how to set them.
const OPTIONS: [(&str, Set); 4] = [
    ("step", |timing, value| {
        timing.method = Some(Method::Rk4);
        timing.tolerance = None;
        timing.step = Some(Step::Seconds(value));
    }),
    ("tolerance", |timing, value| timing.tolerance = Some(value)),
    ("duration", |timing, value| timing.duration = Some(value)),
    ("interval", |timing, value| timing.interval = Some(value)),
];

/// A run option with a meaningless value: refused at once, or harmless.
fn option(spec: Spec, name: &'static str, set: Set, value: f64) -> Case {
    let expected = "refused with its name or the reason, or a run with finite results; never endless";
    Case::new("limits of numbers", format!("knuckle_boom with --{name} {value:e}"), expected, move || {
        let mut timing = timing(Method::RECOMMENDED, 1e-4, 0.1);
        set(&mut timing, value);
        match Subject::new(&spec)?.run(&timing) {
            Ok(recorded) => Ok(format!("ran in {} steps", recorded.run.statistics.steps)),
            Err(message) => expect(message.contains(name) && !message.contains("in row"), message),
        }
    })
}

/// A rod on a pin.
fn rod(mass: &str, com: &str) -> Spec {
    Spec::new(format!(
        "format: 1
name: rod
links:
  - {{name: rod, joint: {{revolute: {{axis: y}}}}, mass: {mass}, com: [0, 0, {com}]}}
run: {{duration: 0.1}}
"
    ))
}

fn refused(number: &'static str, code: &'static str) -> Case {
    let expected = format!("refused by rule {code}, which shows the number");
    Case::new("limits of numbers", format!("spec with a mass of {number}"), expected, move || {
        match Subject::new(&rod(number, "-1")) {
            Ok(_) => Err("accepted".to_owned()),
            Err(message) => expect(message.contains(code), message),
        }
    })
}

/// A centre of mass as far away as the language allows.
fn accepted(number: &'static str) -> Case {
    let expected = "a stable pose and a run, or a clear message; all numbers finite";
    Case::new("limits of numbers", format!("spec with a centre of mass at {number} m"), expected, move || {
        let subject = Subject::new(&rod("1", number))?;
        let equilibrium = subject.equilibrium();
        let run = subject.run(&timing(Method::RECOMMENDED, 1e-4, 0.1));
        sound(&equilibrium.to_string(), equilibrium.q.iter().all(|x| x.is_finite()), run.err().as_deref())
    })
}

/// A mass as large or small as the language allows swings like any other.
fn heavy(mass: f64) -> Case {
    let expected = "stable, hanging; 0.1 s to the end";
    Case::new("limits of numbers", format!("spec with a mass of {mass:e}"), expected, move || {
        let subject = Subject::new(&rod(&format!("{mass:e}"), "-1").changed("guess: {rod_theta: 0.1}"))?;
        let rest = subject.rest()?;
        subject.run(&timing(Method::RECOMMENDED, 1e-4, 0.1))?;
        expect(rest.q[0].abs() < 1e-9, rest.to_string())
    })
}

/// A payload, set as by `--set`.
fn parameter(spec: Spec, load: f64) -> Case {
    let expected = "a stable pose and a run, or a clear message; all numbers finite";
    Case::new("limits of numbers", format!("knuckle_boom with payload={load:e}"), expected, move || {
        let subject = match Subject::new(&spec)?.set("payload", load) {
            Ok(subject) => subject,
            Err(refused) => return expect(refused.contains("[E03"), refused),
        };
        let equilibrium = subject.equilibrium();
        let run = subject.run(&timing(Method::RECOMMENDED, 1e-4, 0.1));
        sound(&equilibrium.to_string(), equilibrium.q.iter().all(|x| x.is_finite()), run.err().as_deref())
    })
}

/// As expected unless a number is not finite, in the pose or in the message of a run.
fn sound(statics: &str, finite: bool, run: Option<&str>) -> super::case::Finding {
    let outcome = run.unwrap_or("ran to the end");
    let clear = !outcome.contains("NaN") && !outcome.contains("in the results") && !outcome.contains("inf ");
    expect(finite && clear, format!("{statics}; {outcome}"))
}
