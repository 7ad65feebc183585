"""A load on a rope is slewed by 60° and comes to rest: LQR on a linear model of the crane, whose state a Kalman filter estimates from an encoder
at the column and a camera that sees the rope. The crane that is controlled is the nonlinear one.

    python lqr_observer.py
"""

import sys
from pathlib import Path

import numpy as np
import scipy.linalg

import crane

INTERVAL = 0.02  # s between two commands
GOAL = np.radians(60)
NOISE = np.radians([0.02, 0.3])  # standard deviations of encoder and camera, rad
MOVE = 10.0  # s from start to goal: quick slewing would swing the load outwards, where slewing cannot stop it
DISTURBANCE = 30.0  # standard deviation of torques that the model does not know, N m
SEEN = ["column_psi", "tangential_phi"]


def main(duration: float) -> float:
    """Runs it; returns the largest distance of the load from its goal in the last two seconds, m."""
    slewing = crane.load(Path(__file__).with_name("slewing_crane.yaml"))
    n, limit = slewing.n, 8000.0
    at_goal = np.zeros(n)
    at_goal[0] = GOAL
    # The radial swing is not controllable by slewing about this pose, and not seen: the model of the controller leaves it out.
    model = slewing.state_space(at_goal, inputs=["torque"], outputs=SEEN)
    kept = [place for place, name in enumerate(model.states) if not name.startswith("radial")]
    A, B, C = model.A[np.ix_(kept, kept)], model.B[kept], model.C[:, kept]
    A, B = sampled(A, B)

    # Bryson's rule: 2°, 3° and their rates at a natural pace against the full torque.
    weights = np.diag(np.radians([2, 3, 6, 6]) ** -2.0)
    riccati = scipy.linalg.solve_discrete_are(A, B, weights, [[limit**-2]])
    gain = np.linalg.solve(B.T @ riccati @ B + limit**-2, B.T @ riccati @ A)
    process = DISTURBANCE**2 * B @ B.T + np.diag([1e-12] * 4)
    covariance = scipy.linalg.solve_discrete_are(A.T, C.T, process, np.diag(NOISE**2))
    filtering = np.linalg.solve(C @ covariance @ C.T + np.diag(NOISE**2), C @ covariance).T

    generator = np.random.default_rng(1)
    simulation = slewing.simulation(q=np.zeros(n))
    estimate = np.array([-GOAL, 0.0, 0.0, 0.0])  # deviations from the goal
    hook, goal = [], slewing.points(at_goal)[0]
    column, swing = (slewing.coordinates.index(name) for name in SEEN)
    for step in range(round(duration / INTERVAL)):
        measured = np.array([simulation.q[column] - GOAL, simulation.q[swing]]) + NOISE * generator.normal(size=2)
        estimate += filtering @ (measured - C @ estimate)
        angle, rate = reference(step * INTERVAL)
        torque = float(np.clip(-(gain @ (estimate - [angle - GOAL, 0, rate, 0]))[0], -limit, limit))
        simulation.step(INTERVAL, inputs={"torque": torque + DISTURBANCE * generator.normal()})
        estimate = A @ estimate + B[:, 0] * torque
        hook.append(slewing.points(simulation.q)[0])
    off = np.linalg.norm(np.array(hook) - goal, axis=-1)
    last = off[-round(2 / INTERVAL) :].max()
    print(f"after {duration:g} s: column {np.degrees(simulation.q[column]):.2f}°, load at most {last:.3f} m from its goal in the last 2 s")
    print(f"{simulation.statistics['evaluations']} evaluations of accelerations")
    return last


def reference(t):
    """Angle and rate of the column that the controller aims at: a polynomial of order five."""
    x = min(t / MOVE, 1.0)
    return GOAL * x**3 * (10 - 15 * x + 6 * x**2), GOAL / MOVE * 30 * (x * (1 - x)) ** 2


def sampled(A, B):
    """A and B with the input constant over an interval."""
    states, inputs = B.shape
    whole = np.zeros((states + inputs, states + inputs))
    whole[:states, :states], whole[:states, states:] = A, B
    whole = scipy.linalg.expm(INTERVAL * whole)
    return whole[:states, :states], whole[:states, states:]


if __name__ == "__main__":
    sys.exit(0 if main(20.0) < 0.15 else "the load does not come to rest at its goal")
