"""MuJoCo: friction as an engine plugin, for any pair of geoms of any model.

Importing this package registers the plugin, so that models that name it can be loaded::

    spec = mujoco.MjSpec.from_file("scene.xml")
    add_friction(spec, ("box", "belt"), ElasticStick(mu_s=0.8, mu_k=0.46))
    model = spec.compile()
"""

from stochfric_mb.mujoco.attach import add_friction, readings
from stochfric_mb.mujoco.callback import ContactWarning, friction
from stochfric_mb.mujoco.joints import Joint, Tendon
from stochfric_mb.mujoco.options import IntegratorWarning
from stochfric_mb.mujoco.plugin import register
from stochfric_mb.mujoco.reading import Reading
from stochfric_mb.mujoco.sensing import add_sensor, register_sensors
from stochfric_mb.mujoco.states import set_friction, state_index, untouched

__all__ = [
    "ContactWarning",
    "IntegratorWarning",
    "Joint",
    "Reading",
    "Tendon",
    "add_friction",
    "add_sensor",
    "friction",
    "readings",
    "register",
    "set_friction",
    "state_index",
    "untouched",
]

register()
register_sensors()
