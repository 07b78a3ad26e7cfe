"""Mechanisms: what moves, apart from friction. One frozen class each; `MECHANISMS` is the registry."""

from stochfric_mb.mechanisms.belt_box import BeltBox
from stochfric_mb.mechanisms.controller import Cascade, Controller, JointLoop, ProportionalDerivative, controller_from_dict
from stochfric_mb.mechanisms.hinge_pendulum import HingePendulum
from stochfric_mb.mechanisms.mjcf import Mjcf
from stochfric_mb.mechanisms.prismatic_joint import PrismaticJoint
from stochfric_mb.mechanisms.spring_slider import SpringSlider

Mechanism = BeltBox | PrismaticJoint | HingePendulum | SpringSlider | Mjcf

MECHANISMS: dict[str, type[Mechanism]] = {cls.kind: cls for cls in (BeltBox, PrismaticJoint, HingePendulum, SpringSlider, Mjcf)}
"""Kind of a mechanism -> its class."""

__all__ = [
    "MECHANISMS",
    "BeltBox",
    "Cascade",
    "Controller",
    "HingePendulum",
    "JointLoop",
    "Mechanism",
    "Mjcf",
    "PrismaticJoint",
    "ProportionalDerivative",
    "SpringSlider",
    "controller_from_dict",
]
