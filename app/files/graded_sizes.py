"""Takes one of the sizes of a pattern that is graded, as S, M and L that lie upon each other."""

from dataclasses import dataclass

from app.files.import_errors import ImportedFileError
from app.files.sketch import Sketch
from planner.message import Message


@dataclass(frozen=True, slots=True)
class Graded:
    """The sizes of a pattern.

    Attributes:
        size: the one that was taken.
        sizes: all of them, from small to large.
    """

    size: str
    sizes: tuple[str, ...]


def graded_sketch(sketch: Sketch, wanted: str | None) -> tuple[Sketch, Graded | None]:
    """Return a drawing in one of its sizes, and its sizes; a drawing of one size as it is, and None.

    Args:
        sketch: the drawing.
        wanted: the size's name, in small or capital letters; None for the sample size, or else the middle one.

    Raises:
        ImportedFileError: there is no such size; the field is ``size``.
    """
    sizes = tuple(sketch.sizes)
    if not sizes:
        if wanted is not None:
            raise ImportedFileError("size", Message("no_sizes", "the drawing has one size; leave out the size"))
        return sketch, None
    by_name = {size.lower(): size for size in sizes}
    if wanted is not None and wanted.strip().lower() not in by_name:
        text = f"expected one of {', '.join(sizes)}; got {wanted[:40]!r}"
        raise ImportedFileError("size", Message("no_such_size", text, {"size": wanted[:40], "sizes": list(sizes)}))
    middle = sizes[(len(sizes) - 1) // 2]
    taken = (
        by_name[wanted.strip().lower()] if wanted is not None else by_name.get((sketch.sample or "").lower(), middle)
    )
    return sketch.sizes[taken], Graded(taken, sizes)
