"""Draws the figures of docs/model.md from the planner itself: `make figures`."""

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

from docs.figures import dag_figure, fold_path_figure, hanging_figure, must_hold_figure, slip_figure
from docs.figures.drawing import Drawing

FOLDER = Path(__file__).parent

FIGURES: Mapping[str, Callable[[], Drawing]] = MappingProxyType(
    {
        "must-hold": must_hold_figure.draw,
        "fold-path": fold_path_figure.draw,
        "t-shirt-dag": dag_figure.draw,
        "slip-limit": slip_figure.draw,
        "hanging": hanging_figure.draw,
    }
)
"""How each figure is drawn, by the name of its file."""


def main() -> None:
    """Write every figure beside this file."""
    for name, draw in FIGURES.items():
        path = FOLDER / f"{name}.svg"
        path.write_text(draw().to_svg(), encoding="utf-8")
        print(path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path)


if __name__ == "__main__":
    main()
