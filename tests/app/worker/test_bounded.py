import subprocess
import sys
from pathlib import Path

from tests.patience import PATIENCE_S

BEGIN = "import sys; from pathlib import Path; from app.worker.bounded import bounded, one_at_a_time\n"


def ran(program: str, *arguments: object) -> "subprocess.CompletedProcess[str]":
    command = [sys.executable, "-c", BEGIN + program, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S)


def test_memory_beyond_the_bound_is_refused_and_afterwards_there_is_no_bound() -> None:
    done = ran(
        "small = 64 << 20\n"
        "with bounded(4 * small, 60):\n"
        "    bytearray(small)\n"
        "    try: bytearray(5 * small)\n"
        "    except MemoryError: print('refused')\n"
        "print(len(bytearray(5 * small)) // small)\n"
    )
    assert done.stdout.split() == ["refused", "5"], done.stderr


def test_a_process_that_takes_too_much_processor_time_is_ended() -> None:
    done = ran("with bounded(1 << 30, 1):\n    while True: pass\n")
    assert done.returncode < 0


def test_two_processes_take_turns(tmp_path: Path) -> None:
    """Each has its turn until all have asked for theirs, and looks which of them have one."""
    program = (
        "from tests.patience import wait_until\n"
        "folder, name = Path(sys.argv[1]), sys.argv[2]\n"
        "(folder / f'{name} asks').touch()\n"
        "with one_at_a_time(folder):\n"
        "    (folder / f'{name} has').touch()\n"
        "    wait_until(lambda: len(list(folder.glob('* asks'))) == 3)\n"
        "    print(len(list(folder.glob('* has')))); (folder / f'{name} has').unlink()\n"
    )
    commands = [[sys.executable, "-c", BEGIN + program, str(tmp_path), name] for name in "abc"]
    running = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for command in commands]
    assert [one.communicate(timeout=PATIENCE_S)[0].strip() for one in running] == ["1", "1", "1"]
