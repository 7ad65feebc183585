"""Random robots in MJCF with most features of the language: joints of all kinds, several per body, frames, classes, shapes, tendons, joints
that follow others."""

from xml.etree import ElementTree

import numpy as np

LETTERS = "xyzXYZ"


class RandomRobot:
    """A serial robot from a seed."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)
        self.degrees = self.rng.random() < 0.5
        self.root = ElementTree.Element("mujoco", model=f"random_{seed}")
        sequence = "".join(self.rng.choice(list(LETTERS), 3))
        compiler = ElementTree.SubElement(self.root, "compiler", angle="degree" if self.degrees else "radian", eulerseq=sequence)
        if self.rng.random() < 0.2:
            compiler.set("settotalmass", text(self.rng.uniform(5, 50)))
        if self.rng.random() < 0.2:
            compiler.attrib.update(boundmass=text(3), boundinertia=text(0.5), balanceinertia="true")
        ElementTree.SubElement(self.root, "option", gravity=text(self.rng.uniform(-10, 10, 3)))
        outer = ElementTree.SubElement(self.root, "default")
        ElementTree.SubElement(outer, "joint", damping=text(self.rng.uniform(0, 3)))
        inner = ElementTree.SubElement(outer, "default", {"class": "soft"})
        ElementTree.SubElement(inner, "joint", stiffness=text(self.rng.uniform(1, 9)), type="hinge", axis="0 1 0")
        ElementTree.SubElement(inner, "geom", type="capsule", size="0.05 0.2", density=text(self.rng.uniform(500, 3000)))
        self.joints = 0
        parent = ElementTree.SubElement(self.root, "worldbody")
        for number in range(self.rng.integers(2, 6)):
            parent = self.body(parent, number)
        if self.rng.random() < 0.5:
            self.tendons()
        if self.joints > 1 and seed % 2:
            self.equality()

    def document(self):
        """The file."""
        return ElementTree.tostring(self.root, encoding="unicode")

    def body(self, parent, number):
        """A body in another one, sometimes in a frame."""
        if self.rng.random() < 0.3:
            parent = ElementTree.SubElement(parent, "frame", self.pose())
        body = ElementTree.SubElement(parent, "body", {"name": f"part_{number}", **self.pose()})
        if self.rng.random() < 0.3:
            body.set("childclass", "soft")
        kind = self.rng.random()
        if number == 0 and kind < 0.3:
            ElementTree.SubElement(body, "freejoint", name="root")
        elif kind > 0.8:
            anchor = self.rng.uniform(-0.5, 0.5, 3)
            ElementTree.SubElement(body, "joint", type="ball", name=f"ball_{number}", pos=text(anchor), stiffness="0", damping="0")
        else:
            # The first body moves; of the others, some are fixed.
            for _ in range(self.rng.integers(1 if number == 0 else 0, 4)):
                self.joint(body)
        self.mass(body)
        if self.rng.random() < 0.5:
            ElementTree.SubElement(body, "site", {"name": f"point_{number}", **self.pose()})
        return body

    def joint(self, body):
        """A hinge or a slide, sometimes with an anchor, a spring, a rotor."""
        joint = ElementTree.SubElement(body, "joint", name=f"joint_{self.joints}")
        self.joints += 1
        # Two joints of a body along the same axis would be redundant.
        first = len(body.findall("joint")) == 1
        if body.get("childclass") is None or not first or self.rng.random() < 0.5:
            joint.set("type", self.rng.choice(["hinge", "slide"]))
            along = self.rng.choice([-1.0, 1.0]) * np.eye(3)[self.rng.integers(3)]
            joint.set("axis", text(along if first and self.rng.random() < 0.6 else self.rng.normal(size=3)))
        turns = joint.get("type", "hinge") == "hinge"
        unit = np.degrees if turns and self.degrees else np.asarray
        if self.rng.random() < 0.5:
            joint.set("pos", text(self.rng.uniform(-0.5, 0.5, 3)))
        if self.rng.random() < 0.4:
            joint.set("ref", text(unit(self.rng.uniform(-1, 1))))
        if self.rng.random() < 0.5:
            joint.set("stiffness", text(self.rng.uniform(1, 50)))
            joint.set("springref", text(unit(self.rng.uniform(-1, 1))))
        if self.rng.random() < 0.2:
            joint.set("springdamper", text(self.rng.uniform(0.2, 2, 2)))
        if self.rng.random() < 0.3:
            joint.set("armature", text(self.rng.uniform(0.1, 2)))
        if self.rng.random() < 0.3:
            joint.set("range", text(unit(np.array([-1.5, 1.5]))))

    def tendons(self):
        """Fixed tendons of one and of two joints with springs and dampers."""
        names = [f"joint_{number}" for number in range(self.joints)]
        # The spring of a single joint is read where the inertia does not determine another one.
        joints = [joint for joint in self.root.find("worldbody").iter("joint") if joint.get("name") in names]
        plain = [joint.get("name") for joint in joints if joint.get("springdamper") is None]
        groups = [self.rng.choice(names, 2, replace=False)] if len(names) > 1 else []
        groups += [plain[:1]] if plain else []
        section = ElementTree.SubElement(self.root, "tendon")
        for number, group in enumerate(groups):
            fixed = ElementTree.SubElement(section, "fixed", name=f"tendon_{number}", stiffness=text(self.rng.uniform(1, 50)), damping="0.7")
            if self.rng.random() < 0.5:
                fixed.set("springlength", text(self.rng.uniform(0.1, 1)))
            for joint in group:
                share = self.rng.choice([-1, 1]) * self.rng.uniform(0.3, 2)
                ElementTree.SubElement(fixed, "joint", joint=str(joint), coef=text(share))

    def equality(self):
        """A joint that follows another one."""
        first, second = self.rng.choice(self.joints, 2, replace=False)
        law = [*self.rng.uniform(-1, 1, 2), 0, 0, 0]
        section = ElementTree.SubElement(self.root, "equality")
        ElementTree.SubElement(section, "joint", joint1=f"joint_{first}", joint2=f"joint_{second}", polycoef=text(law))

    def mass(self, body):
        """An inertial frame, or shapes."""
        if self.rng.random() < 0.5:
            inertial = ElementTree.SubElement(body, "inertial", mass=text(self.rng.uniform(1, 20)), **self.pose())
            # The inertia of some point masses, hence physically possible.
            points = self.rng.normal(size=(4, 3))
            second = points.T @ points
            tensor = np.trace(second) * np.eye(3) - second
            if self.rng.random() < 0.5:
                # MuJoCo allows no orientation together with a full tensor.
                for key in ("quat", "axisangle", "xyaxes", "zaxis", "euler"):
                    inertial.attrib.pop(key, None)
                inertial.set("fullinertia", text(tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]))
            else:
                inertial.set("diaginertia", text(np.diag(tensor)))
            return
        for _ in range(self.rng.integers(1, 4)):
            kind = self.rng.choice(["sphere", "capsule", "cylinder", "box", "ellipsoid", "of the class"])
            geom = ElementTree.SubElement(body, "geom")
            if kind == "of the class":
                geom.set("class", "soft")
            else:
                geom.set("type", kind)
                geom.set("size", text(self.rng.uniform(0.05, 0.3, 3)))
            if kind in ("capsule", "cylinder", "box", "ellipsoid") and self.rng.random() < 0.5:
                geom.set("fromto", text(self.rng.uniform(-0.5, 0.5, 6)))
            else:
                geom.attrib.update(self.pose())
            if self.rng.random() < 0.5:
                geom.set("mass", text(self.rng.uniform(0.5, 5)))

    def pose(self):
        """Position and orientation, in one of the ways to write one."""
        unit = np.degrees if self.degrees else np.asarray
        ways = {
            "quat": lambda: self.rng.normal(size=4),
            "axisangle": lambda: np.append(self.rng.normal(size=3), unit(self.rng.uniform(-3, 3))),
            "xyaxes": lambda: self.rng.normal(size=6),
            "zaxis": lambda: self.rng.choice([self.rng.normal(size=3), np.array([0.0, 0.0, -2.0])]),
            "euler": lambda: unit(self.rng.uniform(-3, 3, 3)),
        }
        way = self.rng.choice([*ways, "none"])
        pose = {"pos": text(self.rng.uniform(-1, 1, 3))}
        return pose if way == "none" else {**pose, way: text(ways[way]())}


def text(numbers):
    """Numbers to their last digit."""
    return " ".join(repr(float(number)) for number in np.atleast_1d(numbers))
