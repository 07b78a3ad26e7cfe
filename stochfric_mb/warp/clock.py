# type: ignore
# (kernels are typed by Warp)
"""The kernel that begins a step in each world: its clock, its coefficients, and a new law where an episode begins."""

import functools
from typing import Any

import warp as wp

from stochfric_mb.warp.domain import CODE, HIGH, LOW, MEAN, PLACE, SIGMA, SPREAD
from stochfric_mb.warp.law import coefficient_functions
from stochfric_mb.warp.state import Worlds

DOMAIN = wp.constant(wp.int64(0x80000000))
"""Part of the address of what is drawn for an episode; paths of coefficients have contact numbers below it."""
ATTEMPTS = wp.constant(10_000)
"""Redraws of a parameter outside its bounds before its mean is taken."""


@functools.cache
def begin_kernel() -> Any:
    """Return the kernel."""
    path, pair, normals, transform = coefficient_functions()

    @wp.func
    def draw(worlds: Worlds, w: int, j: int, seed: wp.int64, address: wp.int64, episode: wp.int64):
        row = worlds.spreads[j]
        n = wp.int64(row.shape[0]) - wp.int64(SPREAD)
        for i in range(ATTEMPTS):
            attempt = wp.int64(j + 1) * wp.int64(ATTEMPTS) + wp.int64(i)
            z, _y = normals(seed, worlds.first_sample[w], address, episode, attempt)
            value = transform(z, row[CODE], row[MEAN], row[SIGMA], row, wp.int64(SPREAD), n)
            if value > wp.float64(0.0) and value >= row[LOW] and value <= row[HIGH]:
                return value
        return row[MEAN]

    @wp.func
    def new_episode(worlds: Worlds, w: int, seed: wp.int64, contact: wp.int64):
        worlds.episode[w] = worlds.episode[w] + 1
        worlds.overflow[w] = 0
        worlds.cursor[w, 0] = wp.float64(0.0)
        episode = wp.int64(worlds.episode[w])
        worlds.sample[w] = worlds.first_sample[w] + worlds.stride * episode
        address = contact + DOMAIN
        if worlds.means.shape[0] > 0:
            mu_s, mu_k = pair(worlds.means, seed, worlds.first_sample[w], address, episode)
            worlds.descriptor[w, 4] = mu_s
            worlds.descriptor[w, 5] = mu_k
            worlds.parameters[w, 0] = wp.float32(mu_s)
            worlds.parameters[w, 1] = wp.float32(mu_k)
        for j in range(worlds.spreads.shape[0]):
            value = wp.float32(draw(worlds, w, j, seed, address, episode))
            place = wp.int32(worlds.spreads[j, PLACE])
            worlds.parameters[w, place] = value
            if place == worlds.v_s:
                worlds.stick_speed[w] = value
                worlds.peak_speed[w] = worlds.peak_ratio * value

    @wp.kernel(module="unique", enable_backward=False)
    def begin(
        time: wp.array[float], timestep: wp.float64, seed: wp.int64, contact: wp.int64, worlds: Worlds,
        used: wp.array2d[int],
    ):  # fmt: skip
        w = wp.tid()
        if time[w] < worlds.last_time[w]:  # the world was reset
            worlds.count[w] = -1
        fresh = wp.int32(0)
        if worlds.count[w] < 0:
            new_episode(worlds, w, seed, contact)
            used[0, w] = 0
            used[1, w] = 0
            fresh = 1
        elif time[w] != worlds.last_time[w]:
            fresh = 1
        worlds.fresh[w] = fresh
        worlds.last_time[w] = time[w]
        worlds.count[w] = worlds.count[w] + fresh
        used[worlds.count[w] % 2, w] = 0
        t = wp.float64(worlds.count[w]) * timestep
        place = worlds.origin  # where a path that is not along time begins
        events = wp.float64(0.0)
        mu_s, mu_k = path(worlds.descriptor[w], worlds.cursor[w], seed, worlds.sample[w], contact, t, place, events)
        worlds.mu_s[w] = wp.float32(mu_s)
        worlds.mu_k[w] = wp.float32(mu_k)

    return begin


@wp.kernel(module="unique", enable_backward=False)
def restart(mask: wp.array[bool], worlds: Worlds):
    """Let the worlds of a mask begin a new episode at their next step."""
    w = wp.tid()
    if mask[w]:
        worlds.count[w] = -1
