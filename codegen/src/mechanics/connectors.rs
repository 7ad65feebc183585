//! Connectors: elements that pull or push two points along the line between them, ropes over sheaves, and couplings of two coordinates.

use super::elements::{Element, Elements};
use super::kinematics::Kinematics;
use super::laws::At;
use super::model::Model;
use super::place::{Place, Pull};
use super::profile;
use super::strains::Strained;
use crate::chain::{Force, Group, Law, Profile, Strain};
use crate::symbolic::Expr;

/// A connector in motion: ℓ, ℓ̇, and the force there.
struct Pulled<'a, 'g> {
    element: Element<'a, 'g>,
    rate: Expr<'g>,
    force: Expr<'g>,
}

/// All connectors at the present state.
fn pulled<'a, 'g>(model: &'a Model<'g>, kinematics: &'a Kinematics<'g>) -> impl Iterator<Item = Pulled<'a, 'g>> {
    Elements::new(model, kinematics, Group::Connectors).all().map(move |element| {
        let rate = element.strained.rate(model, &model.v);
        let force = element.force(At::now(model), rate);
        Pulled { element, rate, force }
    })
}

/// ℓ and ℓ̇ of every connector.
pub fn lengths<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let all = Elements::new(model, kinematics, Group::Connectors).all();
    all.flat_map(|Element { strained, .. }| [strained.length, strained.rate(model, &model.v)]).collect()
}

/// J of every connector, row by row.
pub fn jacobians<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let row = |Element { strained, .. }: Element<'_, 'g>| {
        let mut row = model.zeros();
        for (j, column) in strained.jacobian {
            row[j] = column;
        }
        row
    };
    Elements::new(model, kinematics, Group::Connectors).all().flat_map(row).collect()
}

/// `F, ∂F/∂ℓ, ∂F/∂ℓ̇` of every connector.
pub fn tensions<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let tension = |Pulled { element, rate, force }: Pulled<'_, 'g>| {
        let [by_length, by_rate] = element.slopes(At::now(model), rate);
        [force, by_length, by_rate]
    };
    pulled(model, kinematics).flat_map(tension).collect()
}

/// Power input of the winches, `−Σ W ℓ̇₀` with the force W that each overcomes.
pub fn winch_power<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Expr<'g> {
    pulled(model, kinematics).fold(model.zero(), |sum, Pulled { element, force, .. }| {
        match (&element.force.law, element.force.winch()) {
            (Law::Rope(rope), Some(length)) => {
                let overcome = rope.winch_force(At::now(model), element.strained.length, force);
                sum - overcome * profile::rate(model, length, model.t)
            }
            _ => sum,
        }
    })
}

/// Start and end of the intervals in which every winch moves smoothly.
pub fn pieces<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let winches = model.chain.connectors().iter().filter_map(Force::winch);
    winches.flat_map(Profile::pieces).flatten().map(|time| model.number(&time)).collect()
}

/// Forces on the bodies at the ends, at sheaves and at pads, in the world.
pub fn pulls<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<(Place<'g>, Pull<'g>)> {
    let on_bodies =
        |Pulled { element: Element { force: Force { strain, .. }, strained, .. }, force, .. }: Pulled<'_, 'g>| {
            let pulls = strained.pulls(strain, |_| true).into_iter();
            pulls.map(|(place, pull)| (place, pull.times(force))).collect::<Vec<_>>()
        };
    pulled(model, kinematics).flat_map(on_bodies).collect()
}

/// The same for a tension of 1 N at pads and in those parts of a line that are between two bodies; the others hold to the world.
pub fn between_bodies<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    strain: &Strain,
) -> Vec<(Place<'g>, Pull<'g>)> {
    if !strain.joins_bodies() {
        return Vec::new();
    }
    Strained::new(model, kinematics, strain).pulls(strain, |part| part.joins_bodies())
}
