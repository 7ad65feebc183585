"""Examples of the manual's chapter on Python."""

import re

import numpy as np
import pytest
from conftest import ROOT


def block(heading):
    """The first example below a heading."""
    text = (ROOT / "docs/manual/python.md").read_text()
    return re.search(rf"^## {heading}$.*?^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)[1]


def test_fitting(capsys):
    """The fit finds the payload of the measurement, within its own deviation, and says how well; SciPy's own steps do not."""
    pytest.importorskip("scipy")
    from scipy.optimize import least_squares

    names = {"crane": __import__("crane")}
    exec(block("Fitting"), names)
    fit, deviation = names["fit"], names["deviation"]
    # Three deviations; the noise is fixed, 1 mm, known to a few per cent from 151 values.
    assert fit.success and abs(fit.x[0] - 620.0) < 3 * deviation and deviation < 20
    assert abs(np.sqrt(names["variance"]) / 1e-3 - 1) < 0.2
    assert re.match(r"payload = \d+ ± \d+ kg; differences of \d.\de-0\d m", capsys.readouterr().out)
    # At the default tolerance and steps of 1.5e-8 derivatives are noise.
    names["run"].update(tolerance=2e-5)
    default = least_squares(names["differences"], [400.0], x_scale=[100.0])
    exact = least_squares(names["differences"], [400.0], x_scale=[100.0], diff_step=1e-3)
    assert np.abs(default.jac - exact.jac).max() > 10 * np.abs(exact.jac).max()
