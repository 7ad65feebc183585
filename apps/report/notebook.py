"""Writes what a notebook shows of a crane and of a run, as two elements of one page: `python notebook.py FILE`."""

import sys
from pathlib import Path

import crane

flexible = crane.load("eight_link_flexible")
shown = [flexible._repr_html_(), flexible.simulate(duration=2.0)._repr_html_()]
Path(sys.argv[1]).write_text(f"<!doctype html><meta charset=utf-8><title>Notebook</title>{''.join(shown)}", encoding="utf-8")
