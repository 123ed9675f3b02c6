"""A benchmark's result: a table for people, and JSON for programs."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.table import Table
from rich.text import Text

from bench.environment import environment

ABSENT = "-"


@dataclass(frozen=True, slots=True)
class Row:
    """The entry of one subject in a report.

    Attributes:
        lines: the printed lines, each with as many cells as the report has columns.
        data: the same as JSON.
    """

    lines: tuple[tuple[str, ...], ...]
    data: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Report:
    """A benchmark's result.

    Attributes:
        name: a short name, also of the file.
        title: what is compared, in a sentence.
        columns: headings, with units; the first is text, the others are numbers.
        rows: one for each subject.
        repetitions: how often each time was measured; the median is given.
        source: where results that are not our own come from; "" if there are none.
        figure: the figure as the text of an SVG file; "" if there is none.
    """

    name: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[Row, ...]
    repetitions: int
    source: str = ""
    figure: str = ""

    def to_table(self) -> Table:
        """Return the table; the lines of a row are kept together."""
        table = Table(title=Text(self.title), title_justify="left", header_style="bold")
        for index, heading in enumerate(self.columns):
            # As Text: in a plain string rich takes "[s]" for its markup of crossed-out text.
            table.add_column(Text(heading), justify="right" if index else "left", no_wrap=True)
        for row in self.rows:
            for index, line in enumerate(row.lines):
                table.add_row(*line, end_section=len(row.lines) > 1 and index == len(row.lines) - 1)
        return table

    def to_dict(self) -> dict[str, Any]:
        """Return the report as JSON, with the environment of the run."""
        return {
            "name": self.name,
            "title": self.title,
            "repetitions": self.repetitions,
            "source": self.source,
            "environment": environment(),
            "rows": [row.data for row in self.rows],
        }

    def write(self, folder: Path) -> Path:
        """Write ``<name>.json`` into a folder, making the folder if it is missing; return the file's path."""
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / f"{self.name}.json"
        path.write_text(json.dumps(self.to_dict(), indent=1) + "\n", encoding="utf-8")
        return path


def count(number: int | None) -> str:
    """Return a count for a cell."""
    return ABSENT if number is None else str(number)


def seconds(time_s: float | None, digits: int = 2) -> str:
    """Return a time (s) for a cell."""
    return ABSENT if time_s is None else f"{time_s:.{digits}f}"
