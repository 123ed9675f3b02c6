"""Turn the light that falls into a camera into a picture: uneven light, blur and noise."""

import cv2
import numpy as np
from numpy.typing import NDArray

from app.rehearsal.camera.look import Look
from app.rehearsal.camera.texture import FloatImage

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
