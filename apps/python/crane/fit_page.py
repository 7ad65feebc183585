"""A fit as a page: its numbers, and every measured quantity beside what the fitted crane says. HTML that needs no network and no script."""

from collections.abc import Iterator
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from .fit_result import FEW, SeriesFit
from .results import Array

if TYPE_CHECKING:
    from .fit_result import Fit

STYLE = """
:root { color-scheme: light dark; --ink: light-dark(#222, #ddd); --soft: light-dark(#777, #999); --line: light-dark(#ccc, #444);
  --model: light-dark(#1667b7, #6db3f2); --dot: light-dark(#111, #eee); --band: light-dark(#1667b722, #6db3f233); --bad: light-dark(#b3261e, #f2b8b5); }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: light-dark(#fff, #161616); max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.4rem; margin: 0; } h2 { font-size: 1.1rem; margin: 2rem 0 .4rem; } p { margin: .3rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; } td, th { padding: .15rem .8rem .15rem 0; text-align: right; font-weight: normal; }
th { color: var(--soft); border-bottom: 1px solid var(--line); } td:first-child, th:first-child, td:last-child, th:last-child { text-align: left; }
.status { color: var(--soft); } .caution::before { content: "caution: "; color: var(--bad); }
svg { width: 100%; height: auto; display: block; margin: .3rem 0 1rem; } svg text { font: 12px system-ui, sans-serif; fill: var(--soft); }
.frame, .grid { stroke: var(--line); fill: none; } .model { stroke: var(--model); stroke-width: 1.6; fill: none; } .dot { fill: var(--dot); fill-opacity: .55; }
.band { fill: var(--band); }
"""
# Size of a plot, the place of its panels: left, right, top and bottom, in picture elements.
WIDTH, HEIGHT = 900, 400
LEFT, RIGHT = 80, 885
VALUES, RESIDUALS = (12, 240), (270, 360)


def page(fit: "Fit") -> str:
    """The page of a fit."""
    title = f"Fit of {escape(fit.crane.name)}"
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1"><style>{STYLE}</style></head>
<body><h1>{title}</h1>
{"".join(_body(fit))}</body></html>
"""


def _body(fit: "Fit") -> Iterator[str]:
    numbers, measured, words = fit.tables()
    values = sum(len(one.measured) for one in fit.series)
    yield f'<p class="status">{len(fit.names)} numbers, {values} measured values: {escape(fit.status)}</p>\n'
    yield _table(numbers)
    yield "".join(f"<p>{escape(line)}</p>\n" for line in words)
    yield "".join(f'<p class="caution">{escape(caution)}</p>\n' for caution in fit.cautions)
    yield "<h2>What was measured</h2>\n" + _table(measured)
    single = [one for one in fit.series if len(one.measured) < 4]
    if single:
        rows = [("single values", "measured", "fitted crane", "difference in deviations", "unit")]
        for one in single:
            parts = zip(one.measured, one.model, one.residuals / one.noise, strict=True)
            rows += [(f"{one.experiment}: {one.column}", f"{m:.5g}", f"{model:.5g}", f"{r:+.2f}", one.unit) for m, model, r in parts]
        yield _table(rows)
    for one in fit.series:
        if len(one.measured) >= 4:
            yield f"<h2>{escape(f'{one.experiment}: {one.column}')}</h2>\n{_plot(one)}"


def _table(rows: list[tuple[str, ...]]) -> str:
    """Rows, of which the first one is the head."""
    head, *others = ("".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in row) for tag, row in [("th", rows[0]), *(("td", row) for row in rows[1:])])
    return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(f'<tr>{row}</tr>' for row in others)}</tbody></table>\n"


def _plot(one: SeriesFit) -> str:
    """Measured values as dots, the model as a line, and residuals in deviations with the band that contains 95 % of noise."""
    deviations = one.residuals / one.noise
    reach = max(3.0, float(np.max(np.abs(deviations))) * 1.1)
    x = _Scale(one.at, LEFT, RIGHT)
    upper = _Scale(np.concatenate([one.measured, one.model]), VALUES[1], VALUES[0])
    lower = _Scale(np.array([-reach, reach]), RESIDUALS[1], RESIDUALS[0])
    at = x(one.at)
    line = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(at, upper(one.model), strict=True))
    dots = "".join(_dot(a, b) for a, b in zip(at, upper(one.measured), strict=True))
    below = "".join(_dot(a, b) for a, b in zip(at, lower(deviations), strict=True))
    top, bottom = lower(np.array([1.96, -1.96]))
    ticks = "".join(f'<text x="{x(np.array([v]))[0]:.1f}" y="{RESIDUALS[1] + 18}" text-anchor="middle">{v:g}</text>' for v in x.ticks())
    left = "".join(_label(value, upper) for value in upper.ticks()) + "".join(_label(value, lower) for value in (-2.0, 0.0, 2.0))
    axis = "t [s]" if len(one.at) >= FEW or np.any(one.at % 1) else "row"
    said = escape(f"Measured values of {one.column} as dots, the fitted crane as a line; below, differences in standard deviations.")
    return f"""<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{said}">
<rect class="band" x="{LEFT}" y="{top:.1f}" width="{RIGHT - LEFT}" height="{bottom - top:.1f}"/>
{left}{ticks}<g>{dots}{below}</g><polyline class="model" points="{line}"/>
<rect class="frame" x="{LEFT}" y="{VALUES[0]}" width="{RIGHT - LEFT}" height="{VALUES[1] - VALUES[0]}"/>
<rect class="frame" x="{LEFT}" y="{RESIDUALS[0]}" width="{RIGHT - LEFT}" height="{RESIDUALS[1] - RESIDUALS[0]}"/>
<text x="{LEFT}" y="{VALUES[1] + 20}">{escape(f"{one.column} [{one.unit}]" if one.unit else one.column)}; below: (model − measured)/noise</text>
<text x="{RIGHT}" y="{HEIGHT - 4}" text-anchor="end">{axis}</text></svg>
"""


def _dot(x: float, y: float) -> str:
    return f'<circle class="dot" cx="{x:.1f}" cy="{y:.1f}" r="1.8"/>'


def _label(value: float, scale: "_Scale") -> str:
    """A line of the grid with its number."""
    y = scale(np.array([value]))[0]
    number = f'<text x="{LEFT - 8}" y="{y + 4:.1f}" text-anchor="end">{value:g}</text>'
    return f'<line class="grid" x1="{LEFT}" x2="{RIGHT}" y1="{y:.1f}" y2="{y:.1f}"/>{number}'


class _Scale:
    """From numbers to places between two ends of a plot."""

    def __init__(self, numbers: Array, begin: float, end: float) -> None:
        low, high = float(np.min(numbers)), float(np.max(numbers))
        margin = 0.04 * (high - low) or abs(high) * 0.1 or 1.0
        self._low, self._high, self._begin, self._end = low - margin, high + margin, begin, end

    def __call__(self, numbers: Array) -> Array:
        return self._begin + (numbers - self._low) / (self._high - self._low) * (self._end - self._begin)

    def ticks(self) -> list[float]:
        """Four to eight round numbers."""
        width = self._high - self._low
        step = 10.0 ** np.floor(np.log10(width / 4))
        step *= next(factor for factor in (1, 2, 5, 10) if width / (step * factor) <= 8)
        first = np.ceil(self._low / step)
        return [float(f"{k * step:.10g}") + 0.0 for k in np.arange(first, np.floor(self._high / step) + 1)]
