import pytest

from planner.errors import RequestError
from planner.proposals.target import PRESETS, Target, excess_m, is_filling, is_fitting


@pytest.mark.parametrize("text", ["25x30cm", "0.25x0.30", "0.25x0.30m", ".25x.3"])
def test_a_size_is_read_in_metres_or_centimetres(text: str) -> None:
    target = Target.of(text)
    assert (target.width, target.length) == pytest.approx((0.25, 0.30))
    assert not target.is_share


def test_two_sides_are_a_target() -> None:
    assert Target.of((0.25, 0.3)) == Target(0.25, 0.3) == Target.of(Target(0.25, 0.3))


@pytest.mark.parametrize(
    "text", ["", "attic", "25", "25x30in", "25 x 30", "-1x2", "1e2x3", "nanxnan", "0x0", "11x1", "1x2x3"]
)
def test_what_is_no_size_is_refused_with_its_value(text: str) -> None:
    with pytest.raises(RequestError) as raised:
        Target.of(text)
    assert raised.value.field == "to"


@pytest.mark.parametrize("sides", [(0.2,), (0.2, 0.3, 0.4), (0.0, 0.3), (0.2, 10.5), (float("nan"), 0.3)])
def test_sides_out_of_range_are_refused(sides: tuple[float, ...]) -> None:
    with pytest.raises(RequestError, match="to: "):
        Target.of(sides)


def test_halves_and_thirds_are_shares_of_the_garment() -> None:
    assert PRESETS["halves"].sides_of((0.6, 0.4)) == pytest.approx((0.3, 0.2))
    assert PRESETS["thirds"].sides_of((0.6, 0.3)) == pytest.approx((0.2, 0.1))
    assert PRESETS["shelf"].sides_of((0.6, 0.4)) == (0.25, 0.30)


def test_over_a_hanger_a_garment_is_half_as_long_and_at_most_as_wide_as_the_bar() -> None:
    hanger = Target.of("hanger")
    assert hanger.sides_of((0.6, 1.1)) == pytest.approx((0.4, 0.55))
    assert hanger.sides_of((1.1, 0.6)) == pytest.approx((0.55, 0.4))
    assert hanger.sides_of((0.3, 1.1)) == pytest.approx((0.3, 0.55))
    assert not hanger.is_smallest


def test_a_packet_fits_either_way_round_to_a_centimetre() -> None:
    assert is_fitting((0.305, 0.255), (0.25, 0.30))
    assert is_fitting((0.1, 0.1), (0.25, 0.30))
    assert not is_fitting((0.27, 0.27), (0.25, 0.30))
    assert not is_fitting((0.32, 0.1), (0.25, 0.30))


def test_a_packet_under_half_of_the_target_does_not_fill_it() -> None:
    assert is_filling((0.16, 0.13), (0.25, 0.30))
    assert not is_filling((0.30, 0.11), (0.25, 0.30))


def test_the_excess_is_what_both_sides_are_too_long() -> None:
    assert excess_m((0.30, 0.27), (0.25, 0.30)) == pytest.approx(0.02)
    assert excess_m((0.40, 0.35), (0.25, 0.30)) == pytest.approx(0.20)
    assert excess_m((0.10, 0.10), (0.25, 0.30)) == 0.0
