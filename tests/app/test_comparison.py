from dataclasses import replace
from io import StringIO

from rich.console import Console

from app.comparison import Comparison, compared
from app.tables import comparison_table
from planner import load_garment
from planner.message import Message
from planner.task.reason import Code, Reason
from planner.task.task import Limits


def printed(one: Comparison) -> str:
    console = Console(width=400, file=StringIO(), record=True)
    console.print(comparison_table([one]))
    return console.export_text()


def test_a_robot_whose_search_ran_out_of_time_is_told_to_have_done_so() -> None:
    (one,) = compared(load_garment("t-shirt"), ["pr2"], Limits(time_limit_s=0.01))
    assert one.plan.status == "budget_exceeded" and one.to_dict()["is_cut_short"]
    assert "not known" in printed(one) and "the time limit of 0.01 s" in printed(one)


def test_a_no_that_names_no_cause_says_that_the_time_ran_out_and_a_cause_comes_before_what_waits() -> None:
    (one,) = compared(load_garment("t-shirt"), ["pr2"], Limits(time_limit_s=0.01))
    waits = Reason(3, Code.WAITS_FOR_FOLD, Message.plain("fold 3 waits for fold 1"))
    short = Reason(1, Code.OUT_OF_REACH, Message.plain("0.1 m out of reach"), set=0)
    no = replace(
        one.plan, status="infeasible", reasons=(waits,), statistics=replace(one.plan.statistics, is_cut_short=False)
    )
    assert "the time limit of 0.01 s" in printed(replace(one, plan=no))
    known = replace(one, plan=replace(no, reasons=(waits, short)))
    assert not known.is_cut_short
    assert "out of reach" in printed(known) and "time limit" not in printed(known)
