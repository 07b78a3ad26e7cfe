"""Columns of text files: CSV, TSV and tables aligned by spaces; delimiter and decimal sign are detected."""

from __future__ import annotations

import io
import itertools
import re
from collections import Counter
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.quantities import split_header
from stochfric_mb.measurement.table import Table

Array = npt.NDArray[np.float64]
Dialect = tuple[str | None, str]
"""Delimiter (None: any white space) and decimal sign."""

DIALECTS: tuple[Dialect, ...] = ((",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ","), (None, "."), (None, ","))
"""Those that are tried, the likelier first."""
COMMENT = "#"
MISSING = ("", "nan", "na", "n/a", "null", "none", "-")
"""Fields that stand for a missing value."""
_DATE = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d")
"""How a date in ISO 8601 begins."""
_LOOK = 40
"""Lines that decide the dialect."""
_LONGEST_LINE = 2**20
"""Longest first line of a table [bytes]: ten thousand columns need less."""
_ALIKE = 0.8
"""Part of them that has equally many columns: a few may be broken, which is said later, with their number."""


def read(path: Path, *, skip_rows: int = 0) -> Table:
    """Return the numeric columns of a text file.

    Dates in ISO 8601 become seconds since the first one. Lines that begin with ``#`` are left out; the last of them is the
    header if it has as many names as there are columns and no other line is one. A line of words under the header holds the
    units. Columns without any number are left out.

    Raises:
        InputError: no table of numbers can be seen in it, or a row is broken; names the line.
    """
    _require_lines(path)
    if not skip_rows and (plain := _plain(path)) is not None:
        return plain
    lines = _text(path).splitlines()
    if not any(map(str.strip, lines)):
        raise InputError(f"{path}: the file is empty; record again, or leave the run out")
    kept = [(number, line) for number, line in enumerate(lines, start=1) if number > skip_rows and line.strip()]
    comments = [line.lstrip().lstrip(COMMENT) for _, line in kept if line.lstrip().startswith(COMMENT)]
    rows = [(number, line) for number, line in kept if not line.lstrip().startswith(COMMENT)]
    if not rows:
        raise InputError(f"{path}: no rows after skip_rows = {skip_rows}; lower it or correct the file")
    dialect = _dialect(path, [line for _, line in rows])
    first = _fields(rows[0][1], dialect)
    is_header = all(_number(field, dialect) is None for field in first)
    header = first if is_header else _commented_header(comments, len(first), dialect)
    body = rows[1:] if is_header else rows
    second = _fields(body[0][1], dialect) if is_header and body else []
    has_units = len(second) == len(header) > 0 and all(f and _number(f, dialect) is None for f in second)
    body = body[1:] if has_units else body
    if not body:
        raise InputError(f"{path}: a header without any row under it; record some samples")
    width = _usual_width([line for _, line in body[:_LOOK]], dialect)
    if len(header) == width - 1 and all(not _fields(line, dialect)[-1] for _, line in body[:_LOOK]):
        header = [*header, ""]  # rows end with a delimiter, the header does not
    if header and len(header) != width:
        raise InputError(
            f"{path}: {len(header)} names in the header, line {rows[0][0]}, but {width} columns in most lines under it; "
            f"correct the header, or leave out the lines before it with skip_rows{_skipped(rows, width, dialect)}"
        )
    values = _values(path, body, width, dialect)
    names, units = _names(path, header, width)
    dated = _dated(body[0][1], dialect)
    units = units | {names[i]: "s" for i in dated}
    if has_units:
        units = {name: text.strip("[]()") for name, text in zip(names, second, strict=True)} | units
    filled = [i for i in range(width) if np.isfinite(values[:, i]).any() or names[i] in units]
    return Table(
        columns={names[i]: values[:, i].copy() for i in filled},
        units=units,
        has_header=bool(header),
        rows=np.array([number for number, _ in body], dtype=np.int64),
        row_word="line",
    )


def _skipped(rows: list[tuple[int, str]], width: int, dialect: Dialect) -> str:
    """Return the skip_rows that leave a table with its header, as a text; empty where no line but the first is its header."""
    begin = 0
    for number, line in rows:
        fields = _fields(line, dialect)
        words = sum(_number(field, dialect) is None for field in fields)
        if len(fields) != width or words < width:  # neither a header nor the units under it
            if len(fields) == width and not words:
                break
            begin = 0
        elif not begin:
            begin = number
    return f" = {begin - 1}" if begin > rows[0][0] else ""


def _require_lines(path: Path) -> None:
    """Refuse a file that is no table of lines before all of it is read."""
    with path.open("rb") as file:
        head = file.read(_LONGEST_LINE)
    wide = head.startswith((b"\xff\xfe", b"\xfe\xff"))
    if b"\0" in head and not wide:
        raise InputError(f"{path}: not a text file; give it the ending of its format")
    if len(head) == _LONGEST_LINE and not (b"\n" in head or b"\r" in head):
        raise InputError(
            f"{path}: its first line is longer than {_LONGEST_LINE // 2**20} MiB, so it is no table of lines; write a line "
            "for each sample, or give the file the ending of its format"
        )


def _plain(path: Path) -> Table | None:
    """Return the table of a tidy file, one header line and then numbers, without holding its lines; None if it is none."""
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        head = [line.rstrip("\r\n") for line in itertools.islice(file, _LOOK + 1)]
    if len(head) <= _LOOK or not all(map(str.strip, head)) or any(line.lstrip().startswith(COMMENT) for line in head):
        return None
    delimiter, decimal = _dialect(path, head)
    first, width = _fields(head[0], (delimiter, decimal)), _usual_width(head[1:], (delimiter, decimal))
    if decimal == "," or len(first) != width or any(_number(field, (delimiter, decimal)) is not None for field in first):
        return None
    try:
        values = np.loadtxt(path, delimiter=delimiter, skiprows=1, ndmin=2, comments=None, encoding="utf-8-sig")
    except (ValueError, UnicodeDecodeError):
        return None  # fields that are empty, quoted, dates or no numbers: line after line, to say where
    if len(values) != _count_lines(path) - 1:
        return None  # empty lines: they count where a line's number is said
    names, units = _names(path, first, width)
    filled = [i for i in range(width) if np.isfinite(values[:, i]).any() or names[i] in units]
    return Table(
        columns={names[i]: values[:, i].copy() for i in filled},
        units=units,
        rows=np.arange(2, len(values) + 2, dtype=np.int64),
        row_word="line",
    )


def _count_lines(path: Path) -> int:
    with path.open("rb") as file:
        pieces = iter(lambda: file.read(2**20), b"")
        last, lines = b"\n", 0
        for piece in pieces:
            lines, last = lines + piece.count(b"\n"), piece[-1:]
    return lines + (last != b"\n")


def _text(path: Path) -> str:
    """Return the text of a file: UTF-8, or the Latin alphabet of old loggers where it is not."""
    content = path.read_bytes()
    if b"\0" in content[:4096] and not content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise InputError(f"{path}: not a text file; give it the ending of its format")
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return content.decode("utf-16")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _dialect(path: Path, lines: list[str]) -> Dialect:
    """Return the dialect in which most lines under the first have equally many columns, most numbers and fewest words."""
    look = lines[1 : 1 + _LOOK] or lines
    best: tuple[int, Dialect] | None = None
    for dialect in DIALECTS:
        table = [_fields(line, dialect) for line in look]
        width = _usual_width(look, dialect)
        alike = sum(len(fields) == width for fields in table) >= _ALIKE * len(table)
        read = [_number(field, dialect) is not None for fields in table for field in fields if field.lower() not in MISSING]
        score = 2 * sum(read) - len(read)
        if alike and width > 1 and any(read) and (best is None or score > best[0]):
            best = (score, dialect)
    if best is None:
        raise InputError(
            f"{path}: no table of at least two columns of numbers, divided by comma, semicolon, tab or spaces; "
            "leave out lines before it with skip_rows"
        )
    return best[1]


def _dated(line: str, dialect: Dialect) -> list[int]:
    """Return the columns that hold dates."""
    return [i for i, field in enumerate(_fields(line, dialect)) if _DATE.match(field)]


def _usual_width(lines: list[str], dialect: Dialect) -> int:
    """Return the number of columns that most lines have."""
    return Counter(len(_fields(line, dialect)) for line in lines).most_common(1)[0][0]


def _fields(line: str, dialect: Dialect) -> list[str]:
    delimiter = dialect[0]
    fields = line.split() if delimiter is None else line.rstrip("\r\n").split(delimiter)
    return [field.strip().strip('"').strip() for field in fields]


def _number(field: str, dialect: Dialect) -> float | None:
    """Return the number in a field, or None."""
    if dialect[1] == ",":
        if "." in field:
            return None
        field = field.replace(",", ".")
    try:
        return _seconds(field) if _DATE.match(field) else float(field)
    except ValueError:
        return None


def _seconds(date: str) -> float:
    """Return the time of a date since 1970 [s], of UTC where it names no zone."""
    when = datetime.fromisoformat(date)
    return when.replace(tzinfo=when.tzinfo or UTC).timestamp()


def _commented_header(comments: list[str], width: int, dialect: Dialect) -> list[str]:
    """Return the names in the last comment, if it has one for each column; none otherwise."""
    if not comments:
        return []
    names = _fields(comments[-1], dialect)
    return names if len(names) == width and all(_number(n, dialect) is None for n in names) else []


def _names(path: Path, header: list[str], width: int) -> tuple[list[str], dict[str, str]]:
    if not header:
        return [str(i) for i in range(width)], {}
    pairs = [split_header(text) for text in header]
    names = [name or str(i) for i, (name, _) in enumerate(pairs)]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"{path}: column {name!r} is there {names.count(name)} times; give each its own name")
    return names, {name: unit for name, (_, unit) in zip(names, pairs, strict=True) if unit is not None}


def _values(path: Path, body: list[tuple[int, str]], width: int, dialect: Dialect) -> Array:
    delimiter, decimal = dialect
    text = "\n".join(line for _, line in body)
    try:
        fast = io.StringIO(text.replace(",", ".") if decimal == "," else text)
        values = np.loadtxt(fast, delimiter=delimiter, ndmin=2, comments=None, dtype=np.float64)
        if values.shape == (len(body), width):
            return values
    except ValueError:
        pass  # a field is empty, quoted or no number: one row after the other, to say where
    return _slow_values(path, body, width, dialect)


def _slow_values(path: Path, body: list[tuple[int, str]], width: int, dialect: Dialect) -> Array:
    """Return float64[n, width]: NaN for missing values and throughout columns that hold words."""
    values = np.full((len(body), width), np.nan)
    words: dict[int, tuple[int, str]] = {}
    for i, (number, line) in enumerate(body):
        fields = _fields(line, dialect)
        if len(fields) != width:
            raise InputError(f"{path}, line {number}: {len(fields)} columns instead of {width}; remove or correct the line")
        for j, field in enumerate(fields):
            result = _number(field, dialect)
            if result is not None:
                values[i, j] = result
            elif field.lower() not in MISSING:
                words.setdefault(j, (number, field))
    for j in _dated(body[0][1], dialect):
        values[:, j] -= values[0, j]
    for j, (number, field) in words.items():
        if np.isfinite(values[:, j]).any():
            row = next(i for i, (n, _) in enumerate(body) if n == number)
            only = not np.isfinite(values[row]).any()  # words alone, such as names below a preamble
            names = f", or give skip_rows = {number - 1} if the names of the columns stand in it" if only else ""
            raise InputError(
                f"{path}, line {number}, column {j + 1}: {field!r} is not a number; remove or correct the line{names}"
            )
    return values
