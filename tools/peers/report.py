"""Writes docs/performance.md and its figure from measured times."""

from statistics import median

import figure
from contestants import OURS

SERIES = {
    "Pinocchio, gcc": ("Pinocchio", "gcc"),
    "Pinocchio, clang": ("Pinocchio", "clang"),
    "CasADi C, gcc": ("CasADi C", "gcc"),
    "CasADi C, clang": ("CasADi C", "clang"),
    "MuJoCo": ("MuJoCo", ""),
    "Exudyn": ("Exudyn", ""),
}
# Our kernel for each quantity: the first that exists.
BEST_OF_OURS = {
    "forward_dynamics": ["forward_dynamics", "dense_forward_dynamics"],
    "mass_matrix_and_bias": ["mass_matrix_and_bias"],
    "rk4_step": ["rk4_step"],
    "forward_dynamics_derivatives": ["forward_dynamics_derivatives"],
}
LANES_SUFFIX = "_lanes"
# Kernels of one state most of whose operations are loops over eight columns.
IN_VECTORS = ["mass_matrix", "mass_matrix_and_bias"]
LANES = "forward_dynamics" + LANES_SUFFIX


class Times:
    """Medians of all that was measured, ns for one crane."""

    def __init__(self, results):
        self.contestants = results["contestants"]
        self.coordinates = sorted({c["coordinates"] for c in self.contestants})

    def ours(self, coordinates, kernel):
        """Median of one of our kernels; None if there is none."""
        return self.fastest(coordinates, library=OURS, variant=kernel)[0]

    def of_quantity(self, coordinates, quantity):
        """Median of our kernel for a quantity."""
        return next((t for kernel in BEST_OF_OURS[quantity] if (t := self.ours(coordinates, kernel))), None)

    def fastest(self, coordinates, **properties):
        """The minimum median of contestants with these properties, and its contestant; (None, None) if there is none."""
        wanted = {"coordinates": coordinates, **properties}
        found = [c for c in self.contestants if all(c[key] == value for key, value in wanted.items())]
        return min(((median(c["times"]), c) for c in found), key=lambda pair: pair[0], default=(None, None))

    def series(self, coordinates, quantity, series):
        """Minimum median of a library and compiler."""
        library, compiler = SERIES[series]
        return self.fastest(coordinates, quantity=quantity, library=library, compiler=compiler)[0]

    def spread(self):
        """The interquartile range of a contestant's times over their median; the median over all contestants."""
        widths = []
        for contestant in self.contestants:
            times = sorted(contestant["times"])
            widths.append((times[-1 - len(times) // 4] - times[len(times) // 4]) / median(times))
        return median(widths)


def write(results, document, drawing):
    """Writes the document and its figure."""
    times = Times(results)
    figure.draw(times, drawing, SERIES)
    document.write_text(text(results, times, drawing.relative_to(document.parent)), encoding="utf-8")


def text(results, times, drawing):
    """The document."""
    facts, peak = results["machine"], results["peak"]
    rounds = f"{results['rounds']} rounds of {1000 * results['seconds']:.0f} ms"
    return f"""# Performance

This page compares the run time of the generated functions with libraries that read the same crane at run time, and with C code that
CasADi generated for it. The crane is the reference crane, `specs/eight_link_flexible.yaml`, with 0, 4, 10, 20 and 30 sections of the
boom. All programs use one thread and are compiled for the instructions of this machine. Times are medians of {rounds} in which
the programs take turns; their interquartile range is {100 * times.spread():.1f} %. Before timing, every result is compared with recursions in 80-bit numbers;
results with an error above {results["right"]:.0e} are excluded.

{facts["processor"]} (`{facts["target"]}`), {facts["system"]}, {facts["date"]}. {", ".join(facts["versions"])}.

`cargo xtask performance` writes this page. `cargo bench -p crane-bench` times only the kernels.

![Time of one forward dynamics, and of A and e, over the number of coordinates, both axes logarithmic.]({drawing})

## Forward dynamics, q̈
{times_table(times, "forward_dynamics", ["Pinocchio, gcc", "Pinocchio, clang", "CasADi C, gcc", "CasADi C, clang", "MuJoCo"])}

The next table shows how many times longer the others take. With 8 lanes, one call computes eight cranes, each with its own state and
parameters; the time is per crane.
{ratio_table(times)}

## A and e
{times_table(times, "mass_matrix_and_bias", ["Pinocchio, gcc", "Pinocchio, clang", "CasADi C, gcc", "CasADi C, clang"], "triple_sum")}

The last column is [Urbaś 2016, Eq. (5)] as printed, a sum over bodies and triples of coordinates, on generated derivatives of the
transforms.

## Derivatives of q̈
{times_table(times, "forward_dynamics_derivatives", ["Pinocchio, gcc", "Pinocchio, clang"], "forward_dynamics_derivatives_live")}

∂q̈/∂q, ∂q̈/∂v and A⁻¹ of one state: 3 n² numbers. {derivative_ratios(times)} The last column is a live crane:
its factors come from machine code made at run time, its products are compiled for this machine.

## Without a compiler
{live_table(times)}

Forward dynamics by a live crane: by machine code that it makes at run time, of one state and of eight, the latter with AVX-512 where there is any,
and by its bytecode; in brackets, how many times longer than compiled for this machine.

## One RK4 step with all forces
{times_table(times, "rk4_step", ["MuJoCo", "Exudyn"])}

## Whole runs
{runs_table(results["runs"])}

## What these times include
* **Ours**: from t, q, v to q̈; sines and cosines, supports, elements, drives with their motions, and gravity included.
* **Pinocchio**: `aba`, or `crba`, `nonLinearEffects` and a Cholesky factorisation, whichever is fastest; forces are given. All of its
  joint models of a base and of a rigid finite element are included: elementary joints, angles ψ θ φ as one joint, composite joints, a
  free flyer with a quaternion, whose conversion is not timed. Only headers are used, so that all code is compiled for this machine.
  Derivatives are `computeABADerivatives`; forces are given, while ours include the derivatives of supports, elements and drives. With joints
  of three angles and composite joints, whose axes depend on their coordinates, they are not the derivatives, so they are excluded. Those of
  a free flyer are with respect to its tangent space: A⁻¹ and derivatives of and by the other coordinates are compared.
* **CasADi C**: an articulated-body recursion, and composite bodies with Newton's and Euler's equations, in the same coordinates,
  with the crane's numbers and zeros folded in; forces are given. It does not pay the cost of generality that a library pays, so it differs
  from ours only in algorithm, trigonometry and compiler.
* **MuJoCo**: `mj_forward` with applied forces; constraints, contacts, sensors and actuators are off. The three rotations of an element are
  three hinges of one body. In the step, springs and dampers belong to joints, and supports are as few fixed tendons as possible.
* **Exudyn**: a kinematic tree with springs in its joints and the supports as matrices; the time of a run of 600 steps minus one of 200.
* **Compilers matter.** Ours is compiled by rustc, the others by gcc and by clang, both with `-O3 -march=native`; MuJoCo and Exudyn are
  the binaries that their authors distribute.

The fastest variants:
{winners(times)}

{wrong(results)}

## Our kernels
Times in ns per call for one crane{counters_heading(results)}.
{kernels(times)}

The next table shows the operations per call for one crane, as the compiler counts them (sine and cosine of an angle together count as
one), and their share of the peak performance of one core: {peak["scalar"]:.1f} scalar operations per nanosecond and, for eight cranes at once and for mass matrices, which are filled eight columns at
a time, {peak["vector"]:.0f} vector operations per nanosecond, if every multiplication is fused with an addition.
{operations(results, times)}

The next table shows what limits each kernel. No processor computes it in less time than the longest chain of operations of which each waits for
the previous one, with the latencies of this one; and its units for arithmetic need a time for all operations, if every
multiplication is fused with an addition, a sine and a cosine taking {ANGLE}. The share is that of the larger of both in the time measured. What remains are loads
and stores, operations that do not fuse, and the time to find independent ones.
{limits(results, times)}

{counters(results)}
"""


def number(value):
    """Three significant digits."""
    return "" if value is None else f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def microseconds(nanoseconds):
    """ns as µs."""
    return "" if nanoseconds is None else f"{nanoseconds / 1000:.3g}"


def table(heading, rows):
    """A Markdown table, aligned right."""
    lines = [heading, ["---:"] * len(heading), *rows]
    return "\n" + "\n".join("| " + " | ".join(line) + " |" for line in lines)


def times_table(times, quantity, series, *further):
    """Times in µs, ours and others'."""
    rows = [
        [
            str(n),
            microseconds(times.of_quantity(n, quantity)),
            *(microseconds(times.series(n, quantity, name)) for name in series),
            *(microseconds(times.ours(n, kernel)) for kernel in further),
        ]
        for n in times.coordinates
    ]
    return table(["coordinates", "ours, µs", *series, *(kernel.replace("_", " ") for kernel in further)], rows)


def ratio_table(times):
    """How many times as long as ours the best of each library takes."""

    def ratio(n, quantity, library, ours):
        theirs = times.fastest(n, quantity=quantity, library=library)[0]
        return f"{theirs / ours:.2g} ×" if theirs and ours else ""

    rows = []
    for n in times.coordinates:
        ours, terms, step = (times.of_quantity(n, q) for q in ("forward_dynamics", "mass_matrix_and_bias", "rk4_step"))
        rows.append(
            [
                str(n),
                *(ratio(n, "forward_dynamics", library, ours) for library in ("Pinocchio", "CasADi C", "MuJoCo")),
                ratio(n, "forward_dynamics", "Pinocchio", times.ours(n, LANES)),
                ratio(n, "mass_matrix_and_bias", "Pinocchio", terms),
                ratio(n, "mass_matrix_and_bias", "CasADi C", terms),
                ratio(n, "rk4_step", "MuJoCo", step),
                ratio(n, "rk4_step", "Exudyn", step),
            ]
        )
    forward = ["Pinocchio", "CasADi C", "MuJoCo", "8 lanes: Pinocchio"]
    further = ["A, e: Pinocchio", "A, e: CasADi C", "RK4: MuJoCo", "RK4: Exudyn"]
    return table(["coordinates", *forward, *further], rows)


def derivative_ratios(times):
    """How much longer Pinocchio takes for derivatives."""
    quantity = "forward_dynamics_derivatives"
    ratios = [
        (n, theirs / ours)
        for n in times.coordinates
        if (theirs := times.fastest(n, quantity=quantity, library="Pinocchio")[0]) and (ours := times.of_quantity(n, quantity))
    ]
    if not ratios:
        return ""
    words = ", ".join(f"{ratio:.2g} × at {n}" for n, ratio in ratios)
    return f"Pinocchio's best takes {words} coordinates."


def live_table(times):
    """Forward dynamics without a compiler."""

    def cell(n, kernel, compiled):
        time = times.ours(n, kernel)
        return f"{microseconds(time)} ({time / compiled:.2g} ×)" if time and compiled else ""

    def row(n):
        one, eight = times.ours(n, "forward_dynamics"), times.ours(n, LANES)
        of_one = [cell(n, kernel, one) for kernel in ("forward_dynamics_machine_code", "forward_dynamics_bytecode")]
        return [str(n), microseconds(one), *of_one, microseconds(eight), cell(n, "forward_dynamics_machine_code_lanes", eight)]

    heading = ["coordinates", "compiled, µs", "machine code", "bytecode", "8 lanes: compiled, µs", "machine code"]
    return table(heading, [row(n) for n in times.coordinates])


def runs_table(runs):
    """The shortest run of each library within some errors."""
    libraries = list(dict.fromkeys(run["library"] for run in runs["runs"]))
    duration = runs["runs"][0]["duration"]

    def cell(library, goal):
        within = [run for run in runs["runs"] if run["library"] == library and run["error"] <= goal]
        if not within:
            return "–"
        best = min(within, key=lambda run: run["seconds"])
        return f"{1000 * best['seconds']:.3g} ms, {best['method']}: {number(duration / best['seconds'])} ×"

    rows = [[f"{goal:.0e}", *(cell(library, goal) for library in libraries)] for goal in (1e-2, 1e-3, 1e-4)]
    return f"""
The crane of {runs["coordinates"]} coordinates is let go at its guess, with its load pulled aside by 0.3 rad, while its drives hold, for {duration:g} s. The table
shows the shortest time on one core in which a library gets within an error, its method, and how many times faster than real time that is. An
error is the largest of a coordinate at any of 40 results, over the largest change of a coordinate, against the library's own run with its
shortest steps. Ours chooses among `bdf`, `rosw4` and `rk4`, MuJoCo among `RK4`, `implicitfast` and `Euler`, Exudyn among `RK44` and
`generalized alpha` with constant steps.
""" + table(["error", *libraries], rows)


def winners(times):
    """Which variant of Pinocchio was the fastest."""
    rows = []
    for n in times.coordinates:
        for quantity in ("forward_dynamics", "mass_matrix_and_bias", "forward_dynamics_derivatives"):
            for name in ("Pinocchio, gcc", "Pinocchio, clang"):
                library, compiler = SERIES[name]
                time, best = times.fastest(n, quantity=quantity, library=library, compiler=compiler)
                if best:
                    rows.append([str(n), quantity, name, best["variant"], f"{best['error']:.0e}", microseconds(time)])
    return table(["coordinates", "quantity", "library", "variant", "error", "µs"], rows)


def wrong(results):
    """The contestants that were excluded for their errors."""
    found = results["wrong"]
    if not found:
        return "All variants of all libraries were correct."
    rows = {}
    for contestant in found:
        key = contestant["coordinates"], contestant["library"], contestant["variant"].split(",")[0]
        rows.setdefault(key, []).append(contestant)
    lines = [
        [
            str(key[0]),
            key[1],
            key[2],
            str(len(group)),
            f"{max(c['error'] for c in group):.0e}",
            ", ".join(sorted({c["variant"].split("elements ")[-1] for c in group})),
        ]
        for key, group in sorted(rows.items())
    ]
    return "Excluded because of their errors:\n" + table(
        ["coordinates", "library", "algorithm", "variants", "worst error", "joints of elements"], lines
    )


# Operations of a sine and a cosine of one angle: `crane_model::rt::sin_cos`.
ANGLE = 59


def limits(results, times):
    """What each of our kernels is limited by: the longest chain of operations, or how many there are."""
    peak = results["peak"]
    rows = []
    for kernel in dict.fromkeys(c["variant"] for c in times.contestants if c["library"] == OURS):
        in_lanes = kernel.endswith(LANES_SUFFIX)
        cells = []
        for n in times.coordinates:
            found, time = results.get("limits", {}).get(str(n), {}).get(kernel.removesuffix(LANES_SUFFIX)), times.ours(n, kernel)
            if found is None or time is None or kernel in IN_VECTORS:
                cells.append("")
                continue
            operations, angles, chain = found
            # A call of eight cranes has one chain; sines of one crane are computed eight at a time.
            chain /= 8 if in_lanes else 1
            arithmetic = (operations - angles) / peak["vector" if in_lanes else "scalar"] + ANGLE * angles / peak["vector"]
            limit, name = max((chain, "chain"), (arithmetic, "operations"))
            cells.append(f"{number(chain)}, {number(arithmetic)}: {100 * limit / time:.0f} % ({name})")
        if any(cells):
            rows.append([f"`{kernel}`", *cells])
    return table(["chain, operations in ns: share of the larger", *map(str, times.coordinates)], rows)


def kernels(times):
    """Times of our kernels."""
    names = list(dict.fromkeys(c["variant"] for c in times.contestants if c["library"] == OURS))
    rows = [[f"`{name}`", *(number(times.ours(n, name)) for n in times.coordinates)] for name in names]
    return table(["kernel", *map(str, times.coordinates)], rows)


def shares(results, times):
    """Operations per call of each of our kernels, and their share of the peak, by number of coordinates.

    The share is of the vector peak for eight cranes at once and for loops over columns, else of the scalar one.
    """
    for kernel in dict.fromkeys(c["variant"] for c in times.contestants if c["library"] == OURS):
        peak = results["peak"]["vector" if kernel.endswith(LANES_SUFFIX) or kernel in IN_VECTORS else "scalar"]
        for n in times.coordinates:
            count = results["operations"][str(n)].get(kernel.removesuffix(LANES_SUFFIX))
            time = times.ours(n, kernel)
            if count and time:
                yield kernel, n, count, count / time / peak


def impossible(results):
    """Kernels that seem to compute more than the peak: the peak, an operation count or a time is wrong."""
    found = shares(results, Times(results))
    return [f"{kernel}, {n} coordinates: {100 * share:.0f} %" for kernel, n, _, share in found if share > 1]


def operations(results, times):
    """Operations per call and their share of the peak."""
    rows = {}
    for kernel, n, count, share in shares(results, times):
        rows.setdefault(kernel, {})[n] = f"{count}: {100 * share:.0f} %"
    rows = [[f"`{kernel}`", *(cells.get(n, "") for n in times.coordinates)] for kernel, cells in rows.items()]
    return table(["operations: share of the peak", *map(str, times.coordinates)], rows)


def counters_heading(results):
    """Part of a heading that announces counters, if any."""
    return "; what the processor counted follows below" if any(results["counters"].values()) else ""


def counters(results):
    """Instructions and misses, or that they could not be counted."""
    if not any(results["counters"].values()):
        return "Instructions and cache misses: this machine does not let `perf stat` count them."
    rows = [
        [str(n), f"`{kernel}`", *(number(value) for value in counts.values())]
        for n, kernels_of in results["counters"].items()
        for kernel, counts in kernels_of.items()
    ]
    names = next(iter(next(counts for counts in results["counters"].values() if counts).values()))
    return "Counted by the processor, per call:\n" + table(["coordinates", "kernel", *names], rows)
