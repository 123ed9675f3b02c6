"""Writes a page as PDF 1.4: one page of paths and words, in the fonts that every reader has.

Those fonts have the letters of Western Europe; other letters become question marks.
"""

from itertools import accumulate

from app.files.sheet_page import Disc, Outline, Page, Shape, Words

_FONTS = ("Helvetica", "Helvetica-Bold")
_ROUND = 0.5523
"""How far the control points of a quarter circle are from its ends, in radii."""

_LETTER = 0.5
"""Width of an average letter of Helvetica, in its sizes, by which words are put in the middle."""


def page_pdf(page: Page) -> bytes:
    """Return the page as a PDF document."""
    content = "\n".join(["1 J 1 j", *(_drawn(shape, page.height) for shape in page.shapes)]).encode(
        "latin-1", "replace"
    )
    fonts = " ".join(f"/F{number} {number + 5} 0 R" for number in range(len(_FONTS)))
    objects = [
        b"<< /Type /Catalog /Pages 2 0 R >>",
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {page.width:g} {page.height:g}] /Contents 4 0 R "
        f"/Resources << /Font << {fonts} >> >> >>".encode("ascii"),
        b"<< /Length %d >>\nstream\n%b\nendstream" % (len(content), content),
        *(
            f"<< /Type /Font /Subtype /Type1 /BaseFont /{name} /Encoding /WinAnsiEncoding >>".encode("ascii")
            for name in _FONTS
        ),
        f"<< /Title ({_escaped(page.title)}) /Producer (Pleat) >>".encode("latin-1", "replace"),
    ]
    return _document(objects)


def _document(objects: list[bytes]) -> bytes:
    """Return a document of numbered objects: the first is its catalogue, the last tells about it."""
    head = b"%PDF-1.4\n"
    parts = [b"%d 0 obj\n%b\nendobj\n" % (number, body) for number, body in enumerate(objects, 1)]
    places = list(accumulate((len(part) for part in parts), initial=len(head)))
    table = b"".join(b"%010d 00000 n \n" % place for place in places[:-1])
    count = len(objects) + 1
    trailer = b"trailer\n<< /Size %d /Root 1 0 R /Info %d 0 R >>\nstartxref\n%d\n%%%%EOF\n" % (
        count,
        len(objects),
        places[-1],
    )
    return head + b"".join(parts) + b"xref\n0 %d\n0000000000 65535 f \n" % count + table + trailer


def _drawn(shape: Shape, height: float) -> str:
    match shape:
        case Outline(points, fill, stroke, width, dash):
            (x, y), *rest = [(x, height - y) for x, y in points]
            way = " ".join([f"{x:.2f} {y:.2f} m", *(f"{x:.2f} {y:.2f} l" for x, y in rest)])
            dashes = " ".join(f"{length:g}" for length in dash)
            return f"{_colours(fill, stroke)} {width:g} w [{dashes}] 0 d {way} {_painted(fill, stroke)}"
        case Disc((x, y), radius, fill, stroke):
            return f"{_colours(fill, stroke)} 1 w [] 0 d {_circle(x, height - y, radius)} {_painted(fill, stroke)}"
        case Words((x, y), text, size, is_bold, anchor):
            left = x - len(text) * _LETTER * size / 2 if anchor == "middle" else x
            font = f"/F{int(is_bold)} {size:g} Tf"
            return f"BT 0 g {font} {left:.2f} {height - y:.2f} Td ({_escaped(text)}) Tj ET"


def _circle(x: float, y: float, r: float) -> str:
    c = _ROUND * r
    return (
        f"{x + r:.2f} {y:.2f} m "
        f"{x + r:.2f} {y + c:.2f} {x + c:.2f} {y + r:.2f} {x:.2f} {y + r:.2f} c "
        f"{x - c:.2f} {y + r:.2f} {x - r:.2f} {y + c:.2f} {x - r:.2f} {y:.2f} c "
        f"{x - r:.2f} {y - c:.2f} {x - c:.2f} {y - r:.2f} {x:.2f} {y - r:.2f} c "
        f"{x + c:.2f} {y - r:.2f} {x + r:.2f} {y - c:.2f} {x + r:.2f} {y:.2f} c"
    )


def _colours(fill: str, stroke: str) -> str:
    inside = f"{_rgb(fill)} rg" if fill else ""
    return f"{inside} {_rgb(stroke)} RG" if stroke else inside


def _rgb(colour: str) -> str:
    return " ".join(f"{int(colour[at : at + 2], 16) / 255:.3f}" for at in (0, 2, 4))


def _painted(fill: str, stroke: str) -> str:
    """Return the operator that paints a path: filled and closed, lined, or both."""
    if fill:
        return "b" if stroke else "f"
    return "S"


def _escaped(text: str) -> str:
    plain = "".join(char if char.isprintable() else " " for char in text)
    return plain.replace("\\", r"\\").replace("(", r"\(").replace(")", r"\)")
