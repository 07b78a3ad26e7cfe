"""MuJoCo: friction as an engine plugin, for any pair of geoms, joint or tendon of any model.

Importing this package registers the plugins, so that models that name them can be loaded::

    spec = mujoco.MjSpec.from_file("scene.xml")
    add_friction(spec, ("box", "belt"), ElasticStick(mu_s=0.8, mu_k=0.46))
    model = spec.compile()

Rooms: ``memory`` (the structs of MuJoCo and ours, for compiled code), ``plugin`` (what MuJoCo calls), ``contact`` and
``joint`` (the friction itself), ``check`` (what friction a model really has).
"""

from stochfric_mb.mujoco.anisotropy import Anisotropy
from stochfric_mb.mujoco.attach import ConeWarning, add_friction
from stochfric_mb.mujoco.callback import friction
from stochfric_mb.mujoco.joints import Joint, Tendon
from stochfric_mb.mujoco.pairs import ContactWarning
from stochfric_mb.mujoco.plugin.configuration import PluginWarning
from stochfric_mb.mujoco.plugin.options import IntegratorWarning
from stochfric_mb.mujoco.plugin.sensor import add_sensor, register
from stochfric_mb.mujoco.reading import Reading, readings
from stochfric_mb.mujoco.states import set_friction, state_index, untouched

__all__ = [
    "Anisotropy",
    "ConeWarning",
    "ContactWarning",
    "IntegratorWarning",
    "Joint",
    "PluginWarning",
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
