"""The conditions of a rendered picture: colours, textures, light, camera."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Look:
    """The conditions of a picture.

    Attributes:
        table: the table's colour, blue, green, red.
        cloth: the cloth's colour.
        wood: how strongly the table is grained, 0..1.
        pattern: "plain", "stripes" or "checks".
        shadow: how dark shadows are, 0..1.
        wrinkles: how strongly the cloth is wrinkled, 0..1.
        tilt_rad: how far the camera looks away from straight down (rad).
        height_m: how high over the table it is (m).
        noise: standard deviation of the noise (of 255).
        quality: of the JPEG.
        has_arm: whether an arm reaches into the picture.
        wobble_m: how far the cloth's edge deviates from straight (m).
        back: the colour of the cloth's back; None: that of its front.
    """

    table: tuple[float, float, float]
    cloth: tuple[float, float, float]
    wood: float = 0.3
    pattern: str = "plain"
    shadow: float = 0.3
    wrinkles: float = 0.3
    tilt_rad: float = 0.2
    height_m: float = 2.0
    noise: float = 4.0
    quality: int = 85
    has_arm: bool = False
    wobble_m: float = 0.0015
    back: tuple[float, float, float] | None = None


PLAIN = Look((124.0, 143.0, 163.0), (210.0, 230.0, 240.0), noise=3.0, back=(214.0, 195.0, 180.0))
"""A wooden table, and cloth that is lighter on both sides."""


def random_look(rng: np.random.Generator, *, has_arm: bool = False) -> Look:
    """Return a random look; the colours of table and cloth differ by at least 25 (of 255)."""
    while True:
        table, cloth = rng.uniform(30, 245, 3), rng.uniform(20, 250, 3)
        table = 0.6 * table.mean() + 0.4 * table
        if np.abs(table - cloth).max() >= 25.0:
            break
    return Look(
        (float(table[0]), float(table[1]), float(table[2])),
        (float(cloth[0]), float(cloth[1]), float(cloth[2])),
        wood=float(rng.uniform(0.0, 0.8)),
        pattern=str(rng.choice(["plain", "plain", "stripes", "checks"])),
        shadow=float(rng.uniform(0.0, 0.5)),
        wrinkles=float(rng.uniform(0.0, 0.6)),
        tilt_rad=float(rng.uniform(0.0, 0.45)),
        height_m=float(rng.uniform(1.7, 2.4)),
        noise=float(rng.uniform(1.0, 8.0)),
        quality=int(rng.integers(60, 95)),
        has_arm=has_arm,
        wobble_m=float(rng.uniform(0.0, 0.003)),
    )


FloatImage = NDArray[np.float32]


def wood(look: Look, side: int, rng: np.random.Generator) -> FloatImage:
    """Return a table of `side` pixels a side, grained along its rows: blue, green, red."""
    grain = stretched(rng, side, (20, 2), 2.0)
    knots = stretched(rng, side, (20, 20), 1.3)
    shade = 22 * look.wood * (grain / grain.std() + 0.6 * knots / knots.std())
    tint = np.array([0.7, 0.9, 1.0], np.float32)
    return np.asarray(np.asarray(look.table, np.float32) + shade[:, :, None] * tint, np.float32)


def stretched(rng: np.random.Generator, side: int, times: tuple[int, int], blur: float) -> FloatImage:
    """Return a square of noise, `side` pixels wide, blurred and then stretched across and down by factors."""
    across, down = times
    noise = rng.standard_normal((side // down + 1, side // across + 1), dtype=np.float32)
    if blur:
        noise = np.asarray(cv2.GaussianBlur(noise, (0, 0), blur), np.float32)
    return np.asarray(cv2.resize(noise, (side, side), interpolation=cv2.INTER_CUBIC), np.float32)


Image = NDArray[np.uint8]


def developed(taken: FloatImage, look: Look, rng: np.random.Generator) -> Image:
    """Return the picture of a scene, shape (height, width, 3); colours 0..255."""
    height, width = taken.shape[:2]
    across = np.linspace(-1, 1, width, dtype=np.float32)[None, :]
    down = np.linspace(-1, 1, height, dtype=np.float32)[:, None]
    light = 1.0 + rng.uniform(-0.12, 0.12) * across + rng.uniform(-0.12, 0.12) * down - 0.06 * (across**2 + down**2)
    lit = cv2.GaussianBlur(taken * light[:, :, None].astype(np.float32), (0, 0), 0.9)
    grainy = np.clip(lit + look.noise * rng.standard_normal(taken.shape, dtype=np.float32), 0, 255)
    return np.asarray(grainy, np.uint8)


def coded(image: Image, quality: int) -> bytes:
    """Return a picture as a JPEG."""
    _, data = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])
    return bytes(data)
