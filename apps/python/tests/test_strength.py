"""Internal forces, stresses, tipping and load charts, against moments about known lines and the command's own laws."""

import crane
import numpy as np
import pytest

# A truck of 4 t, centred between four stiff feet 3 m and 2 m apart, and a load on a massless arm that slews and telescopes.
TRUCK = """
format: 1
name: truck
parameters: {payload: {value: 100, unit: kg}}
links:
  - {name: truck, joint: free, mass: 4000, com: [0, 0, 0.5], inertia: {Ixx: 3000, Iyy: 3000, Izz: 3000}}
  - {name: column, placement: {transform: {translation: [0, 0, 1]}}, joint: revolute, mass: 1, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
  - {name: arm, joint: {prismatic: {axis: x}}, mass: payload, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
supports:
  - {name: front_left, at: [1.5, 1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: front_right, at: [1.5, -1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: rear_left, at: [-1.5, 1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: rear_right, at: [-1.5, -1, 0], stiffness: [1e10, 1e10, 1e10]}
drives:
  - {coordinate: column_psi, rigid: true, motion: {hold: 90 deg}}
  - {coordinate: arm_x, rigid: true, motion: {hold: 3}}
points: [{name: hook, link: arm, at: [0, 0, 0]}]
"""

# A beam clamped at one end, with a mass at the other.
BEAM = """
format: 1
name: arm
parameters: {tip: {value: 200, unit: kg}}
links:
  - name: arm
    joint: fixed
    beam:
      length: 3
      sections: 4
      material: {E: 2.1e11, G: 8.1e10, density: 7850, yield_stress: 3.55e8}
      section: {box: {height: 0.2, width: 0.1, thickness: 0.008}}
      safety_factor: 1.5
  - {name: tip, mass: tip, com: [0, 0, 0]}
"""


@pytest.fixture
def truck():
    return crane.load("truck.yaml", text=TRUCK)


@pytest.fixture
def arm():
    return crane.load("arm.yaml", text=BEAM)


def test_the_ground_carries_the_weight(truck):
    """Over a batch of loads: force and moment about the origin of 4001 kg in the middle and the load 3 m to the left."""
    loads = np.array([50.0, 100.0, 300.0])
    batch = truck.replace(payload=loads)
    forces = batch.internal_forces(batch.statics().q)
    assert forces.shape == (3, len(truck.info["cuts"]), 6)
    ground = [cut["kind"] for cut in truck.info["cuts"]].index("ground")
    np.testing.assert_allclose(forces[:, ground, 2], -9.81 * (4001.0 + loads), rtol=1e-12)
    # Springs of 1e10 N/m yield by some 1e-6 m.
    np.testing.assert_allclose(forces[:, ground, 3], -9.81 * 3.0 * loads, rtol=1e-5, atol=0.1)


def test_tipping_is_the_balance_of_moments(truck):
    """About the left feet: 4001 kg at 1 m hold the load at 3 m − 1 m."""
    loads = np.array([100.0, 500.0, 3000.0])
    found = truck.replace(payload=loads).strength()
    np.testing.assert_allclose(found.tipping_margin, 1.0 - 2.0 * loads / 4001.0, rtol=1e-4)
    np.testing.assert_allclose(found.stabilising, 9.81 * 4001.0, rtol=1e-4)
    np.testing.assert_allclose(found.overturning, 9.81 * 2.0 * loads, rtol=1e-4)
    feet = [support["name"] for support in truck.info["supports"]]
    assert {feet[place] for place in found.governing_line[0]} == {"front_left", "rear_left"}
    # Without a batch: one number.
    assert truck.strength().tipping_margin == found.tipping_margin[0]


def test_a_clamped_beam_bends_as_a_lever(arm):
    """σ = M/W with M = (m L + ρ A L²/2) g about y, the weak axis; von Mises' equivalent with the shear forces; over loads as a batch."""
    height, width, wall, length = 0.2, 0.1, 0.008, 3.0
    inner = (height - 2 * wall) * (width - 2 * wall)
    area = height * width - inner
    inertia = (height * width**3 - (height - 2 * wall) * (width - 2 * wall) ** 3) / 12.0
    loads = np.array([100.0, 200.0])
    found = arm.replace(tip=loads).strength()
    assert [section["beam"] for section in arm.info["sections"]] == ["arm"] * len(arm.info["sections"])
    root = int(np.argmin([section["x"] for section in arm.info["sections"]]))
    x = arm.info["sections"][root]["x"]
    reach, mass = length - x, 7850.0 * area
    moment = 9.81 * (loads * reach + mass * reach**2 / 2.0)
    # The tip sinks by centimetres over a length of metres, which shortens the lever by some 1e-4.
    np.testing.assert_allclose(np.abs(found.normal[:, root]), moment * width / 2.0 / inertia, rtol=1e-3)
    np.testing.assert_allclose(found.utilisation, found.equivalent * 1.5 / 3.55e8, rtol=1e-12)
    von_mises = np.sqrt(found.normal**2 + 3.0 * (np.abs(found.shear) + np.abs(found.torsion)) ** 2)
    np.testing.assert_allclose(found.equivalent, von_mises, rtol=1e-12)
    assert np.isnan(found.tipping_margin).all() and (found.governing_line == -1).all()


def test_inertia_adds_to_weight(arm):
    """What a section carries is linear in the accelerations, and differs from that at rest where these are not zero."""
    q = arm.statics().q
    still = arm.internal_forces(q)
    root = [cut["kind"] for cut in arm.info["cuts"]].index("section")
    a = np.random.default_rng(2).normal(size=arm.n)
    moved = arm.internal_forces(q, np.zeros(arm.n), a)
    twice = arm.internal_forces(q, np.zeros(arm.n), 2.0 * a)
    np.testing.assert_allclose(twice - still, 2.0 * (moved - still), rtol=1e-9, atol=1e-9)
    assert np.abs(moved - still)[root].max() > 1.0


def test_at_rest_nothing_but_weight_acts(arm):
    """A crane released in its equilibrium does not accelerate: with zero rates, stresses are those at rest."""
    q = arm.statics().q
    let_go = arm.strength(q, np.zeros(arm.n))
    np.testing.assert_allclose(let_go.equivalent, arm.strength(q).equivalent, rtol=1e-6)


def test_bad_rows_are_named(arm):
    q = np.stack([arm.statics().q] * 2)
    q[1, 3] = np.nan
    with pytest.raises(ValueError, match=r"row \[1\]"):
        arm.strength(q)
    with pytest.warns(crane.InvalidRowWarning, match=r"row \[1\]"):
        found = arm.strength(q, invalid="nan")
    assert np.isfinite(found.equivalent[0]).all() and np.isnan(found.equivalent[1]).all()


def test_a_load_chart_is_the_balance_of_moments(truck):
    """About each line: load · (distance beyond) = 0.8 · 4001 kg · (distance within), over half a turn."""
    angles, reaches = np.linspace(0.0, np.pi, 7), np.linspace(2.0, 6.0, 5)
    calls = []
    chart = truck.envelope({"column": angles, "arm_x": reaches}, tipping=0.2, progress=lambda done, all: calls.append((done, all)))
    assert chart.load.shape == chart.governing.shape == (7, 5) and chart.q.shape == (7, 5, truck.n)
    assert calls[-1] == (35, 35) and (chart.parameter, chart.unit) == ("payload", "kg")
    angle, reach = np.meshgrid(angles, reaches, indexing="ij")
    x, y = reach * np.cos(angle), reach * np.sin(angle)
    beyond = np.stack([x - 1.5, -x - 1.5, y - 1.0])
    within = np.array([1.5, 1.5, 1.0])[:, None, None]
    with np.errstate(divide="ignore"):
        of_lines = np.where(beyond > 1e-9, 0.8 * 4001.0 * within / beyond, np.inf)
    expected, sides = of_lines.min(axis=0), np.array(["front", "rear", "left"])[of_lines.argmin(axis=0)]
    tips = expected < 1e5
    np.testing.assert_allclose(chart.load[tips], expected[tips], rtol=1e-4)
    assert tips.sum() > 20 and (chart.governing[tips] == "tipping").all()
    assert all(of.count(side) == 2 for of, side in zip(chart.governing_of[tips], sides[tips], strict=True))
    np.testing.assert_allclose(chart.radius, reach, atol=1e-3)


def test_limits_of_a_load_chart(truck, knuckle):
    one = truck.envelope({"arm": [4.0]}, tipping=None, efforts={"column_psi": 1.0}, greatest_load=500.0)
    assert one.load.shape == (1,) and one.load[0] == 500.0 and one.governing[0] == ""
    for wrong, said in [
        ({"ranges": {"arn": [1.0]}}, "no drive and no live parameter `arn`"),
        ({"ranges": {"arm": [1.0], "arm_x": [2.0]}}, "twice"),
        ({"ranges": {"payload": [1.0]}}, "is the load"),
        ({"ranges": {"arm": [np.nan]}}, "finite"),
        ({"ranges": {}}, "poses"),
        ({"ranges": {"arm": [3.0]}, "tipping": 1.5}, "tipping=1.5: write a number from 0 to below 1"),
        ({"ranges": {"arm": [3.0]}, "efforts": {"boom": 1.0}}, "no drive `boom`"),
        ({"ranges": {"arm": [3.0]}, "load": "pay"}, "no live parameter `pay`"),
        ({"ranges": {"arm": [3.0]}, "point": "hok"}, "no point `hok`"),
    ]:
        with pytest.raises(ValueError, match=said):
            truck.envelope(**wrong)
    with pytest.raises(ValueError, match="parameters are arrays"):
        truck.replace(payload=[1.0, 2.0]).envelope({"arm": [3.0]})
    # As in the command: without a support polygon and yield stresses, only the drives limit the load.
    free = knuckle.envelope({"main_boom_theta": [-0.5, 0.0]}, greatest_load=1000.0)
    assert np.isnan(free.tipping_margin).all() and (free.load == 1000.0).all()


LIFTER = """format: 1
name: lifter
parameters: {payload: {value: 200, unit: kg}}
links:
  - {name: post, joint: {prismatic: {axis: x}}, mass: 50, com: [0, 0, 0]}
  - {name: arm, joint: {revolute: {axis: y}}, mass: payload, com: [2, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
drives:
  - {coordinate: post_x, rigid: true, motion: {hold: 0}}
  - {coordinate: arm_theta, rigid: true, motion: {hold: 0}}
cylinders:
  - name: lift
    coordinate: arm_theta
    foot: {link: post, at: [0, 0, -0.8]}
    head: {link: arm, at: [0.6, 0, 0]}
    bore: 0.1
    rod: 0.06
    retracted: 0.85
    stroke: 0.45
    max_pressure: 100e5
"""


def test_cylinders_limit_a_load_chart():
    """p A · lever = m g R cos θ with the law of cosines; beyond the stroke there is no load."""
    arm = crane.load("lifter.yaml", text=LIFTER)
    angles = np.array([-0.6, -0.2, 0.1, 0.5])
    chart = arm.envelope({"arm": angles}, utilisation=None)
    length = np.sqrt(1.0 - 0.96 * np.sin(angles))
    load = 100e5 * np.pi / 4.0 * 0.1**2 * 0.48 / length / (9.81 * 2.0)
    inside = (length >= 0.85) & (length <= 1.3)
    np.testing.assert_allclose(chart.load[inside], load[inside], rtol=2e-6)
    assert inside.sum() == 3 and np.isnan(chart.load[~inside]).all()
    assert chart.governing.tolist() == ["pressure", "pressure", "pressure", "stroke"]
    assert any("100 bar" in words for words in chart.considered)
    free = arm.envelope({"arm": angles}, without=["pressure", "stroke"], greatest_load=1e4, load_factor=1.25)
    assert (free.load == 1e4).all() and any("100 bar" in words for words in free.not_considered)
    for wrong, said in [
        ({"without": ["presure"]}, "no limit `presure`"),
        ({"load_factor": 0.0}, "load_factor=0: write a number above 0"),
        ({"ranges": {"arm": [0.0, 70.0]}}, "np.radians"),
    ]:
        with pytest.raises(ValueError, match=said):
            arm.envelope(**({"ranges": {"arm": [0.0]}} | wrong))


def test_oil_and_a_load_that_changes():
    """The ground of a crane with a valve carries a load across its plane at the time that is given."""
    loads = "loads: [{name: wind, link: arm, at: [1, 0, 0], force: [0, 300, 0], scale: {cubic: {from: 0, to: 1, duration: 2}}}]\n"
    oil = "    bulk_modulus: 1.2e9\n    hose_volumes: [1e-3, 1e-3]\n    valve: {flow: 6e-4, pressure_drop: 1e6, lag: 0.03, gain: 2}\npump: {max_flow: 8e-4, pressure: 9e6}\n"
    arm = crane.load("lifter.yaml", text=LIFTER.replace("rigid: true", "stiffness: 1e8") + oil + loads)
    ground = [cut["kind"] for cut in arm.info["cuts"]].index("ground")
    forces = arm.internal_forces(arm.statics().q, t=[0.0, 1.0, 2.0])[:, ground]
    # Half of the load at half of its time; some roundings of the weight.
    np.testing.assert_allclose(forces[:, 1], [0.0, 150.0, 300.0], atol=1e-9)
    np.testing.assert_allclose(forces[:, 5] - forces[0, 5], forces[:, 1] * np.cos(arm.statics().q[-1]), rtol=1e-9, atol=1e-9)


# A crane without weight whose tip is pulled slowly and let go: `F L/W` at the clamp.
PULLED = """
format: 1
name: pulled
gravity: [0, 0, 0]
parameters: {force: {value: 3000, unit: N}}
links:
  - name: beam
    beam: {length: 2, sections: 2, material: {E: 2.1e11, G: 8.1e10, density: 7850}, section: {box: {height: 0.1, width: 0.1, thickness: 0.005}}, damping: {beta: 1e-3}}
loads: [{name: pull, link: beam, at: [2, 0, 0], force: [0, 0, force], scale: {table: {times: [0, 4, 8], values: [0, 1, 0]}}}]
run: {duration: 8, output: 0.02}
"""


def test_damages_of_runs_add_up():
    """The load changes as slowly as the beam follows: half of the range, four times as often, does half of the damage."""
    c = crane.load("pulled.yaml", text=PULLED)
    whole, half = c.simulate(verify=False), c.replace(force=1500).simulate(verify=False)
    found = crane.fatigue([(whole, 1e5), (half, 4e5)], "80 MPa", safety_factor=1.0)
    size = 3000 * 2 / ((0.1**4 - 0.09**4) / 12 / 0.05)
    endured = 2e6 * (80e6 / size) ** 3
    assert found.beams[found.worst] == "beam" and found.x[found.worst] == 0
    assert found.damage[found.worst] == pytest.approx(1.5e5 / endured, rel=3e-3)
    assert found.parts[found.worst] == pytest.approx([1e5 / endured, 0.5e5 / endured], rel=3e-3)
    assert found.history_parameter[found.worst] == pytest.approx((1e5 + 4e5 / 8) / 2e6, rel=1e-3)
    first, second = found.cycles()[:2]
    assert (first.manoeuvre, second.manoeuvre) == (0, 1) and first.part == pytest.approx(2 / 3, rel=1e-3)
    # The peak comes with the load, but for a vibration.
    assert min(abs(first.start - 4), abs(first.end - 4)) < 0.1
    assert found.histories[1].shape == (len(half.t), len(found.places))
    assert found.largest_range[found.worst] == np.ptp(found.histories[0][:, found.worst])
    alone = crane.fatigue(whole, {"beam": 80e6}, safety_factor=2.0)
    assert alone.life[alone.worst] == pytest.approx(endured / 8, rel=3e-3)


@pytest.mark.parametrize(
    ("manoeuvres", "category", "words"),
    [
        ([], 71e6, "there are no manoeuvres"),
        ("one", 71, "write \"71 MPa\""),
        ("one", {"boom": 71e6}, "beams are beam"),
        ("one", {}, "no category for beam"),
        ("one", "71 kN", "is a force"),
        ("never", 71e6, "repetitions=0"),
    ],
)
def test_fatigue_that_cannot_be_computed(manoeuvres, category, words):
    run = crane.load("pulled.yaml", text=PULLED).simulate(duration=0.1, verify=False)
    given = {"one": [(run, 1)], "never": [(run, 0)]}.get(manoeuvres, manoeuvres) if isinstance(manoeuvres, str) else manoeuvres
    with pytest.raises(ValueError, match=words):
        crane.fatigue(given, category)


def test_what_a_hoist_must_be_able_to_do():
    """100 kg rise by 1.5 m within 4 s at 0.5 m/s, a quarter of the time spent accelerating; results are 1 ms apart, and the force jumps between them."""
    text = "format: 1\nname: hoist\nlinks: [{name: load, joint: {prismatic: {axis: z}}, mass: 100, com: [0, 0, 0]}]\n"
    text += "drives: [{coordinate: load_z, rigid: true, motion: {trapezoid: {from: 0, to: 1.5, duration: 4}}}]\nrun: {duration: 5, output: 0.001}\n"
    duties = crane.load("hoist.yaml", text=text).simulate(verify=False).duties()
    duty = duties.drives["load_z"]
    assert (duty.unit, duty.unit_of_rates, duty.braking_work, duties.cylinders, duties.pump) == ("N", "m/s", 0, {}, None)
    assert [duty.effort, duty.rate, duty.power, duty.work] == pytest.approx([1031, 0.5, 515.5, 1471.5], rel=1e-3)


# A post of a slender tube without weight, 6 m high, with a tenth of Euler's load on its top and a push to the side.
POST = """
format: 1
name: post
analyses: [statics, dynamics]
gravity: [0, 0, 0]
links:
  - name: post
    placement: {transform: {rotation: {y: -90 deg}}}
    beam: {length: 6, sections: 8, material: {E: 2.1e11, G: 8.1e10, density: 100}, section: {tube: {diameter: 0.06, thickness: 0.003}}}
loads: [{name: top, link: post, at: [6, 0, 0], force: [1, 0, FORCE]}]
points: [{name: top, link: post, at: [6, 0, 0]}]
"""


def test_a_column_buckles_and_bends_by_both_orders():
    stiffness = 2.1e11 * np.pi * (0.06**4 - 0.054**4) / 64
    euler = np.pi**2 * stiffness / (4 * 36)
    found = crane.load("post.yaml", text=POST.replace("FORCE", str(-0.1 * euler))).buckling()
    # 8 sections: the error of the factor is below 1 %.
    assert abs(found.linearised / 10 - 1) < 0.01
    assert found.beams == ["post"] and found.places[0].startswith("post")
    first, second = np.linalg.norm(found.displacements[0], axis=-1)
    # F L³/(3 E J); a column gives way as u = k L, 3 (tan u − u)/u³ times as far. At 8 sections the error of the first is 1/(2 · 8²).
    u = 0.5 * np.pi * np.sqrt(0.1)
    assert abs(first / (6**3 / (3 * stiffness)) - 1) < 0.01
    assert abs(second / first / (3 * (np.tan(u) - u) / u**3) - 1) < 2e-3
    # At the foot F L and F L tan(u)/u, half a section above it.
    assert abs(found.moments[0, 1] / found.moments[0, 0] / (np.tan(u) / u) - 1) < 0.02


def test_a_crane_that_does_not_rest_does_not_buckle():
    with pytest.raises(crane.NoEquilibrium):
        crane.load("post.yaml", text=POST.replace("FORCE", "-1e6")).buckling()
