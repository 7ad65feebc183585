//! Connectors: elements that pull or push two points along the line between them, and couplings of two coordinates.
//!
//! Notation
//! : points p₁, p₂ in the world, `ℓ = |p₂ − p₁|`, `e = (p₂ − p₁)/ℓ`. `J_j = ∂ℓ/∂q_j = e · (∂p₂/∂q_j − ∂p₁/∂q_j)` for the coordinates
//!   that move only one of the points: those that move both do not change ℓ. `ℓ̇ = J q̇`. For a coupling `ℓ = q_j − r q_i`,
//!   `J_j = 1`, `J_i = −r`.
//!
//! F is the force that resists the growth of ℓ, so `f = −Jᵀ F`.

use super::kinematics::{Kinematics, Pose};
use super::loads::Place;
use super::model::Model;
use super::profile;
use super::vector::{SymmetricMatrix, Vec3};
use crate::chain::{Attachment, BodyId, Connector, ConnectorLaw, CoordinateId, Profile, Strain};
use crate::symbolic::Expr;

/// A connector at the present state.
struct Stretched<'g> {
    /// ℓ, m or rad.
    length: Expr<'g>,
    /// Indices and values of the entries of J.
    jacobian: Vec<(usize, Expr<'g>)>,
    /// p₁, p₂ and e of an element between points.
    line: Option<([Vec3<'g>; 2], Vec3<'g>)>,
}

/// The position of an end in the world.
fn point<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, end: &Attachment) -> Vec3<'g> {
    let at = model.vector(&end.position);
    match end.body {
        Some(BodyId(body)) => {
            let Pose { rotation, origin } = kinematics.poses[body];
            origin + rotation.apply(at)
        }
        None => at,
    }
}

impl<'g> Stretched<'g> {
    fn new(model: &Model<'g>, kinematics: &Kinematics<'g>, connector: &Connector) -> Self {
        let [first, end] = model.chain.spanned(connector);
        match &connector.strain {
            Strain::Distance(ends) => {
                let points = ends.each_ref().map(|end| point(model, kinematics, end));
                let way = points[1] - points[0];
                let length = way.dot(way).sqrt();
                let direction = (1.0 / length) * way;
                let moves_second = model.chain.reach(&ends[1]) == end;
                let (moved, sign) = if moves_second { (points[1], 1.0) } else { (points[0], -1.0) };
                let column = |j: usize| (j, sign * direction.dot(kinematics.generators[j].velocity(moved)));
                Stretched { length, jacobian: (first..end).map(column).collect(), line: Some((points, direction)) }
            }
            Strain::Coupling { coordinate: CoordinateId(j), leader: CoordinateId(i), ratio } => {
                let ratio = model.number(ratio);
                let mut jacobian = vec![(*j, model.graph.constant(1.0)), (*i, -ratio)];
                jacobian.sort_by_key(|(place, _)| *place);
                Stretched { length: model.q[*j] - ratio * model.q[*i], jacobian, line: None }
            }
        }
    }

    /// The bodies that it pulls with 1 N, in the world: place, point, force.
    fn pulls(&self, connector: &Connector) -> impl Iterator<Item = (Place, Vec3<'g>, Vec3<'g>)> {
        let place = |end: &Attachment| end.body.map(|body| Place { body, along: end.position[0].clone() });
        let of_line = match (&connector.strain, self.line) {
            (Strain::Distance(ends), Some((points, direction))) => {
                vec![(place(&ends[0]), points[0], direction), (place(&ends[1]), points[1], -direction)]
            }
            _ => Vec::new(),
        };
        of_line.into_iter().filter_map(|(place, point, pull)| Some((place?, point, pull)))
    }

    /// ℓ̇
    fn rate(&self, model: &Model<'g>, v: &[Expr<'g>]) -> Expr<'g> {
        self.jacobian.iter().fold(model.zero(), |sum, &(j, column)| sum + column * v[j])
    }
}

/// Length and rate on which the force depends; at rest there are no rates, not even that of a winch.
#[derive(Clone, Copy, Debug)]
struct State<'g> {
    t: Expr<'g>,
    length: Expr<'g>,
    rate: Option<Expr<'g>>,
}

/// A rope: ℓ₀ − ℓ, the stretch σ and its rate σ̇.
struct Rope<'g> {
    slack: Expr<'g>,
    stretch: Expr<'g>,
    rate: Expr<'g>,
}

impl<'g> Rope<'g> {
    fn new(model: &Model<'g>, state: &State<'g>, unstretched: &Profile) -> Self {
        let length = profile::position(model, unstretched, state.t);
        let slack = length - state.length;
        Rope {
            slack,
            stretch: slack.select(model.zero(), state.length - length),
            rate: state.rate.map_or(model.zero(), |rate| rate - profile::rate(model, unstretched, state.t)),
        }
    }

    /// `number` if the rope is taut, otherwise 0. A rope that is just taut counts, because Newton's method starts with ropes that
    /// are about to pull.
    fn where_taut(&self, number: Expr<'g>) -> Expr<'g> {
        self.slack.select(self.slack.graph().constant(0.0), number)
    }
}

/// F
fn force<'g>(model: &Model<'g>, law: &ConnectorLaw, state: &State<'g>) -> Expr<'g> {
    match law {
        ConnectorLaw::Linear { stiffness, damping, length, push } => {
            let elastic = model.number(stiffness) * (state.length - model.number(length)) - model.number(push);
            state.rate.map_or(elastic, |rate| elastic + model.number(damping) * rate)
        }
        ConnectorLaw::Rope { stiffness, damping, length } => {
            let rope = Rope::new(model, state, length);
            let growth = (1.0 + model.number(damping) * rope.rate).max(model.zero());
            model.number(stiffness) * rope.stretch * growth
        }
    }
}

/// `∂F/∂ℓ` and `∂F/∂ℓ̇`.
fn slopes<'g>(model: &Model<'g>, law: &ConnectorLaw, state: &State<'g>) -> [Expr<'g>; 2] {
    match law {
        ConnectorLaw::Linear { stiffness, damping, .. } => [model.number(stiffness), model.number(damping)],
        ConnectorLaw::Rope { stiffness, damping, length } => {
            let rope = Rope::new(model, state, length);
            let (stiffness, damping) = (model.number(stiffness), model.number(damping));
            let growth = 1.0 + damping * rope.rate;
            let by_length = rope.where_taut(stiffness * growth.max(model.zero()));
            [by_length, growth.select(stiffness * damping * rope.stretch, model.zero())]
        }
    }
}

/// All connectors at time t, moving or at rest.
fn stretched<'g, 'a>(
    model: &'a Model<'g>,
    kinematics: &'a Kinematics<'g>,
    (t, v): (Expr<'g>, Option<&'a [Expr<'g>]>),
) -> impl Iterator<Item = (&'a Connector, Stretched<'g>, State<'g>)> {
    model.chain.connectors.iter().map(move |connector| {
        let stretched = Stretched::new(model, kinematics, connector);
        let state = State { t, length: stretched.length, rate: v.map(|v| stretched.rate(model, v)) };
        (connector, stretched, state)
    })
}

/// Generalized forces at time t, `−Jᵀ F`; without rates those at rest.
pub fn forces<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    t: Expr<'g>,
    v: Option<&[Expr<'g>]>,
) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for (connector, stretched, state) in stretched(model, kinematics, (t, v)) {
        let pull = force(model, &connector.law, &state);
        for (j, column) in stretched.jacobian {
            forces[j] = forces[j] - column * pull;
        }
    }
    forces
}

/// ℓ and ℓ̇ of every connector.
pub fn lengths<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let pair = |connector| {
        let stretched = Stretched::new(model, kinematics, connector);
        [stretched.length, stretched.rate(model, &model.v)]
    };
    model.chain.connectors.iter().flat_map(pair).collect()
}

/// J of every connector, row by row.
pub fn jacobians<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let row = |connector| {
        let mut row = model.zeros();
        for (j, column) in Stretched::new(model, kinematics, connector).jacobian {
            row[j] = column;
        }
        row
    };
    model.chain.connectors.iter().flat_map(row).collect()
}

/// `F, ∂F/∂ℓ, ∂F/∂ℓ̇` of every connector.
pub fn tensions<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let all = stretched(model, kinematics, (model.t, Some(&model.v)));
    all.flat_map(|(Connector { law, .. }, _, state)| {
        let [by_length, by_rate] = slopes(model, law, &state);
        [force(model, law, &state), by_length, by_rate]
    })
    .collect()
}

/// `½ Σ k (ℓ − ℓ₀)² − P (ℓ − ℓ₀)`, for ropes `½ Σ k σ²`.
pub fn energy<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Expr<'g> {
    let all = stretched(model, kinematics, (model.t, None));
    all.fold(model.zero(), |sum, (connector, _, state)| {
        sum + match &connector.law {
            ConnectorLaw::Linear { stiffness, length, push, .. } => {
                let stretch = state.length - model.number(length);
                0.5 * (model.number(stiffness) * stretch.squared()) - model.number(push) * stretch
            }
            ConnectorLaw::Rope { stiffness, length, .. } => {
                0.5 * (model.number(stiffness) * Rope::new(model, &state, length).stretch.squared())
            }
        }
    })
}

/// Dissipated power: `d ℓ̇²`, for ropes `k σ max(−1, a σ̇) σ̇`.
pub fn dissipation<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Expr<'g> {
    let all = stretched(model, kinematics, (model.t, Some(&model.v)));
    all.fold(model.zero(), |sum, (connector, _, state)| {
        sum + match &connector.law {
            ConnectorLaw::Linear { damping, .. } => {
                model.number(damping) * state.rate.unwrap_or(model.zero()).squared()
            }
            ConnectorLaw::Rope { stiffness, damping, length } => {
                let rope = Rope::new(model, &state, length);
                let share = (model.number(damping) * rope.rate).max(model.graph.constant(-1.0));
                model.number(stiffness) * rope.stretch * (share * rope.rate)
            }
        }
    })
}

/// Power input of the winches, `−Σ F ℓ̇₀`.
pub fn winch_power<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Expr<'g> {
    let all = stretched(model, kinematics, (model.t, Some(&model.v)));
    all.fold(model.zero(), |sum, (connector, _, state)| match connector.winch() {
        Some(length) => sum - force(model, &connector.law, &state) * profile::rate(model, length, model.t),
        None => sum,
    })
}

/// Start and end of the intervals in which every winch moves smoothly.
pub fn pieces<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let winches = model.chain.connectors.iter().filter_map(Connector::winch);
    winches.flat_map(Profile::pieces).flatten().map(|time| model.number(&time)).collect()
}

/// Adds `∂²E/∂q_i∂q_j` at rest at time t.
pub fn stiffness<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, t: Expr<'g>, matrix: &mut SymmetricMatrix<'g>) {
    let forces = forces(model, kinematics, t, None);
    let reach = model.chain.connectors.iter().map(|connector| model.chain.spanned(connector)[1]).max().unwrap_or(0);
    model.add_tangent(&forces, &(0..reach).collect(), matrix);
}

/// Adds `Σ Jᵀ ∂F/∂ℓ̇ J` at rest at time t.
pub fn damping<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, t: Expr<'g>, matrix: &mut SymmetricMatrix<'g>) {
    for (connector, stretched, state) in stretched(model, kinematics, (t, None)) {
        let [_, by_rate] = slopes(model, &connector.law, &state);
        for (place, &(j, one)) in stretched.jacobian.iter().enumerate() {
            for &(i, other) in &stretched.jacobian[..=place] {
                matrix.add(i, j, by_rate * one * other);
            }
        }
    }
}

/// Forces on the bodies at both ends, in the world: place, point, force. Couplings have none: they act on their
/// joints, like drives.
pub fn pulls<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<(Place, Vec3<'g>, Vec3<'g>)> {
    let all = stretched(model, kinematics, (model.t, Some(&model.v)));
    all.flat_map(|(connector, stretched, state)| {
        let force = force(model, &connector.law, &state);
        stretched.pulls(connector).map(|(place, point, pull)| (place, point, force * pull)).collect::<Vec<_>>()
    })
    .collect()
}

/// The same for a connector that pulls with 1 N at two bodies; none if it holds to the world.
pub fn between_bodies<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    connector: &Connector,
) -> Vec<(Place, Vec3<'g>, Vec3<'g>)> {
    if !connector.joins_bodies() {
        return Vec::new();
    }
    Stretched::new(model, kinematics, connector).pulls(connector).collect()
}
