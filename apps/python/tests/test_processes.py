"""Threads, processes and signals."""

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time

import crane
import numpy as np
import pytest


def test_two_threads_on_one_crane(flexible, states):
    _, q, v = states
    batch = np.repeat(q, 40, axis=0)
    expected, alone = flexible.mass_matrix(batch), flexible.bias(q[0], v[0])
    wrong = []

    def work():
        for _ in range(20):
            if not np.array_equal(flexible.mass_matrix(batch), expected):
                wrong.append("batch")
            if not np.array_equal(flexible.bias(q[0], v[0]), alone):
                wrong.append("one")

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def ticks_during(call):
    """Times of a call's begin and end, and of a thread's ticks between them, one per millisecond where the lock is free."""
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.perf_counter()
    call()
    end = time.perf_counter()
    done.set()
    thread.join()
    return [begin, *(tick for tick in ticks if begin < tick < end), end]


def test_a_batch_leaves_the_lock_to_others(flexible):
    q = np.repeat(flexible.guess[None], 60_000, axis=0)
    within = ticks_during(lambda: (flexible.transform_derivatives(q[:2000]), flexible.bias(q, 0 * q)))
    # If the lock were held for the whole call, the thread could not tick.
    assert len(within) > 7


def test_modes_leave_the_lock_to_others(flexible):
    """A thread ticks during modes and stable steps, row by row as often as during other batches."""
    q = np.repeat(flexible.guess[None], 150, axis=0)
    for function in (flexible.modes, flexible.stability):
        within = ticks_during(lambda function=function: function(q))
        # If the lock were held for the eigenvalues or stable steps of all rows, a gap would be nearly as long as the call.
        assert np.diff(within).max() < 0.5 * (within[-1] - within[0]), function


def _work(q):
    c = crane.load("eight_link_flexible")
    return float(c.gravity_energy(np.stack([q] * 200)).sum())


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_processes_compute_alike(flexible, method):
    # Threads of this process have worked before the fork.
    flexible.mass_matrix(np.repeat(flexible.guess[None], 1000, axis=0))
    expected = _work(flexible.guess)
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map(_work, [flexible.guess] * 2) == [expected] * 2


INTERRUPTED = """
import signal
# Where the tests run in the background, processes inherit that Ctrl-C is ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
import crane, numpy as np
c = crane.load("eight_link_flexible")
print("ready", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted", flush=True)
print(c.mass_matrix(c.guess).shape, flush=True)
"""


@pytest.mark.parametrize(
    "call",
    [
        "c.simulate(duration=1e4, output=1e3)",
        "c.replace(load_mass=np.linspace(0, 500, 20000)).simulate_ensemble()",
        "c.simulation().step(1e5)",
        "[c._small_motions(np.repeat(c.guess[None], 20000, axis=0)) for _ in range(1000)]",
        "c.replace(load_mass=np.linspace(0, 500, 600_000)).statics()",
        "c.modes(np.repeat(c.guess[None], 200000, axis=0))",
        "c.stability(np.repeat(c.guess[None], 200000, axis=0))",
        "c.envelope({'column': np.tile([-3.0, 3.0], 20000)})",
    ],
)
def test_ctrl_c_ends_a_long_call(call):
    program = subprocess.Popen([sys.executable, "-c", INTERRUPTED.format(call=call)], stdout=subprocess.PIPE, text=True)
    assert program.stdout.readline() == "ready\n"
    # Every call takes at least three times as long as what is allowed below, also on a machine twice as fast.
    time.sleep(0.2)
    begin = time.monotonic()
    os.kill(program.pid, signal.SIGINT)
    out, _ = program.communicate(timeout=60)
    # The interpreter continues, and soon.
    assert out == "interrupted\n(25, 25)\n"
    assert time.monotonic() - begin < 3


def test_threads_are_set():
    before = crane.threads()
    try:
        crane.set_threads(1)
        assert crane.threads() == 1
        with pytest.raises(ValueError, match="1 or more"):
            crane.set_threads(0)
    finally:
        crane.set_threads()
    assert crane.threads() == before
