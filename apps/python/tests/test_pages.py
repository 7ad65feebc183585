"""Cranes and runs as pages: what a notebook shows. How a browser shows them is tested in apps/report."""

import base64
import html
import json
import pickle
import re
from xml.etree import ElementTree

import crane
import numpy as np
import pytest

from conftest import PENDULUM


def data(page):
    """What the script of a page reads."""
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)[1])


def embedded(shown):
    """The page inside the output for a notebook."""
    return html.unescape(re.search(r'srcdoc="(.*?)"', shown, re.DOTALL)[1])


def numbers(columns):
    """32-bit numbers, column by column."""
    return np.frombuffer(base64.b64decode(columns["data"]), "<f4").reshape(len(columns["columns"]), columns["rows"])


def test_a_notebook_shows_a_crane_at_rest(knuckle):
    """One root element, well-formed: page, name, every parameter."""
    shown = knuckle._repr_html_()
    assert embedded(shown) == knuckle.page()
    root = ElementTree.fromstring(shown.replace("<br>", "<br/>"))
    assert root.find("iframe").get("sandbox") == "allow-scripts allow-downloads"
    texts = " ".join(root.itertext())
    assert "knuckle_boom" in texts and "payload" in texts and "kg" in texts
    (at_rest,) = data(knuckle.page())["cranes"]
    assert at_rest["record"] is None
    assert at_rest["scene"]["pose"] == knuckle.statics().q.tolist()
    assert [mode["frequency"] for mode in at_rest["modes"]] == knuckle.modes().frequencies.tolist()
    results = dict(zip((column["name"] for column in at_rest["run"]["columns"]), numbers(at_rest["run"]), strict=True))
    efforts = [results[name] for name in results if name.endswith(("_drive_torque", "_drive_force"))]
    # At rest, not at the end of the manoeuvre; 32-bit numbers.
    np.testing.assert_allclose(np.ravel(efforts), knuckle.statics().drive_efforts, rtol=2**-23, atol=1e-6)


def tables(page):
    """Rows of the tables of a page by the tables' keys, as dictionaries by column."""
    grids = data(page)["tables"]["grids"]
    return {grid["key"]: [dict(zip(grid["headers"], row, strict=True)) for row in grid["exact"]] for grid in grids}


def test_pages_have_the_tables_of_the_command(knuckle):
    """At rest those of statics and modes, and with a run its extremes."""
    equilibrium = knuckle.statics()
    at_rest = tables(knuckle.page())
    assert [float(row["value"]) for row in at_rest["drives"]] == equilibrium.drive_efforts.tolist()
    points = [[float(row[axis]) for axis in "xyz"] for row in at_rest["points"]]
    assert points == equilibrium.points.tolist()
    frequencies = [float(row["frequency [Hz]"]) for row in at_rest["undamped"]]
    np.testing.assert_allclose(frequencies, knuckle.modes().frequencies, rtol=1e-15)
    assert {"damped", "limits", "pose"} <= at_rest.keys() and "extremes" not in at_rest
    run = knuckle.simulate(duration=0.5, output=0.01)
    moved = tables(run.page())
    names = [row[0] for grid in data(run.page())["tables"]["grids"] if grid["key"] == "extremes" for row in grid["rows"]]
    for name, row in zip(names, moved["extremes"], strict=True):
        extremes = run.extremes(name)
        assert (float(row["minimum"]), float(row["maximum"])) == (extremes["minimum"], extremes["maximum"]), name
        assert (float(row["error"]), float(row["missed"])) == (run.errors[name], run.missed[name]), name
    assert {"main_boom_theta_drive_torque", "load_centre_z"} <= set(names)
    facts = dict((name, value) for name, value, _ in data(run.page())["tables"]["facts"])
    assert "converged to a stable equilibrium" in facts["knuckle_boom"]


def test_a_batch_is_shown_by_its_first_row(knuckle):
    shown = knuckle.replace(payload=[100.0, 900.0])._repr_html_()
    assert "(2,): 100 to 900" in shown and "the first row" in shown
    assert embedded(shown) == knuckle.replace(payload=100.0).page()


def test_text_of_a_spec_is_escaped():
    odd = crane.load("odd.yaml", text=PENDULUM.replace("about: what hangs", "about: 'a < b & c </script>'"))
    assert "a &lt; b &amp; c" in odd._repr_html_()
    page = odd.page()
    assert page.count("</script>") == 2
    assert data(page)["spec"] == odd.spec


@pytest.mark.parametrize("verify", [True, False])
def test_a_run_is_shown_with_all_its_columns(knuckle, verify):
    run = knuckle.replace(payload=700.0).simulate(duration=0.5, output=0.01, verify=verify)
    page = run.page()
    assert embedded(run._repr_html_()) == page
    (moving,) = data(page)["cranes"]
    assert {column["name"]: column["unit"] for column in moving["run"]["columns"]} == run.units
    np.testing.assert_array_equal(numbers(moving["run"]), run.table.T.astype(np.float32))
    record = moving["record"]
    assert record["parameters"]["payload"] == {"value": 700.0, "unit": "kg"}
    assert (record["duration_s"], record["output_s"], record["steps"]) == (0.5, 0.01, run.statistics["steps"])
    assert (record["differences_from_a_finer_run"], record["missed_between_results"]) == (run.errors, run.missed)
    assert pickle.loads(pickle.dumps(run)).page() == page


def test_a_table_of_another_crane_is_refused(knuckle, pendulum):
    run = pendulum.simulate(duration=0.1)
    object.__setattr__(run, "crane", knuckle)
    with pytest.raises(ValueError, match="the table of a run of knuckle_boom has .* columns"):
        run.page()


def test_a_crane_that_does_not_rest_has_a_page(pendulum):
    """Upside down it has no stable equilibrium: modes are missing, the crane is shown."""
    falling = crane.load("falling.yaml", text=PENDULUM.replace("run:", "gravity: [0, 0, 9.81]\nrun:"))
    with pytest.raises(crane.NoEquilibrium):
        falling.statics()
    (shown,) = data(falling.page())["cranes"]
    assert shown["modes"] == [] and len(shown["scene"]["pose"]) == 1


def test_a_pose_is_rendered(knuckle):
    """The crane is more colourful than the ground; it looks different from above, and smaller where there is room for other poses."""
    q = knuckle.statics().q
    image = knuckle.render(q, 120, 80)
    assert (image.shape, image.dtype) == ((80, 120, 3), np.uint8)
    np.testing.assert_array_equal(knuckle.render(width=120, height=80), image)
    np.testing.assert_array_equal(knuckle.render(np.stack([q, -q]).T.copy().T[0].tolist(), 120, 80), image)
    covered = lambda image: np.mean(np.ptp(image.astype(int), axis=2) > 25)
    # Links are narrow: a twentieth of the picture. Room for a boom of three times the length halves that.
    assert 0.03 < covered(image) < 0.1
    extended = q + [0, 0, 10, 0]
    assert covered(knuckle.render(q, 120, 80, shown=[q, extended])) < 0.6 * covered(image)
    assert (knuckle.render(q, 120, 80, elevation=1.5) != image).any() and (knuckle.render(q, 120, 80, azimuth=1.5) != image).any()
    moved = knuckle.render(q + 0.2, 120, 80, shown=[q, q + 0.2])
    assert (moved != knuckle.render(q, 120, 80, shown=[q, q + 0.2])).any()


@pytest.mark.parametrize(
    "given, message",
    [
        ({"width": 4097}, "4097 × 480: write 1 to 4096 picture elements"),
        ({"height": -1}, "640 × -1: write 1 to 4096"),
        ({"azimuth": np.inf}, "azimuth inf.*: write finite numbers, rad"),
        ({"q": np.zeros((2, 4))}, "a picture shows one"),
        ({"q": np.full(4, np.nan)}, "not all numbers are finite"),
        ({"q": np.zeros(3)}, "3 numbers in its last axis"),
    ],
)
def test_what_cannot_be_rendered_is_refused(knuckle, given, message):
    with pytest.raises(ValueError, match=message):
        knuckle.render(**given)
