"""What friction a MuJoCo model really has, probed site by site, and what this package's does in its place."""

from stochfric_mb.mujoco.check.run import check

__all__ = ["check"]
