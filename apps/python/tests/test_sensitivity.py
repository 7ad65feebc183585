"""Derivatives of a crane at rest, against differences of `statics` and `modes`."""

import crane
import numpy as np
import pytest

STEP = 1e-3

# An inverted pendulum: no stable pose.
UPSIDE_DOWN = """
format: 1
name: upside_down
parameters: {bob: {value: 2, unit: kg}}
links:
  - {name: rod, joint: {revolute: {axis: y}}, mass: bob, com: [0, 0, 1.5], inertia: {Ixx: 0.001, Iyy: 0.05, Izz: 0.05}}
"""


def test_derivatives_are_differences_of_equilibria():
    """Central differences have an error of the square of the step, 1e-6, and statics leaves 1e-10 of the forces."""
    here = crane.load("loader_tipping")
    found = here.sensitivity()
    load = here.parameters["load"]
    less, more = (here.replace(load=load * (1 + step)) for step in (-STEP, STEP))
    width = 2 * STEP * load

    points = (more.statics().points - less.statics().points)[0] / width
    for axis, expected in zip("xyz", points, strict=True):
        np.testing.assert_allclose(found.derivative(f"load_centre_{axis}", "load"), expected, rtol=1e-4, atol=1e-10)
    efforts = (more.statics().drive_efforts - less.statics().drive_efforts) / width
    own = [found.derivatives[index, 0] for index, group in enumerate(found.groups) if group == "drives"]
    np.testing.assert_allclose(own, efforts, rtol=1e-4, atol=1e-4)
    margin = (more.strength().tipping_margin - less.strength().tipping_margin) / width
    np.testing.assert_allclose(found.derivative("tipping_margin", "load"), margin, rtol=1e-4)
    frequencies = np.sqrt(more.modes().omega_squared[:3]) - np.sqrt(less.modes().omega_squared[:3])
    own = [found.derivative(f"frequency_{k}", "load") for k in (1, 2, 3)]
    np.testing.assert_allclose(own, frequencies / (2 * np.pi * width), rtol=1e-4, atol=1e-12)
    pose = (more.statics().q - less.statics().q) / width
    np.testing.assert_allclose(found.pose_derivatives[:, 0], pose, rtol=1e-4, atol=1e-10)


def test_numbers_of_the_spec_have_derivatives_by_their_places():
    here = crane.load("cantilever")
    length = "links.beam.beam.length"
    found = here.sensitivity(["tip_mass", length, "materials.steel.E"], frequencies=2)
    assert found.numbers == ("tip_mass", length, "materials.steel.E") and found.number_units == ("kg", "m", "Pa")
    np.testing.assert_allclose(found.number_values, [20, 2.0, 2.1e11])
    # Of a beam that bends under its own weight and the mass at its tip, the sag goes with 1/E, and the frequencies with its root: to
    # some thousandths, as the beam is bent.
    tip = found.outputs.index("tip_z")
    np.testing.assert_allclose(found.derivatives[tip, 2] * 2.1e11, -found.values[tip], rtol=1e-2)
    first = found.outputs.index("frequency_1")
    np.testing.assert_allclose(found.relative(0.1)[first, 2], 0.05, rtol=1e-2)


SOLID = """
extends: cantilever
name: solid
links:
  - {name: beam, beam: {section: {solid: {height: 0.1, width: 0.05}}}}
"""


def test_numbers_that_cannot_be_live_have_differences():
    here = crane.load("solid.yaml", text=SOLID)
    height = "links.beam.beam.section.solid.height"
    found = here.sensitivity([height, "tip_mass"])
    assert found.number_units == ("m", "kg")
    np.testing.assert_allclose(found.number_values, [0.1, 20])
    assert any("differences" in note for note in found.notes)
    # The exact derivatives do not depend on what else is asked for.
    np.testing.assert_array_equal(found.derivatives[:, 1], here.sensitivity(["tip_mass"]).derivatives[:, 0])
    # In the plane in which it is high, the frequency of a beam with a heavy tip rises with the height to the power of 1.5, less what the mass of the
    # beam adds; between 1 and 1.5.
    upright = max(range(3), key=lambda k: found.derivative(f"frequency_{k + 1}", height))
    index = found.outputs.index(f"frequency_{upright + 1}")
    power = found.derivatives[index, 0] * 0.1 / found.values[index]
    assert 0.9 < power < 1.5
    assert np.isfinite(found.pose_derivatives).all()


def test_a_batch_is_its_rows():
    here = crane.load("knuckle_boom")
    loads = np.array([[200.0, 500.0], [800.0, 900.0]])
    batch = here.replace(payload=loads).sensitivity()
    assert batch.derivatives.shape == (2, 2, len(batch.outputs), 1)
    for index in np.ndindex(loads.shape):
        alone = here.replace(payload=loads[index]).sensitivity()
        np.testing.assert_array_equal(batch.derivatives[index], alone.derivatives)
        assert batch.places[index].tolist() == alone.places.tolist()


def test_what_cannot_be_answered_is_said():
    here = crane.load("knuckle_boom")
    with pytest.raises(TypeError, match="no live parameter `pay`"):
        here.sensitivity(["pay"])
    with pytest.raises(ValueError, match="there is no `hoook`"):
        here.sensitivity(["links.hoook.mass"])
    with pytest.raises(ValueError, match="`links.knuckle` is not a number"):
        here.sensitivity(["links.knuckle"])
    with pytest.raises(crane.SpecError):
        crane.load("cantilever").sensitivity(["links.beam.beam.sections"])
    with pytest.raises(ValueError, match="no live parameters"):
        crane.load("double_pendulum").sensitivity()
    with pytest.raises(crane.NoEquilibrium):
        crane.load("upside_down.yaml", text=UPSIDE_DOWN).sensitivity()
