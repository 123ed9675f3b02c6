"""Tables of which only the newest rows are kept."""

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from app.store.schema import SizedRow


def drop_oldest(session: Session, table: type[SizedRow], most: int, most_bytes: int) -> None:
    """Drop the oldest rows of a table beyond a number of rows, and beyond their size in all (bytes)."""
    kept, total = 0, 0
    for number, size in session.execute(select(table.number, table.size).order_by(table.number.desc())):
        kept, total = kept + 1, total + size
        if kept > most or total > most_bytes:
            session.execute(delete(table).where(table.number <= number))
            return
