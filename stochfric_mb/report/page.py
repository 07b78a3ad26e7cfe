"""A page as one HTML file: templates, with pictures, style and script inside."""

from __future__ import annotations

import math
import re
from typing import Any

import jinja2
from markupsafe import Markup


def render(template: str, **context: Any) -> str:
    """Return the HTML text of ``report/templates/<template>``."""
    environment: Any = jinja2.Environment(
        loader=jinja2.PackageLoader("stochfric_mb.report", "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["digits"] = digits
    environment.globals["picture"] = picture
    return environment.get_template(template).render(**context)


def digits(value: float | None, n: int = 3) -> str:
    """Return ``value`` with ``n`` significant digits, in powers of ten where that is shorter; a dash for no value."""
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    mantissa, _, power = f"{value:.{n - 1}e}".partition("e")
    exponent = int(power)
    if -4 < exponent < 6:
        return f"{value:.{max(n - 1 - exponent, 0)}f}".replace("-", "−")
    return f"{mantissa.replace('-', '−')}·10{str(exponent).translate(_SUPERSCRIPT)}"


_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


INKS = {
    "#1f2933": "var(--ink)", "#000000": "var(--ink)", "#52606d": "var(--soft)", "#9aa5b1": "var(--grey)",
    "#e4e7eb": "var(--line)", "#b8c0ca": "var(--pale-line)", "#cbd2d9": "var(--pale-line)", "#ffffff": "none",
}  # fmt: skip
"""Colours of a figure -> those of the page, which differ in light and dark."""
NARROW = 420.0
"""A figure that is wider than this [pt] is scrolled sideways on a small screen, so that its text stays readable."""


def picture(svg: str, text: str) -> Markup:
    """Return a figure from `stochfric_mb.report.figures.svg` as part of a page.

    Args:
        svg: its text.
        text: what it shows, for those who cannot see it.
    """
    for ink, meant in INKS.items():
        svg = svg.replace(f": {ink}", f": {meant}")
    svg = re.sub(r"font-family: sans-serif", "font-family: inherit", svg)
    svg = re.sub(r' width="([\d.]+)pt" height="[\d.]+pt"', lambda found: _size(float(found[1])), svg, count=1)
    svg = svg.replace(' xmlns="http://www.w3.org/2000/svg"', "", 1).replace(
        ' xmlns:xlink="http://www.w3.org/1999/xlink"', "", 1
    )
    svg = svg.replace("xlink:href", "href").replace("<svg ", Markup('<svg role="img" aria-label="{}" ').format(text), 1)
    return Markup('<div class="plot">{}</div>').format(Markup(svg))


def _size(width: float) -> str:
    return f' class="{"wide" if width > NARROW else "narrow"}" style="max-width: {1.5 * width:.0f}px"'
