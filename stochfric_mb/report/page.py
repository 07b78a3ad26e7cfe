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
    environment.filters |= {"digits": marked, "plain": plain, "said": said, "unit": unit}
    environment.globals |= {"picture": picture, "ink": ink}
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


def marked(value: float | None, n: int = 3, times: float = 1.0) -> Markup:
    """Return a number as a page shows it, with its exact value in the markup.

    Args:
        value: as it stands in the file of the page's numbers; a dash for None and what is not finite.
        n: significant digits of one that is no integer.
        times: what it is shown multiplied by, such as 1e6 for metres in µm.
    """
    if value is None or not math.isfinite(value):
        return Markup("–")
    whole = isinstance(value, int)
    text = str(value) if whole and times == 1.0 else digits(times * value, n)
    return Markup('<data value="{}">{}</data>').format(value if whole else repr(float(value)), text)


def plain(value: float) -> Markup:
    """Return a setting, such as a step or a length, with the digits that were set, marked as `marked` does."""
    mantissa, _, power = f"{value:g}".partition("e")
    text = mantissa.replace("-", "−") + (f"·10{str(int(power)).translate(_SUPERSCRIPT)}" if power else "")
    return Markup('<data value="{}">{}</data>').format(value, text)


def unit(text: str) -> str:
    """Return a unit as a page shows it: powers raised, nothing for a number without one."""
    return "" if text == "-" else re.sub(r"\^(-?\d+)", lambda power: power[1].translate(_SUPERSCRIPT), text)


def said(text: object) -> Markup:
    """Return a text that stands in the file of the page's numbers, marked as such: its numbers stand there already."""
    return Markup('<span class="said">{}</span>').format(text)


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
    svg = re.sub(r' width="([\d.]+)pt" height="[\d.]+pt"', lambda width: _size(float(width[1])), svg, count=1)
    svg = svg.replace(' xmlns="http://www.w3.org/2000/svg"', "", 1).replace(
        ' xmlns:xlink="http://www.w3.org/1999/xlink"', "", 1
    )
    svg = svg.replace("xlink:href", "href").replace("<svg ", Markup('<svg role="img" aria-label="{}" ').format(text), 1)
    return Markup('<div class="plot">{}</div>').format(Markup(svg))


def ink(colour: str) -> str:
    """Return the colour of a page, which differs in light and dark, that one of a figure stands for; itself for others."""
    return INKS.get(colour, colour)


def _size(width: float) -> str:
    return f' class="{"wide" if width > NARROW else "narrow"}" style="max-width: {1.5 * width:.0f}px"'
