"""The generated Rust functions, called through the program `evaluate`."""

import json
import subprocess

import numpy as np


class Evaluate:
    """A built `evaluate` program: `list`, `layout NAME`, `values NAME`."""

    def __init__(self, program):
        self.program = program

    def run(self, *arguments, records=b""):
        """The output of the program; an exception contains its error message."""
        result = subprocess.run([self.program, *arguments], input=records, capture_output=True, check=False)
        if result.returncode != 0:
            raise RuntimeError(f"{self.program} {' '.join(arguments)}: {result.stderr.decode(errors='replace')}")
        return result.stdout

    def names(self):
        """The cranes that were compiled in."""
        return self.run("list").decode().split()

    def layout(self, name):
        """Description of a crane, compiled in or from a YAML file, with the order and shape of its quantities."""
        return json.loads(self.run("layout", name))

    def values(self, layout, states):
        """All quantities at all states: name -> array with one row per state."""
        records = np.ascontiguousarray(states.records(), dtype="<f8")
        lengths = [quantity["length"] for quantity in layout["quantities"]]
        numbers = np.frombuffer(self.run("values", layout.get("file", layout["name"]), records=records.tobytes()), dtype="<f8")
        if numbers.size != len(records) * sum(lengths):
            raise RuntimeError(f"{layout['name']}: {numbers.size} numbers for {len(records)} records of {sum(lengths)}")
        columns = np.split(numbers.reshape(len(records), -1), np.cumsum(lengths)[:-1], axis=1)
        return {quantity["name"]: column for quantity, column in zip(layout["quantities"], columns)}
