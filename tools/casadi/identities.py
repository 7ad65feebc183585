"""Laws of mechanics that the derivations must obey by themselves, whatever the generated code returns."""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from comparison import TOLERANCE


@dataclass
class Identity:
    """The violation of a law, relative to the size of its terms."""

    law: str
    error: float

    @property
    def passed(self):
        """Whether the error is within the tolerance; NaN is not."""
        return self.error <= TOLERANCE

    def row(self):
        """A row of the table."""
        return f"  {self.law:60} {self.error:10.1e}  {'ok' if self.passed else 'FAILED'}"


def identities(derivations, states, derived):
    """All laws at all states."""
    count = states.q.shape[1]
    square = (-1, count, count)
    mass, damping = derived["mass_matrix"].reshape(square), derived["linearised_damping"].reshape(square)
    stiffness = derived["tangent_stiffness"].reshape(square)
    kinetic_energy = np.einsum("si,sij,sj->s", states.v, mass, states.v) / 2
    smallest = np.linalg.eigvalsh(mass) if count else np.ones((1, 1))
    return [
        Identity("A is symmetric", relative(mass, mass.transpose(0, 2, 1))),
        Identity("A is positive definite", 0.0 if smallest.min() > 0 else np.inf),
        Identity("the tangent stiffness is symmetric", relative(stiffness, stiffness.transpose(0, 2, 1))),
        Identity("D is symmetric", relative(damping, damping.transpose(0, 2, 1))),
        Identity("half v A v = kinetic energy", relative(kinetic_energy, derived["kinetic_energy"][:, 0])),
        Identity("forces are the sum of their parts", relative(parts_of(derived), derived["forces"])),
        Identity("Adot - 2C is skew: v.Adot v / 2 = v.h", power_of_inertia(derivations, states, derived)),
        Identity("d(E_k + E_p)/dt = power put in - dissipation", power_balance(derivations, states, derived)),
        Identity("supports' forces on the base = sum of reactions", sum_of_reactions(derivations, derived)),
    ]


def relative(left, right, size=None):
    """Largest difference over the largest size."""
    size = np.abs(right) if size is None else size
    return float(np.abs(left - right).max(initial=0) / max(size.max(initial=0), np.finfo(float).tiny))


def parts_of(derived):
    """The sum of the generalized forces by part."""
    return sum(derived[f"{part}_forces"] for part in ("support", "element", "drive", "joint_damper", "stop", "friction", "load", "connector"))


def evaluate(derivations, expression, states):
    """An expression at all states, one row per state."""
    function = ca.Function("identity", derivations.arguments, [ca.densify(expression)])
    return function(states.time[None, :], states.q.T, states.v.T, states.parameters.T).full().T


def power_of_inertia(derivations, states, derived):
    """`½ vᵀ Ȧ v = vᵀ h`, with `e = -(h + g)` and g the gradient of the gravity energy."""
    crane = derivations.crane
    size = len(crane.coordinates)
    mass = ca.reshape(derivations.quantities["mass_matrix"], size, size)
    rate = evaluate(derivations, ca.dot(crane.v, ca.jtimes(mass @ crane.v, crane.q, crane.v)) / 2, states)
    gravity = evaluate(derivations, ca.gradient(derivations.quantities["gravity_energy"], crane.q), states)
    inertia = -derived["bias"] - gravity
    terms = np.abs(states.v * derived["bias"]).sum(axis=1)
    return relative(np.einsum("si,si->s", states.v, inertia), rate[:, 0], terms)


def power_balance(derivations, states, derived):
    """With q̈ from `A q̈ = e + f`: the rate of the energies is the power of drives, loads and winches minus dissipation."""
    crane, quantities = derivations.crane, derivations.quantities
    size = len(crane.coordinates)
    mass = derived["mass_matrix"].reshape(-1, size, size)
    acceleration = np.linalg.solve(mass, (derived["bias"] + derived["forces"])[..., None])[..., 0]
    potential = sum(quantities[f"{part}_energy"] for part in ("gravity", "support", "element", "drive", "stop", "connector"))
    kinetic = quantities["kinetic_energy"]
    rate = evaluate(derivations, derivations.rate(kinetic + potential), states)[:, 0]
    momentum = evaluate(derivations, ca.gradient(kinetic, crane.v), states)
    rate = rate + np.einsum("si,si->s", momentum, acceleration)
    put_in = derived["drive_power"][:, 0] + derived["load_power"][:, 0] + derived["winch_power"][:, 0] - derived["dissipation"][:, 0]
    terms = np.abs(states.v * derived["forces"]).sum(axis=1) + np.abs(states.v * derived["bias"]).sum(axis=1)
    return relative(rate, put_in, terms)


def sum_of_reactions(derivations, derived):
    """The force of the supports along each translation of the base that comes first is the sum of their reactions."""
    base = [i for i, c in enumerate(derivations.crane.coordinates) if c.is_base and not c.is_rotation]
    if not derivations.crane.supports or [derivations.crane.coordinates[i].name[-1] for i in base] != ["x", "y", "z"]:
        return 0.0
    reactions = derived["support_reactions"].reshape(len(derived["support_reactions"]), -1, 3).sum(axis=1)
    return relative(reactions, derived["support_forces"][:, base])
