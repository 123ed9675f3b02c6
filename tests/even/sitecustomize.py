"""Leaves all processes that tests start their priority: Python imports it when they start (see `tests/conftest.py`).

Beside busy tests, work that steps back behind people who draw would wait for minutes.
"""

import os

os.nice = lambda _: 0
