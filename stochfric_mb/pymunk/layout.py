"""Where the running pymunk keeps what compiled callbacks need: field offsets and addresses of its C functions.

The structures of arbiters, contacts and handlers are public (their offsets come from pymunk's own declarations); bodies,
shapes and spaces are opaque. Their few fields are *found*: each is set to a number of its own through pymunk's API and looked
up in the structure's memory, so that a changed layout is noticed and never guessed.
"""

from __future__ import annotations

import functools
import struct

import numpy as np
import numpy.typing as npt
import pymunk
from pymunk._chipmunk_cffi import ffi, lib

from stochfric_mb.errors import SimulationError

BODY_FIELDS = ("m_inv", "p", "v", "f", "i_inv", "w", "t")
ARBITER_FIELDS = (
    "e", "u", "surface_vr", "data", "a", "b", "body_a", "body_b", "count", "contacts", "n", "state", "processCollision",
)  # fmt: skip
CONTACT_FIELDS = ("r1", "r2", "jnAcc", "jtAcc")
GETTERS = ("cpSpaceGetTimestamp", "cpSpaceGetCurrentTimeStep", "cpShapeGetCollisionType", "cpShapeGetSensor")
NAMES = (
    *(f"body.{n}" for n in BODY_FIELDS),
    "space.gravity",
    "shape.number",
    *(f"arbiter.{n}" for n in ARBITER_FIELDS),
    *(f"contact.{n}" for n in CONTACT_FIELDS),
    "contact.size",
    "arbiter.first",
    *GETTERS,
)
"""Order of the entries of `layout`."""
_BODY_BYTES = 176
_SPACE_BYTES = 96
_SHAPE_BYTES = 256


@functools.cache
def layout() -> npt.NDArray[np.int64]:
    """Return the offsets [bytes] and function addresses named in `NAMES`, shape (len(NAMES),).

    Raises:
        SimulationError: this build of pymunk keeps them elsewhere.
    """
    values = _body_offsets() | _space_offsets() | {"shape.number": _shape_number_offset()}
    values |= {f"arbiter.{n}": ffi.offsetof("struct cpArbiter", n) for n in ARBITER_FIELDS}
    values |= {f"contact.{n}": ffi.offsetof("struct cpContact", n) for n in CONTACT_FIELDS}
    values["contact.size"] = ffi.sizeof("struct cpContact")
    values["arbiter.first"] = int(ffi.cast("int", lib.CP_ARBITER_STATE_FIRST_COLLISION))
    values |= {n: address_of(ffi.addressof(lib, n)) for n in GETTERS}
    return np.array([values[n] for n in NAMES], dtype=np.int64)


def address_of(pointer: object) -> int:
    """Return a cffi pointer as an integer."""
    return int(ffi.cast("uintptr_t", pointer))


def _body_offsets() -> dict[str, int]:
    mass, moment = 3.0, 7.0
    body = pymunk.Body(mass, moment)
    body.position, body.velocity, body.force = (11.25, 12.25), (13.25, 14.25), (15.25, 16.25)
    body.angular_velocity, body.torque = 17.25, 18.25
    memory = bytes(ffi.buffer(ffi.cast("char *", body._body), _BODY_BYTES))
    patterns = {
        "m_inv": (1.0 / mass,), "i_inv": (1.0 / moment,), "p": (11.25, 12.25), "v": (13.25, 14.25),
        "f": (15.25, 16.25), "w": (17.25,), "t": (18.25,),
    }  # fmt: skip
    return {f"body.{name}": _find(memory, pattern, f"cpBody.{name}") for name, pattern in patterns.items()}


def _space_offsets() -> dict[str, int]:
    space = pymunk.Space()
    space.gravity = (21.25, 22.25)
    memory = bytes(ffi.buffer(ffi.cast("char *", space._space), _SPACE_BYTES))
    return {"space.gravity": _find(memory, (21.25, 22.25), "cpSpace.gravity")}


def _shape_number_offset() -> int:
    """Return the offset of the number that a space gives to each shape it takes in: 0, 1, 2, ..., never given twice."""
    space, shapes = pymunk.Space(), []
    for i in range(6):
        body = pymunk.Body(1.0, 1.0)
        body.position = (31.25 * i, 0.0)
        shapes.append(pymunk.Poly.create_box(body, (1.0, 1.0)))
        space.add(body, shapes[-1])
    memories = [bytes(ffi.buffer(ffi.cast("char *", s._shape), _SHAPE_BYTES)) for s in shapes]
    numbers = [struct.unpack(f"={_SHAPE_BYTES // 8}q", m) for m in memories]
    places = [8 * i for i, column in enumerate(zip(*numbers, strict=True)) if column == tuple(range(6))]
    return _only(places, "cpShape.hashid")


def _find(memory: bytes, numbers: tuple[float, ...], name: str) -> int:
    """Return the only aligned offset at which ``memory`` holds ``numbers`` as doubles."""
    pattern = struct.pack(f"={len(numbers)}d", *numbers)
    return _only([i for i in range(0, len(memory), 8) if memory.startswith(pattern, i)], name)


def _only(places: list[int], name: str) -> int:
    if len(places) != 1:
        raise SimulationError(
            f"pymunk {pymunk.version} keeps {name} at {len(places)} places, 1 expected: its layout is not the one known "
            "here; install pymunk 7.3.1"
        )
    return places[0]
