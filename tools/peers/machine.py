"""Facts about the machine, the versions and the functions that the document states in addition to the times."""

import os
import platform
import subprocess
from datetime import date
from importlib.metadata import version

from programs import WORKSPACE

PACKAGES = {"Pinocchio": "pin", "CasADi": "casadi", "MuJoCo": "mujoco", "Exudyn": "exudyn", "Eigen": "cmeel-eigen"}
# Events of perf, and their names in the document.
EVENTS = {"instructions": "instructions", "L1-dcache-load-misses": "L1 misses"}
COUNTED_CALLS = 20000


def describe(compilers):
    """Processor, system, versions, date."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return {
        "processor": f"{names[0] if names else platform.machine()}, {os.cpu_count()} cores",
        "system": f"{platform.system()} {platform.machine()}",
        "target": target_cpu(),
        "versions": [
            " ".join(output_of("rustc", "--version").split()[:2]),
            *[compiler.version for compiler in compilers],
            *[f"{name} {version(package)}" for name, package in PACKAGES.items()],
        ],
        "date": date.today().isoformat(),
    }


def output_of(*command):
    """The output of a command."""
    words = [str(word) for word in command]
    return subprocess.run(words, cwd=WORKSPACE, capture_output=True, text=True, check=True).stdout


def target_cpu():
    """Rustc's name for this processor."""
    lines = output_of("rustc", "--print", "target-cpus").splitlines()
    native = next((line for line in lines if line.strip().startswith("native")), "")
    return native.split("currently ")[-1].rstrip(").") if "currently" in native else "native"


def peak(programs):
    """Maximum operations per second, 1e9/s, of one core on scalars and on vectors: the best of any compiler."""
    runs = [output_of(program).split() for program in programs]
    return {kind: max(float(run[k]) for run in runs) for k, kind in enumerate(("scalar", "vector"))}


def operations(builds, coordinates):
    """Floating-point operations of each generated function, as the compiler counts them."""
    command = ["cargo", "run", "--release", "--quiet", "--package", "crane-cli", "--"]
    spec = builds.folder / f"crane_{coordinates}.yaml"
    lines = [line for line in output_of(*command, "operations", spec).splitlines() if line.startswith("| `")]
    rows = [[cell.strip(" `") for cell in line.split("|")[1:-1]] for line in lines]
    return {row[0]: int(row[1]) for row in rows if row[1].isdigit()}


def limits(bench, coordinates):
    """Operations of each generated function, angles among them, and the time of its longest chain of operations, ns."""
    rows = [line.split() for line in output_of(bench, "limits", coordinates).splitlines()]
    return {name: [int(operations), int(angles), float(chain)] for name, operations, angles, chain in rows}


def counters(bench, coordinates):
    """Instructions and L1 misses per call of our kernels; empty where the machine does not count them."""
    kernels = output_of(bench, "kernels", coordinates)
    counted = {}
    for kernel in [line.split()[0] for line in kernels.splitlines()]:
        once, twice = (count(bench, coordinates, kernel, calls) for calls in (COUNTED_CALLS, 2 * COUNTED_CALLS))
        if once is None or twice is None:
            return {}
        counted[kernel] = {name: (twice[name] - once[name]) / COUNTED_CALLS for name in once}
    return counted


def count(bench, coordinates, kernel, calls):
    """Events of a run with this many calls; None where there is no perf or it cannot count."""
    command = ["perf", "stat", "-x", ",", "-e", ",".join(EVENTS), bench, "repeat", str(coordinates), kernel, str(calls)]
    try:
        lines = subprocess.run(command, capture_output=True, text=True, check=True).stderr.splitlines()
    except (OSError, subprocess.CalledProcessError):
        return None
    fields = [line.split(",") for line in lines if line.count(",") > 2]
    values = {EVENTS[f[2].removesuffix(":u")]: f[0] for f in fields if f[2].removesuffix(":u") in EVENTS}
    if len(values) != len(EVENTS) or not all(value.isdigit() for value in values.values()):
        return None
    return {name: int(value) for name, value in values.items()}
