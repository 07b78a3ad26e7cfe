"""Explicit Runge-Kutta formulas as tables of coefficients, and the sums of which a step is made.

The caller evaluates the rates::

    for i in range(stages):
        advance(A[i], i, h, y, k, 0, n, y_stage)
        rates(t + C[i] * h, y_stage, k[i])
    advance(B, stages, h, y, k, 0, n, y_end)

References: `RK4`: W. Kutta, 1901. `DOPRI5`: J. R. Dormand, P. J. Prince, J. Comp. Appl. Math. 6, 1980, 19-26, the pair 5(4);
dense output: L. F. Shampine, Math. Comp. 46, 1986, 135-150. `DOP853`: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary
Differential Equations I, 2nd ed., Springer 1993, section II.10, order 8 with error estimates of orders 5 and 3.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from stochfric_mb.compile import compiled_inline

Array = npt.NDArray[np.float64]


class Tableau(NamedTuple):
    """One formula; k are the rates of its stages, last of all those at the end of the step where ``errors`` use them."""

    a: Array
    """Weights of the earlier stages in each stage, shape (stages, stages)."""
    b: Array
    """Weights of the stages in the solution, shape (stages,)."""
    c: Array
    """Times of the stages in parts of the step, shape (stages,)."""
    errors: Array
    """Weights of the rates in each error estimate, shape (estimates, rates)."""
    dense: Array
    """Weights of the rates in the solution at the part s of the step, by powers of s, shape (rates, powers)."""


def _tableau(
    a: Sequence[Sequence[float]],
    b: Sequence[float],
    c: Sequence[float],
    errors: Sequence[Sequence[float]] = (),
    dense: Sequence[Sequence[float]] = (),
) -> Tableau:
    square = np.zeros((len(a), len(a)))
    for i, row in enumerate(a):
        square[i, : len(row)] = row
    return Tableau(square, np.array(b), np.array(c), np.array(errors), np.array(dense))


RK4 = _tableau([[], [0.5], [0.0, 0.5], [0.0, 0.0, 1.0]], [1 / 6, 1 / 3, 1 / 3, 1 / 6], [0.0, 0.5, 0.5, 1.0])
"""The classical formula, order 4."""

DOPRI5 = _tableau(
    a=[
        [],
        [1 / 5],
        [3 / 40, 9 / 40],
        [44 / 45, -56 / 15, 32 / 9],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ],
    b=[35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84, 0.0],
    c=[0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0],
    errors=[[-71 / 57600, 0.0, 71 / 16695, -71 / 1920, 17253 / 339200, -22 / 525, 1 / 40]],
    dense=[
        [1.0, -8048581381 / 2820520608, 8663915743 / 2820520608, -12715105075 / 11282082432],
        [0.0, 0.0, 0.0, 0.0],
        [0.0, 131558114200 / 32700410799, -68118460800 / 10900136933, 87487479700 / 32700410799],
        [0.0, -1754552775 / 470086768, 14199869525 / 1410260304, -10690763975 / 1880347072],
        [0.0, 127303824393 / 49829197408, -318862633887 / 49829197408, 701980252875 / 199316789632],
        [0.0, -282668133 / 205662961, 2019193451 / 616988883, -1453857185 / 822651844],
        [0.0, 40617522 / 29380423, -110615467 / 29380423, 69997945 / 29380423],
    ],
)
"""Order 5, with an error estimate of order 4 and dense output; its last stage is the end of the step."""

# fmt: off
DOP853 = _tableau(
    a=[
        [],
        [0.05260015195876773],
        [0.0197250569845379, 0.0591751709536137],
        [0.02958758547680685, 0.0, 0.08876275643042054],
        [0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792],
        [0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242],
        [0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125],
        [
            0.03709200011850479, 0.0, 0.0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
            0.008273789163814023,
        ],
        [
            0.6241109587160757, 0.0, 0.0, -3.3608926294469414, -0.868219346841726, 27.59209969944671, 20.154067550477894,
            -43.48988418106996,
        ],
        [
            0.47766253643826434, 0.0, 0.0, -2.4881146199716677, -0.590290826836843, 21.230051448181193, 15.279233632882423,
            -33.28821096898486, -0.020331201708508627,
        ],
        [
            -0.9371424300859873, 0.0, 0.0, 5.186372428844064, 1.0914373489967295, -8.149787010746927, -18.52006565999696,
            22.739487099350505, 2.4936055526796523, -3.0467644718982196,
        ],
        [
            2.273310147516538, 0.0, 0.0, -10.53449546673725, -2.0008720582248625, -17.9589318631188, 27.94888452941996,
            -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636,
        ],
    ],
    b=[
        0.054293734116568765, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003, -5.801203960010585,
        0.3111643669578199, -0.1521609496625161, 0.20136540080403034, 0.04471061572777259,
    ],
    c=[
        0.0, 0.05260015195876773, 0.0789002279381516, 0.1183503419072274, 0.2816496580927726, 0.3333333333333333, 0.25,
        0.3076923076923077, 0.6512820512820513, 0.6, 0.8571428571428571, 1.0,
    ],
    errors=[
        [
            0.01312004499419488, 0.0, 0.0, 0.0, 0.0, -1.2251564463762044, -0.4957589496572502, 1.6643771824549864,
            -0.35032884874997366, 0.3341791187130175, 0.08192320648511571, -0.022355307863886294, 0.0,
        ],
        [
            -0.18980075407240762, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003, -5.801203960010585,
            -0.4226823213237919, -0.1521609496625161, 0.20136540080403034, 0.02265179219836082, 0.0,
        ],
    ],
)
# fmt: on
"""Order 8; its error estimates, of orders 5 and 3, use the rates at the end of the step as one more."""


@compiled_inline
def weighted(weights, count, k, j):
    """Return the sum of the first ``count`` rates of unknown j, each times its weight."""
    total = 0.0
    for i in range(count):
        total += weights[i] * k[i, j]
    return total


@compiled_inline
def advance(weights, count, h, y, k, first, last, out):
    """Write y + h times the weighted sum of the first ``count`` rates into ``out``, for unknowns ``first`` .. ``last`` - 1."""
    for j in range(first, last):
        out[j] = y[j] + h * weighted(weights, count, k, j)


@compiled_inline
def interpolate(dense, part, h, y, k, first, last, out):
    """Write the unknowns at a part of a step of h into ``out``, by the formula's dense output."""
    for j in range(first, last):
        total = 0.0
        for i in range(len(dense)):
            w = dense[i]
            total += (w[0] + part * (w[1] + part * (w[2] + part * w[3]))) * k[i, j]
        out[j] = y[j] + h * part * total
