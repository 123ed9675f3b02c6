"""Films of a plan as MP4 and GIF, and a still picture of it, painted without a browser.

The camera follows the work as in the 3D view. Title and time stand above, what is being done below; at the end the
packet is shown for a moment, with its size.
"""

import io
from collections.abc import Iterator
from pathlib import Path

import matplotlib as mpl
from PIL import Image, ImageDraw, ImageFont

from app.files.export import RATES_HZ
from app.files.video import mp4_video
from app.language import Language, numeral, translated
from app.step_kinds import step_caption
from app.ui.colours import DARK, LIGHT
from app.ui.scene_picture import ScenePainter
from app.ui.viewpoints.following import Following, work_of
from app.ui.viewpoints.presets import Lens
from app.ui.withdrawal import withdrawn
from planner.deadline import ShouldStop
from planner.errors import UnsolvedPlanError
from planner.motion.timeline import Timeline
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan

FILM_PX, GIF_PX, STILL_PX = (960, 540), (480, 270), (1200, 630)
"""Widths and heights; the still's is that of pictures beside links."""

HOLD_S = 2.0
"""Time for which the packet is shown at the end (s)."""

_COLOURS = 128
"""Colours of a GIF."""


def mp4_film(plan: Plan, rate_hz: float, should_stop: ShouldStop, language: Language, *, is_dark: bool) -> bytes:
    """Return a solved plan as an MP4 video, at a whole number of frames a second; empty if stopped."""
    fps = max(round(RATES_HZ[0]), round(rate_hz))
    frames = _Film(plan, FILM_PX, language, is_dark=is_dark).frames(float(fps), should_stop)
    return _unless_stopped(mp4_video(frames, FILM_PX, fps, whole_every=10 * fps), should_stop)


def gif_film(plan: Plan, rate_hz: float, should_stop: ShouldStop, language: Language, *, is_dark: bool) -> bytes:
    """Return a solved plan as a GIF that plays for ever; empty if stopped."""
    frames = _Film(plan, GIF_PX, language, is_dark=is_dark).frames(rate_hz, should_stop)
    first = next(frames).quantize(_COLOURS)
    rest = (frame.quantize(palette=first, dither=Image.Dither.NONE) for frame in frames)
    written = io.BytesIO()
    first.save(written, "GIF", save_all=True, append_images=rest, duration=round(1000.0 / rate_hz), loop=0)
    return _unless_stopped(written.getvalue(), should_stop)


def still(plan: Plan, language: Language, *, is_dark: bool) -> bytes:
    """Return a picture of a solved plan in the middle of its last fold as a PNG, with its title."""
    return _Film(plan, STILL_PX, language, is_dark=is_dark).still()


class _Film:
    """Paints the frames of a plan."""

    def __init__(self, plan: Plan, size_px: tuple[int, int], language: Language, *, is_dark: bool) -> None:
        if not plan.is_solved:
            raise UnsolvedPlanError(plan.status)
        card = self._card = load_robot(plan.task.robot).card
        self._plan, self._size_px, self._language = plan, size_px, language
        self._timeline = Timeline.of(plan)
        self._painter = ScenePainter(card, plan.scene, DARK if is_dark else LIGHT)
        self._ink = (236, 235, 230) if is_dark else (29, 31, 35)
        self._title = f"{translated(language, plan.garment.title)} · {card.title}"

    def frames(self, rate_hz: float, should_stop: ShouldStop) -> Iterator[Image.Image]:
        """Yield the pictures, so many a second, until it should stop."""
        camera, lens, end_s = Following(), Lens(self._size_px[0] / self._size_px[1]), self._plan.cost_s or 0.0
        frames = list(self._timeline.samples(rate_hz))
        frames += [withdrawn(self._card, frames[-1], n / rate_hz) for n in range(1, round(HOLD_S * rate_hz) + 1)]
        for number, frame in enumerate(frames):
            if number and should_stop():
                return
            is_over = number / rate_hz >= end_s
            seen = camera.view(frame.base, work_of(self._plan, frame.t_s), lens, is_over=is_over)
            picture = self._painter.picture(frame, self._plan.garment.layer_m, seen, self._size_px)
            caption = self._packet if is_over else step_caption(self._plan, frame.primitive, self._language)
            yield self._captioned(picture, caption, frame.t_s)

    def still(self) -> bytes:
        """Return the picture in the middle of the last step with hands, as a PNG."""
        step = [step for step in self._plan.steps if step.grips][-1]
        frame = self._timeline.at((step.start_s + step.end_s) / 2)
        camera, lens = Following(), Lens(self._size_px[0] / self._size_px[1])
        seen = camera.view(frame.base, work_of(self._plan, frame.t_s), lens)
        picture = self._painter.picture(frame, self._plan.garment.layer_m, seen, self._size_px)
        written = io.BytesIO()
        self._captioned(picture, self._packet, self._plan.cost_s or 0.0).save(written, "PNG", optimize=True)
        return written.getvalue()

    @property
    def _packet(self) -> str:
        x0, y0, x1, y1 = self._plan.sequence.final.silhouette.bounds
        return " x ".join(numeral(self._language, 100.0 * side, 0) for side in (x1 - x0, y1 - y0)) + " cm"

    def _captioned(self, picture: Image.Image, caption: str, t_s: float) -> Image.Image:
        """Return a picture with the title and the time above, and a caption below."""
        width, height = self._size_px
        margin, brush = height // 24, ImageDraw.Draw(picture)
        large, small = (ImageFont.truetype(_FONT, height // share) for share in (22, 27))
        brush.text((margin, margin), self._title, self._ink, large)
        brush.text((width - margin, margin), f"{numeral(self._language, t_s, 1)} s", self._ink, small, anchor="ra")
        brush.text((margin, height - margin), caption, self._ink, small, anchor="ls")
        return picture


_FONT = Path(mpl.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"


def _unless_stopped(made: bytes, should_stop: ShouldStop) -> bytes:
    return b"" if should_stop() else made
