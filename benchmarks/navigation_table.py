"""Print the navigation filter's table of faults, in Markdown.

    .venv/bin/python benchmarks/navigation_table.py [--seeds N] [--survey] [--only dvl] [--thrusts]

For each fault and vehicle, over the seeds (and two motions with --survey): the greatest error of
the position, the
share of the ticks inside 3 sigma, and the greatest jump of the output in sigma. With --thrusts the
filter is told the thrusts, of a hull whose drag and added mass differ by up to 20 %, in a current
of 0.3 m/s.
"""

import argparse

from navigation_runs import VEHICLES, fault_rows

from uvms_core.vehicle import load_vehicle


def main() -> None:
    """One table with both vehicles."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--survey", action="store_true", help="a second motion, too")
    parser.add_argument("--only", default="", help="faults whose names begin so")
    parser.add_argument("--thrusts", action="store_true", help="the filter is told the thrusts")
    options = parser.parse_args()
    motions = (None, "survey") if options.survey else (None,)
    print("| fault | " + " | ".join(f"{name}: error, inside, jump" for name in VEHICLES) + " |")
    print("|---" * (1 + len(VEHICLES)) + "|")
    tables = [
        fault_rows(load_vehicle(name), options.seeds, motions, options.only, options.thrusts)
        for name in VEHICLES
    ]
    for rows in zip(*tables, strict=True):
        cells = [f"{row.error:.2f} m, {100.0 * row.inside:.1f} %, {row.jump:.1f}" for row in rows]
        print(f"| {rows[0].name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
