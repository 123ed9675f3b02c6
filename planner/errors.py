"""The errors that Pleat raises, as one tree.

::

    FoldingError                     the root; catch this one
    ├── FieldError                   bad input: names the field and says what is wrong
    │   ├── GarmentError             a garment's outline, numbers, names
    │   ├── FoldError                a fold that is not legal on the cloth at its turn
    │   ├── SceneError               table, stations, robot settings, costs
    │   ├── RobotError               a robot's card, or the description it names
    │   └── RequestError             the options of a plan request
    ├── GarmentFileError             a file that cannot be read as a garment (or scene) at all
    ├── UnknownGarmentError          no garment of that name
    ├── ReadOnlyGarmentError         an attempt to change a shipped garment
    ├── UnknownRobotError            no robot of that name
    ├── ReadOnlyRobotError           an attempt to change a shipped robot
    └── UnsolvedPlanError            a request for the timeline of a plan that has none

"No plan exists" is never an error: it is a `planner.task.plan.Plan` with that status.
"""

from dataclasses import dataclass
from typing import Any

from planner.message import Message


class FoldingError(Exception):
    """The root of all errors that Pleat raises on purpose; it keeps its data when it is pickled to another process."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how to rebuild the error from its fields.

        `Exception` would call the leaf with the finished message.
        """
        return _remade, (type(self), self.args, self.__dict__)


def _remade(kind: type[FoldingError], arguments: tuple[object, ...], fields: dict[str, Any]) -> FoldingError:
    error = kind.__new__(kind, *arguments)
    error.__dict__.update(fields)
    return error


class FieldError(FoldingError, ValueError):
    """Bad input, with the path of the field it stands in; pydantic treats it as one of its own errors.

    Attributes:
        field: the path, as in ``outline[3]`` or ``folds[0].start``; relative to the value that was being built until an
            outer layer prefixes it (see `within`).
        message: what is wrong, with the numbers and their units.
        says: the message as data, where it has numbers.
    """

    def __init__(self, field: str, message: str | Message) -> None:
        text = message.text if isinstance(message, Message) else message
        super().__init__(f"{field}: {text}" if field else text)
        self.field = field
        self.message = text
        self.says = message if isinstance(message, Message) else None

    def within(self, prefix: str) -> "FieldError":
        """Return the error with its field's path prefixed."""
        if not prefix:
            return self
        joined = f"{prefix}.{self.field}" if self.field else prefix
        return type(self)(joined.replace(".[", "["), self.says or self.message)


class GarmentError(FieldError):
    """A garment that is not valid: outline, density, radius, name."""


class FoldError(FieldError):
    """A fold that is not legal on the cloth at its turn (paper, section 6)."""


class SceneError(FieldError):
    """A scene that is not valid: table, stations, torso, friction, costs."""


class RobotError(FieldError):
    """A robot's card that is not valid, or whose URDF lacks what it names."""


@dataclass
class UnknownRobotError(FoldingError):
    """No robot has this name."""

    name: str

    def __str__(self) -> str:
        return f"there is no robot named {self.name!r}"


@dataclass
class ReadOnlyRobotError(FoldingError):
    """An attempt to replace or remove a shipped robot."""

    name: str

    def __str__(self) -> str:
        return f"{self.name!r} is shipped with Pleat and read-only; save yours under another name"


class RequestError(FieldError):
    """An option of a plan request that is out of range."""


class GarmentFileError(FoldingError):
    """A file that cannot be read at all: missing, not text, not JSON."""


@dataclass
class UnknownGarmentError(FoldingError):
    """A name of which no garment is shipped or stored."""

    name: str

    def __str__(self) -> str:
        return f"there is no garment named {self.name!r}"


@dataclass
class ReadOnlyGarmentError(FoldingError):
    """An attempt to replace or remove a shipped garment."""

    name: str

    def __str__(self) -> str:
        return f"{self.name!r} is shipped with Pleat and read-only; save yours under another name"


@dataclass
class UnsolvedPlanError(FoldingError):
    """A request for the timeline of a plan that is not solved."""

    status: str

    def __str__(self) -> str:
        return f"no trajectory: the plan is {self.status}"
