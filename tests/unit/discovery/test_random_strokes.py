"""Scatter from stroke to stroke: when strokes are drawn anew, and when they go on from those before."""

import pytest

from stochfric_mb.discovery.driven_joint.scatter.stroke_scatter import StrokeScatter


@pytest.mark.parametrize("strokes", [40, 400])
@pytest.mark.parametrize(("correlation", "anew"), [(0.0, True), (0.6, True), (0.8, False)])
def test_strokes_are_drawn_anew_where_the_one_before_says_less_than_half(strokes, correlation, anew):
    seen = StrokeScatter(
        sigma=0.1, low=0.08, high=0.12, share=0.2, score=100.0, p_value=0.0, believed=0.0, gain=0.5,
        correlation=correlation, across=0.0, strokes=strokes, level=1.0, inside=0.1, floor=0.1,
    )  # fmt: skip
    assert seen.wanders is not anew
    assert seen.named is anew
    assert seen.remembers is (correlation > 0.5)  # 0 is within chance, 0.6 of 40 strokes is four standard errors
