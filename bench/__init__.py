"""How quickly Pleat plans, beside the paper and other inverse kinematics: ``python -m bench`` (or ``make bench``).

Each module makes one table; `bench.__main__` prints them and writes them to ``bench/out/``. Times are printed,
never judged: they depend on the machine. What does not depend on it (equal costs, equal counts) is checked.
"""
