"""Studies: a crane over many values of its parameters, in parts that are kept on disk, computed on this machine or on many.

>>> from crane import study
>>> cases = study.grid(load_mass=[0, 200, 400])
>>> done = study.run("eight_link_flexible", cases, "loads", duration=5)      # doctest: +SKIP
>>> done.to_pandas()[["load_mass", "boom_psi_drive_torque_max"]]             # doctest: +SKIP

The cases are split into parts. Each finished part is a Parquet file, written whole or not at all; `manifest.json` describes the
study. The same study in the same folder continues where it ended: finished parts are never computed again. With a Dask client as
`engine` the parts run on its workers; if one dies, another repeats the part that it was computing.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._native import real_array
from .identity import identity
from .model import Crane, load
from .results import joined_columns

try:
    import pyarrow
    import pyarrow.parquet
except ImportError as error:
    raise ImportError("studies are kept as Parquet: pip install 'crane[study]'") from error

Cases = dict[str, np.ndarray]
MANIFEST = "manifest.json"
# Cases per part: some seconds of runs.
PART = 200
# Version of the folder's layout.
FORMAT = 2
# Key of a part's metadata that identifies its study.
DIGEST = b"crane_study"


def grid(**values: ArrayLike) -> Cases:
    """Every combination of the values of parameters; the last one varies fastest."""
    axes = [np.atleast_1d(real_array(name, column)) for name, column in values.items()]
    rows = np.array(list(itertools.product(*axes))).reshape(-1, len(axes))
    return {name: rows[:, place] for place, name in enumerate(values)}


def table(columns: Mapping[str, ArrayLike]) -> Cases:
    """Cases from columns of equal length: a dict, a pandas DataFrame, a pyarrow Table."""
    if isinstance(columns, pyarrow.Table):
        columns = columns.to_pydict()
    cases = {str(name): np.atleast_1d(real_array(str(name), columns[name])) for name in columns}
    for name, column in cases.items():
        if column.ndim != 1:
            raise ValueError(f"{name} has {column.ndim} axes: give a list of numbers")
    lengths = {name: len(column) for name, column in cases.items()}
    if len(set(lengths.values())) > 1:
        raise ValueError(f"columns of different lengths: {lengths}")
    return cases


def latin_hypercube(count: int, *, seed: int, **ranges: tuple[float, float]) -> Cases:
    """`count` samples of a Latin hypercube over ranges of parameters, (minimum, maximum) each."""
    from scipy.stats import qmc

    return _scaled(qmc.LatinHypercube(len(ranges), rng=seed).random(count), ranges)


def sobol(count: int, *, seed: int, **ranges: tuple[float, float]) -> Cases:
    """`count` points of a scrambled Sobol sequence, a power of two, over ranges of parameters, (minimum, maximum) each."""
    from scipy.stats import qmc

    if count < 1 or count & (count - 1):
        raise ValueError(f"{count} points are not balanced: write a power of two, such as {1 << max(count - 1, 0).bit_length()}")
    return _scaled(qmc.Sobol(len(ranges), rng=seed).random_base2(count.bit_length() - 1), ranges)


def _scaled(samples: np.ndarray, ranges: dict[str, tuple[float, float]]) -> Cases:
    for name, (low, high) in ranges.items():
        if not (np.isfinite([low, high]).all() and low < high):
            raise ValueError(f"{name}=({low}, {high}): write (minimum, maximum), finite numbers that increase")
    least, greatest = np.array(list(ranges.values())).T
    return {name: column for name, column in zip(ranges, (least + samples * (greatest - least)).T, strict=True)}


@dataclass(frozen=True)
class Study:
    """A finished study.

    folder: where its parts are. manifest: its description. computed: parts that were computed now; the others existed already.
    """

    folder: Path
    manifest: dict[str, Any] = field(repr=False)
    computed: int

    def table(self) -> Any:
        """All cases and results as a pyarrow Table, in the order of the cases; the unit of a column is in its metadata."""
        files = [self.folder / _file(part) for part in range(self.manifest["parts"])]
        return pyarrow.concat_tables(pyarrow.parquet.read_table(file) for file in files)

    def to_pandas(self) -> Any:
        """All cases and results as a pandas DataFrame."""
        return self.table().to_pandas()

    @property
    def units(self) -> dict[str, str]:
        """Units of the columns."""
        schema = pyarrow.parquet.read_schema(self.folder / _file(0))
        return {column.name: (column.metadata or {}).get(b"unit", b"").decode() for column in schema}


@dataclass(frozen=True)
class _Part:
    """A part of a study, as it is sent to a worker."""

    source: str
    text: str
    cases: Cases
    inputs: dict[str, float]
    what: str | Callable[[Crane], Mapping[str, ArrayLike]]
    settings: dict[str, Any]
    digest: str
    threads: int | None


def run(
    spec: str | os.PathLike[str] | Crane,
    cases: Mapping[str, ArrayLike],
    folder: str | os.PathLike[str],
    *,
    what: str | Callable[[Crane], Mapping[str, ArrayLike]] = "simulate",
    part: int = PART,
    engine: Any = None,
    retries: int = 2,
    progress: bool | None = None,
    **settings: Any,
) -> Study:
    """Computes every case, except those of parts that the folder contains already.

    spec: a crane, with its parameters and inputs, its YAML file, or the name of a shipped one.
    cases: values of live parameters, columns of equal length.
    what: "simulate": extremes, final values and status of a run of each case; `settings` are those of `Crane.simulate_ensemble`.
        "statics": pose, efforts of the drives, reactions, points and status; `settings` are those of `Crane.statics`.
        A function: it receives a crane with the cases of a part as arrays of parameters and returns columns of the same length;
        its name, its code and the values it refers to identify it, so a changed one is another study.
    part: cases per part. engine: None for the threads of this machine, or a `distributed.Client`.
    retries: how often a part that failed on a worker is repeated. progress: whether to write a line on standard error; by default
        if that is a terminal.

    Raises ValueError if the folder contains another study. If it is interrupted or the disk is full, finished parts stay, and the
    same call continues from there.
    """
    if not callable(what) and what not in _RESULTS:
        raise ValueError(f'what={what!r}: write "simulate", "statics" or give a function')
    if part < 1:
        raise ValueError(f"part={part}: write a number of cases, 1 or more")
    crane = spec if isinstance(spec, Crane) else load(spec)
    if crane.shape:
        raise ValueError("the parameters are arrays: give them as cases")
    cases = table({**crane.parameters, **dict(cases)} if not cases else cases)
    fixed = {name: value for name, value in crane.parameters.items() if name not in cases}
    count = len(next(iter(cases.values()), []))
    if count == 0:
        raise ValueError("there are no cases")
    # Names and rules are checked before anything runs.
    crane.replace(**{name: column[0] for name, column in cases.items()})
    digest = _digest(crane, cases, fixed, what, settings, part)
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    parts = -(-count // part)
    manifest = {
        "format": FORMAT,
        "digest": digest,
        "crane": crane.name,
        "spec_hash": crane.spec_hash,
        "what": _name(what),
        "function": identity(what) if callable(what) else None,
        "settings": settings,
        "parameters": fixed,
        "inputs": crane.inputs,
        "columns": list(cases),
        "cases": count,
        "cases_per_part": part,
        "parts": parts,
        "spec": crane.spec,
    }
    _claim(folder, manifest)
    missing = [index for index in range(parts) if not _is_finished(folder / _file(index), digest, min(part, count - index * part))]
    threads = None if engine is None else 1

    def part_of(index: int) -> _Part:
        rows = slice(index * part, (index + 1) * part)
        own = {name: column[rows] for name, column in cases.items()}
        own |= {name: np.full(len(own[next(iter(cases))]), value) for name, value in fixed.items()}
        return _Part(crane.source, crane.spec, own, crane.inputs, what, settings, digest, threads)

    show = _Line(len(missing), parts, sys.stderr.isatty() if progress is None else progress)
    compute = _here if engine is None else _on_workers(engine, retries)
    for index, result in compute(missing, part_of):
        _write(folder / _file(index), result)
        show.one_more()
    show.end()
    return Study(folder, manifest, len(missing))


def _here(missing: Sequence[int], part_of: Callable[[int], _Part]) -> Iterable[tuple[int, Any]]:
    """Computes parts one after the other, each on all threads."""
    for index in missing:
        yield index, _compute(part_of(index))


def _on_workers(client: Any, retries: int) -> Callable:
    """Computes parts on the workers of a Dask client; those of a worker that dies run again on another one."""
    from distributed import as_completed

    def compute(missing: Sequence[int], part_of: Callable[[int], _Part]) -> Iterable[tuple[int, Any]]:
        # Only some parts ahead of the workers: the cases of a large study are not all sent at once.
        waiting = iter(missing)
        places: dict[str, int] = {}

        def submit(index: int) -> Any:
            future = client.submit(_compute, part_of(index), retries=retries, pure=False)
            places[future.key] = index
            return future

        ahead = max(4 * sum(client.nthreads().values()), 4)
        running = as_completed([submit(index) for index in itertools.islice(waiting, ahead)])
        try:
            for future in running:
                yield places.pop(future.key), future.result()
                for index in itertools.islice(waiting, 1):
                    running.add(submit(index))
        finally:
            client.cancel([key for key in places])

    return compute


def _compute(part: _Part) -> Any:
    """Results of a part as a pyarrow Table, the cases first."""
    from . import _native

    if part.threads:
        # A Dask worker runs several tasks on its own threads.
        _native.set_threads(part.threads)
    crane = load(part.source, text=part.text, invalid="nan", inputs=part.inputs, **part.cases)
    units = {parameter["name"]: parameter["unit"] for parameter in crane.info["parameters"]}
    cases = {name: (column, units[name]) for name, column in part.cases.items()}
    if callable(part.what):
        count = len(next(iter(part.cases.values())))
        results = {name: (_column(name, column, count), "") for name, column in part.what(crane).items()}
    else:
        results = _RESULTS[part.what](crane, part.settings)
    columns = joined_columns(cases, results)
    fields = []
    for name, (column, unit) in columns.items():
        kind = pyarrow.array(np.asarray(column)).type
        fields.append(pyarrow.field(name, kind, metadata={"unit": unit}))
    schema = pyarrow.schema(fields, metadata={DIGEST: part.digest.encode()})
    return pyarrow.table([np.asarray(column) for column, _ in columns.values()], schema=schema)


def _column(name: str, column: ArrayLike, count: int) -> np.ndarray:
    """A column of a function's results: a value for each case."""
    column = np.asarray(column)
    if column.shape != (count,):
        raise ValueError(f"the column {name!r} has shape {column.shape}, and the part has {count} cases: return one value for each")
    return column


def _simulate(crane: Crane, settings: dict[str, Any]) -> dict[str, tuple[np.ndarray, str]]:
    """Results of a run of each case."""
    return crane.simulate_ensemble(invalid="nan", **settings).columns()


def _statics(crane: Crane, settings: dict[str, Any]) -> dict[str, tuple[np.ndarray, str]]:
    """The equilibrium of each case."""
    found = crane.statics(invalid="nan", **settings)
    info = crane.info
    columns = {}
    for place, coordinate in enumerate(info["coordinates"]):
        columns[coordinate["name"]] = (found.q[:, place], coordinate["unit"])
    for place, drive in enumerate(info["drives"]):
        columns[f"{drive['coordinate']}_drive_effort"] = (found.drive_efforts[:, place], drive["unit"])
    for place, support in enumerate(info["supports"]):
        for axis, name in enumerate("xyz"):
            columns[f"{support['name']}_reaction_{name}"] = (found.support_reactions[:, place, axis], "N")
    for place, point in enumerate(info["points"]):
        for axis, name in enumerate("xyz"):
            columns[f"{point}_{name}"] = (found.points[:, place, axis], "m")
    return columns | {"residual": (found.residual, ""), "status": (found.status, "")}


_RESULTS = {"simulate": _simulate, "statics": _statics}


def _digest(crane: Crane, cases: Cases, fixed: dict, what: Any, settings: dict, part: int) -> str:
    """A hash that distinguishes a study from another one."""
    said = [FORMAT, crane.spec_hash, fixed, crane.inputs, list(cases), _name(what), settings, part]
    if callable(what):
        said.append(identity(what))
    digest = hashlib.sha256(json.dumps(said, sort_keys=True).encode())
    for column in cases.values():
        digest.update(np.ascontiguousarray(column, dtype="<f8").tobytes())
    return digest.hexdigest()


def _name(what: Any) -> str:
    """The name of a computation."""
    if isinstance(what, str):
        return what
    kind = what if hasattr(what, "__qualname__") else type(what)
    return f"{kind.__module__}.{kind.__qualname__}"


def _file(part: int) -> str:
    return f"part-{part:06}.parquet"


def _claim(folder: Path, manifest: dict[str, Any]) -> None:
    """Writes the manifest, unless the folder has it; another study's is an error."""
    path = folder / MANIFEST
    try:
        known = json.loads(path.read_text())
    except FileNotFoundError:
        known = None
    except ValueError as error:
        raise ValueError(f"{path} is not the manifest of a study: {error}; use another folder") from None
    if known is not None and known.get("digest") != manifest["digest"]:
        differs = [key for key in ("crane", "spec_hash", "what", "function", "settings", "parameters", "inputs", "columns", "cases", "cases_per_part")
                   if known.get(key) != manifest[key]]
        why = ", ".join(differs) or "cases"
        raise ValueError(f"{folder} contains another study, which differs in: {why}; use another folder, or remove that study")
    if known is None:
        _replace(path, lambda file: file.write((json.dumps(manifest, indent=2) + "\n").encode()))


def _is_finished(path: Path, digest: str, rows: int) -> bool:
    """Whether a part exists and is complete."""
    try:
        with pyarrow.parquet.ParquetFile(path) as file:
            return file.metadata.num_rows == rows and (file.schema_arrow.metadata or {}).get(DIGEST) == digest.encode()
    except (OSError, pyarrow.ArrowInvalid):
        return False


def _write(path: Path, part: Any) -> None:
    _replace(path, lambda file: pyarrow.parquet.write_table(part, file))


def _replace(path: Path, write: Callable[[Any], Any]) -> None:
    """Writes a file under another name and renames it when it is complete and on the disk: nobody ever sees a partial file."""
    unfinished = path.with_name(f"{path.name}.{os.getpid()}.unfinished")
    try:
        with open(unfinished, "wb") as file:
            write(file)
            file.flush()
            os.fsync(file.fileno())
        os.replace(unfinished, path)
    except OSError as error:
        # Finished parts stay; the first error is the one to report.
        try:
            unfinished.unlink(missing_ok=True)
        except OSError:
            pass
        raise OSError(error.errno, f"{error.strerror}: finished parts are kept, and the same call continues there", str(path)) from error
    except BaseException:
        unfinished.unlink(missing_ok=True)
        raise


class _Line:
    """A line on standard error that shows the progress of a study."""

    def __init__(self, missing: int, parts: int, shown: bool) -> None:
        self.missing, self.parts, self.shown = missing, parts, shown
        self.done, self.begin = 0, time.monotonic()

    def one_more(self) -> None:
        self.done += 1
        if self.shown:
            left = (time.monotonic() - self.begin) / self.done * (self.missing - self.done)
            done = self.parts - self.missing + self.done
            sys.stderr.write(f"\r{done} of {self.parts} parts, {left:.0f} s left  ")
            sys.stderr.flush()

    def end(self) -> None:
        if self.shown and self.done:
            sys.stderr.write("\n")
