"""Specs that extend others: mappings merged key by key, lists of named entries entry by entry."""

import csv
from pathlib import Path

from ruamel.yaml import YAML

KINDS = ("joint", "law", "motion", "opening", "placement", "scale", "section")
IDENTITIES = ("name", "coordinate")


def read_whole(path):
    """The keys of a spec, merged over those of all specs that it extends.

    In a file of several documents, a spec comes after those that it extends.
    """
    path = Path(path)
    documents = list(YAML(typ="safe", pure=True).load_all(path.read_text(encoding="utf-8")))
    read_tables(documents, path.parent)
    base = documents[0].pop("extends", None)
    whole = merge(read_whole(path.parent / base), documents[0]) if base else documents[0]
    for document in documents[1:]:
        document.pop("extends", None)
        whole = merge(whole, document)
    return whole


def read_tables(node, folder):
    """Replaces the files of tables by times and values."""
    for child in node.values() if isinstance(node, dict) else node if isinstance(node, list) else []:
        read_tables(child, folder)
    table = node.get("table") if isinstance(node, dict) else None
    if isinstance(table, dict) and "file" in table:
        with (folder / table["file"]).open(newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        names = [name.split(" [")[0] for name in header]
        place = names.index(table["column"]) if "column" in table else 1
        node["table"] = {"times": [float(row[0]) for row in rows], "values": [float(row[place]) for row in rows]}


def merge(base, over):
    """A value laid over another."""
    if isinstance(base, dict) and isinstance(over, dict):
        return merge_mappings(base, over)
    if isinstance(base, list) and isinstance(over, list) and are_named(base) and are_named(over):
        return merge_entries(base, over)
    return over


def merge_mappings(base, over):
    """Key by key; a key without a value removes what it names."""
    merged = dict(base)
    for key, value in over.items():
        if value is None:
            del merged[key]
        elif key in KINDS and kind(base.get(key)) != kind(value):
            merged[key] = value
        else:
            merged[key] = merge(base[key], value) if key in base else value
    return merged


def merge_entries(base, over):
    """Entry by entry, in the order of the base; new entries come last or `after` another one, `remove: true` removes one."""
    merged = list(base)
    for entry in over:
        names = [identity(known) for known in merged]
        name = identity(entry)
        place = names.index(name) if name in names else len(merged)
        known = merged.pop(place) if name in names else {}
        if entry.get("remove") is True:
            continue
        if "after" in entry:
            place = [identity(other) for other in merged].index(entry["after"]) + 1
        changes = {key: value for key, value in entry.items() if key != "after"}
        merged.insert(place, merge(known, changes) if known else changes)
    return merged


def kind(value):
    """The kind of a value that is one of several: the name of its only key."""
    return next(iter(value), None) if isinstance(value, dict) else None


def are_named(entries):
    """Whether every entry of a list is known by a name."""
    return all(isinstance(entry, dict) and identity(entry) is not None for entry in entries)


def identity(entry):
    """What an entry of a list is known by."""
    return next((entry[key] for key in IDENTITIES if key in entry), None)
