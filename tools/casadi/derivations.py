"""Everything a crane's functions return, by CasADi's differentiation of T, of energies and of the dissipation.

No formula of the equations of motion is written down here: A, e, forces, K and D are derivatives of
`E_k = ½ Σ tr(Ṫ H Ṫᵀ)`, of the potential energy by part, and of Rayleigh's dissipation function.
"""

import casadi as ca
import numpy as np

import cylinders
import loop_joints
from contacts import contact
from limits import energy_at_rest, limited_drive, slope_at_rest


def row_major(matrix):
    """Entries row by row, as a column."""
    return ca.vec(matrix.T)


def in_cut(cut, force, moment):
    """Force and moment about the world's origin in the frame of a cut, about its origin."""
    turn, origin = cut.frame[:3, :3].T, cut.frame[:3, 3]
    return [turn @ force, turn @ (moment - ca.cross(origin, force))]


def pressed(length, connector):
    """How far a connector is beyond its length without force, times its stiffness the force; within the clearance of a pad, a fraction of it."""
    stretch, clearance = length - connector.length, connector.clearance
    centring = connector.centring
    beyond, below = stretch - (1 - centring) * clearance, stretch + (1 - centring) * clearance
    return ca.if_else(stretch > clearance, beyond, ca.if_else(stretch < -clearance, below, centring * stretch if connector.pad and not is_zero(clearance) else stretch))


def rubbing(friction, rate):
    """Friction at a rate; dry friction of bristles depends on an additional state."""
    more = (friction.breakaway - friction.coulomb) * ca.exp(-((rate / friction.stribeck) ** 2))
    dry = (friction.coulomb + more) * ca.tanh(rate / friction.width) if friction.bristle is None else 0
    return dry + friction.viscous * rate


def is_zero(number):
    """Whether a number is 0, not a parameter."""
    return ca.SX(number).is_zero()


class Derivations:
    """The quantities of a crane as named CasADi expressions over (t, q, v, parameters)."""

    def __init__(self, crane):
        self.crane = crane
        self.arguments = [crane.time, crane.q, crane.v, crane.parameters]
        self.by_oil = any(drive.by_oil for drive in crane.drives)
        self.contacts = {s.name: contact(s, crane.q, crane.v) for s in crane.supports if s.friction is not None}
        self.quantities = {
            **self.transforms(),
            **self.dynamics(),
            **self.forces(),
            **self.statics(),
            **self.motions(),
            **self.prescribed(),
            **self.internal_forces(),
            **loop_joints.quantities(crane.loop_joints, crane.q, crane.v),
        }
        self.quantities |= self.motion_derivatives()

    def rate(self, expression):
        """Time derivative at given t, q, v: the directional derivative along (1, v)."""
        time, q, v, _ = self.arguments
        return ca.jtimes(expression, q, v) + ca.jtimes(expression, time, ca.SX(1))

    def transforms(self):
        """T, ∂T/∂q_i and ∂²T/∂q_m∂q_n of every body, for the coordinates that move it."""
        bodies, q = self.crane.bodies, self.crane.q
        count = q.numel()
        poses = ca.vertcat(*[row_major(body.transform) for body in bodies])
        block = [slice(16 * index, 16 * index + 16) for index in range(len(bodies))]
        first = ca.jacobian(poses, q)
        second = {}
        for m in range(count):
            reached = ca.vertcat(*[first[block[p], m] for p, body in enumerate(bodies) if m in body.moved_by])
            second[m] = ca.jacobian(reached, q[m:])

        def pair(p, m, n):
            place = sum(m in body.moved_by for body in bodies[:p])
            return second[m][block[place], n - m]

        moving = [(p, body.moved_by) for p, body in enumerate(bodies)]
        return {
            "transforms": poses,
            "body_sizes": ca.vertcat(*[ca.vertcat(body.pseudo_inertia[3, 3], body.length) for body in bodies]),
            "support_places": ca.vertcat(ca.SX(0, 1), *[support.at for support in self.crane.supports]),
            "section_places": ca.vertcat(ca.SX(0, 1), *[ca.vertcat(x, beam.length) for beam in self.crane.beams for x in beam.places]),
            "transform_derivatives": ca.vertcat(*[first[block[p], i] for p, dof in moving for i in dof]),
            "transform_second_derivatives": ca.vertcat(
                *[pair(p, m, n) for p, dof in moving for m in dof for n in dof if n >= m]
            ),
        }

    def motion_derivatives(self):
        """`A a - e`, `r = A a - e - f`, and derivatives of r and f by q and v, at given a, for which the rates are used, too; those of the points.

        The forces of rigid drives are not part of f.
        """
        q, v, known = self.crane.q, self.crane.v, self.quantities
        a = ca.SX.sym("a", q.numel())
        required = ca.reshape(known["mass_matrix"], q.numel(), q.numel()) @ a - known["bias"]
        residual = required - known["forces"]
        slopes, of_forces = (
            [row_major(ca.densify(ca.jacobian(of, x))) for x in (q, v)] for of in (residual, known["forces"])
        )
        found = [ca.substitute(expression, a, v) for expression in (required, residual, ca.vertcat(*slopes))]
        names = ["inverse_dynamics", "dynamic_residual", "dynamic_residual_derivatives"]
        return dict(zip(names, found)) | {
            "force_derivatives": ca.vertcat(*of_forces),
            "point_jacobians": row_major(ca.densify(ca.jacobian(known["points"], q))),
        }

    def internal_forces(self):
        """What the part beyond each cut exerts on the part before it: its weight and the loads on it, minus the rate of its momenta.

        With H the pseudo-inertia, `∫ ẍ dm` is the last column of `T̈ H`, and `∫ x × ẍ dm` the axial vector of `T̈ H Tᵀ`. The
        rates are used as accelerations, too.
        """
        bodies = self.crane.bodies
        required = [self.momenta_rate(body.transform, body.pseudo_inertia) for body in bodies]
        for place in range(len(bodies)):
            for _, pull, turn in self.actions(place):
                required[place] = required[place][0] - pull, required[place][1] - turn
        # A body comes after the one that carries it.
        sums = list(required)
        for place, body in reversed(list(enumerate(bodies))):
            if body.parent is not None:
                sums[body.parent] = sums[body.parent][0] + sums[place][0], sums[body.parent][1] + sums[place][1]
        wrenches = []
        for cut in self.crane.cuts:
            total = ca.SX(6, 1)
            for here, part in cut.parts():
                force, moment = sums[part.body]
                if part.portion is not None:
                    force, moment = self.momenta_rate(bodies[part.body].transform, part.portion)
                    for place, body in enumerate(bodies):
                        if body.parent == part.body:
                            beyond = part.beyond(bodies, place)
                            force, moment = force + beyond * sums[place][0], moment + beyond * sums[place][1]
                    for along, pull, turn in self.actions(part.body):
                        beyond = part.beyond(bodies, part.body, along)
                        force, moment = force - beyond * pull, moment - beyond * turn
                total += here * ca.vertcat(*in_cut(part, -force, -moment))
            wrenches.append(total)
        positions = [support.position for support in self.crane.supports]
        return {
            "internal_forces": ca.vertcat(*wrenches),
            "support_positions": ca.vertcat(ca.SX(0, 1), *positions),
            **self.section_moduli(),
            **self.transmitted(),
        }

    def momenta_rate(self, transform, pseudo_inertia):
        """What a mass that moves with a body requires, and its moment about the world's origin: inertia forces and weight."""
        q, v, gravity = self.crane.q, self.crane.v, self.crane.gravity
        first = ca.jtimes(transform, q, v)
        second = ca.jtimes(first, q, v) + first
        linear = second @ pseudo_inertia[:, 3]
        rate = second @ pseudo_inertia @ transform.T
        angular = ca.vertcat(rate[2, 1] - rate[1, 2], rate[0, 2] - rate[2, 0], rate[1, 0] - rate[0, 1])
        moments = (transform @ pseudo_inertia[:, 3])[:3]
        return linear[:3] - pseudo_inertia[3, 3] * gravity, angular - ca.cross(moments, gravity)

    def actions(self, place):
        """Loads on a body and pulls of connectors: distance along the body, force, moment about the world's origin."""
        for load in self.crane.loads:
            if load.body == place:
                yield load.along, load.force, load.moment + ca.cross(load.position, load.force)
        for connector in self.crane.connectors:
            tension = self.connector(connector)[2]
            for body, along, force, moment in connector.wrenches():
                if body == place:
                    yield along, tension * force, tension * moment

    def transmitted(self):
        """What each cylinder and the parts of each connector between two bodies add to the wrench at each cut, with a force of 1 N."""
        of_cylinders, of_connectors = [ca.SX(0, 1)], [ca.SX(0, 1)]
        for cylinder in self.crane.cylinders:
            for cut in self.crane.cuts:
                total = ca.SX(6, 1)
                for here, part in cut.parts() if self.by_oil else []:
                    force, moment = cylinders.on_part_beyond(cylinder, part, self.crane.bodies)
                    total += here * ca.vertcat(*in_cut(part, force, moment))
                of_cylinders.append(total)
        for connector in self.crane.connectors:
            wrenches = list(connector.wrenches(within=True))
            for cut in self.crane.cuts:
                total = ca.SX(6, 1)
                for here, part in cut.parts():
                    force, moment = ca.SX(3, 1), ca.SX(3, 1)
                    for body, along, pull, turn in wrenches:
                        beyond = part.beyond(self.crane.bodies, body, along)
                        force, moment = force + beyond * pull, moment + beyond * turn
                    total += here * ca.vertcat(*in_cut(part, force, moment))
                of_connectors.append(total)
        return {"cylinder_wrenches": ca.vertcat(*of_cylinders), "connector_wrenches": ca.vertcat(*of_connectors)}

    def section_moduli(self):
        """Section moduli of beams, and the allowable stress; zeros where the spec does not give them."""
        rows = [
            ca.vertcat(*moduli, beam.allowable_stress) if moduli else ca.SX.zeros(8)
            for beam in self.crane.beams
            for moduli in beam.sections
        ]
        return {"section_moduli": ca.vertcat(ca.SX(0, 1), *rows)}

    def kinetic_energy(self):
        """`½ Σ tr(Ṫ H Ṫᵀ)` [Urbaś 2016, Eq. (4)], plus `½ Σ I q̇²` for rotors, whose armature is reflected to the joint."""
        energy = sum((armature * coordinate.v**2 / 2 for coordinate, armature in self.crane.rotors), ca.SX(0))
        for body in self.crane.bodies:
            rate = self.rate(body.transform)
            energy += ca.trace(rate @ body.pseudo_inertia @ rate.T) / 2
        return energy

    def gravity_energy(self):
        """`-Σ g · ∫ r dm`, the generalisation of [Urbaś 2016, Eq. (6)] to any direction of gravity."""
        moments = sum((body.transform @ body.pseudo_inertia[:, 3] for body in self.crane.bodies), ca.SX(4, 1))
        return -ca.dot(self.crane.gravity, moments[:3])

    def dynamics(self):
        """A and e from Lagrange's operators on E_k and E_g [Urbaś 2016, Eqs. (5)-(9)]."""
        q, v = self.crane.q, self.crane.v
        kinetic, gravity = self.kinetic_energy(), self.gravity_energy()
        mass_matrix, momentum = ca.hessian(kinetic, v)
        inertia_force = ca.jtimes(momentum, q, v) - ca.gradient(kinetic, q)
        bias = -(inertia_force + ca.gradient(gravity, q))
        return {
            "mass_matrix": row_major(ca.densify(mass_matrix)),
            "mass_matrix_lower": row_major(ca.densify(ca.tril(mass_matrix))),
            "bias": bias,
            "bias_with_mass_matrix": bias,
            "kinetic_energy": kinetic,
            "linearised_mass": self.unknowns(mass_matrix, 1),
        }

    def potentials(self):
        """Potential energy and Rayleigh's function by part [Urbaś 2016, Eqs. (14), (16), (17), (19)].

        One-sided supports, drives with a limit and drives by oil are not included.
        """
        crane = self.crane

        def sum_of(terms):
            return sum(terms, ca.SX(0))

        def stored(springs):
            return sum_of(s.stiffness * (s.motion - s.coordinate.q) ** 2 / 2 for s in springs)

        def lost(springs):
            return sum_of(s.damping * (self.rate(ca.SX(s.motion)) - s.coordinate.v) ** 2 / 2 for s in springs)

        anchored = [s for s in crane.supports if s.friction is None]
        unlimited = [drive for drive in crane.drives if drive.max_effort is None and not drive.by_oil]
        return {
            "support": (
                sum_of(ca.dot(s.stiffness, s.elongation**2) / 2 for s in anchored),
                sum_of(ca.dot(s.damping, self.rate(s.elongation) ** 2) / 2 for s in anchored),
            ),
            "element": (stored(crane.elements), lost(crane.elements)),
            "drive": (stored(unlimited), lost(unlimited)),
            "joint_damper": (ca.SX(0), lost(crane.joint_dampers)),
        }

    def joint_forces(self):
        """End stops and friction: generalized forces of both, energy of the stops, damping of both at rest.

        A stop is a one-way spring times `1 + a δ̇` where that is positive [Hunt and Crossley 1975]; friction is Coulomb's with
        the Stribeck effect, smoothed by a hyperbolic tangent.
        """
        crane = self.crane
        places = {coordinate.name: place for place, coordinate in enumerate(crane.coordinates)}
        stop_forces, friction_forces, damping = (ca.SX.zeros(crane.q.shape) for _ in range(3))
        energy = ca.SX(0)
        for stop in crane.stops:
            place, rate = places[stop.coordinate.name], stop.sign * stop.coordinate.v
            beyond = stop.sign * (stop.coordinate.q - stop.at)
            depth = ca.if_else(beyond > 0, beyond, 0)
            growth = 1 + stop.damping * rate
            stop_forces[place] -= stop.sign * stop.stiffness * depth * ca.if_else(growth > 0, growth, 0)
            damping[place] += stop.stiffness * depth * stop.damping
            energy += stop.stiffness * depth**2 / 2
        for friction in crane.frictions:
            place, rate = places[friction.coordinate.name], friction.coordinate.v
            friction_forces[place] -= rubbing(friction, rate)
            damping[place] += friction.viscous
        return stop_forces, friction_forces, energy, damping

    def load_forces(self):
        """Generalized forces of the loads: virtual work of force and moment, with `δR Rᵀ` for the rotation."""
        q = self.crane.q
        forces = ca.SX.zeros(q.shape)
        for load in self.crane.loads:
            forces += ca.jacobian(load.position, q).T @ load.force
            for place in range(q.numel()):
                turned = ca.jacobian(ca.vec(load.rotation), q[place])
                spin = ca.reshape(turned, 3, 3) @ load.rotation.T
                forces[place] += ca.dot(ca.vertcat(spin[2, 1], spin[0, 2], spin[1, 0]), load.moment)
        return forces

    def connector(self, connector, moving=True):
        """Length, its rate, the force that pulls its points together, and the energy, of an element between two points.

        At rest all rates are zero, even that of a winch.
        """
        length = connector.strain
        rate = self.rate(length) if moving else ca.SX(0)
        stretch = pressed(length, connector)
        if connector.is_rope:
            stretch = ca.if_else(stretch > 0, stretch, 0)
            growth = 1 + connector.damping * (rate - (self.rate(ca.SX(connector.length)) if moving else 0))
            force = connector.stiffness * stretch * ca.if_else(growth > 0, growth, 0)
        elif connector.pin is not None:
            return length, rate, rubbing(connector.pin.friction, rate), ca.SX(0)
        else:
            cubic = connector.progression * stretch**3
            force = connector.stiffness * stretch + cubic - connector.push + connector.damping * rate
        stored = connector.stiffness * self.stored_by(stretch, length, connector) + connector.progression * stretch**4 / 4 - connector.push * stretch
        return length, rate, force, stored

    @staticmethod
    def stored_by(stretch, length, connector):
        """`½ stretch²`, or its integral where a pad has clearance."""
        clearance = connector.clearance
        if connector.pad is None or is_zero(clearance):
            return stretch**2 / 2
        depth, centring = ca.fabs(length) - clearance, connector.centring
        return ca.if_else(depth > 0, depth**2 / 2 + centring * clearance * (depth + clearance / 2), centring * length**2 / 2)

    def connector_forces(self):
        """Generalized forces of elements between two points by virtual work, power of winches, energies and damping at rest."""
        q, v = self.crane.q, self.crane.v
        forces = ca.SX.zeros(q.shape)
        energy, power, lost, damping = ca.SX(0), ca.SX(0), ca.SX(0), ca.SX(q.numel(), q.numel())
        lengths, tensions, rows = [ca.SX(0, 1)], [ca.SX(0, 1)], [ca.SX(0, q.numel())]
        for connector in self.crane.connectors:
            length, rate, force, stored = self.connector(connector)
            still = self.connector(connector, moving=False)[2]
            row = ca.jacobian(length, q)
            # What is soft beside a pad depends on the place of the pad: forces are the slopes of the energy.
            forces -= ca.gradient(stored, q) + row.T * (force - still) if connector.pad else row.T * force
            energy += stored
            # While the rope's way stays as long as it is, a winch changes the energy, and works against the damper.
            winding = self.rate(ca.SX(connector.length))
            wound = ca.jtimes(stored, self.crane.time, ca.SX(1)) - (force - still) * winding if connector.is_rope else 0
            power += wound
            lost += (force - still) * rate if connector.pad else wound + force * rate - self.rate(stored)
            # Slopes of F(ℓ, ℓ̇) by symbols for length and rate; those of a rope where it is taut.
            stretched, running = ca.SX.sym("length"), ca.SX.sym("rate")
            taut = stretched > connector.length
            if connector.is_rope:
                growth = 1 + connector.damping * (running - self.rate(ca.SX(connector.length)))
                law = ca.if_else(taut, connector.stiffness * (stretched - connector.length), 0) * ca.if_else(growth > 0, growth, 0)
            elif connector.pin is not None:
                law = rubbing(connector.pin.friction, running)
            else:
                stretch = pressed(stretched, connector)
                law = connector.stiffness * stretch + connector.progression * stretch**3 + connector.damping * running
            slopes = ca.substitute(
                ca.vertcat(ca.jacobian(law, stretched), ca.jacobian(law, running)),
                ca.vertcat(stretched, running),
                ca.vertcat(length, rate),
            )
            lengths += [length, rate]
            rows.append(row)
            tensions += [force, slopes]
            resting = connector.damping * (still if connector.is_rope else 1)
            damping += row.T @ row * ca.substitute(ca.SX(resting), self.crane.time, 0)
        return {
            "connector_forces": forces,
            "connector_energy": energy,
            "winch_power": power,
            "connector_lengths": ca.vertcat(*lengths),
            "connector_tensions": ca.vertcat(*tensions),
            "connector_jacobians": row_major(ca.densify(ca.vertcat(*rows))),
        }, lost, damping

    def forces(self):
        """Generalized forces `-∂E_p/∂q - ∂R/∂q̇` by part and in total; power lost 2R; D = ∂²R/∂q̇²."""
        q, v = self.crane.q, self.crane.v
        parts = self.potentials()
        energies = {part: energy for part, (energy, _) in parts.items()}
        by_part = {part: -ca.gradient(e, q) - ca.gradient(r, v) for part, (e, r) in parts.items()}
        dissipation_function = sum(lost for _, lost in parts.values())
        linear = sum(by_part.values())
        damping = -ca.substitute(ca.jacobian(linear, v), v, ca.DM.zeros(v.shape))
        stops, friction, stop_energy, at_rest = self.joint_forces()
        loads = self.load_forces()
        connectors, lost_by_connectors, resting = self.connector_forces()
        contacts, contact_energy, contact_damping = self.contact_forces()
        by_part["support"] += contacts
        energies["support"] += contact_energy
        # Power of stops and friction that does not go into the stops' energy.
        lost = -ca.dot(stops + friction, v) - ca.jtimes(stop_energy, q, v)
        lost += sum((c.lost for c in self.contacts.values()), ca.SX(0))
        drives, drive_energy, drive_lost, drive_damping, *_ = self.limited_drives()
        by_part["drive"] += drives
        energies["drive"] += drive_energy
        step_damping = sum((c.step_damping for c in self.contacts.values()), damping)
        tangents = ca.horzcat(
            -ca.diag(ca.jacobian(stops + drives, q)),
            -ca.diag(ca.jacobian(stops + drives, v)) + ca.fmax(0, -ca.diag(ca.jacobian(friction, v))),
        )
        return {
            "stop_forces": stops,
            "friction_forces": friction,
            "load_forces": loads,
            "load_power": ca.dot(loads, v),
            **connectors,
            "stop_energy": stop_energy,
            "nonlinear_stiffness_and_damping": row_major(ca.densify(tangents)),
            LINEAR_DAMPING: row_major(ca.densify(step_damping)),
            **{f"{part}_forces": force for part, force in by_part.items()},
            "forces": linear + contacts + drives + stops + friction + loads + connectors["connector_forces"],
            "gravity_energy": self.gravity_energy(),
            **{f"{part}_energy": energies[part] for part in ("support", "element", "drive")},
            "dissipation": 2 * dissipation_function + drive_lost + lost + lost_by_connectors,
            "linearised_damping": self.unknowns(
                damping + contact_damping + ca.diag(at_rest + drive_damping) + resting, 0
            ),
        }

    def limited_drives(self):
        """Drives with a limit or an effort besides: their generalized forces, energy, lost power, damping at rest and t = 0, power that
        they put in beyond that of their motions with the delivered efforts, and the potential of their forces at rest."""
        places = {coordinate.name: place for place, coordinate in enumerate(self.crane.coordinates)}
        forces, damping = (ca.SX.zeros(self.crane.q.shape) for _ in range(2))
        energy, lost, slipping, resting = ca.SX(0), ca.SX(0), ca.SX(0), ca.SX(0)
        for drive in self.crane.drives:
            if drive.max_effort is None and isinstance(drive.effort, int):
                continue
            effort, stored, own, beyond = limited_drive(drive, self.rate)
            place = places[drive.coordinate.name]
            forces[place] += effort
            if drive.max_effort is not None:
                damping[place] += ca.substitute(drive.damping * slope_at_rest(drive), self.crane.time, 0)
            energy, lost, slipping = energy + stored, lost + own, slipping + beyond
            resting += energy_at_rest(drive)
        return forces, energy, lost, damping, slipping, resting

    def contact_forces(self):
        """One-sided supports: their generalized forces, energy, damping at rest."""
        size = self.crane.q.numel()
        contacts = self.contacts.values()
        forces = sum((c.jacobian.T @ c.force for c in contacts), ca.SX(size, 1))
        return forces, sum((c.energy for c in contacts), ca.SX(0)), sum((c.at_rest for c in contacts), ca.SX(size, size))

    def unknowns(self, matrix, diagonal):
        """A matrix of small motions, row by row: rows and columns of prescribed coordinates are zero except for the given diagonal."""
        matrix = ca.densify(matrix)
        for place in self.crane.rigid_drives:
            matrix[place, :] = 0
            matrix[:, place] = 0
            matrix[place, place] = diagonal
        return row_major(matrix)

    def prescribed(self):
        """Coordinates and rates, with those of rigid drives replaced by their motions, and the prescribed accelerations."""
        q, v, acceleration = ca.SX(self.crane.q), ca.SX(self.crane.v), ca.SX.zeros(self.crane.q.shape)
        for place, drive in self.crane.rigid_drives.items():
            motion = ca.SX(drive.motion)
            q[place], v[place] = motion, self.rate(motion)
            acceleration[place] = self.rate(v[place])
        return {"prescribed": ca.vertcat(q, v), PRESCRIBED: acceleration}

    def driving_forces(self):
        """`t_dr` of each drive: the generalized force of the drives' springs and dampers on its coordinate."""
        energy, lost = self.potentials()["drive"]
        forces = self.limited_drives()[0]
        places = {coordinate.name: place for place, coordinate in enumerate(self.crane.coordinates)}
        coordinates = [drive.coordinate for drive in self.crane.drives]
        return ca.vertcat(
            *[forces[places[c.name]] - ca.gradient(energy, c.q) - ca.gradient(lost, c.v) for c in coordinates]
        )

    def statics(self):
        """Gradient and Hessian of the whole potential energy, with feet, loads, winches and drives where they are at the time of the state; the
        Hessian also at t = 0 without oil, for small motions."""
        q = self.crane.q
        springs, oil = self.potentials()["drive"][0] + self.limited_drives()[5], self.holding_energy()
        others = self.gravity_energy() + sum(energy for part, (energy, _) in self.potentials().items() if part != "drive")
        others += self.joint_forces()[2] + self.connector_forces()[0]["connector_energy"]
        loads = self.load_forces()
        slope = ca.jacobian(loads, q)
        stiffness, gradient = ca.hessian(others + springs, q)
        stiffness, gradient = stiffness - (slope + slope.T) / 2, gradient - loads
        # Friction has no potential.
        for foot in self.contacts.values():
            stiffness, gradient = stiffness + foot.stiffness, gradient + foot.pull
        of_oil, push = ca.hessian(oil, q)
        residual, holding = ca.densify(gradient + push), ca.densify(-ca.gradient(springs, q) - push)
        for place in self.crane.rigid_drives:
            holding[place], residual[place] = residual[place], 0
        linear = ca.hessian(sum(energy for energy, _ in self.potentials().values()), q)[0]
        linear = sum((c.step_stiffness for c in self.contacts.values()), linear)
        return {
            "static_residual": residual,
            "drive_forces_at_rest": holding,
            "tangent_stiffness": self.unknowns(stiffness + of_oil, 1),
            "linearised_stiffness": self.unknowns(ca.substitute(stiffness, self.crane.time, 0), 1),
            SPRINGS: row_major(ca.densify(linear)),
        }

    def holding_energy(self):
        """Energy of the springs that stand for cylinders with oil at rest: along the cylinder, with the joint at the position of its drive and
        straight beams as the pose without force."""
        energy = ca.SX(0)
        for drive in self.crane.drives:
            if not drive.by_oil:
                continue
            place = self.crane.coordinates.index(drive.coordinate)
            length = next(c.length for c in self.crane.cylinders if c.coordinate is drive.coordinate)
            straight = ca.SX.zeros(self.crane.q.shape)
            straight[place] = drive.motion
            arm, meant = (ca.substitute(of, self.crane.q, straight) for of in (ca.jacobian(length, drive.coordinate.q), length))
            energy += drive.stiffness * ((meant - length) / arm) ** 2 / 2
        return energy

    def motions(self):
        """Points and their velocities, reactions of the supports, cylinders, and the drives' motions, limits and power."""
        crane = self.crane
        points = ca.vertcat(*crane.points.values())
        prescribed = ca.vertcat(*[ca.SX(drive.motion) for drive in crane.drives])
        rates = self.rate(prescribed)
        openings = ca.vertcat(*[ca.SX(drive.opening) for drive in crane.drives])
        return {
            "points": points,
            "point_velocities": self.rate(points),
            # The rates are used as accelerations, too.
            "point_accelerations": ca.jtimes(self.rate(points), crane.q, crane.v) + self.rate(points),
            "support_reactions": ca.vertcat(*[self.reaction(s) for s in crane.supports]),
            "support_gaps": ca.vertcat(*[self.gap(s) for s in crane.supports]),
            **self.stands(),
            "cylinder_states": ca.vertcat(*[cylinders.state(cylinder, self.rate) for cylinder in crane.cylinders]),
            "cylinder_jacobians": self.cylinder_jacobians(),
            "drive_limits": self.drive_limits(),
            "drive_motions": row_major(ca.horzcat(prescribed, rates)),
            "valve_openings": row_major(ca.horzcat(openings, self.rate(openings))),
            "drive_power": ca.dot(self.driving_forces(), rates) + self.limited_drives()[4],
        }

    def cylinder_jacobians(self):
        """Derivatives of the lengths of cylinders; zeros for a crane without valves."""
        lengths = ca.vertcat(ca.SX(0, 1), *[cylinder.length for cylinder in self.crane.cylinders])
        rows = ca.densify(ca.jacobian(lengths, self.crane.q))
        return row_major(rows if self.by_oil else ca.SX.zeros(rows.shape))

    def drive_limits(self):
        """Maximum effort of each drive and its stiffness; zeros for a crane without limits."""
        drives = self.crane.drives
        if all(drive.max_effort is None for drive in drives):
            return ca.SX.zeros(2 * len(drives))
        efforts = self.driving_forces()
        stiffness = [-ca.jacobian(efforts[k], drive.coordinate.q) for k, drive in enumerate(drives)]
        limits = [drive.max_effort or 0 for drive in drives]
        return ca.vertcat(*[ca.vertcat(*pair) for pair in zip(limits, stiffness, strict=True)])

    def reaction(self, support):
        """Force of a support on the crane, world frame."""
        if support.friction is not None:
            return self.contacts[support.name].force
        return -support.stiffness * support.elongation - support.damping * self.rate(support.elongation)

    def gap(self, support):
        """How far a one-sided support is above the ground, and its rate; zeros for others."""
        if support.friction is None:
            return ca.SX.zeros(2)
        return ca.vertcat(support.elongation[2], self.rate(support.elongation[2]))

    def stands(self):
        """How the supports stand, and how feet hold sideways; zeros for a crane without feet."""
        supports = self.crane.supports
        grips = [self.contacts[s.name].grip if s.friction is not None else ca.SX.zeros(3) for s in supports]
        elongations = ca.vertcat(ca.SX(0, 1), *[s.elongation for s in supports])
        found = {
            "support_elongations": elongations,
            "support_jacobians": row_major(ca.densify(ca.jacobian(elongations, self.crane.q))),
            "support_stiffnesses": ca.vertcat(ca.SX(0, 1), *[s.stiffness for s in supports]),
            "support_dampings": ca.vertcat(ca.SX(0, 1), *[s.damping for s in supports]),
            "support_grips": ca.vertcat(ca.SX(0, 1), *grips),
        }
        return found if self.contacts else {name: ca.SX.zeros(of.shape) for name, of in found.items()}

    def sizes(self):
        """How many numbers each quantity has."""
        own = {name: expression.numel() for name, expression in self.quantities.items() if name not in INTERNAL}
        n = self.crane.q.numel()
        equations = own["loop_jacobians"] // n
        loop_rows = 1 + -(-equations // n) + 2 * equations if equations else 0
        return own | dict.fromkeys(SOLUTIONS, n) | {"loop_dynamics": loop_rows * n, "inverse_mass_matrix": n * n}

    def evaluate(self, states):
        """All quantities at all states: name -> array with one row per state."""
        columns = [states.time[None, :], states.q.T, states.v.T, states.parameters.T]
        names = list(self.quantities)
        function = ca.Function("quantities", self.arguments, [ca.densify(self.quantities[name]) for name in names])
        values = function(*columns)
        values = {name: value.full().T for name, value in zip(names, values)}
        return values | solutions(values, states.v, list(self.crane.rigid_drives))

    def closed_accelerations(self, values):
        """Accelerations with closed loops, from the quantities of :meth:`evaluate`: those of generated code are of the open chain."""
        prescribed, count = list(self.crane.rigid_drives), self.crane.q.numel()
        square = values["mass_matrix"].reshape(-1, count, count)
        rows = values["loop_jacobians"].reshape(len(square), -1, count)
        curvatures = values["loop_states"].reshape(len(square), -1, 3)[:, :, 2]
        forces = values["bias"] + values["forces"]
        return loop_joints.closed(square, forces, rows, curvatures, values["forward_dynamics"], prescribed)


# Step size of `implicit_solution`, s; that of the program `evaluate`.
IMPLICIT_STEP = 0.01
# Computed from the other quantities at each state.
SOLUTIONS = ["forward_dynamics", "lane_forward_dynamics", "solve_mass", "implicit_solution"]
# The stiffness of all springs in implicit steps, needed only for these: no generated function returns it.
SPRINGS = "linear_stiffness"
# The accelerations of coordinates that rigid drives prescribe, likewise.
PRESCRIBED = "prescribed_acceleration"
# The damping in implicit steps, likewise.
LINEAR_DAMPING = "linear_damping"
INTERNAL = [SPRINGS, PRESCRIBED, LINEAR_DAMPING]
# What is not derived a second time: numbers of the spec, blocks of matrices that implicit solutions contain, factors of matrices that are
# compared, and the wrenches of loop joints, which no compiled crane has.
NOT_DERIVED = [
    "attachments",
    "base_damping",
    "base_stiffness",
    "drive_pieces",
    "joint_stiffness_and_damping",
    "load_pieces",
    "loop_wrenches",
    "mass_factors",
    "residual_factors",
    "winch_pieces",
]


def solutions(values, v, prescribed):
    """Accelerations and solutions of linear systems, by dense factors of the derived matrices; efforts of rigid drives.

    Prescribed coordinates are not unknowns: with P these and U the others, `A_UU q̈_U = (e + f)_U - A_UP q̈_P`. What the motion
    requires, `(A q̈ - e - f)_P`, is added to the forces.
    """
    count = v.shape[1]
    mass, damping, stiffness = (
        values[name].reshape(-1, count, count) for name in ("mass_matrix", LINEAR_DAMPING, SPRINGS)
    )
    implicit = mass + IMPLICIT_STEP * damping + IMPLICIT_STEP**2 * stiffness
    given = values[PRESCRIBED]
    for name in INTERNAL:
        del values[name]
    forces = values["bias"] + values["forces"]
    accelerations = given + solve_unknown(mass, forces - np.einsum("sij,sj->si", mass, given), prescribed)
    efforts = (np.einsum("sij,sj->si", mass, accelerations) - forces)[:, prescribed]
    for name in ("drive_forces", "forces"):
        values[name][:, prescribed] += efforts
    values["drive_power"][:, 0] += np.einsum("si,si->s", efforts, v[:, prescribed])
    found = [accelerations, accelerations, solve_unknown(mass, v, prescribed), solve_unknown(implicit, v, prescribed)]
    units = np.delete(np.eye(count), prescribed, axis=0)
    inverse = np.zeros_like(mass)
    inverse[:, np.delete(np.arange(count), prescribed)] = np.stack(
        [solve_unknown(mass, np.broadcast_to(unit, v.shape), prescribed) for unit in units], axis=1
    )
    return dict(zip(SOLUTIONS, found)) | {
        "loop_dynamics": loop_dynamics(values, mass, accelerations, prescribed),
        "inverse_mass_matrix": inverse.reshape(len(v), -1),
    }


def loop_dynamics(values, mass, accelerations, prescribed):
    """Accelerations of the open chain, J̇ q̇ of the equations of its loops in rows as long as q, J, and A⁻¹ Jᵀ, row by row."""
    states, count = accelerations.shape
    rows = values["loop_jacobians"].reshape(states, -1, count)
    if rows.shape[1] == 0:
        return np.zeros((states, 0))
    curvatures = values["loop_states"].reshape(states, -1, 3)[:, :, 2]
    filled = np.zeros((states, -(-curvatures.shape[1] // count) * count))
    filled[:, : curvatures.shape[1]] = curvatures
    columns = [solve_unknown(mass, rows[:, row], prescribed) for row in range(rows.shape[1])]
    return np.concatenate([accelerations, filled, rows.reshape(states, -1), *columns], axis=1)


def solve_unknown(matrices, right, prescribed):
    """`A x = r` without the rows and columns of prescribed coordinates, where x = 0."""
    matrices, right = matrices.copy(), right.copy()
    matrices[:, prescribed, :] = 0
    matrices[:, :, prescribed] = 0
    matrices[:, prescribed, prescribed] = 1
    right[:, prescribed] = 0
    return solve_scaled(matrices, right)


def solve_scaled(matrices, right):
    """`A x = r` for positive definite A, scaled to a unit diagonal, which improves its condition."""
    scale = 1 / np.sqrt(np.einsum("sii->si", matrices))
    scaled = matrices * scale[:, :, None] * scale[:, None, :]
    return scale * np.linalg.solve(scaled, (scale * right)[:, :, None])[:, :, 0]
