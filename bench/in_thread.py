"""Workers that do everything in the thread that asks: its CPU time is measured, and tests replace what it calls."""

import threading
from collections import defaultdict
from collections.abc import Callable
from typing import Any

from app.worker.process import Hear
from app.worker.stop import Stop, StoppedError
from app.worker.workers import Workers


class _Here:
    """The caller of work done in its own thread."""

    def __init__(self, on_news: Hear, stop: Stop) -> None:
        self._on_news = on_news
        self.should_stop = stop

    def tell(self, news: object) -> None:
        if not self.should_stop():
            self._on_news(news)


class InThread(Workers):
    """Does work where it is asked for; for a key one piece after the other."""

    def __init__(self) -> None:
        """Start no process."""
        super().__init__()
        self._turns: dict[str, threading.Lock] = defaultdict(threading.Lock)

    def run(self, work: Callable[..., Any], stop: Stop, on_news: Hear, *arguments: Any, **options: Any) -> Any:  # noqa: ANN401
        """Return the result of work done here."""
        if stop():
            raise StoppedError
        answer = work(_Here(on_news, stop), *arguments, **options)
        if stop():
            raise StoppedError
        return answer

    def run_for(
        self,
        key: str,
        work: Callable[..., Any],
        stop: Stop,
        on_news: Hear,
        *arguments: Any,  # noqa: ANN401
        **options: Any,  # noqa: ANN401
    ) -> Any:  # noqa: ANN401
        """Return the result of work done here, once earlier work for the key is done."""
        with self._turns[key]:
            return self.run(work, stop, on_news, *arguments, **options)
