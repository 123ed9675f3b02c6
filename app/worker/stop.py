"""Stop a piece of work: set once, from any thread; it also wakes those who wait for something else."""

import threading
from collections.abc import Callable
from types import TracebackType

from planner.errors import FoldingError


class StoppedError(FoldingError):
    """The work was stopped."""

    def __str__(self) -> str:
        return "the work was stopped"


class Stop:
    """Whether a piece of work is to stop; called, it says so, as the planner's `should_stop` does."""

    def __init__(self) -> None:
        """Begin unset."""
        self._is_set = False
        self._lock = threading.Lock()
        self._acts: dict[object, Callable[[], None]] = {}

    def __call__(self) -> bool:
        """Return whether it is set."""
        return self._is_set

    def set(self) -> None:
        """Stop the work; what is to be done then is done in this thread."""
        with self._lock:
            self._is_set = True
            acts, self._acts = tuple(self._acts.values()), {}
        for act in acts:
            act()

    def then(self, act: Callable[[], None]) -> Callable[[], None]:
        """Call a function once this is set, at once if it is; return a function that takes this back."""
        token = object()
        with self._lock:
            is_set = self._is_set
            if not is_set:
                self._acts[token] = act
        if is_set:
            act()

        def forget() -> None:
            with self._lock:
                self._acts.pop(token, None)

        return forget


class LimitedStop(Stop):
    """A stop that follows another one, and is also set some time after the work has begun."""

    def __init__(self, other: Stop, limit_s: float) -> None:
        """Follow another stop; the time (s) does not run before `begin`."""
        super().__init__()
        self._other = other
        self._timer = threading.Timer(limit_s, self.set)
        self._timer.daemon = True

    def begin(self) -> None:
        """Let the time run."""
        self._timer.start()

    def __enter__(self) -> "LimitedStop":
        """Begin to follow the other stop."""
        self._forget = self._other.then(self.set)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Follow the other stop no more, and let no more time run."""
        self._timer.cancel()
        self._forget()
