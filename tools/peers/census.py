"""Looks for what `crane import` drops in silence in robots of other projects.

    python census.py --crane target/release/crane FOLDER... [--seconds 300]

Every URDF and MJCF file below the folders that `crane import` accepts is imported again with each kind of attribute changed, once per file: an
attribute of an element, or its text, in the elements around it, of a kind of joint. A change that changes neither the spec nor its notes, and to
which the notes say nothing of the attribute or of an element around it, is dropped in silence, and listed, unless MuJoCo or URDF give it no effect either
(`NEUTRAL`). A kind that had an effect in one file is not changed again in others. Exit code 1 if anything is listed.
"""

import argparse
import re
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ET
from collections import Counter
from pathlib import Path

# Attributes that have no effect where they stand, and why.
NEUTRAL = {
    "name": "a name alone says nothing about the motion",
    "limited": "without a range",
    "autolimits": "where `limited` is given",
    "springref": "without stiffness",
    "balanceinertia": "where all inertias are possible",
}
# What notes say of attributes without their names.
SENTENCES = {
    "density": "Forces of the surrounding medium",
    "viscosity": "Forces of the surrounding medium",
    "frictionloss": "Left out of tendon",
    "lower": "The range of joint",
    "upper": "The range of joint",
}
OPPOSITES = {"true": "false", "false": "true", "enable": "disable", "disable": "enable", "radian": "degree", "degree": "radian"}
# Larger files take long, and have nothing that others have not.
LARGEST = 400_000


def main():
    """Prints what is dropped in silence, and the numbers of files and kinds."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--crane", metavar="PROGRAM", required=True, help="the built program `crane`")
    parser.add_argument("--seconds", type=float, default=300, help="time after which no further file is begun")
    parser.add_argument("folders", metavar="FOLDER", nargs="+", help="where to look for robots")
    options = parser.parse_args()
    paths = sorted(path for folder in options.folders for ending in ("urdf", "xml") for path in Path(folder).rglob(f"*.{ending}"))
    counts, effective, silent, texts = Counter(), set(), {}, set()
    end = time.monotonic() + options.seconds
    with tempfile.TemporaryDirectory() as folder:
        for path in paths:
            text = path.read_text(encoding="utf-8", errors="replace")
            if time.monotonic() > end or len(text) > LARGEST or text in texts or "<include" in text:
                continue
            texts.add(text)
            robot = Path(folder) / path.name
            told = imported(options.crane, robot, text)
            if told is None:
                continue
            counts["files"] += 1
            for kind in silent_kinds(options.crane, robot, text, told.partition("\nformat: 1\n")[0], effective, counts):
                silent.setdefault(kind, []).append(path)
    for kind, found in sorted(silent.items(), key=str):
        print(f"{' / '.join(map(str, kind))}: {len(found)} files, such as {found[0]}")
    print(f"{counts['files']} files, {counts['attributes']} attributes of {counts['kinds']} kinds per file, {len(silent)} kinds dropped in silence")
    return 1 if silent else 0


def imported(crane, robot, text):
    """The spec of a robot, with its notes; `None` if it is refused."""
    robot.write_text(text, encoding="utf-8")
    done = subprocess.run([crane, "import", robot], check=False, capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else None


def silent_kinds(crane, robot, text, notes, effective, counts):
    """Kinds of attributes of a file that are dropped in silence; `effective` is added to."""
    root, done = ET.fromstring(text), set()
    plain = imported(crane, robot, ET.tostring(root, encoding="unicode"))
    for element, around, joint in walk(root):
        values = {**element.attrib, **({"its text": element.text} if element.text and element.text.strip() else {})}
        counts["attributes"] += len(values)
        for attribute, value in values.items():
            kind = (*around[-3:], joint, attribute)
            if kind in done:
                continue
            done.add(kind)
            counts["kinds"] += 1
            # Unused classes of defaults have no effect.
            if kind in effective or attribute in NEUTRAL or "default" in around or is_told(notes, around, attribute):
                continue
            put(element, attribute, changed(value))
            if imported(crane, robot, ET.tostring(root, encoding="unicode")) == plain:
                yield kind
            else:
                effective.add(kind)
            put(element, attribute, value)


def put(element, attribute, value):
    """Gives an attribute or the text of an element a value."""
    if attribute == "its text":
        element.text = value
    else:
        element.set(attribute, value)


def walk(element, around=(), joint=None):
    """All elements with the names of those around them, its own last, and the type of the joint to which they belong."""
    around = (*around, element.tag.split("}")[-1])
    if around[-1] == "joint":
        joint = element.get("type", "joint")
    yield element, around, joint
    for inner in element:
        if isinstance(inner.tag, str):
            yield from walk(inner, around, joint)


def is_told(notes, around, attribute):
    """Whether notes name an element that is left out, or its attribute, with any prefix."""
    if re.search(rf"`(\w+:)?{re.escape(attribute.split('}')[-1])}` of <{around[-1]}>", notes):
        return True
    sentence = SENTENCES.get(attribute)
    if sentence and sentence in notes:
        return True
    left_out = re.sub(r"`[^`]*` of <[^>]*>", "", notes)
    return any(re.search(rf"<(\w+:)?{re.escape(name)}>", left_out) for name in around)


def changed(value):
    """Another value of an attribute: other numbers, the opposite word, or another name."""
    try:
        numbers = [float(word) for word in value.split()]
    except ValueError:
        numbers = []
    return " ".join(repr(1.1 * number + 0.013) for number in numbers) if numbers else OPPOSITES.get(value.strip(), f"{value}_x")


if __name__ == "__main__":
    sys.exit(main())
