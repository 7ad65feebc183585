"""100,000 runs of the reference crane, or a sample of them from which their cost is extrapolated.

    python many_runs.py 2000                    # a sample on this machine
    python many_runs.py 100000 --folder study   # all; continues after an interruption
    python many_runs.py 100000 --folder study --scheduler tcp://head:8786   # on the workers of a Dask cluster

Each case is a manoeuvre of 10 s of the eight-link crane with its flexible boom (25 coordinates), with its own load and its own Young's
modulus of the boom.
"""

import argparse
import shutil
import tempfile
import time
from pathlib import Path

import crane
from crane import study

ALL = 100_000
SPEC = Path(__file__).with_name("studied_crane.yaml")

arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
arguments.add_argument("cases", type=int, nargs="?", default=2_000)
arguments.add_argument("--folder", help="where finished parts are kept; a folder that is removed at the end unless given")
arguments.add_argument("--scheduler", help="address of a Dask scheduler")
given = arguments.parse_args()

engine, cores = None, crane.threads()
if given.scheduler:
    from distributed import Client

    engine = Client(given.scheduler)
    cores = sum(engine.nthreads().values())

cases = study.latin_hypercube(given.cases, seed=1, load_mass=(0, 800), youngs_modulus=(2.0e11, 2.2e11))
folder = given.folder or tempfile.mkdtemp()
begin, before = time.perf_counter(), time.process_time()
done = study.run(SPEC, cases, folder, duration=10, engine=engine)
wall, used = time.perf_counter() - begin, time.process_time() - before

table = done.table()
reached = sum(status == "done" for status in table["status"].to_pylist())
print(f"{reached} of {given.cases} runs reached their end")
computed = min(given.cases, done.computed * done.manifest["cases_per_part"])
if computed:
    # Core seconds per case: CPU time of this process, or elapsed time times the number of the workers' cores.
    cost = (wall * cores if engine else used) / computed
    print(f"{wall:.1f} s for {computed} runs on {cores} cores: {1e3 * cost:.1f} ms of a core per run")
    print(f"{ALL} runs: {ALL * cost / cores / 60:.1f} min on {cores} cores, {ALL * cost / 1000:.1f} s on 1000 of them")
if not given.folder:
    shutil.rmtree(folder)
