"""The friction element as an FMU: it is the in-process law, and it takes steps back."""

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

from stochfric_mb.contact import PlaneContact
from stochfric_mb.export.exported import Exported
from stochfric_mb.friction import Friction
from stochfric_mb.laws import LAWS, make_law

from .fmus import Driven, built, table_1, table_1_fmu

SAME = 1.0e-12
"""As the same operations in the same libm they are equal; a master's own arithmetic may cost some roundings."""
H = 1.0e-3


def motion(rng, n):
    """Return displacement, velocity, normal force and holding force at n instants of a contact that slides, turns, creeps."""
    v = 2.0e-3 * np.cumsum(rng.standard_normal((n, 2)), axis=0) / np.sqrt(n) + [1.0e-3, 0.0]
    v[n // 4 : n // 2] *= 0.01  # slow enough to stick
    u = H * np.cumsum(v, axis=0)
    normal = 13.0 * (1.0 + 0.2 * np.sin(0.05 * np.arange(n)))
    return u, v, normal, 8.0 * rng.standard_normal((n, 2))


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("mechanism", [False, True], ids=["element", "belt_box"])
def test_validation_finds_nothing(fmi, mechanism):
    assert validate_fmu(str(table_1_fmu(fmi=fmi, mechanism=mechanism))) == []


@pytest.mark.parametrize("kind", [k for k in LAWS if k != "augmented"])
@pytest.mark.parametrize("fmi", [2, 3])
def test_it_is_the_law_of_this_process(rng, kind, fmi):
    law = make_law(kind, mu_s=0.8, mu_k=0.46)
    process = table_1().process
    fmu = Driven(built(Exported(law, process), fmi, False), start=False)
    contact = PlaneContact(Friction(law, process), effective_mass=6.08, seed=7, sample=2, contact=5)
    inputs = motion(rng, 400)
    u, v, normal, hold = (x[0].tolist() for x in inputs)
    fmu.begin(
        seed=7, sample=2, contact=5, relative_displacement=tuple(u), relative_velocity=tuple(v), normal_force=normal,
        holding_force=tuple(hold), effective_mass=6.08,
    )  # fmt: skip
    contact.start(0.0, u, v, normal, hold=hold)
    forces = []
    for i in range(1, 400):
        u, v, normal, hold = (x[i].tolist() for x in inputs)
        fmu.step(H, relative_displacement=tuple(u), relative_velocity=tuple(v), normal_force=normal, holding_force=tuple(hold))
        contact.commit(fmu.t, u, v, normal, hold=hold)
        force = contact.force(fmu.t, u, v, normal, hold=hold)
        ours = fmu.get("friction_force[1]"), fmu.get("friction_force[2]")
        np.testing.assert_allclose(ours, force, rtol=SAME, atol=SAME * 13.0)
        assert (fmu.get("mu_s"), fmu.get("mu_k")) == (contact.mu_s, contact.mu_k)
        assert bool(fmu.get("stick")) == contact.stick
        forces.append(force)
    assert np.ptp(np.array(forces)[:, 0]) > 1.0
    fmu.end()


@pytest.mark.parametrize("fmi", [2, 3])
def test_steps_taken_back_leave_no_trace(fmi):
    """1000 random savings, detours and restorings, half of them through bytes: the outputs are those of the straight run."""
    rng = np.random.default_rng(5)
    path, n = table_1_fmu(fmi=fmi), 1000
    u, v, normal, hold = motion(rng, n)

    def inputs(i):
        return {
            "relative_displacement": tuple(u[i].tolist()), "relative_velocity": tuple(v[i].tolist()), "normal_force": normal[i],
            "holding_force": tuple(hold[i].tolist()), "effective_mass": 6.08,
        }  # fmt: skip

    straight, bent = Driven(path, seed=3, **inputs(0)), Driven(path, seed=3, **inputs(0))
    for i in range(n):
        saved = bent.save()
        for _ in range(rng.integers(1, 4)):
            bent.step(H * rng.uniform(0.1, 3.0), **inputs(rng.integers(n)))
        if i % 2:
            data = bent.bytes_of(saved)
            bent.forget(saved)
            saved = bent.from_bytes(data, saved[1])
        bent.restore(saved)
        bent.forget(saved)
        straight.step(H, **inputs(i))
        bent.step(H, **inputs(i))
        names = ("friction_force[1]", "friction_force[2]", "mu_s", "mu_k", "stick")
        assert [bent.get(x) for x in names] == [straight.get(x) for x in names]
    straight.end()
    bent.end()


def test_a_thousand_instances_share_nothing(rng):
    """Instances with seeds of their own, stepped in turn, give what each gives alone."""
    path = table_1_fmu()
    u, v, normal, _ = motion(rng, 12)
    first = Driven(path, seed=0, normal_force=13.0, effective_mass=6.08)
    made = [first] + [Driven(path, seed=k, normal_force=13.0, effective_mass=6.08) for k in range(1, 1000)]
    got = np.empty((len(made), 12))
    for i in range(12):
        for k, fmu in enumerate(made):
            fmu.step(
                0.005, relative_displacement=tuple(u[i]), relative_velocity=tuple(v[i] + [0.01, 0.0]), normal_force=normal[i]
            )
            got[k, i] = fmu.get("friction_force[1]")
    for fmu in made:
        fmu.end()
    for k in rng.choice(1000, 20, replace=False).tolist():
        alone = Driven(path, seed=k, normal_force=13.0, effective_mass=6.08)
        for i in range(12):
            alone.step(
                0.005, relative_displacement=tuple(u[i]), relative_velocity=tuple(v[i] + [0.01, 0.0]), normal_force=normal[i]
            )
            assert alone.get("friction_force[1]") == got[k, i]
        alone.end()
    assert len(np.unique(got[:, -1])) == 1000


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ({"normal_force": -1.0}, "normal force is negative"),
        ({"effective_mass": -1.0}, "effective mass is negative"),
        ({"relative_velocity[1]": float("nan")}, "not finite"),
        ({"relative_displacement[2]": float("inf")}, "not finite"),
    ],
)
def test_bad_input_is_an_error_status_with_a_message(fmi, inputs, message):
    fmu = Driven(table_1_fmu(fmi=fmi), normal_force=13.0)
    before = fmu.get("friction_force[1]")
    with pytest.raises(FMICallException):
        fmu.step(H, **inputs)
    assert message in fmu.log[-1]
    fmu.set("normal_force", 13.0)
    fmu.set("effective_mass", 6.08)
    fmu.step(H)  # it goes on from where it was
    assert fmu.get("friction_force[1]") == before
    fmu.end()


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"law__mu_k": 0.9}, "mu_k <= mu_s"),
        ({"law__v_s": 0.0}, "law: v_s"),
        ({"coefficients__spacing": -1.0}, "spacing"),
        ({"coefficients__sigma_s": 2.0}, "standard deviation"),
    ],
)
def test_parameters_that_break_a_rule_stop_the_start(fmi, parameters, message):
    fmu = Driven(table_1_fmu(fmi=fmi), start=False)
    with pytest.raises(FMICallException):
        fmu.begin(**parameters)
    assert message in fmu.log[-1]


def test_parameters_take_effect():
    fmu = Driven(table_1_fmu(), law__mu_s=0.7, law__mu_k=0.3, coefficients__sigma_s=0.0, coefficients__sigma_k=0.0)
    fmu.step(H, relative_velocity=(1.0, 0.0), normal_force=10.0, effective_mass=6.08)
    assert fmu.get("friction_force[1]") == pytest.approx(3.0, rel=1e-12)  # sliding fast: mu_k N
    assert fmu.get("mu") == pytest.approx(0.3, rel=1e-12)
    fmu.end()


def test_another_description_is_refused():
    path = table_1_fmu()
    fmu = Driven.__new__(Driven)
    fmu.log = []
    with pytest.raises(Exception, match="instantiate"):
        Driven.__init__(fmu, path, start=False, token="not mine")
    assert "export the FMU again" in fmu.log[-1]
