"""The garments that a study's file names, each entry one or many."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

from app.studies.axis import number_axis
from app.studies.cell import GarmentCase
from app.studies.fields import StudyError, pair, reported_at, require_known, required, table, text, whole
from app.studies.random_garment import RandomShape, random_garment
from app.templates.catalogue import TEMPLATES, find_template
from app.templates.measure import MeasureError
from app.templates.template import Template
from planner.cloth.garment import Garment
from planner.cloth.garment_files import load_garment
from planner.errors import FieldError, FoldingError, GarmentError
from planner.strict_model import LARGEST_M

RANDOM_MAX = 100_000
"""The most random garments of one entry."""

CORNERS_MAX, FOLDS_MAX = 40, 12
"""The most corners and folds of a random garment."""


@dataclass(frozen=True, slots=True)
class Sources:
    """The sources of garments.

    Attributes:
        named: returns the garment of a name.
        folder: the folder to which files are relative; None where no files may be read.
    """

    named: Callable[[str], Garment] = load_garment
    folder: Path | None = None


@dataclass(frozen=True, slots=True)
class _Entry:
    """A kind of entry: the fields it may have, and how it is read."""

    fields: frozenset[str]
    cases: Callable[[str, Mapping[str, Any], Sources], Iterator[GarmentCase]]


def read_garments(given: object, sources: Sources) -> tuple[GarmentCase, ...]:
    """Return all garments that the entries name, with labels that differ.

    Args:
        given: the field ``garments`` of a study's file.
        sources: where they come from.

    Raises:
        StudyError: an entry is not valid.
    """
    if not isinstance(given, list) or not given:
        raise StudyError("garments", "is no list of one or more entries; write [[garments]] before each")
    found = [case for number, entry in enumerate(given) for case in _cases(f"garments[{number}]", entry, sources)]
    return tuple(_with_labels(found))


def _cases(field: str, given: object, sources: Sources) -> Iterator[GarmentCase]:
    entry = table(field, given)
    kinds = [kind for kind in _ENTRIES if kind in entry]
    if len(kinds) != 1:
        raise StudyError(field, f"names {' and '.join(kinds) or 'nothing'}; it has one of {', '.join(_ENTRIES)}")
    kind = _ENTRIES[kinds[0]]
    require_known(field, entry, kind.fields)
    yield from kind.cases(field, entry, sources)


def _named(field: str, entry: Mapping[str, Any], sources: Sources) -> Iterator[GarmentCase]:
    name = text(f"{field}.name", entry["name"])
    yield GarmentCase(name, _checked(f"{field}.name", sources.named, name))


def _drawn(field: str, entry: Mapping[str, Any], _: Sources) -> Iterator[GarmentCase]:
    drawing = table(f"{field}.garment", entry["garment"])
    with reported_at(f"{field}.garment"):
        garment = Garment.from_dict(drawing)
    yield GarmentCase(garment.name, garment)


def _from_files(field: str, entry: Mapping[str, Any], sources: Sources) -> Iterator[GarmentCase]:
    pattern, folder = text(f"{field}.file", entry["file"]), sources.folder
    if folder is None:
        raise StudyError(f"{field}.file", "files are not read here; give the garment itself")
    paths = sorted(folder.glob(pattern)) if any(sign in pattern for sign in "*?[") else [folder / pattern]
    if not paths:
        raise StudyError(f"{field}.file", f"no file in {folder} matches {pattern!r}")
    for path in paths:
        garment = _checked(f"{field}.file", load_garment, path)
        yield GarmentCase(garment.name, garment)


def _from_template(field: str, entry: Mapping[str, Any], _: Sources) -> Iterator[GarmentCase]:
    name = text(f"{field}.template", entry["template"])
    template = find_template(name)
    if template is None:
        raise StudyError(
            f"{field}.template", f"expected one of {', '.join(one.name for one in TEMPLATES)}; got {name!r}"
        )
    known = {measure.name: measure for measure in template.measures}
    measures = table(f"{field}.measures", entry.get("measures", {}))
    require_known(f"{field}.measures", measures, known.keys())
    axes = [number_axis(f"{field}.measures.{measure}", given) for measure, given in measures.items()]
    for axis, measure in zip(axes, measures, strict=True):
        for value in axis.values:
            _checked(axis.name, known[measure].require, float(value))
    for values in product(*(axis.values for axis in axes)):
        yield _cut(template, {measure: float(value) for measure, value in zip(measures, values, strict=True)})


def _cut(template: Template, measures: Mapping[str, float]) -> GarmentCase:
    """Return the garment of some measures, or why they do not fit each other."""
    label = " ".join((template.name, *(f"{value:g}" for value in measures.values())))
    try:
        return GarmentCase(label, template.garment(measures), measures=measures)
    except (MeasureError, GarmentError) as error:
        return GarmentCase(label, None, measures=measures, error=str(error))


def _random(field: str, entry: Mapping[str, Any], _: Sources) -> Iterator[GarmentCase]:
    count = whole(f"{field}.random", entry["random"], 1, RANDOM_MAX)
    seed = whole(f"{field}.seed", required(field, entry, "seed"), 0, 2**53)
    default = RandomShape()
    corners = pair(f"{field}.corners", entry.get("corners", list(default.corners)), 3, CORNERS_MAX)
    folds = pair(f"{field}.folds", entry.get("folds", list(default.folds)), 1, FOLDS_MAX)
    size_m = pair(f"{field}.size_m", entry.get("size_m", list(default.size_m)), 0.1, LARGEST_M)
    shape = RandomShape((int(corners[0]), int(corners[1])), (int(folds[0]), int(folds[1])), size_m)
    for own in range(seed, seed + count):
        yield GarmentCase(f"random {own}", random_garment(own, shape), own)


def _checked(field: str, read: Callable[[Any], Any], given: object) -> Any:  # noqa: ANN401
    """Return what a function reads; report its error at the field."""
    try:
        return read(given)
    except FieldError as error:
        raise StudyError(field, f"{given}: {error}" if isinstance(given, Path) else error.message) from None
    except FoldingError as error:
        raise StudyError(field, str(error)) from None


def _with_labels(cases: Sequence[GarmentCase]) -> Iterator[GarmentCase]:
    """Number the labels that are given twice, such as files of one name."""
    seen: dict[str, int] = {}
    for case in cases:
        seen[case.label] = seen.get(case.label, 0) + 1
        yield case if seen[case.label] == 1 else replace(case, label=f"{case.label} ({seen[case.label]})")


_ENTRIES = {
    "name": _Entry(frozenset({"name"}), _named),
    "garment": _Entry(frozenset({"garment"}), _drawn),
    "file": _Entry(frozenset({"file"}), _from_files),
    "template": _Entry(frozenset({"template", "measures"}), _from_template),
    "random": _Entry(frozenset({"random", "seed", "corners", "folds", "size_m"}), _random),
}
