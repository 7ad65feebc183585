"""Studies: in parts, interrupted and resumed, on workers that die, on a full disk."""

import errno
import functools
import json
import os
import signal
import subprocess
import sys
import threading
import time

import crane
import numpy as np
import pytest

pytest.importorskip("pyarrow")
from crane import study  # noqa: E402
from crane.identity import identity  # noqa: E402

SHORT = {"duration": 0.2, "output": 0.05}


def cases(count=30):
    return study.grid(payload=np.linspace(0, 600, count))


def test_cases():
    grid = study.grid(a=[1, 2], b=[3, 4, 5])
    np.testing.assert_array_equal(grid["a"], [1, 1, 1, 2, 2, 2])
    np.testing.assert_array_equal(grid["b"], [3, 4, 5, 3, 4, 5])
    with pytest.raises(ValueError, match="different lengths"):
        study.table({"a": [1, 2], "b": [1]})
    pytest.importorskip("scipy")
    for wrong in ((8, 0), (0, np.inf)):
        with pytest.raises(ValueError, match=r"a=\(.*write \(minimum, maximum\)"):
            study.latin_hypercube(2, seed=1, a=wrong)
    cube = study.latin_hypercube(10, seed=1, a=(0, 1), b=(5, 6))
    # One sample in each tenth of every range.
    np.testing.assert_array_equal(np.sort((10 * cube["a"]).astype(int)), np.arange(10))
    assert cube["b"].min() >= 5 and cube["b"].max() <= 6
    assert len(study.sobol(8, seed=1, a=(0, 1))["a"]) == 8
    with pytest.raises(ValueError, match="power of two, such as 8"):
        study.sobol(7, seed=1, a=(0, 1))


def test_a_study_is_its_cases(tmp_path, knuckle):
    done = study.run("knuckle_boom", cases(), tmp_path, part=8, **SHORT)
    assert done.computed == 4 and sorted(path.name for path in tmp_path.iterdir())[0] == "manifest.json"
    table = done.table()
    assert table.num_rows == 30 and done.units["payload"] == "kg" and set(table["status"].to_pylist()) == {"done"}
    alone = knuckle.replace(payload=cases()["payload"]).simulate_ensemble(**SHORT)
    name = "main_boom_theta_drive_torque_max"
    np.testing.assert_array_equal(table[name].to_numpy(), alone[name])
    manifest = json.loads((tmp_path / "manifest.json").read_text())
    assert manifest["cases"] == 30 and manifest["settings"] == SHORT and manifest["spec_hash"] == knuckle.spec_hash


def test_what_is_finished_is_never_computed_again(tmp_path):
    first = study.run("knuckle_boom", cases(), tmp_path, part=8, **SHORT)
    expected = first.table()
    stamps = {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()}
    assert study.run("knuckle_boom", cases(), tmp_path, part=8, **SHORT).computed == 0
    # One part is lost, one is cut short.
    (tmp_path / "part-000001.parquet").unlink()
    cut = tmp_path / "part-000003.parquet"
    cut.write_bytes(cut.read_bytes()[:100])
    again = study.run("knuckle_boom", cases(), tmp_path, part=8, **SHORT)
    assert again.computed == 2 and again.table().equals(expected)
    kept = tmp_path / "part-000000.parquet"
    assert kept.stat().st_mtime_ns == stamps[kept]


def test_another_study_in_the_folder_is_refused(tmp_path):
    study.run("knuckle_boom", cases(4), tmp_path, what="statics")
    with pytest.raises(ValueError, match="another study, which differs in: what, settings"):
        study.run("knuckle_boom", cases(4), tmp_path, **SHORT)
    with pytest.raises(ValueError, match="another study, which differs in: cases"):
        study.run("knuckle_boom", cases(5), tmp_path, what="statics")


def test_mistakes_are_found_before_anything_runs(tmp_path):
    with pytest.raises(TypeError, match="no live parameter `load`"):
        study.run("knuckle_boom", {"load": [1.0]}, tmp_path)
    with pytest.raises(ValueError, match="no cases"):
        study.run("knuckle_boom", {"payload": []}, tmp_path)
    with pytest.raises(ValueError, match='write "simulate", "statics"'):
        study.run("knuckle_boom", cases(2), tmp_path, what="dance")
    assert not list(tmp_path.iterdir())


def test_a_case_that_fails_says_why(tmp_path):
    with pytest.warns(crane.InvalidRowWarning):
        table = study.run("knuckle_boom", {"payload": [100.0, 1e12]}, tmp_path, **SHORT).table()
    assert table["status"].to_pylist()[0] == "done" and "statics did not find" in table["status"].to_pylist()[1]
    assert np.isnan(table["main_boom_theta_drive_torque_max"].to_numpy()[1])


def test_a_function_of_ones_own(tmp_path):
    def lowest(c):
        return {"lowest": c.modes().frequencies[:, 0]}

    table = study.run("knuckle_boom", cases(5), tmp_path, what=lowest, part=3).table()
    expected = crane.load("knuckle_boom", payload=cases(5)["payload"]).modes().frequencies[:, 0]
    np.testing.assert_array_equal(table["lowest"].to_numpy(), expected)


def test_a_changed_function_is_another_study(tmp_path):
    """Its code, defaults, what it encloses, and functions and constants of its module; the same function continues."""

    def with_factor(factor):
        return lambda c: {"x": factor * c.parameters["payload"]}

    def plain(c, power=1):
        return {"x": c.parameters["payload"] ** power}

    same = with_factor(2.0)
    assert study.run("knuckle_boom", cases(2), tmp_path, what=same).computed == 1
    assert study.run("knuckle_boom", cases(2), tmp_path, what=with_factor(2.0)).computed == 0
    others = [
        with_factor(3.0),
        lambda c: {"x": 2.0 * c.parameters["payload"]},
        lambda c: {"x": 2.0 - c.parameters["payload"]},
        plain,
        functools.partial(plain, power=2),
        functools.partial(plain, power=3),
        _Once(tmp_path / "asked"),
        _Once(tmp_path / "other"),
        _helped,
    ]
    identities = {identity(other) for other in [*others, same]}
    assert len(identities) == len(others) + 1
    for other in others:
        with pytest.raises(ValueError, match="another study, which differs in: .*function"):
            study.run("knuckle_boom", cases(2), tmp_path, what=other)
    before = identity(_helped)
    original = globals()["_help"]
    try:
        globals()["_help"] = lambda x: 2 * x
        assert identity(_helped) != before
        globals()["_help"] = original
        globals()["_SCALE"] = 2.0
        assert identity(_helped) != before
    finally:
        globals()["_help"], globals()["_SCALE"] = original, 1.0
    assert identity(_helped) == before
    # The identity is that of another process, too.
    program = "from test_study import *; from test_study import _helped; print(identity(_helped))"
    out = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=os.path.dirname(__file__), env={**os.environ, "PYTHONHASHSEED": "7"})
    assert out.stdout.strip() == before, out.stderr
    with pytest.raises(TypeError, match="cannot be identified"):
        study.run("knuckle_boom", cases(2), tmp_path / "no", what=lambda c, lock=threading.Lock(): {"x": c.n})


def test_columns_do_not_replace_cases(tmp_path):
    with pytest.raises(ValueError, match="the name of the parameter 'payload'"):
        study.run("knuckle_boom", cases(2), tmp_path / "a", what=lambda c: {"payload": 0 * c.parameters["payload"]})
    with pytest.raises(ValueError, match="'x' has shape"):
        study.run("knuckle_boom", cases(2), tmp_path / "b", what=lambda c: {"x": [1.0]})
    with pytest.raises(TypeError, match="payload holds complex"):
        study.run("knuckle_boom", {"payload": np.array([1j, 2.0])}, tmp_path / "c")
    with pytest.raises(ValueError, match="payload has 2 axes"):
        study.run("knuckle_boom", {"payload": np.ones((2, 2))}, tmp_path / "d")


_SCALE = 1.0


def _help(x):
    return _SCALE * x


def _helped(c):
    return {"x": _help(c.parameters["payload"]), "known": [name in {"a", "b", "payload"} for name in c.parameters]}


def test_a_full_disk_loses_nothing(tmp_path, monkeypatch):
    real, written = os.fsync, []

    def full(file):
        if len(written) == 3:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        written.append(file)
        real(file)

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="finished parts are kept") as caught:
        study.run("knuckle_boom", cases(), tmp_path, part=8, **SHORT)
    assert caught.value.errno == errno.ENOSPC
    # The manifest and two parts; nothing half-written.
    assert sorted(path.name for path in tmp_path.iterdir()) == ["manifest.json", "part-000000.parquet", "part-000001.parquet"]
    monkeypatch.undo()
    assert study.run("knuckle_boom", cases(), tmp_path, part=8, **SHORT).computed == 2


INTERRUPTED = """
import signal, sys
# Where the tests run in the background, processes inherit that Ctrl-C is ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
import numpy as np
from crane import study
try:
    study.run("knuckle_boom", study.grid(payload=np.linspace(0, 600, 400)), sys.argv[1], part=2, duration=5)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


def test_ctrl_c_keeps_what_is_finished(tmp_path):
    program = subprocess.Popen([sys.executable, "-c", INTERRUPTED, tmp_path], stdout=subprocess.PIPE, text=True)
    finished = lambda: list(tmp_path.glob("part-*.parquet"))
    begin = time.monotonic()
    while len(finished()) < 2:
        assert program.poll() is None and time.monotonic() - begin < 60
        time.sleep(0.01)
    program.send_signal(signal.SIGINT)
    out, _ = program.communicate(timeout=60)
    assert out == "interrupted\n"
    kept = len(finished())
    # Nothing half-written, and far from the end.
    assert 2 <= kept < 200 and len(list(tmp_path.iterdir())) == kept + 1
    done = study.run("knuckle_boom", study.grid(payload=np.linspace(0, 600, 400)), tmp_path, part=2, duration=5)
    assert done.computed == 200 - kept and set(done.table()["status"].to_pylist()) == {"done"}


def test_a_part_without_memory_stops_a_study_and_loses_nothing(tmp_path):
    greedy = _Greedy(tmp_path / "asked")
    folder = tmp_path / "study"
    with pytest.raises(MemoryError):
        study.run("knuckle_boom", cases(), folder, part=3, what=greedy)
    # The fifth part has failed.
    assert len(list(folder.glob("part-*.parquet"))) == 4 and len(list(folder.iterdir())) == 5
    again = study.run("knuckle_boom", cases(), folder, part=3, what=greedy)
    assert again.computed == 6 and again.table().num_rows == 30


@pytest.mark.filterwarnings("default")
def test_a_worker_without_memory_repeats_its_part(tmp_path):
    distributed = pytest.importorskip("distributed")
    marker = tmp_path / "asked"
    with (
        distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        done = study.run("knuckle_boom", cases(), tmp_path / "there", part=3, what=_Greedy(marker), engine=client)
        assert marker.exists() and done.computed == 10 and done.table().num_rows == 30
        # Without repeats the error comes back; what is finished is kept.
        marker.unlink()
        with pytest.raises(MemoryError):
            study.run("knuckle_boom", cases(), tmp_path / "once", part=3, what=_Greedy(marker), engine=client, retries=0)
        kept = len(list((tmp_path / "once").glob("part-*.parquet")))
        again = study.run("knuckle_boom", cases(), tmp_path / "once", part=3, what=_Greedy(marker), engine=client)
        assert again.computed == 10 - kept and again.table().equals(done.table().replace_schema_metadata(again.table().schema.metadata))


@pytest.mark.filterwarnings("default")
def test_a_killed_worker_costs_only_its_part(tmp_path):
    distributed = pytest.importorskip("distributed")
    here = study.run("knuckle_boom", cases(), tmp_path / "here", part=3, **SHORT).table()
    marker = tmp_path / "killed"

    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        killed = study.run("knuckle_boom", cases(), tmp_path / "there", part=3, what=_Murderous(marker), engine=client)
        # Ten parts, one of which killed its worker: complete, and equal to the local result.
        assert marker.exists() and killed.computed == 10
        table = killed.table()
        assert table["main_boom_theta_drive_torque_max"].equals(here["main_boom_theta_drive_torque_max"])
        done = study.run("knuckle_boom", cases(), tmp_path / "plain", part=3, engine=client, **SHORT)
        assert done.table().equals(here)


class _Once:
    """Runs a part; the first time that the fifth part is computed, `fail` is called."""

    def __init__(self, marker):
        self.marker = str(marker)

    def __call__(self, c):
        if np.any(c.parameters["payload"] == cases()["payload"][13]):
            try:
                os.close(os.open(self.marker, os.O_CREAT | os.O_EXCL))
            except FileExistsError:
                pass
            else:
                self.fail()
        return dict(c.simulate_ensemble(**SHORT))


class _Murderous(_Once):
    """Kills the first worker that computes the fifth part."""

    def fail(self):
        os.kill(os.getpid(), 9)


class _Greedy(_Once):
    """Asks for more memory than there is, the first time that the fifth part is computed."""

    def fail(self):
        bytearray(2**62)
