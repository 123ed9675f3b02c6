"""Texts that everybody who follows a document is sent: each is made once, by the first who needs it."""

import threading
from collections.abc import Callable


class SharedTexts:
    """The newest text of each kind; safe to use from any thread."""

    def __init__(self) -> None:
        """Start with no text."""
        self._lock = threading.Lock()
        self._texts: dict[str, tuple[object, str]] = {}

    def text(self, kind: str, key: object, make: Callable[[], str]) -> str:
        """Return the text of a kind, made now unless it has been for the same key; whoever needs it meanwhile waits."""
        with self._lock:
            known = self._texts.get(kind)
            if known is None or known[0] != key:
                known = self._texts[kind] = (key, make())
            return known[1]
