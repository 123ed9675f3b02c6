"""The table of a study: one row for each cell, as CSV and, where PyArrow is installed, as Parquet; times in a file."""

import csv
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any

from app.distribution import is_installed
from app.studies.answer import COMFORT_MARGIN, RESULT_COLUMNS, TIMING_COLUMNS
from app.studies.rehearsed import REHEARSAL_COLUMNS
from app.studies.results import Results
from app.studies.study import GARMENT, Study

PARQUET, CSV, TIMING = "table.parquet", "table.csv", "timing.csv"

_ROWS_A_GROUP = 10_000
"""Rows of the Parquet file that are held at once."""

_SEED, _MEASURE = "garment_seed", "measure."


def columns_of(study: Study) -> dict[str, type]:
    """Return the table's columns and their types, in order."""
    measures = {f"{_MEASURE}{name}": float for case in study.garments for name in case.measures}
    axes = {axis.name: type(axis.values[0]) for axis in study.axes}
    searched = {COMFORT_MARGIN: float} if study.has_comfort_margin else {}
    rehearsed = {} if study.rehearsal is None else REHEARSAL_COLUMNS
    return {"cell": int, GARMENT: str, _SEED: int, **measures, **axes, **RESULT_COLUMNS, **searched, **rehearsed}


def table_rows(study: Study, results: Results) -> Iterator[dict[str, Any]]:
    """Yield the rows of the table, by cell."""
    columns = columns_of(study)
    for index, row, _ in results.rows():
        yield dict.fromkeys(columns) | axis_values(study, index) | dict(row)


def axis_values(study: Study, index: int) -> dict[str, Any]:
    """Return a cell's number, garment and values by column."""
    digits = study.digits(index)
    case = study.garments[digits[0]]
    measures = {f"{_MEASURE}{name}": value for name, value in case.measures.items()}
    values = {axis.name: axis.values[digit] for axis, digit in zip(study.axes, digits[1:], strict=True)}
    return {"cell": index, GARMENT: case.label, _SEED: case.seed, **measures, **values}


def written_files() -> tuple[str, ...]:
    """Return the files that `write_tables` writes here: Parquet needs PyArrow."""
    return (CSV, TIMING, PARQUET) if is_installed("pyarrow") else (CSV, TIMING)


def write_tables(study: Study, results: Results) -> None:
    """Write `written_files` into the results' folder; the table does not depend on how the answers came.

    Raises:
        OSError: a file cannot be written.
    """
    columns, folder = columns_of(study), results.folder
    times = ({"cell": index, **timing} for index, _, timing in results.rows())
    _write_csv(folder / CSV, columns, table_rows(study, results))
    _write_csv(folder / TIMING, ["cell", *TIMING_COLUMNS], times)
    if PARQUET in written_files():
        _write_parquet(folder / PARQUET, columns, table_rows(study, results))


def _write_csv(path: Path, columns: Iterable[str], rows: Iterable[Mapping[str, Any]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as text:
        lines = csv.DictWriter(text, list(columns), lineterminator="\n")
        lines.writeheader()
        lines.writerows(rows)


def _write_parquet(path: Path, columns: Mapping[str, type], rows: Iterator[Mapping[str, Any]]) -> None:
    import pyarrow as pa
    from pyarrow import parquet

    types = {float: pa.float64(), int: pa.int64(), bool: pa.bool_(), str: pa.string()}
    schema = pa.schema([(name, types[kind]) for name, kind in columns.items()])
    with parquet.ParquetWriter(path, schema) as table:
        while group := list(islice(rows, _ROWS_A_GROUP)):
            table.write_table(pa.Table.from_pylist(group, schema))
