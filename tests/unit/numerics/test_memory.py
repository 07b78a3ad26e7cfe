"""Numbers at addresses."""

from __future__ import annotations

import numpy as np
from numba import carray  # pyright: ignore[reportPrivateImportUsage]

from stochfric_mb.compile import compiled
from stochfric_mb.numerics import memory as m


@compiled
def swap(doubles, n):
    """Swap the first and the last of n doubles."""
    x = carray(m.as_doubles(doubles), (n,))
    first = m.load_double(doubles)
    m.store_double(doubles, x[n - 1])
    x[n - 1] = first


@compiled
def look(word):
    """Return a word, its lower and upper half and its lowest byte as they are read, and let it be negative."""
    pair = m.load_word(word), m.load_int(word), m.load_int(word + 4), m.load_byte(word)
    m.store_word(word, -carray(m.as_words(word), (1,))[0])
    return pair


def test_doubles_are_read_and_written() -> None:
    doubles = np.array([1.5, -2.0, 3.25])
    swap(doubles.ctypes.data, 3)
    assert doubles.tolist() == [3.25, -2.0, 1.5]


def test_words_are_read_in_parts_and_written() -> None:
    words = np.array([3 * 2**32 + 5 * 256 + 7], dtype=np.int64)
    assert look(words.ctypes.data) == (3 * 2**32 + 1287, 1287, 3, 7)
    assert words.tolist() == [-3 * 2**32 - 1287]
