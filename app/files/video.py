"""Pictures as an MP4 video, where PyAV is installed."""

import io
from collections.abc import Sequence
from importlib.util import find_spec
from typing import Final

from PIL import Image

CODEC: Final = "h264"
PIXELS: Final = "yuv420p"
"""The form of its pixels: width and height must be even."""

_OPTIONS: Final = {"crf": "23", "g": "2", "bf": "0"}
"""A quarter of the size of JPEGs, and every second frame whole: learning reads frames in any order."""


def can_encode() -> bool:
    """Return whether PyAV is installed."""
    return find_spec("av") is not None


def mp4_video(jpegs: Sequence[bytes], size_px: tuple[int, int], fps: int) -> bytes:
    """Return JPEG pictures of an even width and height as a video, so many frames a second."""
    import av

    written = io.BytesIO()
    with av.open(written, "w", format="mp4") as file:
        stream = file.add_stream(CODEC, rate=fps, options=dict(_OPTIONS))
        stream.width, stream.height = size_px
        stream.pix_fmt = PIXELS
        for jpeg in jpegs:
            file.mux(stream.encode(av.VideoFrame.from_image(Image.open(io.BytesIO(jpeg)))))
        file.mux(stream.encode())
    return written.getvalue()
