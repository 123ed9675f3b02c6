"""What of an SVG drawing is seen: an outline is a line or an area that shows on the paper, and not the paper."""

import numpy as np
import pytest

from app.files.import_errors import ImportedFileError
from app.files.import_file import import_file
from app.files.sketch_garment import Imported

PIECE = '<polygon points="5,5 45,5 45,35 5,35" fill="none" stroke="#222222"/>'
FOLD = '<line x1="25" y1="5" x2="25" y2="35" stroke="#0000ff"/>'


def svg(*shapes: str, more: str = "", size: str = 'width="50cm" height="40cm" viewBox="0 0 50 40"') -> bytes:
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} {more}>{"".join(shapes)}</svg>'.encode()


def read(*shapes: str, more: str = "") -> Imported:
    return import_file("piece.svg", svg(*shapes, more=more))


def sides(imported: Imported) -> tuple[float, float]:
    width, height = np.ptp(np.array(imported.garment.outline), axis=0).tolist()
    return (round(width, 6), round(height, 6))


@pytest.mark.parametrize(
    "page",
    [
        '<rect width="100%" height="100%" fill="#ffffff"/>',
        '<rect width="50" height="40" fill="white"/>',
        '<rect x="0" y="0" width="50" height="40" style="fill: #f8f8f8; stroke: none"/>',
        '<rect x="-10%" y="-10%" width="120%" height="120%" fill="white"/>',
        '<path d="M 25 40 L 0 40 L 0 0 L 50 0 L 50 40 Z" fill="rgb(255, 255, 255)"/>',
        '<g fill="#fff"><g><rect width="50" height="40"/></g></g>',
        '<style>.page { fill: color(display-p3 1 1 1) }</style><rect class="page" width="100%" height="100%"/>',
        '<rect width="50" height="40" fill="#dde7ee"/>',
        '<rect width="50" height="40" fill="white" stroke="white"/>',
        '<rect width="50" height="40" fill="none" stroke="black"/>',
        '<rect x=".05" y=".05" width="49.9" height="39.9" fill="white" stroke="#ccc"/>',
        '<rect width="25" height="40" fill="white"/><rect x="25" width="25" height="40" fill="white"/>',
    ],
    ids=range(12),
)
def test_the_page_is_no_outline(page: str) -> None:
    found = read(page, PIECE, FOLD)
    assert sides(found) == (0.4, 0.3)
    assert [fold.kind for fold in found.garment.folds] == ["blue"]
    assert not any("does not fit" in note.text for note in found.notes)


def test_a_page_with_an_edge_is_no_outline_of_what_open_lines_draw() -> None:
    page, lines = '<rect width="50" height="40" fill="none" stroke="black"/>', '<g stroke="black">{}</g>'
    piece = '<path d="M 5 5 H 45 V 35" fill="none"/><path d="M 45 35 H 5 V 5" fill="none"/>'
    assert sides(read(page, lines.format(piece), FOLD)) == (0.4, 0.3)
    assert sides(read(page, lines.format('<line x1="9" y1="9" x2="9" y2="30"/>'))) == (0.5, 0.4)


FRAME = '<rect x="1" y="1" width="48" height="38" fill="none" stroke="black"/>'


@pytest.mark.parametrize(
    "frame",
    [
        FRAME,
        '<path d="M 49 39 H 1 V 1 H 49 Z" fill="none" stroke="#888"/>',
        '<rect x="2.1" y="2" width="45.9" height="36" fill="white" stroke="black"/>',
        '<rect x="1" y="1" width="48" height="38" rx="1" fill="none" stroke="navy"/>',
        f'<rect width="100%" height="100%" fill="white"/>{FRAME}',
        f'<rect width="50" height="40" fill="none" stroke="black"/>{FRAME}',
        f'{FRAME}<path d="M 42 36 H 48 V 38 H 42 Z M 42 37 H 48" fill="none" stroke="black"/>',
    ],
    ids=range(7),
)
def test_a_frame_a_little_inside_of_the_page_is_no_outline(frame: str) -> None:
    found = read(frame, PIECE, FOLD)
    assert sides(found) == (0.4, 0.3)
    assert [fold.kind for fold in found.garment.folds] == ["blue"]


def test_a_frame_is_no_outline_of_what_open_lines_draw() -> None:
    lines = '<g stroke="black" fill="none"><path d="M 5 5 H 45 V 35"/><path d="M 45 35 H 5 V 5"/></g>'
    assert sides(read(FRAME, lines, FOLD)) == (0.4, 0.3)
    block = '<g stroke="black" fill="none"><path d="M 42 36 H 48 V 38 H 42 Z"/><path d="M 42 37 H 48"/></g>'
    assert sides(read(FRAME, block, lines, FOLD)) == (0.4, 0.3)
    for grid in ("M 25 5 V 35 M 5 20 H 45", "M 20 5 V 35 M 30 5 V 35 M 5 15 H 45 M 5 25 H 45"):
        assert sides(read(FRAME, f'<path d="{grid}" stroke="black" fill="none"/>')) == (0.48, 0.38)


def test_a_legend_beside_the_garment_does_not_make_its_frame_the_outline() -> None:
    legend = '<path d="M 3 37 H 6 M 8 37 H 11" stroke="blue"/>'
    assert sides(read(FRAME, PIECE, FOLD, legend)) == (0.4, 0.3)


@pytest.mark.parametrize(
    "inner",
    [
        "",
        '<line x1="25" y1="1" x2="25" y2="39" stroke="blue"/>',
        '<line x1="25" y1="3" x2="25" y2="37" stroke="blue"/><line x1="3" y1="20" x2="24" y2="20" stroke="red"/>',
        '<line x1="25" y1="0" x2="25" y2="40" stroke="blue"/>',
        '<line x1="25" y1="1" x2="25" y2="39" stroke="black"/>',
        '<rect x="2" y="2" width="46" height="36" fill="none" stroke="black" stroke-dasharray="1"/>',
        '<circle cx="9" cy="9" r="3" stroke="black"/>',
        '<rect x="20" y="8" width="10" height="12" stroke="gray"/><path d="M 25 1 V 39" stroke="blue"/>',
        '<rect x="4" y="4" width="12" height="12" stroke="gray"/><path d="M 25 3 V 37" stroke="blue"/>',
    ],
    ids=range(9),
)
def test_a_towel_that_its_page_fits_with_a_margin_stays_the_outline(inner: str) -> None:
    assert max(sides(read(FRAME, inner))) >= 0.46


@pytest.mark.parametrize(
    "other",
    [
        '<rect x="1" y="1" width="40" height="38" fill="none" stroke="black"/>',
        '<rect x="5.5" y="5.5" width="39" height="29" fill="none" stroke="black"/>',
        '<rect x="1" y="1" width="48" height="38" fill="#dca" stroke="black"/>',
        '<path d="M 1 1 H 49 V 30 L 40 39 H 1 Z" fill="none" stroke="black"/>',
        f'{FRAME}<circle cx="45" cy="38" r="1.9" stroke="black"/>',
    ],
    ids=range(5),
)
def test_what_is_unlike_a_frame_stays_the_outline(other: str) -> None:
    found = read(other, '<rect x="8" y="8" width="20" height="20" fill="none" stroke="black"/>')
    assert max(sides(found)) >= 0.39


def test_what_an_all_black_mask_hides_is_not_seen() -> None:
    mask = '<mask id="m"><rect width="50" height="40" fill="{}"/></mask>'
    box = '<rect x="1" y="1" width="48" height="38" fill="#555" mask="url(#m)"/>'
    assert sides(read(mask.format("black"), box, PIECE)) == (0.4, 0.3)
    assert sides(read(mask.format("white"), box, PIECE)) == (0.48, 0.38)
    assert sides(read('<mask id="m"><text>A</text></mask>', box, PIECE)) == (0.48, 0.38)


def test_open_lines_that_make_the_outline_are_not_said_to_be_no_folds() -> None:
    lines = ["5,5 45,5", "45,5 45,35", "45,35 5,35", "5,35 5,5", "5,35 5,5"]
    drawn = [f'<polyline points="{line}" fill="none" stroke="black"/>' for line in lines]
    assert not any("no fold" in note.text for note in read(*drawn).notes)
    found = read(*drawn, '<polyline points="25,5 25,35" fill="none" stroke="black"/>')
    assert [note.text[:11] for note in found.notes if "no fold" in note.text] == ["1 open line"]


def test_a_page_without_a_view_box_is_as_large_as_the_sheet() -> None:
    rect = (
        '<rect width="100%" height="100%" fill="white"/><rect x="10" y="10" width="300" height="200" stroke="black"/>'
    )
    found = import_file("piece.svg", svg(rect, size='width="10cm" height="10cm"'), "mm")
    assert sides(found) == (0.3, 0.2)


def test_what_fills_its_sheet_is_the_outline_if_there_is_no_other() -> None:
    assert sides(read('<rect width="100%" height="100%" fill="white"/>')) == (0.5, 0.4)
    assert sides(
        read('<rect width="50" height="40" stroke="black"/>', '<circle cx="9" cy="9" r="3" stroke="red"/>')
    ) == (
        0.5,
        0.4,
    )


def test_white_cloth_is_seen_on_a_dark_page() -> None:
    page = '<rect width="100%" height="100%" fill="#333"/>'
    assert sides(read(page, '<rect x="5" y="5" width="30" height="20" fill="white"/>')) == (0.3, 0.2)


@pytest.mark.parametrize(
    "attributes",
    [
        'fill="none" stroke="none"',
        'fill="none"',
        'style="fill: none; stroke: none"',
        'opacity="0"',
        'style="opacity: 0.0"',
        'fill="transparent"',
        'fill="rgba(0, 0, 0, 0)"',
        'fill="#0000"',
        'fill="rgb(0 0 0 / 0%)" stroke="#ff000000"',
        'fill="none" stroke="black" stroke-width="0"',
        'fill="none" stroke="black" stroke-opacity="0"',
        'fill-opacity="0"',
        'display="none"',
        'style="visibility: hidden"',
        'class="BoundingBox"',
        'fill="white"',
        'clip-path="url(#aside)"',
    ],
)
def test_what_cannot_be_seen_is_no_outline(attributes: str) -> None:
    style = "<style>.BoundingBox { stroke: none; fill: none }</style>"
    clip = '<clipPath id="aside"><rect x="60" y="0" width="9" height="9"/></clipPath>'
    box = f'<rect {attributes} x="2" y="2" width="46" height="36"/>'
    found = read(style, clip, f"<g>{box}</g>", PIECE, FOLD)
    assert sides(found) == (0.4, 0.3)
    assert not any("other closed line" in note.text for note in found.notes if attributes != 'fill="white"')


def test_a_group_that_cannot_be_seen_hides_its_lines() -> None:
    hidden = '<g opacity="0"><rect x="1" y="1" width="48" height="38" stroke="black"/></g>'
    fold = '<g style="stroke-opacity: 0"><line x1="15" y1="5" x2="15" y2="35" stroke="blue"/></g>'
    found = read(hidden, fold, PIECE)
    assert sides(found) == (0.4, 0.3) and found.garment.folds == ()


def test_an_outline_ends_where_it_is_clipped() -> None:
    clip = '<clipPath id="c"><rect x="10" y="5" width="20" height="100"/></clipPath>'
    found = read(clip, f'<g clip-path="url(#c)">{PIECE}</g>')
    assert sides(found) == (0.2, 0.3)
    # As Figma exports a frame: the clip is the page, and changes nothing.
    page = '<defs><clipPath id="p"><rect width="50" height="40" fill="white"/></clipPath></defs>'
    assert sides(read(page, f'<g clip-path="url(#p)">{PIECE}</g>')) == (0.4, 0.3)


def test_a_drawing_with_nothing_to_be_seen_is_refused() -> None:
    with pytest.raises(ImportedFileError, match="nothing drawn"):
        read('<rect x="5" y="5" width="30" height="20" fill="none"/>')


def test_percentages_are_of_the_viewport_around_them() -> None:
    # 80 % of 50 by 75 % of 40; then half of a nested drawing that is 20 by 10 and drawn twice as large.
    assert sides(read('<rect x="10%" y="10%" width="80%" height="75%"/>')) == (0.4, 0.3)
    nested = '<svg x="5" y="5" width="40" height="20" viewBox="0 0 20 10"><rect width="50%" height="50%"/></svg>'
    assert sides(read(nested)) == (0.2, 0.1)
    line = '<line x1="50%" y1="12.5%" x2="50%" y2="87.5%" stroke="blue"/>'
    fold = read(PIECE, line).garment.folds[0]
    assert np.allclose([fold.start, fold.end], [(0.2, 0.3), (0.2, 0.0)])
    circle = read('<circle cx="50%" cy="50%" r="10%"/>')
    assert sides(circle)[0] == pytest.approx(0.2 * np.hypot(0.5, 0.4) / np.sqrt(2.0), abs=1e-3)


@pytest.mark.parametrize(
    "sheet",
    [
        "#folds path { stroke: #0000ff } #outline path { stroke: #000; fill: none }",
        "#folds > path { stroke: blue }",
        "svg g.late path { stroke: navy }",
        "g g path { stroke: #00f } #outline path { stroke: black }",
        "svg > g > .late { stroke: lightskyblue } #folds * { stroke: royalblue }",
        "path[id=middle] { stroke: color(display-p3 0 0 1) }",
        'path[data-kind^="fo"] { stroke: color(display-p3 0.0000 0.0000 1.0000 / 1) }',
        ":root .late path { stroke: hwb(240 0% 0%) }",
        "#folds path { stroke: blue !important } .late path#middle { stroke: black }",
        "@media screen { #folds path { stroke: blue } }",
        "#folds { color: blue } #folds path { stroke: currentColor }",
        "path:hover { stroke: red } #folds path:first-child { stroke: red } #folds path { stroke: #00F }",
    ],
    ids=range(12),
)
def test_style_sheets_reach_lines_through_what_is_around_them(sheet: str) -> None:
    outline = '<g id="outline"><path d="M5 5H45V35H5Z"/></g>'
    folds = '<g id="folds" class="late"><g class="late"><path id="middle" data-kind="fold" d="M25 5V35"/></g></g>'
    flat = folds.replace('<g class="late">', "", 1).replace("</g></g>", "</g>")
    found = read(f"<style>{sheet}</style>", outline, folds if "g g path" in sheet else flat)
    assert [fold.kind for fold in found.garment.folds] == ["blue"]
    assert sides(found) == (0.4, 0.3)


def test_a_selector_asks_for_all_of_its_steps() -> None:
    sheet = "<style>#folds .a > path { stroke: blue } g { stroke: none; fill: none }</style>"
    near = '<g id="folds"><g class="a"><path d="M25 5V35"/></g><g class="a"><g><path d="M15 5V35"/></g></g></g>'
    far = '<g class="a"><path d="M35 5V35"/></g>'
    found = read(sheet, PIECE, near, far)
    assert [fold.start[0] for fold in found.garment.folds] == pytest.approx([0.2])


@pytest.mark.parametrize(
    ("paint", "kind"),
    [
        ("lightskyblue", "blue"),
        ("slateblue", "blue"),
        ("salmon", "red"),
        ("MAROON", "red"),
        ("color(srgb 0.1 0.2 0.9)", "blue"),
        ("color(display-p3 1 0 0)", "red"),
        ("rgb(0 0 255 / 50%)", "blue"),
        ("#00f icc-color(cmyk, 1, 1, 0, 0)", "blue"),
        ("hwb(0 10% 10%)", "red"),
        ("forestgreen", None),
        ("color(xyz 0.18 0.07 0.95)", "blue"),
        ("color(xyz-d50 0.436 0.222 0.014)", "red"),
        ("color(srgb-linear 0.02 0.02 0.8)", "blue"),
        ("color(own 0.1 0.2 0.9)", None),
        ("oklch(0.45 0.31 264)", "blue"),
        ("oklch(45.2% 78% 264.05deg / 0.9)", "blue"),
        ("OKLCH(62.8% 0.2577 29.23)", "red"),
        ("oklch(0.6 0.4 0.08turn)", "red"),
        ("oklch(0.6 0 264)", None),
        ("oklch(60% 0.2 142)", None),
        ("oklab(0.452 -0.032 -0.312)", "blue"),
        ("oklab(62.8% 56.2% 31.5%)", "red"),
        ("lab(29.57 68.3 -112.03)", "blue"),
        ("lab(54.29% 64.6% 55.9%)", "red"),
        ("lch(29.57 131.2 301.4)", "blue"),
        ("lch(54.3% 71% 40.85deg / 80%)", "red"),
        ("lch(50 none none)", None),
        ("hsl(240 100% 50%)", "blue"),
        ("hsl(240deg, 80%, 40%)", "blue"),
        ("hsla(0.6667turn 100% 40% / 1)", "blue"),
        ("hsl(4.19rad 90% 50%)", "blue"),
        ("hsl(0 100 50)", "red"),
        ("hwb(266.7grad 0% 20%)", "blue"),
        ("var(--own, oklch(0.45 0.31 264))", "blue"),
        ("light-dark(red, rgb(0, 0, 255))", "red"),
        ("color-mix(in oklab, oklch(54.6% 0.245 262.9) 50%, transparent)", "blue"),
        ("color-mix(in srgb, white, 80% rgb(255 0 0))", "red"),
        ("color-mix(in srgb, rgb(100%, 0%, 0%), black 10%)", "red"),
        ("color-mix(in srgb, red 5%, black)", None),
        ("color-mix(in srgb, own, red)", None),
        ("color-mix(in srgb, transparent, transparent)", None),
        ("color-mix(in srgb, red", None),
        ("url(#gradient)", None),
    ],
)
def test_a_line_is_a_fold_by_its_colour_however_that_is_written(paint: str, kind: str | None) -> None:
    drawn = f'<path d="M 15 5 V 35" style="stroke: {paint}" fill="none"/>'
    kinds = [fold.kind for fold in read(PIECE, FOLD, drawn).garment.folds]
    assert kinds == (["blue"] if kind is None else ["blue", kind])


@pytest.mark.parametrize(
    ("sheet", "more", "paint", "kind"),
    [
        (":root { --fold: #f00 }", "", "var(--fold)", "red"),
        ("svg { --fold: oklch(0.63 0.26 29) }", "", "var( --fold , blue)", "red"),
        ("", 'style="--fold: red"', "var(--fold)", "red"),
        (":root { --ink: Red; --fold: var(--ink) }", "", "var(--fold)", "red"),
        (":root { --Fold: blue; --fold: red }", "", "var(--fold)", "red"),
        (":root { --Fold: red; --fold: blue }", "", "VAR(--Fold)", "red"),
        (":root { --parts: 255, 0, 0 }", "", "rgb(var(--parts))", "red"),
        (":root { --fold: blue } g { --fold: red !important }", "", "var(--fold)", "red"),
        (":root { --ink: red; --fold: blue } g { --fold: initial }", "", "var(--fold, var(--ink))", "red"),
        (":root { --fold: red; } g { --fold: inherit }", "", "var(--fold)", "red"),
        (":root { --one: var(--two); --two: var(--one) }", "", "var(--one, red)", "red"),
        (":root { --one: var(--one) }", "", "var(--one)", None),
        ("", "", "var(--none)", None),
        ("", "", "var(--none,)", None),
        ("", "", "var(--none", None),
        ("g { stroke: red }", "", "var(--none)", "red"),
    ],
    ids=range(16),
)
def test_a_colour_may_be_a_variable(sheet: str, more: str, paint: str, kind: str | None) -> None:
    for drawn in (f'stroke="{paint}"', f'style="stroke: {paint}"'):
        line = f'<g><path d="M 15 5 V 35" {drawn} fill="none"/></g>'
        kinds = [fold.kind for fold in read(f"<style>{sheet}</style>", PIECE, FOLD, line, more=more).garment.folds]
        assert kinds == (["blue"] if kind is None else ["blue", kind])


def test_a_variable_counts_in_a_mask_as_where_the_mask_stands() -> None:
    mask = '<g style="--paper: white"><mask id="m"><rect width="50" height="40" fill="var(--paper)"/></mask></g>'
    assert sides(read(mask, '<rect x="1" y="1" width="48" height="38" fill="#555" mask="url(#m)"/>')) == (0.48, 0.38)


@pytest.mark.parametrize("value", ["var(--n{0}) var(--n{0})", "var(--n{0}, var(--n{0}))", "var(--n{0})"])
def test_variables_that_multiply_each_other_take_no_time(value: str) -> None:
    declared = "; ".join(f"--n{n}: {value.format(n - 1)}" for n in range(1, 100))
    for first in ("--n0:;", "--n0: red;", ""):
        line = '<path d="M 15 5 V 35" stroke="var(--n99, red)" fill="none"/>' * 100
        found = read(f"<style>* {{ {first} {declared} }}</style>", PIECE, FOLD, line)
        assert found.garment.folds[0].kind == "blue"


def test_a_drawing_with_too_many_variables_is_refused() -> None:
    paints = "".join(f'<path stroke="var(--n{n})"/>' for n in range(201))
    with pytest.raises(ImportedFileError, match="more than 200 variables"):
        read(paints, PIECE)
