"""Brake squeal in Exudyn: two modes of a pad couple through friction and grow above a critical coefficient.

A pad of mass m moves along a disc (x) and away from it (y). Its mount has the stiffness [[k_x, k_c], [k_c, k_y]]; the disc
presses it with k_n and drags it with mu N. Linear and without damping, the modes meet, and one of them grows, where

    mu k_n abs(k_c) > ((k_x - k_y - k_n)/2)^2 + k_c^2        (mode coupling, N. Hoffmann et al., J. Sound Vib. 2002)

Random coefficients make the squeal come and go.
"""

import exudyn
import numpy as np
from exudyn.itemInterface import MarkerBodyPosition, MarkerNodePosition, NodePoint2D, ObjectGenericODE2, ObjectGround

from stochfric_mb.coefficients import Matern
from stochfric_mb.exudyn import add_friction, silent_settings, solve_dynamic
from stochfric_mb.friction import Friction
from stochfric_mb.laws import make_law

MASS, K_X, K_Y, K_C, K_N = 1.0, 1.2e6, 0.4e6, -0.3e6, 1.0e6
PRESS = 1000.0  # N
DISC = 5.0  # m/s
DT, STEPS = 2e-5, 10_000


def critical_coefficient() -> float:
    return ((0.5 * (K_X - K_Y - K_N)) ** 2 + K_C**2) / (K_N * abs(K_C))


def predicted_growth(mu: float) -> float:
    """Rate [1/s] at which the linear system grows."""
    squares = np.linalg.eigvals(np.array([[K_X, K_C + mu * K_N], [K_C, K_Y + K_N]]) / MASS)
    return float(np.max(np.sqrt(-squares.astype(complex)).real))


def vibration(mu: float, *, sigma: float = 0.0, seed: int = 0, push: float = 1e-8) -> np.ndarray:
    """Distance of the pad from the disc [m] about its rest, after a push, every 10 steps."""
    mbs = exudyn.SystemContainer().AddSystem()
    disc = mbs.AddMarker(MarkerBodyPosition(bodyNumber=mbs.AddObject(ObjectGround())))
    stiffness = np.array([[K_X, K_C], [K_C, K_Y]])
    # where mount, disc and mean friction balance: the mount is set so that the disc presses with PRESS
    rest = np.array([0.0, -PRESS / K_N])
    force = stiffness @ rest - np.array([mu * PRESS, PRESS])
    node = mbs.AddNode(NodePoint2D(initialCoordinates=[rest[0], rest[1] + push]))
    mbs.AddObject(
        ObjectGenericODE2(nodeNumbers=[node], massMatrix=MASS * np.eye(2), stiffnessMatrix=stiffness, forceVector=force)
    )
    pad = mbs.AddMarker(MarkerNodePosition(nodeNumber=node))
    law = make_law("tanh", mu_s=2.0 * mu, mu_k=mu, v_s=0.05)  # the disc is fast: it always slides
    process = Matern(sigma_s=sigma, sigma_k=sigma, correlation_time=0.02) if sigma else None
    contact = add_friction(
        mbs,
        disc,
        pad,
        Friction(law, process),
        normal=(0.0, 1.0, 0.0),
        contact_stiffness=K_N,
        surface_velocity=(DISC, 0.0, 0.0),
        effective_mass=MASS,
        seed=seed,
    )
    mbs.Assemble()
    rows = contact.record(10 * DT * np.arange(STEPS // 10 + 1))
    solve_dynamic(mbs, silent_settings(DT, STEPS * DT))
    return (PRESS - rows[:, 7]) / K_N


def growth(y: np.ndarray) -> float:
    """Rate [1/s] at which the vibration grew, from its first to its last tenth."""
    n = len(y) // 10
    return float(np.log(np.ptp(y[-n:]) / np.ptp(y[:n])) / (0.9 * STEPS * DT))


def main() -> None:
    mu = critical_coefficient()
    print(f"critical coefficient {mu:.3f}")
    for factor in (0.8, 0.95, 1.05, 1.2):
        y = vibration(factor * mu)
        print(f"mu = {factor * mu:.3f}: grows at {growth(y):7.2f} /s, predicted {predicted_growth(factor * mu):.2f} /s")
    for seed in range(3):
        y = vibration(0.97 * mu, sigma=0.1 * mu, seed=seed)
        print(f"mu = {0.97 * mu:.3f} +- 10 %, seed {seed}: grows at {growth(y):7.2f} /s")


if __name__ == "__main__":
    main()
