"""Everything that Pleat raises, as one tree.

::

    FoldingError                     the root; catch this one
    ├── FieldError                   bad input: names the field and says what is wrong
    │   ├── GarmentError             a garment's outline, numbers, names
    │   ├── FoldError                a fold that is not legal on the cloth as it is then
    │   ├── SceneError               table, stations, robot settings, costs
    │   └── RequestError             the options of a plan request
    ├── GarmentFileError             a file that cannot be read as a garment (or scene) at all
    ├── UnknownGarmentError          no garment of that name
    ├── ReadOnlyGarmentError         a shipped garment was to be changed
    └── UnsolvedPlanError            a timeline was asked of a plan that has none

"No plan exists" is never an error: it is a `planner.plan.Plan` whose status says so.
"""

from dataclasses import dataclass
from typing import Any

from planner.message import Message


class FoldingError(Exception):
    """The root of all errors that Pleat raises on purpose; one that comes from another process is equal to it."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Have it made again from what it holds: `Exception` would call the leaf with the finished message."""
        return _remade, (type(self), self.args, self.__dict__)


def _remade(kind: type[FoldingError], arguments: tuple[object, ...], fields: dict[str, Any]) -> FoldingError:
    error = kind.__new__(kind, *arguments)
    error.__dict__.update(fields)
    return error


class FieldError(FoldingError, ValueError):
    """Bad input, with the path of the field it stands in; pydantic takes it for one of its own.

    Attributes:
        field: where, as in ``outline[3]`` or ``folds[0].start``; relative to the value
            that was being built until an outer layer prefixes it (see `within`).
        message: what is wrong, with the numbers and their units.
        says: the same as data, where it has numbers.
    """

    def __init__(self, field: str, message: str | Message) -> None:
        text = message.text if isinstance(message, Message) else message
        super().__init__(f"{field}: {text}" if field else text)
        self.field = field
        self.message = text
        self.says = message if isinstance(message, Message) else None

    def within(self, prefix: str) -> "FieldError":
        """The same error, its field seen from further out."""
        if not prefix:
            return self
        joined = f"{prefix}.{self.field}" if self.field else prefix
        return type(self)(joined.replace(".[", "["), self.says or self.message)


class GarmentError(FieldError):
    """A garment that is not valid: outline, density, radius, name."""


class FoldError(FieldError):
    """A fold that is not legal on the cloth as it is when its turn comes (paper, section 6)."""


class SceneError(FieldError):
    """A scene that is not valid: table, stations, torso, friction, costs."""


class RequestError(FieldError):
    """An option of a plan request that is out of range."""


class GarmentFileError(FoldingError):
    """A file that cannot be read at all: missing, not text, not JSON."""


@dataclass
class UnknownGarmentError(FoldingError):
    """No garment of this name is shipped or stored."""

    name: str

    def __str__(self) -> str:
        return f"there is no garment named {self.name!r}"


@dataclass
class ReadOnlyGarmentError(FoldingError):
    """A shipped garment cannot be replaced or removed."""

    name: str

    def __str__(self) -> str:
        return f"{self.name!r} is shipped with Pleat and read-only; save yours under another name"


@dataclass
class UnsolvedPlanError(FoldingError):
    """A timeline exists only for a solved plan."""

    status: str

    def __str__(self) -> str:
        return f"the plan is {self.status}, so there is nothing to play"
