"""Times the generated functions and other libraries on the same cranes, in turns, and writes docs/performance.md.

    python measure.py [--quick] [--without pinocchio] [--rounds 11] [--seconds 0.03]
    python measure.py --report

First all results are compared: those with an error above 1e-8 are excluded. What has been built once is not built again; results
are kept after every round, and `--report` writes the document from the results so far.
"""

import argparse
import json
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict

import machine
import report
import runs
from contestants import LIBRARIES, OURS, Arena, Contestant
from programs import TARGET, WORKSPACE, Builds, compilers, crane_bench

# Sections of the boom; 13 + 3 n coordinates.
SECTIONS, SECTIONS_QUICK = [0, 4, 10, 20, 30], [0]
# Coordinates of the crane of whole runs.
RUNS = 25
# Contestants with larger errors are excluded.
RIGHT = 1e-8
# This many variants per library and compiler take part in the rounds: the fastest in a short trial.
VARIANTS = 2
FIRST_LOOK = 0.01


def main():
    """Builds, compares, measures, writes."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--quick",
        action="store_true",
        help="13 coordinates, 3 rounds, without this machine's instructions, into the build folder only",
    )
    parser.add_argument("--without", nargs="+", choices=LIBRARIES, default=[], help="libraries that do not take part")
    parser.add_argument("--rounds", type=int, help="turns of everybody (11)")
    parser.add_argument("--seconds", type=float, default=0.03, help="length of a turn (0.03)")
    parser.add_argument("--report", action="store_true", help="write the document from the last results")
    options = parser.parse_args()
    builds = Builds(TARGET / "peers")
    results = builds.folder / ("quick.json" if options.quick else "results.json")
    if not options.report:
        measure(options, builds, results)
    elif not results.exists():
        parser.error(f"{results}: nothing has been measured yet")
    document = builds.folder / "performance.md" if options.quick else WORKSPACE / "docs/performance.md"
    figure = builds.folder / "performance.svg" if options.quick else WORKSPACE / "docs/images/performance.svg"
    content = json.loads(results.read_text(encoding="utf-8"))
    report.write(content, document, figure)
    print(f"written: {document}, {figure}")
    if wrong := report.impossible(content):
        print("More operations than the peak of the core: something was not measured right.", *wrong, sep="\n  ")
        # A quick measurement beside other work shows that everything runs, not how fast.
        return 0 if options.quick else 1
    return 0


def measure(options, builds, results):
    """Everything up to writing the results file."""
    sections = SECTIONS_QUICK if options.quick else SECTIONS
    print("building", flush=True)
    bench = crane_bench(sections, native=not options.quick)
    tools = compilers()
    libraries = [library for library in LIBRARIES if library not in options.without]
    arenas = [Arena(13 + 3 * count, builds, tools, bench, libraries) for count in sections]
    compile_all(builds, arenas, tools, libraries)
    taking_part, wrong = [], []
    for arena in arenas:
        right, off = compare(arena)
        taking_part += shortlist(right)
        wrong += off
    facts = {
        "machine": machine.describe(tools),
        "peak": machine.peak([builds.program("peak", compiler) for compiler in tools]),
        "operations": {arena.coordinates: machine.operations(builds, arena.coordinates) for arena in arenas},
        "limits": {arena.coordinates: machine.limits(bench, arena.coordinates) for arena in arenas},
        "counters": {arena.coordinates: machine.counters(bench, arena.coordinates) for arena in arenas},
        "wrong": [asdict_of(contestant) for contestant in wrong],
        "right": RIGHT,
    }
    print("whole runs", flush=True)
    of_runs = next((arena for arena in arenas if arena.coordinates == RUNS), arenas[0])
    facts["runs"] = {"coordinates": of_runs.coordinates, "runs": runs.measure(of_runs, libraries, options.quick)}
    rounds = options.rounds or (3 if options.quick else 11)
    begun = time.perf_counter()
    for number in range(rounds):
        for contestant in taking_part:
            contestant.times.append(contestant.time(options.seconds))
        facts["rounds"], facts["seconds"] = number + 1, options.seconds
        content = facts | {"contestants": [asdict_of(contestant) for contestant in taking_part]}
        results.write_text(json.dumps(content, indent=1), encoding="utf-8")
        print(f"round {number + 1} of {rounds}, {time.perf_counter() - begun:.0f} s", flush=True)


def compile_all(builds, arenas, tools, libraries):
    """Compiles the slow sources on all cores, the slowest first."""
    slow = [library for library in libraries if library == "pinocchio"]
    sources = [source for arena in reversed(arenas) for _, source in arena.sources()] if "casadi" in libraries else []
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = [pool.submit(builds.program, library, compiler) for library in slow for compiler in tools]
        jobs += [pool.submit(builds.shared_library, source, compiler) for source in sources for compiler in tools]
        for job in jobs:
            job.result()


def compare(arena):
    """The contestants with correct results, and the others."""
    print(f"{arena.coordinates} coordinates: comparing", flush=True)
    reference = arena.reference()
    right, wrong = [], []
    for contestant in arena.contestants():
        contestant.error = arena.error(contestant, reference)
        (right if contestant.error is None or contestant.error <= RIGHT else wrong).append(contestant)
    for quantity, library in sorted({(c.quantity, c.library) for c in right if c.error is not None}):
        errors = [c.error for c in right if (c.quantity, c.library) == (quantity, library)]
        print(f"  {quantity:22} {library:14} {len(errors):3} right, to {max(errors):.1e}")
    if wrong:
        print(f"  {len(wrong)} not right to {RIGHT:.0e}")
    return right, wrong


def shortlist(contestants):
    """All our kernels, and the fastest variants of every library and compiler in a short trial."""
    chosen = []
    for quantity in dict.fromkeys(c.quantity for c in contestants):
        rivals = [c for c in contestants if c.quantity == quantity]
        for library, compiler in dict.fromkeys((c.library, c.compiler) for c in rivals):
            variants = [c for c in rivals if (c.library, c.compiler) == (library, compiler)]
            if library != OURS and len(variants) > VARIANTS:
                variants = sorted(variants, key=lambda c: c.time(FIRST_LOOK))[:VARIANTS]
            chosen += variants
    return chosen


def asdict_of(contestant: Contestant):
    """A contestant as a dict, without paths."""
    return {key: value for key, value in asdict(contestant).items() if key not in ("program", "arguments")}


if __name__ == "__main__":
    sys.exit(main())
