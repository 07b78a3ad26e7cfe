"""A slider-crank in Exudyn that friction in its joints brings to rest: in the main bearing and in the slider's guide.

Both normal forces are the joints' own reactions, so that they follow the motion; the coefficients are random.
"""

import exudyn
import numpy as np
from exudyn.itemInterface import (
    MarkerBodyPosition,
    MarkerBodyRigid,
    NodeRigidBody2D,
    ObjectGround,
    PrismaticJoint2D,
    RevoluteJoint2D,
    RigidBody2D,
)

from stochfric_mb.coefficients import Matern
from stochfric_mb.exudyn import add_joint_friction, silent_settings, solve_dynamic
from stochfric_mb.friction import Friction
from stochfric_mb.laws import make_law

CRANK, ROD = 0.1, 0.3  # lengths [m]
MASSES = {"crank": (2.0, 0.02), "rod": (0.5, 4e-3), "slider": (0.4, 1e-3)}  # kg, kg m^2
SPIN = 60.0  # rad/s
RADIUS = 0.03  # of the main bearing [m]
LAW = make_law("elastic_stick", mu_s=0.3, mu_k=0.2, e_lim=1e-5, v_s=1e-3, decay_velocity=1e-2)
PROCESS = Matern(sigma_s=0.02, sigma_k=0.02, correlation_time=0.05)


def add_body(mbs, name: str, place, velocity, spin: float):
    mass, inertia = MASSES[name]
    node = mbs.AddNode(NodeRigidBody2D(referenceCoordinates=[*place, 0.0], initialVelocities=[*velocity, spin]))
    return mbs.AddObject(RigidBody2D(nodeNumber=node, mass=mass, inertia=inertia, name=name))


def build(*, seed: int = 0):
    """The mechanism, its crank up, and the contacts in bearing and guide."""
    mbs = exudyn.SystemContainer().AddSystem()
    ground = mbs.AddObject(ObjectGround())
    tip, reach = SPIN * CRANK, np.sqrt(ROD**2 - CRANK**2)
    crank = add_body(mbs, "crank", (0.0, 0.5 * CRANK), (-0.5 * tip, 0.0), SPIN)
    slope = -np.arcsin(CRANK / ROD)
    mass, inertia = MASSES["rod"]
    node = NodeRigidBody2D(referenceCoordinates=[0.5 * reach, 0.5 * CRANK, slope], initialVelocities=[-tip, 0.0, 0.0])
    rod = mbs.AddObject(RigidBody2D(nodeNumber=mbs.AddNode(node), mass=mass, inertia=inertia, name="rod"))
    slider = add_body(mbs, "slider", (reach, 0.0), (-tip, 0.0), 0.0)

    def at(body, x: float = 0.0, y: float = 0.0):
        return mbs.AddMarker(MarkerBodyPosition(bodyNumber=body, localPosition=[x, y, 0.0]))

    bearing = mbs.AddObject(RevoluteJoint2D(markerNumbers=[at(ground), at(crank, 0.0, -0.5 * CRANK)]))
    mbs.AddObject(RevoluteJoint2D(markerNumbers=[at(crank, 0.0, 0.5 * CRANK), at(rod, -0.5 * ROD)]))
    mbs.AddObject(RevoluteJoint2D(markerNumbers=[at(rod, 0.5 * ROD), at(slider)]))
    rails = [mbs.AddMarker(MarkerBodyRigid(bodyNumber=b)) for b in (ground, slider)]
    guide = mbs.AddObject(PrismaticJoint2D(markerNumbers=rails, axisMarker0=[1, 0, 0], normalMarker1=[0, 1, 0]))
    friction = Friction(LAW, PROCESS)
    bearing_mass = (MASSES["crank"][1] + MASSES["crank"][0] * (0.5 * CRANK) ** 2) / RADIUS**2
    contacts = [
        add_joint_friction(mbs, bearing, friction, radius=RADIUS, effective_mass=bearing_mass, seed=seed, contact=0),
        add_joint_friction(mbs, guide, friction, effective_mass=MASSES["slider"][0], seed=seed, contact=1),
    ]
    mbs.Assemble()
    return mbs, contacts


def kinetic_energy(mbs) -> float:
    v = mbs.systemData.GetODE2Coordinates_t().reshape(-1, 3)
    pairs = zip(MASSES.values(), v, strict=True)
    return sum(0.5 * m * (vx**2 + vy**2) + 0.5 * i * w**2 for (m, i), (vx, vy, w) in pairs)


def run(*, seed: int = 0, duration: float = 0.5, dt: float = 1e-4):
    """Energy at the end [J], and the recorded rows of both contacts."""
    mbs, contacts = build(seed=seed)
    times = dt * np.arange(round(duration / dt) + 1)
    rows = [contact.record(times) for contact in contacts]
    solve_dynamic(mbs, silent_settings(dt, duration), solver="generalized_alpha")
    return kinetic_energy(mbs), rows


def main() -> None:
    for seed in range(3):
        energy, (bearing, guide) = run(seed=seed)
        works = [np.trapezoid(r[:, 3] * r[:, 2], r[:, 0]) for r in (bearing, guide)]
        print(f"seed {seed}: {energy:.3f} J left; the bearing took {works[0]:.3f} J, the guide {works[1]:.3f} J")


if __name__ == "__main__":
    main()
