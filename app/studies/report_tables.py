"""The tables of a study's report."""

import math
from collections.abc import Iterable, Sequence
from html import escape

from app.studies.axis import Value
from app.studies.findings import Findings

EMPTY = "<td>-</td>"


def plain_table(caption: str, corner: str, heads: Sequence[str], rows: Iterable[tuple[str, Sequence[str]]]) -> str:
    """Return a table that scrolls sideways where the page is narrow.

    Args:
        caption: what it shows; "" for none.
        corner: the heading of the first column.
        heads: the headings of the others.
        rows: the first column's text, and the other cells as HTML.
    """
    told = f"<caption>{escape(caption)}</caption>" if caption else ""
    top = "".join(f'<th scope="col">{escape(head)}</th>' for head in (corner, *heads))
    body = "".join(f'<tr><th scope="row">{escape(name)}</th>{"".join(cells)}</tr>' for name, cells in rows)
    return f'<div class="wide"><table>{told}<thead><tr>{top}</tr></thead><tbody>{body}</tbody></table></div>'


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
