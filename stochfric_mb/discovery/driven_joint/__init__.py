"""Discovery at driven joints, where motion and driving force were measured and friction follows from inverse dynamics.

One direction: force balance (in weak form) -> timing -> fits -> selection of effects -> scores on held-out runs
(inverse dynamics, the closed loop simulated again) -> verdict.
"""

from stochfric_mb.discovery.driven_joint.joint_result import JointOutcome, PlaceOutcome
from stochfric_mb.discovery.driven_joint.joint_workflow import joint_outcome

__all__ = ["JointOutcome", "PlaceOutcome", "joint_outcome"]
