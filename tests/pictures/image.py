"""Pictures as small files: at most 256 colors, which nobody sees of a screen, in a third of the bytes."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

from PIL import Image

_COLORS = 256


def write_image(png: bytes, path: Path | str, *, cut_top: int = 0) -> None:
    """Write a picture as a small PNG, without its first `cut_top` rows."""
    picture = Image.open(BytesIO(png)).convert("RGB")
    picture = picture.crop((0, cut_top, *picture.size))
    few = picture.quantize(_COLORS, method=Image.Quantize.MEDIANCUT, kmeans=4, dither=Image.Dither.NONE)
    few.save(path, format="PNG", optimize=True)
