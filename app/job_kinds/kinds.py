"""The kinds of jobs; a new one is a file beside this one and a line here."""

from collections.abc import Mapping

from app.job_kinds.comparisons import COMPARISONS
from app.job_kinds.placements import PLACEMENTS
from app.job_kinds.rehearsals import REHEARSALS
from app.job_kinds.studies import STUDIES
from app.job_kinds.suggestions import SUGGESTIONS
from app.jobs.job_kind import AnyKind

_ALL: tuple[AnyKind, ...] = (
    COMPARISONS,
    PLACEMENTS,
    REHEARSALS,
    STUDIES,
    SUGGESTIONS,
)

KINDS: Mapping[str, AnyKind] = {kind.name: kind for kind in _ALL}
