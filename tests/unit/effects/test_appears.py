"""Where an effect shows depends on its parameters."""

from stochfric_mb.effects import make_effect


def test_friction_along_the_stroke_is_not_said_to_lie_on_the_belt():
    belt, stroke = (
        make_effect("position_dependent_friction", amplitude=0.1, wavelength=0.01, axis=axis) for axis in ("belt", "position")
    )
    assert belt.appears() == ("belt position", "friction varies along the belt")
    assert stroke.appears() == ("position of the box", "friction varies along the stroke")
