import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from app.templates.catalogue import TEMPLATES, find_template
from app.templates.measure import Measure, MeasureError, Measures
from app.templates.template import Template
from planner import load_garment, make_plan
from planner.cloth.garment import Garment
from planner.errors import GarmentError
from planner.task.reason import Code
from tests.laws.law import law

# The shipped garments whose values are the defaults of a template.
SHIPPED = {
    "t-shirt": "t-shirt",
    "vest": "vest",
    "shirt": "shirt",
    "trousers": "jeans",
    "skirt": "skirt",
    "towel": "hand-towel",
    "scarf": "scarf",
    "tie": "tie",
}

each = pytest.mark.parametrize("template", TEMPLATES, ids=[template.name for template in TEMPLATES])


def made(name: str, **measures: float) -> Garment:
    template = find_template(name)
    assert template is not None
    return template.garment(measures)


def refusal(name: str, **measures: float) -> MeasureError:
    with pytest.raises(MeasureError) as caught:
        made(name, **measures)
    return caught.value


@pytest.mark.parametrize(
    "template",
    [
        pytest.param(template, id=template.name, marks=[pytest.mark.long] if template.name in SHIPPED else [])
        for template in TEMPLATES
    ],
)
def test_a_template_makes_a_garment_that_a_robot_can_fold(template: Template) -> None:
    plan = make_plan(template.garment({}))
    assert plan.status == "solved"


@pytest.mark.parametrize(("name", "shipped"), SHIPPED.items())
def test_the_defaults_are_the_shipped_garment_to_two_millimetres(name: str, shipped: str) -> None:
    garment, known = made(name), load_garment(shipped)
    assert garment.areal_density_kg_m2 == known.areal_density_kg_m2
    assert garment.thickness_m == known.thickness_m
    for point, same in zip(garment.outline, known.outline, strict=True):
        assert point == pytest.approx(same, abs=0.002)
    for fold, same_fold in zip(garment.folds, known.folds, strict=True):
        assert (*fold.start, *fold.end) == pytest.approx((*same_fold.start, *same_fold.end), abs=0.002)
    assert garment.placement.to_dict() == pytest.approx(known.placement.to_dict(), abs=0.002)


@each
def test_defaults_are_within_their_ranges_and_named(template: Template) -> None:
    names = [measure.name for measure in template.measures]
    assert len(set(names)) == len(names)
    for measure in template.measures:
        assert measure.min_m < measure.default_m < measure.max_m
        assert measure.name.endswith("_m")
        assert measure.label
        assert measure.text


@each
@given(data=st.data())
@law("geometry", short=15, long=60)
def test_any_likely_measures_are_refused_by_name_or_make_folds_that_are_all_legal(
    template: Template, data: st.DataObject
) -> None:
    measures = {
        measure.name: measure.default_m * data.draw(st.floats(0.6, 1.6), label=measure.name)
        for measure in template.measures
    }
    try:
        garment = template.garment(measures)
    except MeasureError as error:
        assert error.field in measures
    else:
        assert [problem.message for problem in solve(drawing_of(garment)).problems] == []


@each
@given(data=st.data())
@law("geometry", short=10, long=30)
def test_a_little_more_or_less_of_everything_still_makes_legal_folds(template: Template, data: st.DataObject) -> None:
    near = {
        measure.name: measure.default_m * data.draw(st.floats(0.97, 1.03), label=measure.name)
        for measure in template.measures
    }
    garment = template.garment({name: value for name, value in near.items() if name != "folded_width_m"})
    assert solve(drawing_of(garment)).problems == ()


@each
@given(data=st.data())
@law("geometry", short=15, long=60)
def test_measures_of_any_size_make_a_drawing_or_are_refused_because_there_is_no_such_garment(
    template: Template, data: st.DataObject
) -> None:
    measures = {
        measure.name: data.draw(st.floats(measure.min_m, measure.max_m), label=measure.name)
        for measure in template.measures
    }
    try:
        garment = template.garment(measures)
    except MeasureError as error:
        assert error.field in measures
    except GarmentError as error:
        assert error.field.startswith(("outline", "end"))
    else:
        assert Garment.from_dict(garment.to_dict()) == garment
        assert all(problem.fold is not None for problem in solve(drawing_of(garment)).problems)


@each
@pytest.mark.parametrize("times", [0.25, 0.5, 2.0, 4.0])
def test_one_measure_alone_is_taken_in_any_size_and_what_hangs_on_it_follows(template: Template, times: float) -> None:
    for measure in template.measures:
        if not measure.follows:
            garment = template.garment({measure.name: times * measure.default_m})
            assert solve(drawing_of(garment)).problems == ()


def test_a_towel_wider_than_the_table_and_a_large_round_cloth_are_drawings_with_reasons() -> None:
    towel, cloth = made("towel", width_m=1.5), made("round", diameter_m=0.5)
    assert (max(x for x, _ in towel.outline), towel.folds[1].start[0]) == pytest.approx(
        (1.5, (1.5 - 1.5 / 0.686 * 0.298) / 2)
    )
    plan = make_plan(cloth)
    assert plan.status == "infeasible"
    assert [reason.code for reason in plan.reasons][:1] == [Code.TOO_MANY_GRIPS]


def test_a_garment_larger_than_files_may_have_is_refused_with_how_far_it_reaches() -> None:
    with pytest.raises(GarmentError) as caught:
        made("t-shirt", width_m=9.0)
    assert caught.value.message == "reaches 12 m from where it begins, at most 10 m"


def test_a_measure_changes_what_it_says() -> None:
    # A T-shirt 5 cm longer: the hem stays at y = 0, the collar is at 0.66 m, the lower half is folded up at 0.33 m.
    longer = made("t-shirt", length_m=0.66)
    assert max(y for _, y in longer.outline) == 0.66
    assert longer.folds[-1].start[1] == longer.folds[-1].end[1] == 0.33


def test_the_cuff_of_a_shirt_is_square_to_its_sleeve_and_as_wide_as_it_says() -> None:
    (x1, y1), (x2, y2) = made("shirt", width_m=0.4, length_m=0.6, cuff_m=0.1, sleeve_m=0.5, slope_m=0.3).outline[2:4]
    # The sleeve falls by 0.3 m on 0.5 m, so its upper edge goes (-0.4, -0.3), and the cuff (0.06, -0.08).
    assert (x2, y2) == pytest.approx((-0.4, 0.6 - 0.3))
    assert (x1 - x2, y1 - y2) == pytest.approx((0.06, -0.08))


def test_what_is_out_of_range_is_refused_with_the_range() -> None:
    error = refusal("t-shirt", width_m=12.0)
    assert (error.field, error.message) == ("width_m", "width is 12 m, not between 0.001 and 10 m")


def test_what_does_not_go_together_is_refused_with_both_numbers() -> None:
    error = refusal("t-shirt", armhole_m=0.35)
    assert error.field == "armhole_m"
    assert error.message == "armhole (0.35 m) must be less than half of the length (0.305 m)"
    sides = refusal("towel", width_m=0.9, folded_width_m=0.25)
    assert sides.field == "folded_width_m"
    assert "a third of the width, or the sides would stick out (0.3 m)" in sides.message


def test_a_measure_that_nobody_asked_for_is_refused() -> None:
    assert refusal("scarf", sleeve_m=0.1).message == "is not a measure of this template"


def test_measures_not_a_number_are_out_of_range() -> None:
    asked = (Measure("width_m", "Width", "across", 0.5),)
    with pytest.raises(MeasureError):
        Measures(asked, {"width_m": float("nan")})
