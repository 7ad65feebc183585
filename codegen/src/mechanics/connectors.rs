//! Connectors: elements that pull or push two points along the line between them, ropes over sheaves, and couplings of two coordinates.

use super::elements::{Element, Elements, Posed};
use super::laws::LawState;
use super::model::Model;
use super::place::{Place, Pull};
use super::profile;
use crate::chain::{Force, Group, Law, Profile};
use crate::symbolic::Expr;

/// A connector in motion: ℓ, ℓ̇, and the force there.
struct Pulled<'a, 'g> {
    element: Element<'a, 'g>,
    rate: Expr<'g>,
    force: Expr<'g>,
}

/// All connectors at the present state.
fn pulled<'a, 'g>(posed: Posed<'a, 'g>) -> impl Iterator<Item = Pulled<'a, 'g>> {
    let (model, ..) = posed;
    Elements::new(posed, Group::Connectors).all().map(move |element| {
        let rate = element.strained.rate(model, &model.v);
        let force = element.force(LawState::now(model), rate);
        Pulled { element, rate, force }
    })
}

/// ℓ and ℓ̇ of every connector.
pub fn lengths<'g>(posed: Posed<'_, 'g>) -> Vec<Expr<'g>> {
    let (model, ..) = posed;
    let all = Elements::new(posed, Group::Connectors).all();
    all.flat_map(|Element { strained, .. }| [strained.length, strained.rate(model, &model.v)]).collect()
}

/// J of every connector, row by row.
pub fn jacobians<'g>(posed: Posed<'_, 'g>) -> Vec<Expr<'g>> {
    let (model, ..) = posed;
    let row = |Element { strained, .. }: Element<'_, 'g>| {
        let mut row = model.zeros();
        for &(j, column) in &strained.jacobian {
            row[j] = column;
        }
        row
    };
    Elements::new(posed, Group::Connectors).all().flat_map(row).collect()
}

/// `F, ∂F/∂ℓ, ∂F/∂ℓ̇` of every connector.
pub fn tensions<'g>(posed: Posed<'_, 'g>) -> Vec<Expr<'g>> {
    let (model, ..) = posed;
    let tension = |Pulled { element, rate, force }: Pulled<'_, 'g>| {
        let [by_length, by_rate] = element.slopes(LawState::now(model), rate);
        [force, by_length, by_rate]
    };
    pulled(posed).flat_map(tension).collect()
}

/// Power input of the winches, `−Σ W ℓ̇₀` with the force W that each overcomes.
pub fn winch_power<'g>(posed: Posed<'_, 'g>) -> Expr<'g> {
    let (model, ..) = posed;
    pulled(posed).fold(model.zero(), |sum, Pulled { element, force, .. }| {
        match (&element.force.law, element.force.winch()) {
            (Law::Rope(rope), Some(length)) => {
                let overcome = rope.winch_force(LawState::now(model), element.strained.length, force);
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
pub fn pulls<'g>(posed: Posed<'_, 'g>) -> Vec<(Place<'g>, Pull<'g>)> {
    let on_bodies =
        |Pulled { element: Element { force: Force { strain, .. }, strained, .. }, force, .. }: Pulled<'_, 'g>| {
            let pulls = strained.pulls(strain, |_| true).into_iter();
            pulls.map(|(place, pull)| (place, pull.times(force))).collect::<Vec<_>>()
        };
    pulled(posed).flat_map(on_bodies).collect()
}

/// Of every connector, the same for a tension of 1 N at pads and in those parts of a line that are between two bodies; the others hold to the world.
pub fn between_bodies<'g>(posed: Posed<'_, 'g>) -> Vec<Vec<(Place<'g>, Pull<'g>)>> {
    let of_one = |Element { force: Force { strain, .. }, strained, .. }: Element<'_, 'g>| {
        if strain.joins_bodies() { strained.pulls(strain, |part| part.joins_bodies()) } else { Vec::new() }
    };
    Elements::new(posed, Group::Connectors).all().map(of_one).collect()
}
