"""What scatter is called: kicks, independent draws, a wander, or nothing that has a name."""

from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.decision import Finding
from stochfric_mb.discovery.stick_slip.decision.random_effects import kicks, random_effects
from stochfric_mb.discovery.stick_slip.screening.switching import Switching
from stochfric_mb.discovery.stick_slip.screening.variance_components import Randomness

N, RUNS = 40, 2
STATIC, KINETIC = 8.0, 5.0
CALM = Switching(separation=3.0, changes=10.0, regular=False, rarer=10, jumps=0, still=1.0)


def sensor(deviation: float, coloured: float = 0.0) -> SimpleNamespace:
    return SimpleNamespace(deviation=deviation, coloured=coloured)


def study(onset: np.ndarray, in_slip: np.ndarray | float = 0.0, jumps: int = 0) -> SimpleNamespace:
    """Slips whose onset force and mean force [N] are off, with a little noise; as much of a study as chance needs."""
    generator = np.random.default_rng(1)
    features = np.zeros((N * RUNS, 8))
    features[:, :2] = np.array([STATIC, KINETIC]) + 0.01 * generator.standard_normal((N * RUNS, 2))
    features[:, 0] += onset
    features[:, 1] += in_slip
    times = np.tile(1.1 * np.arange(N), RUNS)
    pool = SimpleNamespace(
        features=features,
        run=np.repeat(np.arange(RUNS), N),
        n_runs=RUNS,
        static=np.full(N * RUNS, STATIC),
        kinetic=np.full(N * RUNS, KINETIC),
        slips=[SimpleNamespace(onset_time=1.1 * np.arange(N), noise=sensor(5.0e-6))] * RUNS,
        onset_time=times,
        restick_time=times + 0.1,
        normal_force=np.full(N * RUNS, 13.0),
        angular_frequency=25.0,
        cycle=1.1,
        per_run=lambda _: np.ones(N * RUNS),  # the belt's direction
    )
    solution = SimpleNamespace(coefficients=np.array([0.6, 0.4]), scatter=np.log(np.array([0.3, 0.2, 0.01]) / 13.0))
    variance = np.exp(2.0 * solution.scatter[:2]).sum()
    return SimpleNamespace(
        pool=pool,
        baseline=SimpleNamespace(solution=solution, variance=variance),
        model=SimpleNamespace(process=None),
        sticking=SimpleNamespace(jumps=jumps),
        records=[SimpleNamespace(mechanism=SimpleNamespace(stiffness=4000.0))],
    )


def struck(count: int) -> np.ndarray:
    return np.random.default_rng(2).choice(N * RUNS, count, replace=False)


def test_slips_that_stand_out_by_their_own_amounts_are_kicked():
    onset = np.zeros(N * RUNS)
    onset[struck(12)] = -np.random.default_rng(3).uniform(0.5, 2.6, 12)
    in_slip = np.where(onset < 0.0, -0.4, 0.0)  # blows of 0.04 N s against the belt, felt over slips of 0.1 s
    result = kicks(study(onset, in_slip))
    assert result is not None
    assert result.kind == "impacts"
    assert result.values["rate"] == pytest.approx(12 / 80 / 1.1)
    assert result.values["mean"] == pytest.approx(-0.04, abs=3e-4)  # 0.01 N of noise in 12 forces, over 0.1 s
    assert result.values["impulse"] == pytest.approx(1e-3, rel=0.65)  # that noise; 11 degrees of freedom, 3 deviations


def test_kicks_from_both_sides_have_no_mean_and_some_are_not_seen():
    onset, in_slip = np.zeros(N * RUNS), np.zeros(N * RUNS)
    at = struck(12)
    onset[at] = -np.random.default_rng(3).uniform(0.5, 2.6, 12)
    in_slip[at] = 0.4 * np.resize([1.0, -1.0], 12)
    result = kicks(study(onset, in_slip))
    assert result is not None
    assert result.values["mean"] == 0.0
    assert result.values["impulse"] == pytest.approx(0.04, rel=0.05)
    assert result.values["rate"] == pytest.approx(1.5 * 12 / 80 / 1.1)


def test_a_box_that_slides_on_about_the_kinetic_force_is_not_kicked_anew():
    onset = np.zeros(N * RUNS)
    onset[struck(12)] = -np.random.default_rng(3).uniform(0.5, 2.6, 12)
    calm = kicks(study(onset))
    onset[20:32] = KINETIC - STATIC  # for twelve swings it only seems to stick, at the force that kinetic friction holds
    swinging = kicks(study(onset))
    assert calm is not None
    assert swinging is not None
    assert swinging.values["rate"] <= calm.values["rate"]


def test_jumps_in_stick_count_beside_slips_that_stand_out():
    onset = np.zeros(N * RUNS)
    onset[struck(3)] = [-0.7, -2.0, -2.5]
    few, more = kicks(study(onset)), kicks(study(onset, jumps=5))
    assert few is not None
    assert more is not None
    assert more.values["rate"] == pytest.approx(few.values["rate"] * 8 / 3)
    assert kicks(study(np.zeros(N * RUNS), jumps=20)) is None  # nothing but jumps: of what force, nobody knows


def test_slips_that_stand_out_by_the_same_amount_are_at_a_second_level():
    onset = np.zeros(N * RUNS)
    onset[struck(12)] = -1.1
    assert kicks(study(onset)) is None


def test_a_long_tail_of_static_friction_is_no_kicks():
    onset = np.zeros(N * RUNS)
    onset[struck(6)] = np.random.default_rng(3).uniform(0.5, 2.6, 6)  # held longer, and as any other in slip
    assert kicks(study(onset)) is None
    pushed = np.zeros(N * RUNS)
    pushed[np.random.default_rng(4).choice(N * RUNS, 12, replace=False)] = 0.5  # pushes that hold it back come in slips, too
    assert kicks(study(onset, pushed)) is not None


@pytest.mark.parametrize("count", [0, 2, 40])
def test_none_single_ones_or_half_of_the_slips_are_not_kicked(count):
    onset = np.zeros(N * RUNS)
    onset[struck(count)] = -np.random.default_rng(3).uniform(0.5, 5.0, count)
    assert kicks(study(onset)) is None


def scatter(**changes: float | str) -> Randomness:
    plain = {"static": 900.0, "kinetic": 900.0, "within": 0.0, "correlation": 0.0, "wander": 0.0, "wander_share": 0.05}
    return Randomness(**(plain | {"wander_time": 3.0, "wander_of": "both", "together": 0.0} | changes))


def called(levels: Switching = CALM, in_slip: float = 0.5, **changes: float) -> Finding | Where | None:
    """What a scatter is called whose deviation in slip is ``in_slip`` times that at break-away."""
    one = study(np.zeros(N * RUNS))
    one.baseline.solution.scatter = one.baseline.solution.scatter[0] + np.log([1.0, in_slip, 1.0])
    return random_effects(one, one.baseline, scatter(**changes), levels, [])


@pytest.mark.parametrize(
    ("noise", "coloured", "together", "drawn"),
    [
        (20.0e-6, 20.0e-6, 0.45, True),
        (400.0e-6, 400.0e-6, 0.0, False),  # what is slower than a stick phase may be as large
        (400.0e-6, 0.0, 0.45, False),  # a zero moves both; coefficients need not
        (400.0e-6, 0.0, 0.0, True),
    ],
)
def test_scatter_no_larger_than_slow_noise_of_the_sensor_is_no_friction(noise, coloured, together, drawn):
    one = study(np.zeros(N * RUNS))
    # the scatter, as motion of the spring
    assert 13.0 * np.exp(one.baseline.solution.scatter[0]) / 4000.0 == pytest.approx(75.0e-6)
    one.pool.slips = [SimpleNamespace(onset_time=s.onset_time, noise=sensor(noise, coloured)) for s in one.pool.slips]
    assert (random_effects(one, one.baseline, scatter(together=together), CALM, []) is not None) == drawn


def test_independent_scatter_is_random_coefficients():
    result = called()
    assert isinstance(result, Finding)
    assert result.kind == "random_coefficients"


def test_scatter_that_stick_and_slip_share_without_memory_has_no_name():
    result = called(together=0.85, in_slip=1.0)  # the same force in both
    assert isinstance(result, Where)
    assert "stick and slip alike" in result.axis


def test_a_factor_of_both_coefficients_is_drawn_anew_for_each_slip():
    result = called(together=0.95, in_slip=KINETIC / STATIC)
    assert isinstance(result, Finding)
    assert result.kind == "random_coefficients"


def test_a_wander_may_share_it():
    result = called(together=0.95, correlation=5.0, wander=80.0)
    assert isinstance(result, Finding)
    assert result.kind == "correlated_coefficients"


def test_switching_has_no_name_however_it_wanders():
    levels = Switching(separation=80.0, changes=10.0, regular=False, rarer=10, jumps=20, still=0.7)
    assert called(levels, correlation=5.0, wander=80.0) is levels.where
    assert levels.where is not None


@pytest.mark.parametrize(("noise", "verdict"), [(5.0e-6, Where), (5.0e-5, None)])
def test_a_force_that_wanders_alike_in_stick_and_slip_is_no_coefficient_and_may_be_the_sensor(noise, verdict):
    one = study(np.zeros(N * RUNS))
    one.pool.slips = [SimpleNamespace(onset_time=s.onset_time, noise=sensor(noise)) for s in one.pool.slips]
    wander = scatter(correlation=5.0, wander=80.0, wander_of="offset", wander_share=0.01)  # 0.08 N, 20 um
    result = random_effects(one, one.baseline, wander, CALM, [])
    assert result is None if verdict is None else isinstance(result, verdict)


def test_noise_is_nothing():
    assert called(static=4.0, kinetic=2.0) is None
