"""Compares what the generated Rust functions return with what CasADi derives from the same YAML file.

    python check.py --evaluate target/release/evaluate [--crane NAME]... [--states 100] [--seed 1] [--json FILE]
    python check.py --self-test [SPEC.yaml]...

Exit code 0 if every quantity of every crane agrees, 1 if one does not, 2 if the command line is invalid.
"""

import json
import sys
import time
import zlib
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from command_line import parser, run
from comparison import HEADER, compare
from crane_model import read_crane
from derivations import NOT_DERIVED, Derivations
from evaluate import Evaluate
from identities import identities
from sabotage import perturb, unnoticed
from states import random_states

WORKSPACE = Path(__file__).resolve().parents[2]


def main():
    """Runs the check or the self-test and returns the exit code."""
    options = parser(__doc__)
    options.add_argument("--json", metavar="FILE", help="write a summary")
    options.add_argument("--processes", type=int, default=2, help="cranes checked at the same time")
    options.add_argument("--sabotage", metavar="QUANTITY", help="perturb one entry of what Rust returns: must fail")
    return run(options, check, self_test)


def check(options):
    """Checks all cranes and prints a table for each."""
    evaluate = Evaluate(options.evaluate)
    names = options.crane or evaluate.names()
    quantities = [quantity["name"] for name in names[:1] for quantity in evaluate.layout(name)["quantities"]]
    quantities = [name for name in quantities if name not in NOT_DERIVED]
    if options.sabotage and options.sabotage not in quantities:
        print(f"no quantity {options.sabotage!r}; there are: {', '.join(quantities)}", file=sys.stderr)
        return 2
    reports = []
    with ProcessPoolExecutor(options.processes) as pool:
        for report in pool.map(check_crane, names, [options] * len(names)):
            print_report(report)
            reports.append(report)
    failed = [report["crane"] for report in reports if not report["passed"]]
    if options.json:
        summary = {"passed": not failed, "cranes": reports}
        Path(options.json).write_text(json.dumps(summary, indent=1), encoding="utf-8")
    print(f"{len(reports) - len(failed)} of {len(reports)} cranes agree")
    if failed:
        print(f"FAILED: {', '.join(failed)}")
    return 1 if failed or not reports else 0


def check_crane(name, options):
    """Compares one crane: its description, then every quantity at every state."""
    started = time.perf_counter()
    evaluate = Evaluate(options.evaluate)
    layout = evaluate.layout(name)
    crane = read_crane(WORKSPACE / layout["spec"])
    derivations = Derivations(crane)
    differences = describe_differences(crane, derivations, layout)
    comparisons = []
    if not differences:
        states = seeded_states(crane, options)
        derived, generated = derivations.evaluate(states), evaluate.values(layout, states)
        if options.sabotage:
            rng = np.random.default_rng(options.seed)
            generated[options.sabotage] = perturb(options.sabotage, generated[options.sabotage], rng)
        common = [name for name in derived if name in generated]
        comparisons = [compare(name, derived[name], generated[name], states.groups) for name in common]
    return {
        "crane": name,
        "coordinates": len(crane.coordinates),
        "states": options.states,
        "passed": not differences and all(comparison.passed for comparison in comparisons),
        "differences": differences,
        "quantities": [comparison.summary() for comparison in comparisons],
        "table": [comparison.row() for comparison in comparisons],
        "seconds": round(time.perf_counter() - started, 2),
    }


def describe_differences(crane, derivations, layout):
    """Differences between the compiled-in description and the YAML."""
    index = {coordinate.name: i for i, coordinate in enumerate(crane.coordinates)}
    expected = {
        "name": crane.name,
        "coordinates": list(index),
        "parameters": [{"name": name, "default": default} for name, default in crane.spec.defaults.items()],
        "bodies": [{"name": body.name, "degrees_of_freedom": body.degrees_of_freedom} for body in crane.bodies],
        "points": list(crane.points),
        "supports": [support.name for support in crane.supports],
        "drives": [index[drive.coordinate.name] for drive in crane.drives],
    }
    differences = [
        f"{key}: {layout[key]}, from the YAML {value}" for key, value in expected.items() if layout.get(key, value) != value
    ]
    offered = {quantity["name"]: quantity["length"] for quantity in layout["quantities"]}
    offered = {name: length for name, length in offered.items() if name not in NOT_DERIVED}
    wanted = derivations.sizes()
    if "file" in layout:  # interpreted: only some of the quantities
        wanted = {name: size for name, size in wanted.items() if name in offered}
    for name in sorted(offered.keys() | wanted.keys()):
        if offered.get(name) != wanted.get(name):
            differences.append(f"quantity {name}: size {offered.get(name)}, derived {wanted.get(name)}")
    return differences


def seeded_states(crane, options):
    """The states of a crane, which do not depend on what else is checked."""
    return random_states(crane, options.states, [options.seed, zlib.crc32(crane.name.encode())])


def print_report(report):
    """Prints the table of a crane."""
    print(f"{report['crane']}: {report['coordinates']} coordinates, {report['states']} states, {report['seconds']} s")
    for difference in report["differences"]:
        print(f"  FAILED: {difference}")
    if report["table"]:
        print("\n".join([HEADER, *report["table"]]), flush=True)


def self_test(options):
    """Checks laws that the derivations must obey, and that the comparison detects errors introduced on purpose."""
    failed = False
    for path in options.self_test or sorted(WORKSPACE.glob("specs/*.yaml")):
        crane = read_crane(path)
        derivations = Derivations(crane)
        states = seeded_states(crane, options)
        derived = derivations.evaluate(states)
        laws = identities(derivations, states, derived)
        missed = unnoticed(derived, states.groups)
        failed |= bool(missed) or not all(law.passed for law in laws)
        print(f"{crane.name}: {len(crane.coordinates)} coordinates")
        print("\n".join(law.row() for law in laws))
        print(f"  errors put into every quantity: {'NOT NOTICED in ' + ', '.join(missed) if missed else 'all noticed'}")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
