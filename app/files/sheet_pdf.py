"""Writes a page as PDF, with its fonts inside.

The letters are those of DejaVu Sans: Latin, Greek, Cyrillic and more. Others are taken from a font of the system, where
there is one that has them; a letter that no font has becomes an empty square.
"""

import io
from functools import cache

from matplotlib.artist import Artist
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, fontManager, get_font
from matplotlib.ft2font import FT2Font
from matplotlib.patches import Circle, Polygon
from matplotlib.text import Text
from matplotlib.transforms import Affine2D, Transform

from app.files.sheet_page import Disc, Outline, Page, Shape, Words

_FAMILY = "DejaVu Sans"
_OTHERS = (
    "Noto Sans CJK SC",
    "Noto Sans CJK JP",
    "WenQuanYi Zen Hei",
    "Hiragino Sans",
    "Microsoft YaHei",
    "Malgun Gothic",
    "Arial Unicode MS",
)
"""Fonts of several systems with the letters that the first one lacks."""

_AS_HELVETICA = 0.88
"""The size at which DejaVu Sans is as wide as Helvetica, for which the sheet is laid out."""

_NO_LETTER = "\N{WHITE SQUARE}"
_PT = 72.0


def page_pdf(page: Page) -> bytes:
    """Return the page as a PDF document."""
    figure = Figure((page.width / _PT, page.height / _PT))
    from_top = Affine2D().scale(1.0 / _PT, -1.0 / _PT).translate(0.0, page.height / _PT) + figure.dpi_scale_trans
    for number, shape in enumerate(page.shapes):
        artist = _drawn(shape, from_top)
        artist.set_zorder(number)
        figure.add_artist(artist)
    written = io.BytesIO()
    about = {"Title": _printable(page.title), "Producer": "Pleat", "Creator": "Pleat", "CreationDate": None}
    FigureCanvasPdf(figure).print_pdf(written, metadata=about)
    return written.getvalue()


def _drawn(shape: Shape, from_top: Transform) -> Artist:
    match shape:
        case Outline(points, fill, stroke, width):
            return Polygon(
                points,
                closed=bool(fill),
                facecolor=_colour(fill),
                edgecolor=_colour(stroke),
                linewidth=width,
                joinstyle="round",
                transform=from_top,
            )
        case Disc(middle, radius, fill, stroke):
            return Circle(
                middle, radius, facecolor=_colour(fill), edgecolor=_colour(stroke), linewidth=1.0, transform=from_top
            )
        case Words((x, y), text, size, is_bold, anchor):
            weight = "bold" if is_bold else "normal"
            return Text(
                x,
                y,
                _shown(text, weight),
                fontproperties=FontProperties(family=list(_families()), size=_AS_HELVETICA * size, weight=weight),
                horizontalalignment="center" if anchor == "middle" else "left",
                verticalalignment="baseline",
                parse_math=False,
                transform=from_top,
            )


def _colour(colour: str) -> str:
    return f"#{colour}" if colour else "none"


@cache
def _families() -> tuple[str, ...]:
    """Return the fonts that are here, the first one first."""
    installed = set(fontManager.get_font_names())
    return (_FAMILY, *(name for name in _OTHERS if name in installed))


@cache
def _fonts(weight: str) -> tuple[FT2Font, ...]:
    found = (fontManager.findfont(FontProperties(family=[name], weight=weight)) for name in _families())
    return tuple(get_font(path) for path in found)


def _shown(text: str, weight: str) -> str:
    """Return a text whose letters all have a font."""
    fonts = _fonts(weight)
    return "".join(
        char if any(font.get_char_index(ord(char)) for font in fonts) else _NO_LETTER for char in _printable(text)
    )


def _printable(text: str) -> str:
    return "".join(char if char.isprintable() else " " for char in text)
