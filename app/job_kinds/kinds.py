"""The kinds of jobs; a new one is a file beside this one and a line here."""

from collections.abc import Mapping

from app.job_kinds.comparisons import COMPARISONS
from app.job_kinds.placements import PLACEMENTS
from app.job_kinds.proposals import PROPOSALS
from app.job_kinds.rehearsals import REHEARSALS
from app.job_kinds.robots import ROBOTS
from app.job_kinds.runs import RUNS
from app.job_kinds.studies import STUDIES
from app.job_kinds.suggestions import SUGGESTIONS
from app.jobs.job_kind import AnyKind

BY_JSON: tuple[AnyKind, ...] = (COMPARISONS, PLACEMENTS, PROPOSALS, REHEARSALS, RUNS, STUDIES, SUGGESTIONS)
"""The kinds that are asked for with a body of JSON, each at a route that is made of it."""

KINDS: Mapping[str, AnyKind] = {kind.name: kind for kind in (*BY_JSON, ROBOTS)}
