"""Springs and gaps between motor and load; the motor's encoder is what is recorded.

The generator's two bodies (`plant.CHAIN`) with what earlier sets held fixed: how much of the friction the load's own guide
has, and where the spring's damping and hardening come from.
"""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator
from tests.discovery.joint_generator.plant import CHAIN, Plant

from .enter import form


def linked(
    plant: Plant, *, load: float, frequency: float, damping: float, held: float, half_gap: float = 0.0, cubic: float = 0.0
) -> Plant:
    """Part the inertia.

    Args:
        plant: one body.
        load: share of the inertia behind the link.
        frequency: of the load while the motor stands still [Hz].
        damping: ratio of that.
        held: share of Coulomb friction that the load's own guide has.
        half_gap: half of the play [m or rad].
        cubic: stretch at which a cubic part of the spring is as strong as the linear one [m or rad]; 0: none.
    """
    whole = plant.body["inertia"]
    stiffness = (2.0 * np.pi * frequency) ** 2 * load * whole
    plant = plant.with_body(
        kind=CHAIN,
        rotor=(1.0 - load) * whole,
        inertia=load * whole,
        link_stiffness=stiffness,
        link_damping=2.0 * damping * np.sqrt(stiffness * load * whole),
        half_gap=half_gap,
        link_cubic=stiffness / cubic**2 if cubic else 0.0,
    )
    friction = plant.coulomb[0]
    return replace(plant, coulomb=((1.0 - held) * friction, held * friction))


@form("joint_compliance", also=("second_mode",), on=HINGES)
def gear_and_arm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Spong 1987; Albu-Schaeffer, Ott and Hirzinger 2007 (a light robot's gear: two thirds of the inertia behind a spring)."""
    frequency = bench.speed / bench.reach * rng.uniform(0.8, 1.1) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.66, frequency=frequency, damping=0.04, held=0.1),
    )


@form("joint_compliance", also=("second_mode",), on=LINES)
def carriage_on_a_belt(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hace, Jezernik and Sabanovic 2007 (a belt-driven carriage: most of the friction is that of its own rail)."""
    frequency = bench.speed / bench.reach * rng.uniform(0.8, 1.1) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.6, frequency=frequency, damping=0.06, held=0.6),
    )


@form("joint_compliance", also=("second_mode",), on=SINGLES)
def twisted_strings(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Palli, Natale, May, Melchiorri and Wurtz 2013 (strings that stiffen as they are stretched, with much damping)."""
    frequency = bench.speed / bench.reach * rng.uniform(0.65, 0.85) / np.sqrt(strength)
    cubic = 0.15 * strength * bench.reach
    return Effect(
        {"frequency": frequency, "cubic": cubic},
        alter=lambda plant, _: linked(plant, load=0.5, frequency=frequency, damping=0.15, held=0.3, cubic=cubic),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=LINES)
def rack_and_pinion(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nordin and Gutman 2002 (a carriage on a rack, held by the friction of its own rail while the teeth change sides)."""
    gap = 0.035 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.7, frequency=18.0, damping=0.12, held=0.5, half_gap=gap),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=HINGES)
def worn_bevel_gear(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dubowsky and Freudenstein 1971 (worn teeth: the weight keeps one flank, its sign and every blow change it)."""
    gap = 0.04 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.75, frequency=16.0, damping=0.1, held=0.15, half_gap=gap),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=SINGLES)
def dog_clutch(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson 1985, chapter 4 (a clutch whose dogs meet on round faces: soft as they touch, hard when pressed)."""
    gap = 0.045 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(
            plant, load=0.55, frequency=10.0, damping=0.2, held=0.3, half_gap=gap, cubic=0.01 * bench.reach
        ),
    )
