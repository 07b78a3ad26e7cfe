"""MuJoCo: friction as an engine plugin, for any pair of geoms of any model.

Importing this package registers the plugin, so that models that name it can be loaded.
"""

from stochfric_mb.mujoco.plugin import register

register()
