"""Every quantity compared with CasADi's derivation from the YAML alone, which shares no code with the compiler."""

from functools import partial

import crane
import numpy as np
import pytest
from crane import _native

from conftest import ROOT

pytest.importorskip("casadi")

NEAR_AND_FAR = 16


def on_paper(c, t, q, v, names=None):
    """Quantities under the names of the derivation: a row per state. names: all, unless given."""
    bodies = [body["degrees_of_freedom"] for body in c.info["bodies"]]
    first, second = c.transform_derivatives(q), c.transform_second_derivatives(q)
    stored = [first[:, p, i] for p, dof in enumerate(bodies) for i in range(dof)]
    pairs = [second[:, p, m, n] for p, dof in enumerate(bodies) for m in range(dof) for n in range(m, dof)]
    # The derivation uses the rates as accelerations, too.
    given = {"t": t, "q": q, "v": v, "a": v}
    of_table = {
        name: partial(getattr(c, name), *(given[argument] for argument in arguments)) for name, arguments, _ in _native.functions()
    }
    quantities = {
        **of_table,
        "transform_derivatives": lambda: np.stack(stored, axis=1),
        "transform_second_derivatives": lambda: np.stack(pairs, axis=1),
        "internal_forces": lambda: c.internal_forces(q, v, v, t),
        "linearised_mass": lambda: c.linearise(q).mass,
        "linearised_stiffness": lambda: c.linearise(q).stiffness,
        "linearised_damping": lambda: c.linearise(q).damping,
    }
    return {name: quantities[name]().reshape(len(t), -1) for name in names or quantities}


@pytest.mark.parametrize("name", ["eight_link_rigid", "eight_link_identified", "knuckle_boom", "double_pendulum"])
def test_quantities(name):
    """States near the guess and far from it, each with its own parameters: one batch, each row a lane of eight."""
    from comparison import compare
    from crane_model import read_crane
    from derivations import Derivations
    from states import random_states

    derived_crane = read_crane(ROOT / f"specs/{name}.yaml")
    states = random_states(derived_crane, NEAR_AND_FAR, 1)
    derived = Derivations(derived_crane).evaluate(states)
    parameters = dict(zip(derived_crane.spec.defaults, states.parameters.T, strict=True))
    c = crane.load(name, **parameters)
    assert c.coordinates == [coordinate.name for coordinate in derived_crane.coordinates]
    for quantity, values in on_paper(c, states.time, states.q, states.v).items():
        if quantity not in derived or values.shape[1] == 0:
            # A part that the crane does not have.
            np.testing.assert_array_equal(values, 0)
            continue
        comparison = compare(quantity, derived[quantity], values, states.groups)
        assert comparison.passed, comparison.row()


@pytest.mark.parametrize("name", ["eight_link_rigid", "knuckle_boom", "double_pendulum"])
def test_small_motions_about_any_motion(name):
    """K and D compared with CasADi's Jacobians of the required forces `A a − e − f`, from its own A, e and f."""
    import casadi as ca
    from crane_model import read_crane
    from derivations import Derivations
    from states import random_states

    derived_crane = read_crane(ROOT / f"specs/{name}.yaml")
    derivations = Derivations(derived_crane)
    states = random_states(derived_crane, NEAR_AND_FAR, 2)
    time, q, v, parameters = derivations.arguments
    count = q.numel()
    a = ca.SX.sym("a", count)
    mass = ca.reshape(derivations.quantities["mass_matrix"], count, count)
    required = mass @ a - derivations.quantities["bias"] - derivations.quantities["forces"]
    jacobians = ca.Function("k_and_d", [time, q, v, parameters, a], [ca.jacobian(required, q), ca.jacobian(required, v)])
    c = crane.load(name, **dict(zip(derived_crane.spec.defaults, states.parameters.T, strict=True)))
    accelerations = np.random.default_rng(3).normal(size=states.q.shape)
    small = c.linearise(states.q, states.v, accelerations, states.time)
    for row in range(NEAR_AND_FAR):
        stiffness, damping = jacobians(
            states.time[row], states.q[row], states.v[row], states.parameters[row], accelerations[row]
        )
        for found, expected in ((small.stiffness[row], stiffness), (small.damping[row], damping)):
            expected = expected.full()
            # Some hundred roundings of the largest entry, a support's stiffness or that of the inertia of all masses.
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("name", ["eight_link_rigid", "knuckle_boom"])
def test_products_with_derivatives(name):
    """wᵀ ∂r/∂(q, v, a, p) and ∂r/∂(q, v, a, p) x of `r = A a − e − f`, by CasADi's own backward and forward mode on its own A, e and f."""
    import casadi as ca
    from crane_model import read_crane
    from derivations import Derivations
    from states import random_states

    derived_crane = read_crane(ROOT / f"specs/{name}.yaml")
    derivations = Derivations(derived_crane)
    states = random_states(derived_crane, NEAR_AND_FAR, 5)
    time, q, v, parameters = derivations.arguments
    count = q.numel()
    a, weights = ca.SX.sym("a", count), ca.SX.sym("w", count)
    mass = ca.reshape(derivations.quantities["mass_matrix"], count, count)
    residual = mass @ a - derivations.quantities["bias"] - derivations.quantities["forces"]
    numbers = ca.vertcat(q, v, a, parameters)
    change = ca.SX.sym("x", numbers.numel())
    products = [ca.jtimes(residual, numbers, weights, True), ca.jtimes(residual, numbers, change)]
    products = ca.Function("products", [time, q, v, parameters, a, weights, change], products)
    c = crane.load(name, **dict(zip(derived_crane.spec.defaults, states.parameters.T, strict=True)))
    rng = np.random.default_rng(6)
    accelerations, w = rng.normal(size=states.q.shape), rng.normal(size=states.q.shape)
    x = rng.normal(size=(NEAR_AND_FAR, numbers.numel()))
    state = {"q": states.q, "v": states.v, "a": accelerations, "t": states.time}
    backward = c.vjp("dynamic_residual", w, **state)
    backward = np.concatenate([backward[key] for key in "qva"] + [backward[key][:, None] for key in c.parameters], axis=1)
    parts = np.split(x, [count, 2 * count, 3 * count], axis=1)
    changes = dict(zip("qva", parts, strict=False)) | dict(zip(c.parameters, parts[3].T, strict=True))
    forward = c.jvp("dynamic_residual", changes, **state)
    for row in range(NEAR_AND_FAR):
        given = (states.time[row], states.q[row], states.v[row], states.parameters[row], accelerations[row], w[row], x[row])
        for found, expected in zip((backward[row], forward[row]), products(*given), strict=True):
            expected = expected.full().ravel()
            # Some hundred roundings of the largest entry, a support's stiffness or that of the inertia of all masses.
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_accelerations_of_closed_loops(tmp_path):
    """The four-bar of the manual on a slewing column, with friction in its loop joint: accelerations in a run compared with those by Lagrange's
    multipliers, from CasADi's own A, e, f, rows and curvatures of the gaps."""
    from crane_model import read_crane
    from derivations import Derivations
    from states import States

    page = (ROOT / "docs/manual/loops.md").read_text()
    text = page.split("```yaml\n")[1].split("```")[0]
    column = "  - {name: column, joint: revolute, mass: 300, com: [0.1, 0, 1], inertia: {Ixx: 60, Iyy: 60, Izz: 20}}\n"
    text = text.replace("  - name: crank\n", column + "  - name: crank\n").replace("from: {at: [1.2", "from: {link: column, at: [1.2")
    pin = "    joint: {pin: {axis: [0, 1, 0], to_axis: [0, 0, 1]}}\n"
    text = text.replace(pin, pin + "    friction: {coulomb: 3, breakaway: 4, width: 0.05}\n    damping: 2\n")
    text = text.replace("drives:\n", "drives:\n  - {coordinate: column_psi, stiffness: 1e4, damping: 200, motion: {quintic: {from: 0, to: 1, duration: 1}}}\n")
    file = tmp_path / "four_bar.yaml"
    file.write_text(text)
    derived_crane = read_crane(file)
    c = crane.load(str(file))
    run = c.simulate(duration=1, output=0.1, tolerance=1e-9, verify=False)
    names = [coordinate.name for coordinate in derived_crane.coordinates]
    q, v = (np.stack([run[f"{name}{end}"] for name in names], axis=1) for end in ("", "_rate"))
    states = States(np.array(run["t"]), q, v, np.zeros((len(q), 0)))
    derivations = Derivations(derived_crane)
    expected = derivations.closed_accelerations(derivations.evaluate(states))
    assert np.abs(run["ground_pin_friction_torque"]).max() > 3
    # Elimination and least squares differ by the conditions of A and of the rows; the table of the run has rounded rates.
    np.testing.assert_allclose(c.forward_dynamics(q, v, states.time), expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def test_accelerations_with_rigid_couplings(tmp_path):
    """A screw and a belt beside a rod that closes a loop: in a run, accelerations by Lagrange's multipliers as above, and equations."""
    from comparison import compare
    from crane_model import read_crane
    from derivations import Derivations
    from states import States, random_states

    derived_crane = read_crane(ROOT / "tools/casadi/geared.yaml")
    derivations = Derivations(derived_crane)
    states = random_states(derived_crane, NEAR_AND_FAR, 1)
    derived = derivations.evaluate(states)
    parameters = dict(zip(derived_crane.spec.defaults, states.parameters.T, strict=True))
    c = crane.load(ROOT / "tools/casadi/geared.yaml", **parameters)
    found = on_paper(c, states.time, states.q, states.v, ["loop_states", "loop_jacobians"])
    for quantity, values in found.items():
        comparison = compare(quantity, derived[quantity], values, states.groups)
        assert comparison.passed, comparison.row()
    c = crane.load(ROOT / "tools/casadi/geared.yaml", rest=0.3)
    run = c.simulate(duration=1, output=0.1, tolerance=1e-9, verify=False)
    q, v = (np.stack([run[f"{name}{end}"] for name in c.coordinates], axis=1) for end in ("", "_rate"))
    np.testing.assert_allclose(q[:, 2], 0.05 * q[:, 0] + 0.3, rtol=0, atol=1e-15)
    states = States(np.array(run["t"]), q, v, np.tile([0.05, 0.3], (len(q), 1)))
    expected = derivations.closed_accelerations(derivations.evaluate(states))
    np.testing.assert_allclose(c.forward_dynamics(q, v, states.time), expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def test_a_beam_of_parts(tmp_path):
    """A stepped, tapered, curved beam with a live dimension: CasADi integrates with 24 points per part, we with ten or in closed form."""
    from comparison import compare
    from crane_model import read_crane
    from derivations import Derivations
    from states import random_states

    file = tmp_path / "parts.yaml"
    file.write_text(
        """
format: 1
name: parts
parameters: {wall: {value: 0.008, unit: m}}
links:
  - name: boom
    joint: revolute
    beam:
      length: 3.5
      sections: 3
      material: {E: 2.1e11, G: 8.1e10, density: 7850, yield_stress: 3.5e8}
      parts:
        - {length: 1.2, section: {box: {height: 0.3, width: 0.2, thickness: wall}}}
        - {length: 1.5, section: {box: {height: 0.3, width: 0.2, thickness: 0.006}}, to: {box: {height: 0.16, width: 0.14, thickness: 0.005}}}
        - {length: 0.8, section: {tube: {diameter: 0.12, thickness: 0.01}}}
      bend: {psi: 12 deg, theta: -5 deg}
      extra_mass: 4
      damping: {beta: 1e-3}
drives: [{coordinate: boom_psi, stiffness: 1e6, motion: {hold: 0.3}}]
points: [{name: tip, link: boom, at: [3.5, 0, 0]}]
"""
    )
    derived_crane = read_crane(file)
    states = random_states(derived_crane, NEAR_AND_FAR, 5)
    derived = Derivations(derived_crane).evaluate(states)
    c = crane.load(str(file), wall=states.parameters[:, 0])
    for quantity in ("mass_matrix", "bias", "points", "transforms", "element_forces", "tangent_stiffness", "linearised_damping"):
        values = on_paper(c, states.time, states.q, states.v)[quantity]
        comparison = compare(quantity, derived[quantity], values, states.groups)
        assert comparison.passed, comparison.row()


def test_a_linkage_on_a_boom_that_bends(tmp_path):
    """Foot and pivot are on different elements of a curved boom: length, slopes, and the springs that stand for the oil at rest."""
    from comparison import compare
    from crane_model import read_crane
    from derivations import Derivations
    from states import random_states

    file = tmp_path / "linkage.yaml"
    file.write_text(
        """
format: 1
name: linkage
materials:
  steel: {E: 2.1e11, G: 8.1e10, density: 7850}
links:
  - {name: column, joint: revolute, mass: 300, com: [0, 0, 0.5], inertia: {Ixx: 40, Iyy: 40, Izz: 20}}
  - name: boom
    placement: {transform: {translation: [0, 0, 1.4], rotation: {x: 90 deg}}}
    joint: revolute
    beam:
      length: 3.2
      sections: 4
      material: steel
      section: {box: {height: 0.24, width: 0.18, thickness: 0.006}}
      bend: {psi: 12 deg, theta: -5 deg}
      damping: {beta: 1e-3}
  - {name: jib, joint: revolute, mass: 900, com: [3, 0, 0.3], inertia: {Ixx: 30, Iyy: 300, Izz: 300}}
drives:
  - {coordinate: column_psi, stiffness: 3e6, motion: {hold: 0}}
  - {coordinate: boom_psi, stiffness: 5e7, motion: {hold: 0.3}}
  - {coordinate: jib_psi, stiffness: 5e7, motion: {hold: -0.2}}
cylinders:
  - name: knuckle
    coordinate: jib_psi
    foot: {link: boom, at: [0.9, -0.22, 0.01]}
    head: {link: jib, at: [0.26, -0.18, 0.02]}
    linkage: {pivot: [2.7, 0.02, -0.03], rocker: 0.9, link: 1.0, side: right}
    bore: 0.115
    rod: 0.07
    retracted: 1.3
    stroke: 0.9
    max_pressure: 32e6
    bulk_modulus: 1.2e9
    hose_volumes: [1e-3, 1e-3]
    valve: {flow: 6e-4, pressure_drop: 1e6, lag: 0.03, gain: 2}
pump: {max_flow: 8e-4, pressure: 30e6}
"""
    )
    derived_crane = read_crane(file)
    states = random_states(derived_crane, NEAR_AND_FAR, 8)
    derived = Derivations(derived_crane).evaluate(states)
    c = crane.load(str(file))
    names = ("transforms", "mass_matrix", "bias", "cylinder_states", "cylinder_jacobians", "static_residual", "tangent_stiffness")
    for quantity, values in on_paper(c, states.time, states.q, states.v, names).items():
        comparison = compare(quantity, derived[quantity], values, states.groups)
        assert comparison.passed, comparison.row()
