"""Builds the programs that are timed; what has not changed is not built again."""

import hashlib
import importlib.util
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from chain import TOOLS

WORKSPACE = TOOLS.parent
HERE = Path(__file__).resolve().parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", WORKSPACE / "target"))
# Generated Rust for this machine's instructions.
NATIVE = {"RUSTFLAGS": "-C target-cpu=native", "CARGO_TARGET_DIR": str(TARGET / "native")}
# gcc fuses multiplications and additions of different statements by default, clang needs an option.
FLAGS = ["-O3", "-march=native", "-ffp-contract=fast"]

VERSION = re.compile(r"\d+(\.\d+)+")


@dataclass
class Compiler:
    """A pair of C and C++ compilers."""

    name: str
    c: str
    cpp: str

    @property
    def version(self):
        """Name and version."""
        first = subprocess.run([self.c, "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]
        return f"{self.name} {VERSION.search(first)[0]}"


def compilers():
    """gcc, and the newest clang, if installed."""
    found = [Compiler("gcc", "gcc", "g++")] if shutil.which("g++") else []
    names = {
        Path(folder, file).name for folder in os.get_exec_path() if Path(folder).is_dir() for file in os.listdir(folder)
    }
    suffixes = [match[1] for name in names if (match := re.fullmatch(r"clang\+\+(-\d+)?", name))]
    if suffixes:
        newest = max((suffix or "" for suffix in suffixes), key=lambda suffix: int(suffix[1:] or 0))
        found.append(Compiler("clang", f"clang{newest}", f"clang++{newest}"))
    if not found:
        raise RuntimeError("neither gcc nor clang is installed")
    return found


class Builds:
    """The folder of everything that is built."""

    def __init__(self, folder):
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)

    def write(self, name, content):
        """Writes a file into the folder."""
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def compile(self, sources, name, command):
        """Runs a compiler unless it has been run with this command on these sources; `command` ends before `-o`."""
        text = b"".join(Path(source).read_bytes() for source in sources) + " ".join(map(str, command)).encode()
        target = self.folder / f"{name}-{hashlib.sha256(text).hexdigest()[:12]}"
        if not target.exists():
            print(f"  compiling {name}", flush=True)
            unfinished = target.with_name(target.name + ".unfinished")
            subprocess.run([*map(str, command), "-o", str(unfinished)], check=True)
            unfinished.rename(target)
        return target

    def program(self, library, compiler):
        """A program of this folder: `pinocchio`, `mujoco`, `casadi`, `peak`."""
        sources = [HERE / f"{library}.cpp", HERE / "timing.hpp"]
        command = [compiler.cpp, "-std=c++17", *FLAGS, "-DNDEBUG", sources[0], *OPTIONS[library]()]
        return self.compile(sources, f"{library}-{compiler.name}", command)

    def shared_library(self, source, compiler):
        """A C file as a shared library."""
        return self.compile(
            [source], f"{source.stem}-{compiler.name}", [compiler.c, *FLAGS, "-shared", "-fPIC", source]
        )


def package(name):
    """The folder of an installed Python package."""
    return Path(importlib.util.find_spec(name).submodule_search_locations[0])


def options_of_pinocchio():
    """Headers of the wheel, of Boost and of Eigen; everything is a template. More joint types than Boost's default limit."""
    include = next(Path(folder) for folder in sys.path if (Path(folder) / "cmeel.prefix/include").is_dir())
    include = include / "cmeel.prefix/include"
    limits = ["-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS"]
    # gcc warns about code that it inlines from these headers.
    return [*limits, "-w", "-isystem", include, "-isystem", include / "eigen3"]


def options_of_mujoco():
    """Headers and the library of the wheel."""
    folder = package("mujoco")
    library = next(folder.glob("libmujoco.so.*"))
    return ["-isystem", folder / "include", library, f"-Wl,-rpath,{folder}"]


OPTIONS = {
    "pinocchio": options_of_pinocchio,
    "mujoco": options_of_mujoco,
    "casadi": lambda: ["-ldl"],
    "peak": lambda: [],
}


def crane_bench(sections, native):
    """The program of crane-bench with the crane of these numbers of sections, for this machine's instructions or as everything else is built."""
    environment = {"CARGO_TARGET_DIR": str(TARGET)} | (NATIVE if native else {})
    sections = {"CRANE_BENCH_SECTIONS": " ".join(map(str, sections))}
    command = ["cargo", "build", "--release", "--quiet", "--package", "crane-bench"]
    subprocess.run(command, cwd=WORKSPACE, env=os.environ | environment | sections, check=True)
    return Path(environment["CARGO_TARGET_DIR"]) / "release/crane-bench"
