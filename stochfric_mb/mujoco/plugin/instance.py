"""A plugin instance as compiled code sees it: its texts, by the hash of which its numbers are found, and its address.

The first time that a process meets an instance's texts, compiled code asks Python (`configuration`) for the numbers that they
stand for. From then on no Python runs.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false, reportCallIssue=false
# (compiled functions are typed by numba)

from __future__ import annotations

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory import words as w

N_TEXTS = 6
"""Number of the keys, the first ones of each plugin, that make up an instance's record: all but names and address."""
SEED, SAMPLE, CONTACT = 6, 7, 8
"""Places of the keys of the coefficient path's address, in each plugin."""
LARGEST = 4294967295
"""Largest number of an address."""


@compiled
def text_of(model, instance, key):
    """Return the address of a configuration value, 0 if there is none; ``key`` is a place in the table."""
    return engine.mj_getPluginConfig(model, instance, w.entry(key))


@compiled
def is_given(text):
    """Return whether a configuration value is not empty."""
    return text != 0 and w.load_byte(text) != 0


@compiled
def extended_hash(address, h):
    """Return the FNV-1a hash, continued from ``h``, of the C string at ``address`` (0: an empty one)."""
    if address != 0:
        byte = w.load_byte(address)
        while byte != 0:
            h = (h ^ byte) * 1099511628211
            address += 1
            byte = w.load_byte(address)
    return (h ^ 255) * 1099511628211


@compiled
def record_of(model, instance, keys):
    """Return the address of the header that the instance's state starts with, 0 if its configuration is malformed.

    ``keys`` is the first place of the plugin's keys, by which its reader is known as well.
    """
    h = 1469598103934665603 + keys
    for k in range(N_TEXTS):
        h = extended_hash(text_of(model, instance, keys + k), h)
    key = h & 9007199254740991
    place = w.CONFIGURATIONS + key % w.N_CONFIGURATIONS
    for _ in range(2):
        address = w.entry(place)
        if address != 0 and w.load(address) == float(key):
            return address + 8
        if not explain(model, instance, keys, key):
            return 0
    return 0


@compiled
def explain(model, instance, keys, key):
    """Let Python read the instance's texts and keep their numbers under ``key``; what is wrong with them is printed."""
    return w.call_python(w.entry(keys + w.READER), model, instance, key) == 1


@compiled
def reset(model, state, instance, keys):
    """Write a fresh state: the record, the address of the coefficient path, and zeros."""
    record = record_of(model, instance, keys)
    header = s.header_record(record)
    length = s.N_HEADER + int(header.n_descriptor)
    w.copy_bytes(record, state, 8 * length)
    for j in range(length, s.state_size(length - s.N_HEADER, int(header.n_slots))):
        w.put(state, j, 0.0)
    fresh = s.header_record(state)
    fresh.seed = parse_integer(text_of(model, instance, keys + SEED), 0)
    fresh.sample = parse_integer(text_of(model, instance, keys + SAMPLE), 0)
    fresh.contact = parse_integer(text_of(model, instance, keys + CONTACT), 0)


@compiled
def has_address(model, instance, keys):
    """Return whether the address of the coefficient path is one."""
    for k in (SEED, SAMPLE, CONTACT):
        number = parse_integer(text_of(model, instance, keys + k), 0)
        if number < 0 or number > LARGEST:
            return False
    return True


@compiled
def size_of(model, instance, keys):
    """Return the length of the instance's state [doubles], -1 if its configuration is malformed."""
    record = record_of(model, instance, keys)
    if record == 0:
        return -1
    header = s.header_record(record)
    return s.state_size(int(header.n_descriptor), int(header.n_slots))


@compiled
def parse_integer(address, default):
    """Return the whole number of the C string at ``address``; ``default`` for an empty one, -1 for anything else."""
    if not is_given(address):
        return default
    value = 0
    byte = w.load_byte(address)
    while byte != 0:
        if byte < 48 or byte > 57 or value > 100 * LARGEST:
            return -1
        value = 10 * value + byte - 48
        address += 1
        byte = w.load_byte(address)
    return value
