"""A crane learns to slew without swinging its load: augmented random search for a linear policy, in NumPy alone.

    python examples/python/slewing.py              # some 5 s on two cores
    python examples/python/slewing.py --rounds 3   # a second

The policy is a matrix: the rate at which the column slews, from the angles and rates of the column and of the load. A plain drive, with which it
is compared, slews along a smooth ramp that ends after as many seconds as the learnt policy needs, or along a proportional controller.
H. Mania, A. Guy, B. Recht, Simple random search of static linear policies is competitive for reinforcement learning, NeurIPS 2018.
"""

import argparse

import crane
import numpy as np
from crane.gym import CraneVectorEnv, reach

SPEC = """
format: 1
name: slewing_crane
title: Slewing crane whose load hangs from a cardan joint
inputs: {slew: {unit: rad, about: where the column shall be}}
parameters: {load_mass: {value: 800, unit: kg}}
links:
  - name: column
    joint: revolute
    mass: 900
    com: [0, 0, 1.5]
    inertia: {Ixx: 700, Iyy: 700, Izz: 90}
  - name: boom
    placement: {transform: {translation: [0, 0, 3]}}
    mass: 600
    com: [3, 0, 0]
    inertia: {Ixx: 20, Iyy: 1900, Izz: 1900}
  - name: pin                     # swings in the boom's plane
    placement: {transform: {translation: [6, 0, 0]}}
    joint: {revolute: {axis: y}}
    mass: 10
    com: [0, 0, -0.1]
    inertia: {gyration: [0.1, 0.1, 0.1]}
  - name: load                    # and across it
    joint: {revolute: {axis: x}}
    mass: load_mass
    com: [0, 0, -3]
    inertia: {gyration: [0.5, 0.5, 0.5]}
drives:
  - {coordinate: column_psi, stiffness: 3e6, damping: 2e5, motion: {input: slew}}
damping: {pin_theta: 40, load_phi: 40}
points:
  - {name: load, link: load, at: [0, 0, -3]}
run: {duration: 12, output: 0.05}
"""
RATE = 0.5  # greatest rate of the column, rad/s
OBSERVED = ["missing", "column_psi_rate", "pin_theta", "pin_theta_rate", "load_phi", "load_phi_rate"]


def environment(count, duration=12.0):
    """Cranes that shall slew by up to 90 degrees to either side, with loads of 200 to 1500 kg."""
    return CraneVectorEnv(
        crane.load("slewing_crane", text=SPEC),
        count,
        actions={"slew": (-RATE, RATE)},
        rates=True,
        observations=["column_psi", "column_psi_target", "column_psi_rate", "pin_theta", "pin_theta_rate", "load_phi", "load_phi_rate"],
        targets={"column_psi": (-np.pi / 2, np.pi / 2)},
        bands={"load_mass": (200.0, 1500.0)},
        reward=reach("column_psi", swing={"load_phi": 0.2, "load_phi_rate": 0.4}),
        dt=0.1,
        duration=duration,
    )


def features(observed):
    """What the policy sees: how far the column is from its target, its rate, and angles and rates of the load."""
    return np.column_stack([observed[:, 1] - observed[:, 0], observed[:, 2:]])


def episodes(env, act, seed):
    """Sum of rewards of an episode in each crane, and the greatest angle between load and vertical in its last 3 s, degrees."""
    observed, _ = env.reset(seed=seed)
    total, swing = np.zeros(env.num_envs), np.zeros(env.num_envs)
    steps = round(12.0 / 0.1)
    for step in range(steps):
        observed, rewards, *_ = env.step(act(features(observed), step * 0.1)[:, None])
        total += rewards
        if step >= steps - 30:
            swing = np.maximum(swing, np.degrees(np.hypot(observed[:, 3], observed[:, 5])))
    return total, swing


def train(rounds, directions=16, step=0.3, noise=0.15, seed=0):
    """Augmented random search: the policy moves along random directions, weighted by the difference of rewards on both sides of each."""
    random = np.random.default_rng(seed)
    env = environment(2 * directions)
    policy = np.zeros(len(OBSERVED))
    policy[0] = 1.0  # towards the target
    for each in range(rounds):
        moves = random.standard_normal((directions, len(policy)))
        both = np.concatenate([policy + noise * moves, policy - noise * moves])
        # Both sides of a direction have the same targets and loads.
        seeds = np.tile(random.integers(1 << 31, size=directions), 2).tolist()
        total, _ = episodes(env, lambda seen, _, both=both: np.sum(both * seen, axis=1), seeds)
        up, down = total[:directions], total[directions:]
        best = np.argsort(-np.maximum(up, down))[: directions // 2]
        scale = np.concatenate([up[best], down[best]]).std() + 1e-9
        policy = policy + step * ((up - down)[best] @ moves[best]) / (len(best) * scale)
        print(f"round {each + 1}: mean reward {total.mean():8.2f}")
    return policy


def compare(policy, count=32, seed=12_345):
    """Mean reward and mean residual swing of the learnt policy, the untrained one and a plain drive, in the same episodes."""
    env = environment(count)

    def plain(seen, t, duration=5.0):
        # The rate of a smooth ramp, 30 τ² (1 − τ)² of the way per duration; the way is known from the first observation.
        if t == 0.0:
            plain.way = seen[:, 0].copy()
        tau = min((t + 0.05) / duration, 1.0)
        return plain.way / duration * 30.0 * (tau * (1.0 - tau)) ** 2 / RATE

    untrained = np.zeros(len(OBSERVED))
    untrained[0] = 1.0
    drives = {"plain drive": plain, "untrained": lambda seen, _: seen @ untrained, "learnt": lambda seen, _: seen @ policy}
    return {name: tuple(float(of.mean()) for of in episodes(env, act, seed)) for name, act in drives.items()}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=60)
    learnt = train(parser.parse_args().rounds)
    print("policy:", dict(zip(OBSERVED, learnt.round(3).tolist(), strict=True)))
    for name, (total, swing) in compare(learnt).items():
        print(f"{name:12} reward {total:8.2f}, swing in the last 3 s {swing:6.2f} deg")
