//! Curved beams against the closed form of a curved cantilever, and independence of the names of planes.

use std::f64::consts::FRAC_PI_4;

use crane_codegen::SourceFile;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::nalgebra::Vector3;
use crane_model::statics;

const RADIUS: f64 = 100.0;
const MODULUS: f64 = 1e7;
/// Small: the square of the deflection over the radius is below 1e-12.
const FORCE: f64 = 1e-3;

/// An arc along x at its beginning, E = G, Jy = Jz = 1 m⁴, with a force at its tip.
fn arc(sections: usize, bend: &str, torsion: f64, force: [f64; 3], more: &str) -> LiveCrane {
    let length = RADIUS * FRAC_PI_4;
    let text = format!(
        "format: 1
name: arc
gravity: [0, 0, 0]
{more}
links:
  - name: arc
    beam:
      length: {length:?}
      sections: {sections}
      bend: {bend}
      material: {{E: {MODULUS:e}, G: {MODULUS:e}, density: 1}}
      section: {{numbers: {{area: 1, Jy: 1, Jz: 1, Jo: {torsion}}}}}
loads: [{{name: tip, link: arc, at: [{length:?}, 0, 0], force: {force:?}}}]
points: [{{name: tip, link: arc, at: [{length:?}, 0, 0]}}]
"
    );
    LiveCrane::from_spec(&SourceFile::new("arc.yaml", &text)).unwrap_or_else(|mistakes| panic!("\n{mistakes}\n{text}"))
}

/// Deflection of the tip.
fn deflection(crane: &dyn DynCrane) -> Vector3<f64> {
    let rest = crane.equilibrium(&statics::Settings::default());
    assert!(rest.is_stable(), "{rest}");
    crane.points_at(&rest.q)[0] - crane.points_at(&vec![0.0; rest.q.len()])[0]
}

/// Out of the plane of an arc, a force bends and twists it: by Castigliano,
/// `δ = F R³/EJ ∫ sin² + F R³/GJo ∫ (1 − cos)²`, both from 0 to the angle of the arc.
#[test]
fn a_curved_cantilever_converges_with_order_two() {
    let angle = FRAC_PI_4;
    let (bending, torsion) =
        (angle / 2.0 - (2.0 * angle).sin() / 4.0, 1.5 * angle - 2.0 * angle.sin() + (2.0 * angle).sin() / 4.0);
    // Bent in one plane, in the other, and in a plane between them, in which a third of the angle is about z.
    let (psi, theta) = (angle / 3.0, angle * 8.0_f64.sqrt() / 3.0);
    let ratios = [1.0, 0.843, 0.12];
    for (bend, normal, ratios) in [
        (format!("{{psi: {angle:?}}}"), [0.0, 0.0, 1.0], &ratios[..]),
        (format!("{{theta: {angle:?}}}"), [0.0, 1.0, 0.0], &ratios[2..]),
        (format!("{{psi: {psi:?}, theta: {theta:?}}}"), [0.0, theta / angle, psi / angle], &ratios[2..]),
    ] {
        for ratio in ratios {
            let exact = FORCE * RADIUS.powi(3) / MODULUS * (bending + torsion / ratio);
            let force = normal.map(|share| FORCE * share);
            let error = |sections: usize| {
                let value = deflection(&arc(sections, &bend, *ratio, force, "")).dot(&Vector3::from(normal));
                (value / exact - 1.0).abs()
            };
            let [coarse, fine] = [4, 32].map(error);
            let order = (coarse / fine).log2() / 3.0;
            assert!(order > 1.9, "{bend}, GJ/EJ = {ratio}: order {order}, from {coarse} to {fine}");
            assert!(coarse < 0.04 && fine < 6e-4, "{bend}, GJ/EJ = {ratio}: {coarse}, {fine}");
        }
    }
}

/// Turned by 90° about its axis, an arc is the same arc with its planes exchanged: the angles are one rotation vector.
#[test]
fn planes_of_an_arc_can_be_exchanged() {
    let one = arc(5, "{psi: 0.5, theta: -0.3}", 0.2, [1.0, 2.0, 3.0], "");
    let other = arc(5, "{psi: -0.3, theta: -0.5}", 0.2, [1.0, -3.0, 2.0], "");
    let turned = |x: Vector3<f64>| Vector3::new(x.x, -x.z, x.y);
    let tip = |crane: &dyn DynCrane| crane.points_at(&[0.0; 15])[0];
    assert!((turned(tip(&one)) - tip(&other)).amax() < 1e-12, "{} {}", tip(&one), tip(&other));
    let [a, b]: [Vector3<f64>; 2] = [&one, &other].map(|crane| deflection(crane));
    assert!((turned(a) - b).amax() < 1e-9 * b.amax(), "{a} {b}");
    // Both angles are that of the arc, in the plane of the rotation vector (0, θ, ψ).
    let (theta, psi) = (-0.3_f64, 0.5_f64);
    let angle = theta.hypot(psi);
    let step = angle / 5.0;
    let radius = RADIUS * FRAC_PI_4 / 5.0 / 2.0 / (step / 2.0).tan();
    let aside = radius * (1.0 - angle.cos()) / angle;
    let polygon = Vector3::new(radius * angle.sin(), aside * psi, -aside * theta);
    assert!((tip(&one) - polygon).amax() < 1e-12, "{} {polygon}", tip(&one));
}

/// Live angles give the same arc as written ones, and none if both are 0.
#[test]
fn angles_may_be_live() {
    let parameters = "parameters: {a: {value: 0.5, unit: rad}, b: {value: -0.3, unit: rad}}";
    let written = arc(3, "{psi: 0.5, theta: -0.3}", 0.2, [1.0, 2.0, 3.0], "");
    let mut live = arc(3, "{psi: a, theta: b}", 0.2, [1.0, 2.0, 3.0], parameters);
    let q: Vec<f64> = (0..9).map(|j| 0.1 * (1.0 + f64::from(j)).sin()).collect();
    let [a, b] = [&written, &live].map(|crane| (crane as &dyn DynCrane).transforms_at(&q));
    // Positions are some 100 m.
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).amax() < 1e-12), "{a:?} {b:?}");
    live.set_parameters(&[0.0; 2]).expect("any angle");
    let tip = (&live as &dyn DynCrane).points_at(&[0.0; 9])[0];
    assert!((tip - Vector3::new(RADIUS * FRAC_PI_4, 0.0, 0.0)).amax() < 1e-13, "{tip}");
}
