"""Colours of blocks as files have them."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt


def hex_of(red: int, green: int, blue: int) -> str:
    """Return the colour with these parts of 255 as "#rrggbb"."""
    return "#" + "".join(f"{min(max(int(part), 0), 255):02x}" for part in (red, green, blue))


def parts_of(colour: str) -> tuple[int, int, int]:
    """Return the parts of 255 of "#rrggbb"; white for no colour."""
    red, green, blue = bytes.fromhex((colour or "#ffffff")[1:])
    return red, green, blue


def common(rows: npt.NDArray[np.uint8]) -> str:
    """Return the colour that all vertices (n, 3) have; empty where they differ or are plain white."""
    if len(rows) == 0 or (rows != rows[0]).any() or (rows[0] == 255).all():
        return ""
    return hex_of(*rows[0].tolist())


def of_linear(factors: Sequence[float]) -> str:
    """Return the colour of linear parts of one, as glTF has them (IEC 61966-2-1); empty for white."""
    linear = np.clip(np.asarray(factors[:3], dtype=np.float64), 0.0, 1.0)
    parts = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)
    return common(np.round(255.0 * parts).astype(np.uint8).reshape(1, 3))


def linear_of(colour: str) -> tuple[float, ...]:
    """Return the linear parts of one of "#rrggbb" (IEC 61966-2-1)."""
    parts = np.array(parts_of(colour)) / 255.0
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return tuple(linear.tolist())


def known(colour: str) -> str:
    """Return a text that is a colour, "#rrggbb", in small letters; empty for any other."""
    return colour.lower() if re.fullmatch(r"#[0-9a-fA-F]{6}", colour) else ""
