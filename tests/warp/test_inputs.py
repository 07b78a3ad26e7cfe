"""What cannot work is refused before the first step, with one clear error."""

import mujoco
import pytest

from stochfric_mb import Coulomb, Friction, Knots
from stochfric_mb.errors import InputError
from stochfric_mb.laws import make_law
from stochfric_mb.warp import add_friction
from tests.warp.scenes import box_on_plane, on_device

LAW = Coulomb(0.8, 0.46)


@pytest.fixture(scope="module")
def scene():
    return box_on_plane(nworld=2)


def test_pyramidal_cones(scene):
    model = mujoco.MjModel.from_xml_string("<mujoco><worldbody/></mujoco>")
    m, d = on_device(model, 1)
    with pytest.raises(InputError, match=r"mjCONE_ELLIPTIC.*before put_model"):
        add_friction(model, m, d, ("a", "b"), LAW)


@pytest.mark.parametrize("integrator", ["RK4", "discrete"])
def test_integrators_with_other_stages(integrator):
    text = f'<mujoco><option cone="elliptic" integrator="{integrator}"/><worldbody/></mujoco>'
    model = mujoco.MjModel.from_xml_string(text)
    m, d = on_device(model, 1)
    with pytest.raises(InputError, match="use one of Euler, implicitfast, implicit"):
        add_friction(model, m, d, ("a", "b"), LAW)


def test_unknown_geoms(scene):
    with pytest.raises(InputError, match="unknown geom 'bix'; did you mean 'box'"):
        add_friction(*scene, ("bix", "floor"), LAW)
    with pytest.raises(InputError, match="is not a pair"):
        add_friction(*scene, "box", LAW)
    with pytest.raises(InputError, match="name both"):
        add_friction(*scene, ("*", "*"), LAW)


def test_contacts_without_friction():
    scene = box_on_plane(nworld=1, condim=1)
    with pytest.raises(InputError, match="condim 1: no friction that a law could steer; set condim to 3"):
        add_friction(*scene, ("box", "floor"), LAW)


def test_geoms_that_never_touch():
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><option cone="elliptic"/><worldbody><geom name="floor" type="plane" size="1 1 1"/>'
        '<body><freejoint/><geom name="ghost" size=".1" contype="0" conaffinity="0"/></body></worldbody></mujoco>'
    )
    m, d = on_device(model, 1)
    with pytest.raises(InputError, match="can never touch; check contype"):
        add_friction(model, m, d, ("ghost", "floor"), LAW)


@pytest.mark.parametrize("kind", ["lugre", "dahl"])
def test_laws_that_are_no_caps(scene, kind):
    with pytest.raises(InputError, match=rf"law {kind} is a bristle.* use .*elastic_stick"):
        add_friction(*scene, ("box", "floor"), make_law(kind, mu_s=0.8, mu_k=0.46))


def test_addresses_and_slots(scene):
    with pytest.raises(InputError, match=r"seed = -1 is not an integer in \[0, 2\^32\)"):
        add_friction(*scene, ("box", "floor"), LAW, seed=-1)
    with pytest.raises(InputError, match="sample = 4294967296"):
        add_friction(*scene, ("box", "floor"), LAW, first_sample=2**32 - 1)
    with pytest.raises(InputError, match="whole number from 1 on"):
        add_friction(*scene, ("box", "floor"), LAW, slots=0)
    with pytest.raises(InputError, match="4 contacts in one world, but slots = 3"):
        add_friction(*scene, ("box", "floor"), LAW, slots=3)


def test_another_model(scene):
    _, m, d = scene
    other = mujoco.MjModel.from_xml_string('<mujoco><worldbody><geom size="1"/></worldbody></mujoco>')
    with pytest.raises(InputError, match="give the model that put_model was called with"):
        add_friction(other, m, d, ("box", "floor"), LAW)


def test_a_law_of_another_type(scene):
    with pytest.raises(InputError, match="neither a law nor a Friction"):
        add_friction(*scene, ("box", "floor"), "coulomb")  # pyright: ignore[reportArgumentType]
    with pytest.raises(InputError, match="joint standard deviations apart"):
        add_friction(*scene, ("box", "floor"), Friction(Coulomb(0.5, 0.5), Knots(sigma_s=0.1, sigma_k=0.1, spacing=0.1)))
