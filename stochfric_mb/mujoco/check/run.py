"""What a model's friction does and what this package's does in its place: contact pairs, joints and tendons.

Each site is probed on copies of the model, from the state to which it settles (`probes`): it holds a share of its
limit, breaks away under a rising load, and slides; with the model's own friction and with ours.
"""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Generator
from pathlib import Path

import mujoco

from stochfric_mb.errors import require_number
from stochfric_mb.laws import make_law
from stochfric_mb.mujoco.check.bench import Bench, paired
from stochfric_mb.mujoco.check.findings import CheckResult
from stochfric_mb.mujoco.check.loading import load
from stochfric_mb.mujoco.check.search import find_sites
from stochfric_mb.mujoco.check.settling import Stage
from stochfric_mb.mujoco.check.settling import settle as leave_alone

HOLD, MOST_STEPS = 0.5, 500
"""Time of a hold [s], and most steps of one: a model with short steps is small and fast, and a check should take seconds."""


def check(
    model: str | Path | mujoco.MjSpec,
    *,
    keyframe: str | None = None,
    settle: float = 2.0,
    duration: float | None = None,
    law: str = "elastic_stick",
    mu_k_ratio: float = 1.0,
    most: int = 12,
    stage: Stage = lambda name, length: lambda t: None,
) -> CheckResult:
    """Return what the friction of a model does, and what a law of this package does in its place.

    Args:
        model: an MJCF, URDF or MJB file, or a spec (which is left as it is).
        keyframe: name or number of the keyframe to start from.
        settle: time that the model is left to itself first [s].
        duration: time of a hold [s]; `HOLD`, but at most `MOST_STEPS` steps, if not given.
        law: kind of our law.
        mu_k_ratio: its mu_k over mu_s [-], in [0, 1]; mu_s is the model's coefficient.
        most: most contact pairs that are probed, the most loaded first.
        stage: called with each site's name and total simulated time [s]; what it returns is called with the progress.

    Raises:
        InputError: the model cannot be loaded, or an option is out of range.
        SimulationError: the model breaks before anything is probed.
    """
    require_number("settle", settle, low=0.0, unit="s")
    if duration is not None:
        require_number("duration", duration, above=0.0, unit="s")
    require_number("mu_k_ratio", mu_k_ratio, low=0.0, high=1.0)
    make_law(law, mu_s=1.0, mu_k=mu_k_ratio)
    with _quiet() as said:
        spec, compiled, invented = load(model)
        if duration is None:
            duration = min(HOLD, MOST_STEPS * float(compiled.opt.timestep))
        settled = leave_alone(compiled, keyframe, settle, stage)
        result, notes = find_sites(compiled, settled, most)
        own = paired(spec, [site for site, problem in result if not problem])
        bench = Bench(spec, compiled, own, invented, settled.data, law, mu_k_ratio, duration)
        rows = tuple(bench.row(site, problem, stage(site.name, bench.probe_time())) for site, problem in result)
    option = compiled.opt
    return CheckResult(
        model=str(model) if isinstance(model, str | Path) else (model.modelname or "spec"),
        timestep=float(option.timestep),
        integrator=mujoco.mjtIntegrator(option.integrator).name.removeprefix("mjINT_").lower(),
        cone=mujoco.mjtCone(option.cone).name.removeprefix("mjCONE_").lower(),
        impratio=float(option.impratio),
        keyframe=keyframe or "",
        settle=settle,
        duration=duration,
        mu_k_ratio=mu_k_ratio,
        rows=rows,
        notes=tuple(dict.fromkeys([*(str(w.message) for w in said), *notes])),
    )


@contextlib.contextmanager
def _quiet() -> Generator[list[warnings.WarningMessage]]:
    """Give the warnings about the model; MuJoCo's while it runs, which become errors here, stay out of MUJOCO_LOG.TXT."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda text: None)
    try:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            yield said
    finally:
        mujoco.set_mju_user_warning(before)
