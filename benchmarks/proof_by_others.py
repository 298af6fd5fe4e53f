"""What other programs say of plans and programs of this project, in one table: largest differences, planted faults.

Four checks, each by programs that nobody here wrote: meshes of cutter, shank and holder against the part's mesh;
LinuxCNC's interpreter and kinematics; material removal by cutrail; tilted planes by scipy.  Each is also given plans
and programs with planted faults and must find them.  A check whose program is not there is left out, and the table says
why.
"""

from collections.abc import Callable, Sequence

from benchmarks._others import Check, Unavailable
from benchmarks._others_angles import compare_angles
from benchmarks._others_control import TRUNNIONS, compare_control
from benchmarks._others_distances import compare_distances
from benchmarks._others_removal import TOOL, compare_removal

#: What can be checked, in the order of the table.
CHECKS: dict[str, Callable[[], Check]] = {
    "distances": compare_distances, "moving": lambda: compare_distances("dish", TOOL, count=60, strategy="sturz"),
    "removal": compare_removal, "removal-moving": lambda: compare_removal(strategy="sturz"),
    "control": compare_control, "angles": compare_angles}
#: The same in less time: fewer motions and orientations, one machine, nothing that is fetched or built.
SHORT: dict[str, Callable[[], Check]] = {
    "distances": lambda: compare_distances("dish", TOOL, count=40),
    "control": lambda: compare_control(TRUNNIONS[:1], "dish", fetch=False), "angles": lambda: compare_angles(60)}


def print_table(checks: dict[str, Callable[[], Check]]) -> bool:
    """Print a row for each check that can run here; whether all agree and find every planted fault.

    Parameters
    ----------
    checks : dict of str to callable
    """
    print(f"{'program':44} {'checks':56} {'how many':>17} {'largest difference':>23} {'allowed':>21} "
          f"{'faults found':>12}")
    notes, sound = list[str](), True
    for name, check in checks.items():
        try:
            row = check()
        except Unavailable as reason:
            print(f"{name}: not measured: {reason}", flush=True)
            continue
        told = f"{sum(row.found.values())} of {len(row.found)}"
        print(f"{row.program:44} {row.checks:56} {row.count:>17} {row.difference:>23} {row.allowed:>21} {told:>12}"
              f"{'' if row.agrees else '  DIFFERS'}", flush=True)
        notes += [*row.notes, f"planted faults for {name}: " + ", ".join(
            f"{fault} {'found' if found else 'NOT FOUND'}" for fault, found in row.found.items())]
        sound &= row.agrees and all(row.found.values())
    print("\n".join(notes))
    return sound


def main() -> None:
    """All checks."""
    print_table(CHECKS)


def short() -> None:
    """What takes less time."""
    print_table(SHORT)


def run_with(words: Sequence[str]) -> int:
    """Only the checks that are named; 1 where one differs or misses a planted fault.

    Parameters
    ----------
    words : sequence of str
    """
    return int(not print_table({name: check for name, check in CHECKS.items() if name in words}))


if __name__ == "__main__":
    main()
