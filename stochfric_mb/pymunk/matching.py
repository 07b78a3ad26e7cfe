"""Which slot of which table a contact has: found by the numbers of its two shapes, which a space never gives twice.

Chipmunk frees and reuses the memory of shapes and arbiters, so addresses tell nothing for long. A slot stays with its
pair of shapes, touching or not, until it is needed for another; then the one that was not seen for longest goes.
"""

from __future__ import annotations

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.numerics.memory import as_words, carray, load_int, load_word, store_word
from stochfric_mb.pymunk import records as r
from stochfric_mb.pymunk.memory import get_byte, get_word


@compiled_inline
def find_slot(table, arbiter):
    """Return the number of the slot of the arbiter's pair of shapes, -1 where it has none."""
    a = load_word(load_word(arbiter + table[r.ARBITER_A]) + table[r.SHAPE_NUMBER])
    b = load_word(load_word(arbiter + table[r.ARBITER_B]) + table[r.SHAPE_NUMBER])
    pairs = carray(as_words(table[r.PAIRS]), (table[r.CAPACITY], r.PAIR))
    cached = load_word(arbiter + table[r.CACHE]) - 1
    if 0 <= cached < table[r.USED] and _is_pair(pairs[cached], a, b):
        return cached
    for i in range(table[r.USED]):
        if _is_pair(pairs[i], a, b):
            store_word(arbiter + table[r.CACHE], i + 1)
            return i
    return -1


@compiled_inline
def _is_pair(pair, a, b):
    return (pair[r.NUMBER_A] == a and pair[r.NUMBER_B] == b) or (pair[r.NUMBER_A] == b and pair[r.NUMBER_B] == a)


@compiled
def slot_for(table, arbiter, stamp):
    """Return the number of the slot of a contact that is ours, made if it has none, and whether it was made; -1: not ours."""
    first = load_int(arbiter + table[r.ARBITER_STATE]) == table[r.FIRST]
    slot = find_slot(table, arbiter)
    if slot >= 0 and not first:
        return slot, False
    a = load_word(arbiter + table[r.ARBITER_A])
    b = load_word(arbiter + table[r.ARBITER_B])
    on_a, on_b = place(table, r.SIDE_A, a), place(table, r.SIDE_B, b)
    if on_a < 0 or on_b < 0:
        a, b = b, a
        on_a, on_b = place(table, r.SIDE_A, a), place(table, r.SIDE_B, b)
    if on_a < 0 or on_b < 0 or get_byte(table[r.GET_SENSOR], a) != 0 or get_byte(table[r.GET_SENSOR], b) != 0:
        return -1, False
    if slot >= 0:
        return slot, False
    slot = free_slot(table, stamp)
    if slot < 0:
        table[r.PROBLEM] |= r.OVERFLOW
        return -1, False
    pair = carray(as_words(table[r.PAIRS]), (table[r.CAPACITY], r.PAIR))[slot]
    pair[r.NUMBER_A] = load_word(a + table[r.SHAPE_NUMBER])
    pair[r.NUMBER_B] = load_word(b + table[r.SHAPE_NUMBER])
    if table[r.SIDE_A + r.SIDE_KIND] == r.LISTED and table[r.SIDE_B + r.SIDE_KIND] == r.LISTED:
        pair[r.CONTACT] = on_a * table[r.SIDE_B + r.SIDE_SIZE] + on_b
    else:
        pair[r.CONTACT] = table[r.COUNTER]
        table[r.COUNTER] += 1
    store_word(arbiter + table[r.CACHE], slot + 1)
    return slot, True


@compiled
def place(table, side, shape):
    """Return the number of a shape on a side, 0 where shapes are not listed, -1 where it does not belong there."""
    kind = table[side + r.SIDE_KIND]
    if kind == r.ANY:
        return 0
    if kind == r.TYPE:
        return 0 if get_word(table[r.GET_TYPE], shape) == table[side + r.SIDE_TYPE] else -1
    size = table[side + r.SIDE_SIZE]
    addresses = carray(as_words(table[side + r.SIDE_ADDRESSES]), size)
    low, high = 0, size
    while low < high:
        middle = (low + high) // 2
        if addresses[middle] < shape:
            low = middle + 1
        else:
            high = middle
    if low < size and addresses[low] == shape:
        return carray(as_words(table[side + r.SIDE_NUMBERS]), size)[low]
    return -1


@compiled
def free_slot(table, stamp):
    """Return a slot that no contact needs: a new one, or the one not seen for longest; -1 where all touch."""
    if table[r.USED] < table[r.CAPACITY]:
        table[r.USED] += 1
        return table[r.USED] - 1
    pairs = carray(as_words(table[r.PAIRS]), (table[r.CAPACITY], r.PAIR))
    oldest = 0
    for i in range(table[r.CAPACITY]):
        if pairs[i, r.STAMP] < pairs[oldest, r.STAMP]:
            oldest = i
    return oldest if pairs[oldest, r.STAMP] < stamp - 1 else -1
