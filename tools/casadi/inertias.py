"""Pseudo-inertia `H = ∫ r rᵀ dm`, `r = [x y z 1]ᵀ` [Urbaś 2016, Eq. (4)], from mass, com and inertia tensor."""

import casadi as ca


def pseudo_inertia(mass, com, tensor_at_com):
    """H about the origin of the frame from the inertia tensor about the centre of mass, whose Ixy = -∫ xy dm.

    `∫ r rᵀ dm` about the centre of mass is `½ tr(I) 1 - I`; the parallel-axis theorem then adds `m c cᵀ`.
    """
    tensor = ca.SX(tensor_at_com)
    com = ca.SX(com)
    about_com = ca.trace(tensor) / 2 * ca.SX.eye(3) - tensor
    second = about_com + mass * com @ com.T
    first = mass * com
    return ca.blockcat([[second, first], [first.T, ca.SX(mass)]])


def moved_to_com(tensor_at_origin, mass, com):
    """Steiner: the tensor about the centre of mass from the one about the origin."""
    com = ca.SX(com)
    return tensor_at_origin - mass * (ca.dot(com, com) * ca.SX.eye(3) - com @ com.T)


def read_tensor(spec, inertia, mass, com):
    """The tensor about the centre of mass from a body's `inertia:` in any of its forms."""
    if "gyration" in inertia:
        return ca.diag(mass * spec.vector(inertia["gyration"]) ** 2)
    element = {key: spec.number(inertia.get(key, 0)) for key in ("Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz")}
    tensor = ca.blockcat(
        [
            [element["Ixx"], element["Ixy"], element["Ixz"]],
            [element["Ixy"], element["Iyy"], element["Iyz"]],
            [element["Ixz"], element["Iyz"], element["Izz"]],
        ]
    )
    about = inertia.get("about", "com")
    if about == "origin":
        return moved_to_com(tensor, mass, com)
    if about == "com":
        return tensor
    raise ValueError(f"inertia about {about!r}: expected com or origin")


def read_pseudo_inertia(spec, body):
    """H of one body as written: `mass`, `com`, `inertia`."""
    mass = spec.number(body["mass"])
    com = spec.vector(body.get("com", [0, 0, 0]))
    return pseudo_inertia(mass, com, read_tensor(spec, body.get("inertia", {}), mass, com))
