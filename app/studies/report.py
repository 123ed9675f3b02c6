"""The report of a study: one HTML file without scripts, that needs no network."""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from itertools import islice

from app.studies.axis import Value
from app.studies.findings import STATUSES, Findings
from app.studies.rehearsed import NOISE_AXIS
from app.studies.results import Results
from app.studies.study import Study

FILE = "report.html"

_ROWS = 100
"""The most garments, and the most flips, that are listed."""

_MAPS, _FIELDS = 28, 4_000
"""The most heat maps, and the most fields of one."""

_OPEN = 2
"""Heat maps that are shown unfolded."""

_BEST = 10
"""Combinations listed as the best."""

_TITLES = ("solved", "no plan", "out of budget", "failed")


def write_report(study: Study, results: Results) -> None:
    """Write the report into the results' folder; raises `OSError`."""
    page = report_page(Findings(study, results))
    (results.folder / FILE).write_text(page, encoding="utf-8")


def report_page(findings: Findings) -> str:
    """Return the report as HTML."""
    study = findings.study
    title = escape(study.title)
    body = "\n".join(
        part
        for parts in (
            _head(findings),
            _who_folds_what(findings),
            _what_holds(findings),
            _best(findings),
            _each_axis(findings),
            _heat_maps(findings),
            _flips(findings),
            _reasons(findings),
        )
        for part in parts
    )
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{title}</title><style>{STYLE}</style></head><body>\n{body}\n</body></html>\n"
    )


def _head(findings: Findings) -> Iterator[str]:
    study = findings.study
    varied = " x ".join(f"{len(axis.values)} {escape(axis.name)}" for axis in findings.axes)
    drawn = (
        "" if study.sample is None else f", {study.count:,} of {study.product:,} drawn with seed {study.sample.seed}"
    )
    yield f"<h1>{escape(study.title)}</h1><p>{varied}{drawn}.</p>"
    if len(findings.cells) < study.count:
        yield f"<p><strong>{len(findings.cells):,} of {study.count:,} cells have an answer so far.</strong></p>"
    counted = zip(findings.counts, _TITLES, strict=True)
    yield f'<ul class="counts">{"".join(f"<li><b>{count:,}</b>{what}</li>" for count, what in counted)}</ul>'
    fixed = [axis for axis in study.all_axes[1:] if len(axis.values) == 1]
    same = ", ".join(f"{escape(axis.name)} {escape(shown(axis.values[0]))}" for axis in fixed)
    yield f'<p class="faint">The same everywhere: {same}.</p>' if same else ""


def _who_folds_what(findings: Findings) -> Iterator[str]:
    """Yield garments by robots; with one robot, garments by the values of the first axis that varies."""
    if not len(findings.cells):
        return
    by = next((n for n, axis in enumerate(findings.axes) if axis.name == "robot"), min(1, len(findings.axes) - 1))
    garments, axis = findings.axes[0], findings.axes[by]
    yield "<h2>Who folds what</h2>"
    tally = findings.tally(0) if by == 0 else findings.tally(0, by)
    solved, cells, cost_s = (
        part.reshape(len(garments.values), -1) for part in (tally.solved, tally.cells, tally.cost_s)
    )
    heads = ["all"] if by == 0 else [shown(value) for value in axis.values]
    rows = (
        (shown(name), [share_cell(*field) for field in zip(solved[n], cells[n], cost_s[n], strict=True)])
        for n, name in enumerate(garments.values[:_ROWS])
    )
    more = "" if len(garments.values) <= _ROWS else f"; the first {_ROWS} of {len(garments.values)} garments"
    what = "all cells" if by == 0 else axis.name
    yield plain_table(f"Share of cells solved, and their mean time, by garment and {what}{more}", "", heads, rows)


def _what_holds(findings: Findings) -> Iterator[str]:
    """Yield the share of rehearsed runs that held, garments by noise."""
    rehearsal = findings.study.rehearsal
    if rehearsal is None or not len(findings.cells):
        return
    by = next((n for n, axis in enumerate(findings.axes) if axis.name == NOISE_AXIS), None)
    tally = findings.held_by(0) if by is None else findings.held_by(0, by)
    garments = findings.axes[0].values
    held, runs = (part.reshape(len(garments), -1) for part in (tally.solved, tally.cells))
    noise = next(axis.values for axis in findings.study.axes if axis.name == NOISE_AXIS)
    rows = (
        (shown(name), [share_cell(*field, math.nan, "runs") for field in zip(held[n], runs[n], strict=True)])
        for n, name in enumerate(garments[:_ROWS])
    )
    yield "<h2>What holds</h2>"
    how_many = (
        f"Share of rehearsed runs that held, {rehearsal.runs} of each plan from seed {rehearsal.seed}, by garment and"
    )
    yield plain_table(f"{how_many} noise", "", [shown(value) for value in noise], rows)


def _best(findings: Findings) -> Iterator[str]:
    if len(findings.axes) < 2 or not len(findings.cells):
        return
    axes = findings.axes[1:]
    yield "<h2>What folds most garments</h2>"
    rows = (
        (str(number), [*(_text(value) for value in values_of(findings, cell)[1:]), share_cell(solved, asked, cost_s)])
        for number, (cell, solved, asked, cost_s) in enumerate(findings.best(_BEST), 1)
    )
    heads = [*(axis.name for axis in axes), "garments folded"]
    yield plain_table("Combinations that fold the most garments; among equals the quicker first", "", heads, rows)


def _each_axis(findings: Findings) -> Iterator[str]:
    if len(findings.axes) > 1 and len(findings.cells):
        yield "<h2>Each quantity alone</h2>"
        for number, axis in enumerate(findings.axes[1:], 1):
            tally = findings.tally(number)
            fields = zip(tally.solved, tally.cells, tally.cost_s, strict=True)
            heads = [shown(value) for value in axis.values]
            yield plain_table("", axis.name, heads, [("solved", [share_cell(*field) for field in fields])])


def _heat_maps(findings: Findings) -> Iterator[str]:
    if len(findings.cells):
        for count, (one, other) in enumerate(islice(findings.pairs(_FIELDS), _MAPS)):
            if count == 0:
                yield "<h2>Two quantities at once</h2>"
            names = f"{escape(findings.axes[one].name)} and {escape(findings.axes[other].name)}"
            is_open = " open" if count < _OPEN else ""
            yield f"<details{is_open}><summary>{names}</summary>{_heat_map(findings, one, other)}</details>"


def _heat_map(findings: Findings, one: int, other: int) -> str:
    down, across = findings.axes[one], findings.axes[other]
    tally = findings.tally(one, other)
    rows = (
        (shown(value), [share_cell(*f) for f in zip(tally.solved[n], tally.cells[n], tally.cost_s[n], strict=True)])
        for n, value in enumerate(down.values)
    )
    corner = f"{down.name} \\ {across.name}"
    return plain_table("", corner, [shown(value) for value in across.values], rows)


def _flips(findings: Findings) -> Iterator[str]:
    """Yield where the answer turns between neighbours: how often between which values, and the cells."""
    if not findings.flips:
        return
    yield "<h2>Where it flips</h2>"
    yield "<p>Cells that differ by one step of one quantity, one solved and one with no plan.</p>"
    counts = Counter((flip.axis, flip.low) for flip in findings.flips)
    steps = (
        (axis.name, [_text(axis.values[low]), _text(axis.values[low + 1]), f"<td>{count:,}</td>"])
        for (number, low), count in sorted(counts.items())
        for axis in [findings.axes[number]]
    )
    yield plain_table("", "quantity", ["from", "to", "flips"], steps)
    listed = islice(findings.flips, _ROWS)
    rows = (
        (findings.axes[flip.axis].name, [_text(flip.solved), _text(flip.unsolved), *_cells_of(findings, flip.solved)])
        for flip in listed
    )
    heads = ["solved cell", "unsolved cell", *(axis.name for axis in findings.axes)]
    more = "" if len(findings.flips) <= _ROWS else f"; the first {_ROWS} of {len(findings.flips):,}"
    table = plain_table(f"The values are those of the solved cell{more}", "by a step of", heads, rows)
    yield f"<details><summary>The cells</summary>{table}</details>"
    yield "<p>The plan of a cell: <code>pleat study-plan DIR CELL --out FILE</code></p>"


def _cells_of(findings: Findings, cell: int) -> Iterable[str]:
    return [_text(value) for value in values_of(findings, cell)]


def _reasons(findings: Findings) -> Iterator[str]:
    if findings.reasons:
        without = findings.counts[STATUSES.index("infeasible")]
        yield "<h2>Why not</h2>"
        rows: Sequence[tuple[str, list[str]]] = [(code, [f"<td>{count:,}</td>"]) for code, count in findings.reasons]
        yield plain_table(f"Reasons given, in the {without:,} cells with no plan", "reason", ["cells"], rows)


def _text(value: float | int | str) -> str:
    return f'<td class="text">{escape(shown(value))}</td>'


EMPTY = "<td>-</td>"


def plain_table(caption: str, corner: str, heads: Sequence[str], rows: Iterable[tuple[str, Sequence[str]]]) -> str:
    """Return a table that scrolls sideways where the page is narrow.

    Args:
        caption: what it shows; "" for none.
        corner: the heading of the first column.
        heads: the headings of the others.
        rows: the first column's text, and the other cells as HTML.
    """
    title = f"<caption>{escape(caption)}</caption>" if caption else ""
    top = "".join(f'<th scope="col">{escape(head)}</th>' for head in (corner, *heads))
    body = "".join(f'<tr><th scope="row">{escape(name)}</th>{"".join(cells)}</tr>' for name, cells in rows)
    return f'<div class="wide"><table>{title}<thead><tr>{top}</tr></thead><tbody>{body}</tbody></table></div>'


def share_cell(solved: int, cells: int, cost_s: float, what: str = "cells") -> str:
    """Return a field coloured by the share of cells that are solved, with their mean time; or of something else."""
    if not cells:
        return EMPTY
    share = round(100 * solved / cells)
    time = f"<small>{cost_s:.1f} s</small>" if math.isfinite(cost_s) else ""
    return f'<td class="share" style="--share:{share}%" title="{solved} of {cells} {what}">{share}%{time}</td>'


def shown(value: Value) -> str:
    """Return a value as text."""
    return f"{value:g}" if isinstance(value, float) else str(value)


def values_of(findings: Findings, cell: int) -> Sequence[Value]:
    """Return a cell's values on the findings' axes."""
    by_axis = dict(zip((axis.name for axis in findings.study.all_axes), findings.study.digits(cell), strict=True))
    return [axis.values[by_axis[axis.name]] for axis in findings.axes]


STYLE = """
:root { color-scheme: light dark; --paper: #fbfaf7; --ink: #23262b; --faint: #6a6f78; --line: #d9d6cd;
  --yes: #79c39a; --no: #efe4dc; --part: #e9c46a; }
@media (prefers-color-scheme: dark) { :root { --paper: #16181c; --ink: #e7e6e2; --faint: #9aa0aa; --line: #363a42;
  --yes: #2d7a55; --no: #33292a; --part: #8a6d1f; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 72rem; padding: 1rem; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.5rem; margin: .5rem 0; } h2 { font-size: 1.15rem; margin: 2rem 0 .5rem; }
p { margin: .4rem 0; max-width: 60rem; } .faint { color: var(--faint); }
.wide { overflow-x: auto; margin: .5rem 0 1rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--faint); padding: .25rem 0; }
th, td { padding: .25rem .6rem; text-align: right; border: 1px solid var(--line); white-space: nowrap; }
th { font-weight: 600; } th:first-child, td.text { text-align: left; }
td small { display: block; color: var(--faint); }
td.share { background: color-mix(in oklab, var(--yes) var(--share), var(--no)); min-width: 3.6rem; }
td.share small { color: inherit; opacity: .75; }
ul.counts { display: flex; flex-wrap: wrap; gap: .5rem; list-style: none; padding: 0; margin: 1rem 0; }
ul.counts li { border: 1px solid var(--line); border-radius: .5rem; padding: .4rem .8rem; }
ul.counts b { display: block; font-size: 1.3rem; }
details { border-top: 1px solid var(--line); padding: .4rem 0; } summary { cursor: pointer; }
code { background: var(--no); padding: .1rem .3rem; border-radius: .25rem; overflow-wrap: anywhere; }
"""
