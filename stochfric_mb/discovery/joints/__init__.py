"""Discovery at driven joints, where motion and driving force were measured and friction follows from inverse dynamics.

One direction: sheet (balance of forces in weak form) -> timing -> fits -> selection of effects -> scores on held-out runs
(inverse dynamics, the closed loop simulated again) -> verdict.
"""

from stochfric_mb.discovery.joints.discover import discover_joint, joint_outcome
from stochfric_mb.discovery.joints.outcome import JointOutcome, PlaceOutcome

__all__ = ["JointOutcome", "PlaceOutcome", "discover_joint", "joint_outcome"]
