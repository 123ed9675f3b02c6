from app.playback import SPEED_MAX, SPEED_MIN, Playback

TEN_S = Playback(duration_s=10.0)


def test_it_stands_still_until_played() -> None:
    assert TEN_S.at(1000.0) == 0.0


def test_time_runs_at_the_speed_set() -> None:
    playing = TEN_S.played(100.0).sped(100.0, 2.0)
    assert playing.at(103.0) == 6.0


def test_a_change_of_speed_keeps_the_time() -> None:
    playing = TEN_S.played(0.0).sped(4.0, 0.5)
    assert playing.at(4.0) == 4.0
    assert playing.at(6.0) == 5.0


def test_it_ends_at_the_end_exactly() -> None:
    playing = TEN_S.played(0.0)
    assert not playing.has_ended(9.9)
    assert playing.has_ended(11.0)
    assert playing.at(11.0) == 10.0


def test_playing_at_the_end_begins_again() -> None:
    ended = TEN_S.sought(0.0, 10.0)
    assert ended.played(5.0).at(6.0) == 1.0


def test_pausing_keeps_the_time() -> None:
    paused = TEN_S.played(0.0).paused(3.0)
    assert paused.at(50.0) == 3.0
    assert not paused.is_playing


def test_seeking_stays_within_the_plan_and_keeps_playing() -> None:
    playing = TEN_S.played(0.0)
    assert playing.sought(1.0, 99.0).at(1.0) == 10.0
    assert playing.sought(1.0, -5.0).at(1.0) == 0.0
    assert playing.sought(1.0, 4.0).at(2.0) == 5.0


def test_the_speed_stays_within_its_limits() -> None:
    assert TEN_S.sped(0.0, 1e9).speed == SPEED_MAX
    assert TEN_S.sped(0.0, 0.0).speed == SPEED_MIN


def test_nothing_plays_without_a_plan() -> None:
    assert not Playback().played(0.0).is_playing
