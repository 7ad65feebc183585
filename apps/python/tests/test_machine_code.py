"""Machine code of functions that are called often gives the bits of bytecode, also where the system refuses to make any."""

import subprocess
import sys

import pytest

CALLS = """
import ctypes
import hashlib
import sys

if sys.argv[1] == "refuse":
    # PR_SET_MDWE: no memory of this process becomes executable.
    if ctypes.CDLL(None).prctl(65, 1, 0, 0, 0):
        sys.exit(77)

import numpy as np
import crane

c = crane.load("eight_link_flexible")
v = np.full_like(np.array(c.guess), 0.1)
rows = [c.forward_dynamics(c.guess, v * k / 1500, 0.1) for k in range(1500)]
together = c.forward_dynamics(np.tile(c.guess, (1500, 1)), np.outer(np.arange(1500) / 1500, v), 0.1)
for accelerations in (np.array(rows), together):
    # Zeros may differ in their signs.
    print(hashlib.sha256((accelerations + 0.0).tobytes()).hexdigest())
"""


def accelerations(how):
    return subprocess.run([sys.executable, "-c", CALLS, how], capture_output=True, text=True, check=False)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux can be asked to refuse")
def test_refused_memory_changes_no_bit():
    refused = accelerations("refuse")
    if refused.returncode == 77:
        pytest.skip("this system cannot refuse")
    assert refused.returncode == 0, refused.stderr
    permitted = accelerations("permit")
    assert permitted.stdout == refused.stdout
