"""Copies all that is in one database to another one, of any kind."""

from dataclasses import dataclass

from sqlalchemy import func, insert, select

from app.store.database import Database
from app.store.schema import Table
from planner.errors import FoldingError

_AT_ONCE = 100
"""Number of rows copied at a time."""

_GIVEN_ANEW = "number"
"""The column that a database counts up: it gives copied rows numbers of its own, in the same order."""


@dataclass
class UsedDatabaseError(FoldingError):
    """The database to restore to has something in it."""

    table: str

    def __str__(self) -> str:
        return f"the database is not empty, it has {self.table}; restore to a new one"


def copy_rows(source: Database, target: Database) -> None:
    """Copy all rows of a database, as of one moment, to an empty one; all of them or none.

    Raises:
        UsedDatabaseError: the target is not empty.
        StorageError: a database refuses.
    """
    with source.reading("the database could not be read") as old, target.writing("it could not be copied") as new:
        for table in Table.metadata.sorted_tables:
            if new.scalar(select(func.count()).select_from(table)):
                raise UsedDatabaseError(table.name)
        for table in Table.metadata.sorted_tables:
            counted = [
                column for column in table.primary_key if column.name == _GIVEN_ANEW and column.autoincrement is True
            ]
            columns = [column for column in table.columns if column not in counted]
            rows = old.execute(select(*columns).order_by(*(counted or table.primary_key)))
            for some in rows.mappings().partitions(_AT_ONCE):
                new.execute(insert(table), [dict(row) for row in some])
