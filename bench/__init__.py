"""Pleat's planning times, beside the paper and other inverse kinematics: ``python -m bench`` (or ``make bench``).

Each module makes one table; `bench.__main__` prints them and writes them to ``bench/out/``. Times are only printed,
because they depend on the machine. Results that do not depend on it (equal costs, equal counts) are checked.
"""
