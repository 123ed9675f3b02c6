"""A clock that is as late as it was waited for."""


class ManualClock:
    """Begins at 0; a wait takes no time."""

    def __init__(self) -> None:
        self.t_s = 0.0

    def now_s(self) -> float:
        return self.t_s

    def wait_until(self, t_s: float) -> None:
        self.t_s = max(self.t_s, t_s)
