"""Writes a page as SVG."""

from xml.sax.saxutils import escape

from app.files.sheet_page import Disc, Outline, Page, Shape, Words


def page_svg(page: Page) -> bytes:
    """Return the page as an SVG document, as large as it is on paper."""
    size = f'width="{page.width:g}pt" height="{page.height:g}pt" viewBox="0 0 {page.width:g} {page.height:g}"'
    lines = (
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="Helvetica, Arial, sans-serif">',
        f"<title>{_text(page.title)}</title>",
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        *map(_element, page.shapes),
        "</svg>",
    )
    return ("\n".join(lines) + "\n").encode("utf-8", "replace")


def _element(shape: Shape) -> str:
    match shape:
        case Outline(points, fill, stroke, width):
            d = "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in points) + ("Z" if fill else "")
            colours = f'fill="{_colour(fill)}" stroke="{_colour(stroke)}"'
            return f'<path d="{d}" {colours} stroke-width="{width:g}" stroke-linejoin="round"/>'
        case Disc((x, y), radius, fill, stroke):
            return (
                f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{radius:g}" fill="{_colour(fill)}" stroke="{_colour(stroke)}"/>'
            )
        case Words((x, y), text, size, is_bold, anchor):
            weight = ' font-weight="bold"' if is_bold else ""
            place = f'x="{x:.2f}" y="{y:.2f}" font-size="{size:g}" text-anchor="{anchor}"'
            return f"<text {place}{weight}>{_text(text)}</text>"


def _colour(colour: str) -> str:
    return f"#{colour}" if colour else "none"


def _text(text: str) -> str:
    return escape("".join(char if char.isprintable() else " " for char in text))
