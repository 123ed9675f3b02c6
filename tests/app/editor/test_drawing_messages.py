import pytest

from app.drawing.outline_problems import outline_problems
from app.drawing.problem import Problem
from app.drawing.ring import straight_ring
from app.language import LANGUAGES, Language
from app.ui.editor.drawing_messages import _LOCALIZED, localized
from app.ui.editor.refusal import sentence
from planner.cloth.garment import DrawnFold
from planner.errors import FoldError, RequestError
from planner.folds.fold import snapped_line
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.message import Message
from tests.messages import MESSAGES


def outline_problems_of(points: list[Point2]) -> tuple[Problem, ...]:
    return outline_problems(straight_ring(points))


def test_a_bow_tie_is_told_as_the_board_tells_it_in_centimetres_and_counted_from_one() -> None:
    problem = outline_problems_of([(0.0, 0.0), (0.5, 0.5), (0.5, 0.0), (0.0, 0.5)])[0]
    assert problem.message == "edges 0 and 2 cross at (0.250, 0.250) m"
    assert localized("en", problem.says, problem.message) == "edges 1 and 3 cross at (25, 25) cm of the garment"


def test_a_short_edge_and_a_small_outline_are_told_in_centimetres() -> None:
    short = outline_problems_of([(0.0, 0.0), (0.0004, 0.0), (0.3, 0.3)])[0]
    assert localized("en", short.says, short.message) == (
        "edge 1, from point 1 to point 2, is 0.04 cm long, less than 0.1 cm"
    )
    small = outline_problems_of([(0.0, 0.0), (0.01, 0.0), (0.0, 0.01)])[0]
    assert (
        localized("en", small.says, small.message)
        == "it covers 0.5 cm\N{SUPERSCRIPT TWO}, less than 1 cm\N{SUPERSCRIPT TWO}"
    )


def test_a_refused_fold_is_told_in_centimetres() -> None:
    square = Region.polygon([(0.0, 0.0), (0.4, 0.0), (0.4, 0.4), (0.0, 0.4)])
    with pytest.raises(FoldError) as caught:
        snapped_line(DrawnFold("", "blue", (0.1, 0.1047), (0.2, 0.4)), square)
    assert sentence(caught.value) == (
        "Its end at (10, 10.5) cm of the garment is 10 cm from the cloth\N{RIGHT SINGLE QUOTATION MARK}s edge; "
        "ends within 0.5 cm snap to it."
    )


def test_what_has_no_numbers_is_its_sentence() -> None:
    assert localized("en", None, "so it is") == "so it is"
    assert localized("en", Message("take_back", "so it is"), "so it is") == "so it is"
    assert sentence(RequestError("line", Message("line_misses_cloth", "does not cross the cloth"))) == (
        "The line does not cross the cloth."
    )


def test_messages_are_told_in_the_language_of_the_3d_view_with_its_decimal_mark() -> None:
    bow_tie = outline_problems_of([(0.0, 0.0), (0.506, 0.506), (0.506, 0.0), (0.0, 0.506)])[0]
    assert (
        localized("de", bow_tie.says, bow_tie.message) == "Kanten 1 und 3 kreuzen sich bei (25,3; 25,3) cm des Stücks"
    )
    short = outline_problems_of([(0.0, 0.0), (0.0004, 0.0), (0.3, 0.3)])[0]
    assert "0,04 cm" in localized("es", short.says, short.message)
    off = RequestError("line", Message("line_misses_cloth", "does not cross the cloth"))
    assert sentence(off, "de") == "Die Linie kreuzt den Stoff nicht."


@pytest.mark.parametrize("code", sorted(_LOCALIZED))
@pytest.mark.parametrize("language", LANGUAGES)
def test_every_localized_message_has_a_text_for_each_of_its_places(code: str, language: Language) -> None:
    (values,) = (sample for sample in MESSAGES if sample["code"] == code)
    says = Message(code, "the English sentence", {name: value for name, value in values.items() if name != "code"})
    told = localized(language, says, says.text)
    assert told != says.text
    assert "{" not in told
