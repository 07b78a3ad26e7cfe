"""A page as one HTML file: templates, with pictures and style inside."""

from __future__ import annotations

import base64
import math
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


def picture(png: bytes, text: str) -> Markup:
    """Return an ``<img>`` that holds the picture itself; ``text`` is what it shows, for those who cannot see it."""
    data = base64.b64encode(png).decode("ascii")
    return Markup('<img src="data:image/png;base64,{}" alt="{}">').format(data, text)
