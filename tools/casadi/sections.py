"""Sections of beams within their elements: at pins, loads, steps and at the end."""

import casadi as ca

from cuts import Cut, CutAtPad
from telescopes import length_of
from transforms import translate

# Farther along than whatever acts beside an element, and nearer than a link on its end.
BEYOND_ALL_POINTS = 1e300
# Places of a beam that are closer than this fraction of its length are one place.
SAME = 1e-9


def add_sections(crane, spans):
    """Adds to the cuts those within elements, each behind that of its element, and to the beams the moduli there."""
    added = {}
    for beam, span in zip(crane.beams, spans):
        beam.length = length_of(span)
        beam.places = list(span.starts)
        if beam.portion is None:
            continue
        moduli, beam.places = [], []
        for element, body in enumerate(span.bodies):
            moduli.append(beam.sections[element])
            beam.places.append(span.starts[element])
            index = next(i for i, other in enumerate(crane.bodies) if other is body)
            added[index] = []
            for distance, before, of_section in within(crane, beam, span, element, index):
                start, length = span.starts[element], beam.lengths[element]
                shift = translate(x=distance)
                rest = shift @ beam.portion(start + distance, start + length) @ shift.T
                # What acts at the section itself acts beyond it, if the section is just before.
                place, whole = crane.spec.default(distance), crane.spec.default(length)
                limit = place - SAME * whole if before else place + SAME * whole
                if not before and place >= whole * (1 - SAME):
                    limit = BEYOND_ALL_POINTS
                added[index].append(Cut(body.transform @ shift, index, rest, limit))
                moduli.append(of_section)
                beam.places.append(start + distance)
        for pad in pads_on(crane, span):
            added[index] += [at_pad(crane, beam, span, pad, before) for before in (True, False)]
            moduli += [beam.moduli_beside(0.0)[1]] * 2
            beam.places += [ca.fmin(ca.fmax(pad.s, 0), pad.length)] * 2
        beam.sections = moduli
    crane.cuts[:] = merged(crane, added)


def pads_on(crane, span):
    """The pads on which a beam slides, each once."""
    for held in [*crane.connectors, *crane.loop_joints]:
        if held.pad is not None and held.pad.direction == "y" and crane.bodies[held.pad.stations[1].body] is span.bodies[0]:
            yield held.pad


def at_pad(crane, beam, span, pad, before):
    """The section just before or just after a pad, in the element on which the pad is."""
    within = []
    # What acts at the pad itself acts beyond the section, if the section is just before.
    same = SAME * crane.spec.default(pad.length) * (-1 if before else 1)
    for element, (index, distance, here) in enumerate(pad.on_elements()):
        start, length = span.starts[element], beam.lengths[element]
        shift = translate(x=distance)
        rest = shift @ beam.portion(start + distance, start + length) @ shift.T
        within.append((here, Cut(span.bodies[element].transform @ shift, index, rest, distance + same)))
    return CutAtPad(within)


def merged(crane, added):
    """All cuts, each within an element behind that of its body: the last of those before which only the body begins."""
    cuts = []
    for place, cut in enumerate(crane.cuts):
        cuts.append(cut)
        is_last = place + 1 == len(crane.cuts) or crane.cuts[place + 1].body > cut.body
        if is_last:
            cuts.extend(added.get(cut.body, []))
    return cuts


def within(crane, beam, span, element, index):
    """Sections within an element: distance from its beginning, whether they are just before what acts there, moduli."""
    spec = crane.spec
    start, length = spec.default(span.starts[element]), spec.default(beam.lengths[element])
    whole = spec.default(span.starts[-1]) + spec.default(beam.lengths[-1])
    last = element + 1 == len(span.bodies)
    places = {}

    def add(distance, jumps):
        value = spec.default(distance)
        same = next((other for other in places if abs(other - value) <= SAME * whole), value)
        before = places.get(same, (distance, False))
        places[same] = before[0], before[1] or jumps

    if last:
        add(beam.lengths[element], False)
    for step in beam.steps:
        if start + SAME * whole < step <= start + length + SAME * whole:
            add(step - start, True)
    for along, jumps in pins(crane, index):
        value = spec.default(along)
        add(0.0 if value <= 0 else beam.lengths[element] if value >= length else along, jumps)
    for value, (distance, jumps) in sorted(places.items()):
        before, after = beam.moduli_beside(start + value)
        if last and value >= length * (1 - SAME):
            after = before
        if value <= SAME * whole:
            yield 0.0, False, after
        elif not jumps:
            yield distance, True, before
        else:
            yield distance, True, before
            if last or value < length - SAME * whole:
                yield distance, False, after


def pins(crane, index):
    """Distances along a body at which something acts on it, or another link begins, and whether forces jump there."""
    yield from ((body.at, True) for body in crane.bodies if body.parent == index and body.at is not None)
    yield from ((load.at, True) for load in crane.loads if load.body == index)
    for cylinder in crane.cylinders:
        yield from ((at, True) for body, at in cylinder.pins if body == index)
    for joint in crane.loop_joints:
        yield from ((at, True) for body, at in joint.ends if body is crane.bodies[index])
    for connector in crane.connectors:
        yield from ((at, True) for body, at in zip(connector.bodies, connector.at) if body == index)
    for held in [*crane.connectors, *crane.loop_joints]:
        if held.pad is not None:
            pad = held.pad.stations[0]
            yield from ((pad.at, True) for _ in range(pad.body == index))
