"""Replayed tracks: what a file says is where the animal is, and what a file must not say."""

from __future__ import annotations

import gzip
import math
import pickle
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comms.frames import METRES_PER_DEGREE, GeoPoint
from vehicle_sim.tracks import Tracks, TracksError, parse_tracks, read_tracks

MOVEBANK = "timestamp,location-long,location-lat,individual-local-identifier"
BOTH_LAYOUTS = "t, id, x, y or timestamp, individual-local-identifier, location-long, location-lat"

Fixes = list[tuple[float, float, float]]  # t, x, y of one animal, in order of time


def meters(*rows: str, max_gap_s: float = 30.0, home: GeoPoint | None = None) -> Tracks:
    return parse_tracks("\n".join(("t,id,x,y", *rows)), source="a.csv", home=home, max_gap_s=max_gap_s)


def movebank(*rows: str, home: GeoPoint | None = None) -> Tracks:
    return parse_tracks("\n".join((MOVEBANK, *rows)), source="a.csv", home=home)


def one_animal(fixes: Fixes, max_gap_s: float = 30.0) -> Tracks:
    return meters(*(f"{t!r},a,{x!r},{y!r}" for t, x, y in fixes), max_gap_s=max_gap_s)


def problems_of(read: Callable[[], Tracks]) -> list[str]:
    with pytest.raises(TracksError) as caught:
        read()
    return str(caught.value).splitlines()


coordinates = st.floats(-500.0, 500.0)


@st.composite
def walks(draw: st.DrawFn) -> Fixes:
    """One animal's fixes from t = 0, 0.1 s to 20 s apart: no gap."""
    steps = draw(st.lists(st.floats(0.1, 20.0), min_size=1, max_size=12))
    times = [sum(steps[:i]) for i in range(len(steps) + 1)]
    return [(t, draw(coordinates), draw(coordinates)) for t in times]


class TestLaws:
    @given(walks())
    def test_every_fix_is_hit_exactly(self, fixes: Fixes) -> None:
        tracks = one_animal(fixes)
        for t, x, y in fixes:
            state = tracks.at(0, t)
            assert state is not None
            assert state[:2] == (x, y)

    @given(walks(), st.floats(0.0, 1.0))
    def test_between_two_fixes_it_is_on_their_segment_at_its_share_of_the_time(
        self, fixes: Fixes, share: float
    ) -> None:
        tracks = one_animal(fixes)
        for (t0, x0, y0), (t1, x1, y1) in pairwise(fixes):
            state = tracks.at(0, t0 + share * (t1 - t0))
            assert state is not None
            assert math.dist(state[:2], (x0, y0)) == pytest.approx(share * math.dist((x0, y0), (x1, y1)), abs=1e-6)
            assert math.dist(state[:2], (x1, y1)) == pytest.approx(
                (1 - share) * math.dist((x0, y0), (x1, y1)), abs=1e-6
            )

    @given(walks(), st.floats(0.01, 0.98))
    def test_velocity_is_the_rate_of_change_of_position(self, fixes: Fixes, share: float) -> None:
        tracks = one_animal(fixes)
        for (t0, *_), (t1, *_) in pairwise(fixes):
            now_s, later_s = t0 + share * (t1 - t0), t0 + (share + 0.01) * (t1 - t0)
            now, later = tracks.at(0, now_s), tracks.at(0, later_s)
            assert now is not None
            assert later is not None
            assert now[2] * (later_s - now_s) == pytest.approx(later[0] - now[0], abs=1e-6)
            assert now[3] * (later_s - now_s) == pytest.approx(later[1] - now[1], abs=1e-6)

    @given(walks(), coordinates, coordinates, st.floats(0.0, 1.0))
    def test_moving_all_fixes_moves_the_animal_and_keeps_its_velocity(
        self, fixes: Fixes, dx: float, dy: float, share: float
    ) -> None:
        here, there = one_animal(fixes), one_animal([(t, x + dx, y + dy) for t, x, y in fixes])
        t_s = share * here.duration_s
        a, b = here.at(0, t_s), there.at(0, t_s)
        assert a is not None
        assert b == pytest.approx((a[0] + dx, a[1] + dy, a[2], a[3]), abs=1e-6)

    @given(walks(), st.floats(-1e6, 1e6), st.floats(0.001, 0.999))
    def test_the_clock_of_the_file_does_not_matter(self, fixes: Fixes, late_s: float, share: float) -> None:
        now, later = one_animal(fixes), one_animal([(t + late_s, x, y) for t, x, y in fixes])
        a, b = now.at(0, share * now.duration_s), later.at(0, share * later.duration_s)
        assert a is not None
        assert b is not None
        assert b[:2] == pytest.approx(a[:2], abs=1e-4)  # 1e6 s resolves 1e-10 s, at up to 1e4 m/s

    @given(st.permutations(range(12)))
    def test_rows_of_movebank_may_come_in_any_order(self, order: list[int]) -> None:
        rows = [f"2012-08-05 03:00:{i:02d}.500,36.9{i:02d},0.3{i:02d},{'ab'[i % 2]}" for i in range(12)]
        assert movebank(*(rows[i] for i in order)) == movebank(*rows)

    @given(st.floats(-80.0, 80.0), st.floats(-180.0, 180.0), coordinates, coordinates)
    def test_a_home_further_east_and_north_sees_the_animals_further_west_and_south(
        self, latitude: float, longitude: float, east_m: float, north_m: float
    ) -> None:
        row = f"{longitude!r},{latitude!r},a"
        per_degree_east = METRES_PER_DEGREE * math.cos(math.radians(latitude))
        home = GeoPoint(latitude + north_m / METRES_PER_DEGREE, longitude + east_m / per_degree_east, 7.0)
        tracks = movebank(f"2012-08-05 03:00:00,{row}", f"2012-08-05 03:00:10,{row}", home=home)
        assert tracks.origin == home
        # The plane of the new home is not quite the old one's: its parallel is up to 500 m away.
        assert tracks.at(0, 5.0) == pytest.approx((-east_m, -north_m, 0.0, 0.0), abs=0.5)


class TestTime:
    def test_a_walk_by_hand(self) -> None:
        tracks = meters("10,a,0,0", "12,a,4,-2", "16,a,4,6")
        assert tracks.at(0, 1.0) == (2.0, -1.0, 2.0, -1.0)
        assert tracks.at(0, 2.0) == (4.0, -2.0, 0.0, 2.0)  # at a fix: the velocity ahead
        assert tracks.at(0, 3.0) == (4.0, 0.0, 0.0, 2.0)
        assert tracks.at(0, 6.0) == (4.0, 6.0, 0.0, 2.0)  # at the last fix: the velocity behind
        assert tracks.duration_s == 6.0

    def test_animals_appear_at_their_first_fix_and_leave_after_their_last(self) -> None:
        tracks = meters("0,early,0,0", "10,early,10,0", "5,late,0,0", "15,late,0,10")
        assert tracks.names == ("early", "late")
        assert [tracks.at(0, t) is not None for t in (-0.1, 0.0, 10.0, 10.1)] == [False, True, True, False]
        assert [tracks.at(1, t) is not None for t in (4.9, 5.0, 15.0, 15.1)] == [False, True, True, False]
        assert tracks.duration_s == 15.0

    def test_inside_a_gap_the_animal_is_absent_and_at_its_ends_present(self) -> None:
        tracks = meters("0,a,0,0", "1,a,1,0", "4,a,2,0", "5,a,2,3", max_gap_s=2.0)
        assert tracks.at(0, 1.0) == (1.0, 0.0, 1.0, 0.0)  # the velocity behind: ahead lies the gap
        assert [tracks.at(0, t) for t in (1.1, 2.5, 3.9)] == [None, None, None]
        assert tracks.at(0, 4.0) == (2.0, 0.0, 0.0, 3.0)

    def test_a_fix_alone_between_two_gaps_stands_still_for_its_instant(self) -> None:
        tracks = meters("0,a,0,0", "1,a,1,0", "10,a,5,5", "20,a,9,9", max_gap_s=2.0)
        assert tracks.at(0, 10.0) == (5.0, 5.0, 0.0, 0.0)
        assert tracks.at(0, 9.9) is None
        assert tracks.at(0, 10.1) is None
        assert tracks.at(0, 20.0) == (9.0, 9.0, 0.0, 0.0)

    def test_fixes_exactly_the_longest_gap_apart_hold_together_whatever_the_rounding(self) -> None:
        clock = ("2012-08-05 03:00:00.001,0,0,z", "2012-08-05 03:00:01.001,0,0,z")
        rows = [f"2012-08-05 03:{i // 2:02d}:{30 * (i % 2):02d}.999,0,0,a" for i in range(100)]
        tracks = movebank(*clock, *rows)
        assert max(b - a for a, b in pairwise(tracks.times_s[0])) > 30.0  # the rounding that must not matter
        assert all(tracks.at(0, 1.0 + 10.0 * k) is not None for k in range(297))

    def test_max_gap_is_half_a_minute_unless_told(self) -> None:
        rows = ("0,a,0,0", "1,a,0,0", "31,a,0,0", "61.1,a,0,0")
        assert meters(*rows).at(0, 30.0) is not None
        assert meters(*rows).at(0, 45.0) is None
        assert meters(*rows, max_gap_s=30.2).at(0, 45.0) is not None

    def test_of_two_rows_with_one_animal_and_time_the_last_wins(self) -> None:
        tracks = meters("0,a,0,0", "1,a,50,50", "1,a,2,0", "1,b,7,7", "2,b,8,8")
        assert tracks.at(0, 0.5) == (1.0, 0.0, 2.0, 0.0)
        assert tracks.repeated_times == 1

    def test_movebank_times_are_utc_with_or_without_fraction_and_offset(self) -> None:
        tracks = movebank(
            "2012-08-05 03:00:00,0,0,a",
            "2012-08-05 03:00:00.5,0,0,a",
            "2012-08-05T03:00:01.999Z,0,0,a",
            "2012-08-05 06:00:03.000001+03:00,0,0,a",
        )
        assert tracks.times_s == ((0.0, 0.5, 1.999, 3.000001),)

    def test_a_repeated_movebank_time_is_one_however_it_is_written(self) -> None:
        tracks = movebank("2012-08-05 03:00:00,0,0,a", "2012-08-05 03:00:01,0,0,a", "2012-08-05 04:00:01+01:00,1,0,a")
        assert tracks.times_s == ((0.0, 1.0),)
        assert tracks.repeated_times == 1


class TestPlace:
    def test_a_degree_is_as_long_as_the_autopilot_says(self) -> None:
        tracks = movebank(
            "2012-08-05 03:00:00,36.0,60.0,a", "2012-08-05 03:00:10,36.001,60.001,a", home=GeoPoint(60.0, 36.0, 0.0)
        )
        # 111319.4908 m a degree of latitude, half that a degree of longitude at 60 degrees north
        assert tracks.at(0, 10.0) == pytest.approx((55.6597454, 111.3194908, 5.56597454, 11.13194908))

    def test_without_home_the_origin_is_the_median_fix_which_one_wild_fix_does_not_move(self) -> None:
        rows = [f"2012-08-05 03:00:0{i},36.{i},-1.{i},a" for i in range(1, 6)]
        assert movebank(*rows).origin == GeoPoint(-1.3, 36.3, 0.0)
        assert movebank(*rows[:4], "2012-08-05 03:00:05,170,-80,a").origin == GeoPoint(-1.3, 36.3, 0.0)

    def test_the_origin_is_a_place_mavlink_can_hold(self) -> None:
        rows = ("2012-08-05 03:00:00,36.92300491,0.35090011,a", "2012-08-05 03:00:01,36.92300493,0.35090013,a")
        assert movebank(*rows).origin == GeoPoint(0.3509001, 36.9230049, 0.0)

    @pytest.mark.parametrize("about", [179.999, -179.999])
    def test_tracks_may_cross_the_date_line(self, about: float) -> None:
        rows = ("2012-08-05 03:00:00,179.999,0,a", "2012-08-05 03:00:10,-179.999,0,a")
        state = movebank(*rows, home=GeoPoint(0.0, about, 0.0)).at(0, 5.0)
        assert state is not None
        assert abs(state[0]) == pytest.approx(0.001 * METRES_PER_DEGREE)
        assert state[2] == pytest.approx(0.0002 * METRES_PER_DEGREE)
        assert movebank(*rows).span_m == pytest.approx((-111.319491, 0.0, 111.319491, 0.0), abs=1e-6)

    def test_an_origin_beyond_the_date_line_is_still_a_longitude(self) -> None:
        rows = [f"2012-08-05 03:00:0{i},{east},0,a" for i, east in enumerate(("179.999", "-179.999", "-179.998"))]
        tracks = movebank(*rows)
        assert tracks.origin == GeoPoint(0.0, -179.999, 0.0)
        assert tracks.span_m == pytest.approx((-222.638982, 0.0, 111.319491, 0.0), abs=1e-6)

    def test_span_and_reach(self) -> None:
        tracks = meters("0,a,-3,4", "1,a,1,0", "0,b,2,-1", "1,b,0,0")
        assert tracks.span_m == (-3.0, -1.0, 2.0, 4.0)
        assert tracks.reach_m == 5.0

    def test_meters_are_about_the_home_already(self) -> None:
        home = GeoPoint(10.0, 20.0, 30.0)
        tracks = meters("0,a,1,2", "1,a,1,2", home=home)
        assert tracks.at(0, 0.0) == (1.0, 2.0, 0.0, 0.0)
        assert tracks.origin == home
        assert meters("0,a,1,2", "1,a,1,2").origin is None


class TestFile:
    def test_empty_positions_and_blank_lines_are_normal_and_counted(self) -> None:
        tracks = movebank("2012-08-05 03:00:00,0,0,a", "2012-08-05 03:00:01,,,a", "", "2012-08-05 03:00:02,0.1,0,a", "")
        assert tracks.times_s == ((0.0, 2.0),)
        assert tracks.empty_positions == 1

    def test_an_animal_never_present_is_left_out_by_name_and_does_not_set_the_clock(self) -> None:
        tracks = meters("-900,once,0,0", "0,a,0,0", "1,a,0,0", "0,far,0,0", "99,far,0,0", "3,nowhere,,")
        assert tracks.names == ("a",)
        assert tracks.left_out == ("far", "nowhere", "once")
        assert tracks.times_s == ((0.0, 1.0),)

    @pytest.mark.parametrize(
        "text",
        [
            "id,y,t,x\na,2,0,1\na,4,1,3\n",
            "t,id,x,y,speed\n0,a,1,2,9\n1,a,3,4,\n",
            't, id, x, y\r\n0, "a", 1, 2\r\n1, a , 3, 4\r\n',
            '"t","id","x","y"\n"0","a","1","2"\n"1","a","3","4"',
            "\ufefft,id,x,y\n0,a,1,2\n1,a,3,4\n",
        ],
        ids=["order", "more columns", "spaces and CRLF", "quotes", "byte order mark"],
    )
    def test_one_meaning_in_many_spellings(self, text: str, tmp_path: Path) -> None:
        path = tmp_path / "a.csv"
        path.write_bytes(text.encode())
        assert read_tracks(path) == meters("0,a,1,2", "1,a,3,4")

    def test_movebank_columns_as_the_web_page_and_as_the_api_write_them(self) -> None:
        web = (
            "event-id,visible,timestamp,location-long,location-lat,sensor-type,individual-local-identifier\n"
            '7,true,2012-08-05 03:00:00.000,36.9,0.3,"gps","a, the first"\n'
            '8,true,2012-08-05 03:00:01.000,36.9,0.3,"gps","a, the first"\n'
        )
        tracks = parse_tracks(web, source="a.csv")
        assert tracks.names == ("a, the first",)
        assert parse_tracks(web.replace("-long,", "_long,").replace("-local-", "_local_"), source="a.csv") == tracks

    def test_names_are_sorted_as_text(self) -> None:
        tracks = meters(*(f"{t},{name},{len(name)},0" for name in ("b", "a10", "a2") for t in (0, 1)))
        assert tracks.names == ("a10", "a2", "b")
        assert [tracks.x_m[i][0] for i in range(3)] == [3.0, 2.0, 1.0]

    @pytest.mark.parametrize("name", ["a.csv.gz", "a.csv"])
    def test_gzip_is_known_by_its_content(self, name: str, tmp_path: Path) -> None:
        path = tmp_path / name
        path.write_bytes(gzip.compress(b"t,id,x,y\n0,a,1,2\n1,a,3,4\n"))
        assert read_tracks(str(path)) == meters("0,a,1,2", "1,a,3,4")


class TestErrors:
    @pytest.mark.parametrize(
        ("row", "problem"),
        [
            ("1O,a,0,0", "t is '1O'; allowed: a number from -1e+10 to 1e+10"),
            ("1344135654999,a,0,0", "t is '1344135654999'; allowed: a number from -1e+10 to 1e+10"),
            ("nan,a,0,0", "t is 'nan'; allowed: a number from -1e+10 to 1e+10"),
            (",a,0,0", "t is ''; allowed: a number from -1e+10 to 1e+10"),
            ("1,,0,0", "id is empty; allowed: any text"),
            ("1,a,zero,0", "x is 'zero'; allowed: a number from -1e+07 to 1e+07"),
            ("1,a,0,inf", "y is 'inf'; allowed: a number from -1e+07 to 1e+07"),
            ("1,a,,0", "x is ''; allowed: a number from -1e+07 to 1e+07"),
            ("1,a,0", "3 fields; allowed: 4, as in the header"),
            ("1,a,0,0,0", "5 fields; allowed: 4, as in the header"),
            ("-0.5,a,0,0", "t of 'a' goes back from 0 to -0.5; allowed: never back"),
            (f"1,a,{'z' * 99},0", f"x is '{'z' * 40}...'; allowed: a number from -1e+07 to 1e+07"),
        ],
    )
    def test_a_bad_row_in_meters(self, row: str, problem: str) -> None:
        assert problems_of(lambda: meters("0,a,0,0", row, "2,a,0,0")) == [f"a.csv: line 3: {problem}"]

    @pytest.mark.parametrize(
        ("row", "problem"),
        [
            ("2012-08-05 03:00:01,0,90.1,a", "location-lat is '90.1'; allowed: a number from -90 to 90"),
            ("2012-08-05 03:00:01,-180.1,0,a", "location-long is '-180.1'; allowed: a number from -180 to 180"),
            ("2012-08-05 03:00:01,0,,a", "location-lat is ''; allowed: a number from -90 to 90"),
            ("2012-08-05 03:00:01,,,", "individual-local-identifier is empty; allowed: any text"),
            (
                "05/08/2012 03:00,0,0,a",
                "timestamp is '05/08/2012 03:00'; allowed: a date and time such as 2012-08-05 03:00:54.999 (UTC)",
            ),
        ],
    )
    def test_a_bad_row_of_movebank(self, row: str, problem: str) -> None:
        rows = ("2012-08-05 03:00:00,0,0,a", row, "2012-08-05 03:00:02,0,0,a")
        assert problems_of(lambda: movebank(*rows)) == [f"a.csv: line 3: {problem}"]

    def test_several_bad_rows_are_told_together_each_with_its_line(self) -> None:
        rows = ("0,a,0,0", "1,a,?,0", "", "2,a,0", "3,a,0,0")
        assert problems_of(lambda: meters(*rows)) == [
            "a.csv: line 3: x is '?'; allowed: a number from -1e+07 to 1e+07",
            "a.csv: line 5: 3 fields; allowed: 4, as in the header",
        ]

    def test_reading_stops_at_ten_problems(self) -> None:
        problems = problems_of(lambda: meters(*["0"] * 30))
        assert problems[:10] == [f"a.csv: line {n}: 1 fields; allowed: 4, as in the header" for n in range(2, 12)]
        assert problems[10:] == ["a.csv: reading stopped at 10 problems"]

    @pytest.mark.parametrize(
        ("text", "problem"),
        [
            ("", f"line 1: there is no header; allowed: {BOTH_LAYOUTS}"),
            ("t;id;x;y\n0;a;0;0\n", f"line 1: the columns are 't;id;x;y'; allowed: {BOTH_LAYOUTS}"),
            ("0,a,0,0\n1,a,0,0\n", f"line 1: the columns are '0, a, 0, 0'; allowed: {BOTH_LAYOUTS}"),
            ('t,id,x,y\n0,"a,0,0\n', "line 2: unexpected end of data; allowed: well-formed CSV"),
            (
                "t,id,x,y\n",
                "0 ids with 0 fixes, none to replay; allowed: at least one id with two fixes at most 30 s apart",
            ),
            (
                "t,id,x,y\n0,a,0,0\n0,b,0,0\n31,b,0,0\n",
                "2 ids with 3 fixes, none to replay; allowed: at least one id with two fixes at most 30 s apart",
            ),
        ],
        ids=["empty", "semicolons", "no header", "open quote", "no rows", "nothing usable"],
    )
    def test_a_bad_text(self, text: str, problem: str) -> None:
        assert problems_of(lambda: parse_tracks(text, source="a.csv")) == [f"a.csv: {problem}"]

    def test_a_broken_quote_is_told_after_the_bad_rows_before_it(self) -> None:
        assert problems_of(lambda: meters("0,a,?,0", '1,"a"b,0,0')) == [
            "a.csv: line 2: x is '?'; allowed: a number from -1e+07 to 1e+07",
            "a.csv: line 3: ',' expected after '\"'; allowed: well-formed CSV",
        ]

    @pytest.mark.parametrize(
        ("data", "problem"),
        [
            (b"t,id,x,y\n0,Zo\xeb,0,0\n", "line 2: byte 0xeb; allowed: text in UTF-8"),
            (gzip.compress(b"t,id,x,y\n0,a,0,0\n")[:-9], "broken or cut gzip; allowed: a whole gzip file"),
            (b"\x1f\x8b" + bytes(99), "broken or cut gzip; allowed: a whole gzip file"),
        ],
        ids=["latin-1", "cut gzip", "not gzip"],
    )
    def test_a_bad_file(self, data: bytes, problem: str, tmp_path: Path) -> None:
        path = tmp_path / "a.csv"
        path.write_bytes(data)
        assert problems_of(lambda: read_tracks(path)) == [f"{path}: {problem}"]

    def test_no_file(self, tmp_path: Path) -> None:
        path = tmp_path / "none.csv"
        allowed = "allowed: a CSV file, plain or gzip"
        assert problems_of(lambda: read_tracks(path)) == [f"{path}: No such file or directory; {allowed}"]
        assert problems_of(lambda: read_tracks(tmp_path)) == [f"{tmp_path}: Is a directory; {allowed}"]

    def test_the_error_is_a_value_error_that_survives_a_worker_process(self) -> None:
        error = TracksError("a.csv", ["line 2: 1 fields", "line 3: 1 fields"])
        assert isinstance(error, ValueError)
        copy = pickle.loads(pickle.dumps(error))
        assert (copy.source, copy.problems, str(copy)) == (error.source, error.problems, str(error))

    @given(st.text(alphabet='t,idxy0123.-"\n\r e\x00é', max_size=200))
    def test_any_text_gives_tracks_or_a_tracks_error(self, text: str) -> None:
        try:
            tracks = parse_tracks("t,id,x,y\n" + text, source="a.csv")
        except TracksError:
            return
        assert tracks.duration_s > 0.0

    @given(st.sampled_from([b"", b"t,id,x,y\n", b"\x1f\x8b\x08"]), st.binary(max_size=200))
    def test_any_bytes_give_a_tracks_error(
        self, tmp_path_factory: pytest.TempPathFactory, start: bytes, data: bytes
    ) -> None:
        path = tmp_path_factory.getbasetemp() / "any.csv"
        path.write_bytes(start + data)
        with pytest.raises(TracksError):
            read_tracks(path)
