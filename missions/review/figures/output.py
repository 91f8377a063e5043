"""Figures as files, and as parts of a page. The same figure is the same bytes."""

from __future__ import annotations

import re
from io import BytesIO
from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from missions.problems import InputError
from missions.study.style import DIM, GRID, INK, STYLE

FORMATS = (".png", ".svg")
# The page has variables of these names: on a dark page its figures are dark.
_PAGE_COLORS = {INK: "var(--ink)", DIM: "var(--dim)", GRID: "var(--line)"}
_PROLOG = re.compile(r"\A.*?(?=<svg)|<metadata>.*?</metadata>|<!--.*?-->", re.DOTALL)
_ID = re.compile(r' id="[A-Za-z0-9.]+_[0-9]+"')
_FONT = re.compile(r"font: [^;\"]*?([0-9.]+px) [^;\"]*")
_SIZE = re.compile(r'(<svg[^>]*?) (?:width|height)="[^"]*"')


def write_picture(figure: Figure, path: Path) -> None:
    """Write a figure as the file's name says.

    Raises:
        InputError: it says something else than PNG or SVG, or the file cannot be written.
    """
    if path.suffix.lower() not in FORMATS:
        raise InputError(f"--plot: got {path}; allowed: a file that ends with {' or '.join(FORMATS)}")
    try:
        path.write_bytes(_as_bytes(figure, path.suffix.lower().removeprefix(".")))
    except OSError as error:
        raise InputError(f"--plot: got {path}; allowed: a file that can be written ({error.strerror})") from error


def part_of_page(figure: Figure, *, about: str) -> str:
    """A figure as an SVG element that has the colors and the font of the page around it; `about` is read out loud."""
    svg = _PROLOG.sub("", _as_bytes(figure, "svg", transparent=True).decode())
    while (bare := _SIZE.sub(r"\1", svg)) != svg:  # as wide as the page
        svg = bare
    svg = _FONT.sub(r"font-size: \1", _ID.sub("", svg))
    for color, variable in _PAGE_COLORS.items():
        svg = re.sub(re.escape(color), variable, svg, flags=re.IGNORECASE)
    return svg.replace("<svg", f'<svg role="img" aria-label="{about}"', 1)


def _as_bytes(figure: Figure, kind: str, *, transparent: bool = False) -> bytes:
    out = BytesIO()
    metadata = {"Date": None} if kind == "svg" else {"Software": None}
    with mpl.rc_context(STYLE):
        figure.savefig(out, format=kind, metadata=metadata, transparent=transparent)
    return out.getvalue()
