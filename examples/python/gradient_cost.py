"""What gradients of a run cost, as multiples of the run: of all columns by ten parameters, of one number by these, and by these and all starts. Alternating
rounds in one process, by the time of its core.

    python gradient_cost.py 5        # rounds
"""

import statistics
import sys
import time

import crane

# Numbers of the cranes that become live parameters: a name, its value, and a text of the spec in which it replaces a number.
CRANES = {
    "knuckle_boom": (
        "{m1: {value: 420}, m2: {value: 310}, k1: {value: 4e6}, k2: {value: 2e6}, k3: {value: 8e6}, d1: {value: 6e4}, d2: {value: 3e4}, d3: {value: 8e4}, e: {value: 50}}",
        "links: [{name: main_boom, mass: m1}, {name: knuckle, mass: m2}]\n"
        "drives: [{coordinate: main_boom_theta, stiffness: k1, damping: d1}, {coordinate: knuckle_theta, stiffness: k2, damping: d2}, "
        "{coordinate: extension_x, stiffness: k3, damping: d3}]\ndamping: {hook_theta: e}\n",
    ),
    "eight_link_flexible": (
        "{m1: {value: 15000}, m2: {value: 515.5}, m3: {value: 335}, m4: {value: 224}, z: {value: 1.265}, b: {value: 0.25}, beta: {value: 1.5e-3}, k1: {value: 1e7}, d1: {value: 7e3}}",
        "links:\n  - {name: truck, mass: m1}\n  - {name: column, mass: m2, com: [0.027, 0, z]}\n"
        "  - {name: boom, beam: {section: {box: {height: b, width: 0.2, thickness: 0.008}}, damping: {beta: beta}}}\n"
        "  - {name: outer_boom, mass: m3}\n  - {name: telescope, mass: m4}\n"
        "drives: [{coordinate: grapple_psi, stiffness: k1}, {coordinate: column_psi, damping: d1}]\n",
    ),
    "eight_link_hydraulic": (
        "{pin: {value: 1.1}, x: {value: 0.3}, rocker: {value: 0.45}, m1: {value: 125}, m2: {value: 99}, s: {value: 5e6}, c: {value: 600}, k: {value: 1e6}, d: {value: 7e4}}",
        "cylinders:\n  - {name: boom_cylinder, foot: {link: column, at: [x, 0, pin]}}\n"
        "  - {name: outer_boom_cylinder, linkage: {pivot: [3.2, 0.15, 0], rocker: rocker, link: 0.45, side: left}}\n"
        "links: [{name: extension, mass: m1}, {name: telescope, mass: m2}]\ncouplings: [{name: chains, stiffness: s}]\n"
        "friction: {boom_psi: {coulomb: c}}\ndrives: [{coordinate: grapple_psi, stiffness: k}, {coordinate: column_psi, damping: d}]\n",
    ),
}


def measure(name: str, rounds: int) -> str:
    """Times of a run of 10 s, and of the same with gradients."""
    parameters, changes = CRANES[name]
    text = f"format: 1\nextends: {name}\nname: changed\nparameters: {parameters}\n{changes}"
    c = crane.load("changed.yaml", text=text)
    names = list(c.parameters)
    how = {"duration": 10.0, "output": 0.02, "method": "rosw4", "verify": False}
    asked = {"adjoint": f"{c.coordinates[-1]}.final"}
    ways = {"run": {}, "forward": {"gradients": names}, "adjoint": asked | {"gradients": names}, "by all": asked}

    def timed(**more):
        begin = time.process_time()
        run = c.simulate(**how, **more)
        return time.process_time() - begin, run

    # The first calls make machine code.
    first = {way: timed(**more)[1] for way, more in ways.items()}
    measured = [{way: timed(**more)[0] for way, more in ways.items()} for _ in range(rounds)]
    ratio = {way: statistics.median(times[way] / times["run"] for times in measured) for way in ways}
    (by_all,) = first["by all"].adjoint.values()
    own = statistics.median(times["run"] for times in measured)
    return (
        f"{name}, by {len(names)} parameters: {ratio['forward']:.1f} times the run, one number {ratio['adjoint']:.1f}; one number by {len(by_all)}, "
        f"among them all starts: {ratio['by all']:.1f} ({1e3 * own:.0f} ms; {', '.join(str(run.statistics['steps']) for run in first.values())} steps)"
    )


if __name__ == "__main__":
    for crane_name in CRANES:
        print(measure(crane_name, int(sys.argv[1]) if len(sys.argv) > 1 else 5), flush=True)
