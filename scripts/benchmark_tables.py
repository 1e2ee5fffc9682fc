# SPDX-FileCopyrightText: 2026 beautymap contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints what scripts/benchmark measured as Markdown tables, and writes it to FOLDER/results.json.

usage: benchmark_tables.py FOLDER
FOLDER/stages.json is Google Benchmark's output, FOLDER/runs/INPUT/CONFIG/report.json a replay's.
"""
import json
import pathlib
import sys

COLUMNS_PER_TILE = 32 * 32


def stage_times(path):
    """-> {stage: {(beams, res_g in cm): {'ms', 'to_floor'}}}, and {name: {'ms', 'map_mb'}} of the
    benchmarks without these two."""
    stages, others = {}, {}
    for result in json.loads(path.read_text())["benchmarks"]:
        name, *arguments = result["name"].replace("/process_time", "").split("/")
        name = name.replace("<kDefault>", ", default").replace("<kPaper>", ", paper_kitti")
        values = dict(argument.split(":") for argument in arguments)
        if "beams" in values:
            key = (int(values["beams"]), int(values["res_g_cm"]))
            stages.setdefault(name, {})[key] = {"ms": result["cpu_time"]}
        else:
            # Of a road the counters tell more: a scan's share of the time, and the map's memory.
            whole_s = result.get("s_per_scan")
            others[name + "".join(f", {argument}" for argument in arguments)] = {
                "ms": result["cpu_time"] if whole_s is None else 1000 * whole_s,
                "map_mb": result.get("map_MB"),
            }
    for times in stages.values():
        for key, time in times.items():
            time["to_floor"] = time["ms"] / stages["floor"][key]["ms"]
    return stages, others


def print_table(header, rows):
    for cells in [header, ["---"] * len(header), *rows]:
        print("| " + " | ".join(cells) + " |")
    print()


def print_stages(stages):
    beams = sorted({key[0] for times in stages.values() for key in times})
    cells = sorted({key[1] for times in stages.values() for key in times})
    print("Milliseconds of CPU for a scan, one thread; in brackets: to the floor\n")
    for title, keys in (
        ("64 beams, res_g", [(64, cell) for cell in cells]),
        ("res_g 1 m, beams", [(count, 100) for count in beams]),
    ):
        labels = [f"{k[1] / 100:g} m" if k[0] == 64 and "64" in title else str(k[0]) for k in keys]
        rows = [
            [name] + [f"{times[k]['ms']:.3f} ({times[k]['to_floor']:.1f})" for k in keys]
            for name, times in stages.items()
        ]
        print_table([title] + labels, rows)


def whole_runs(folder):
    runs = []
    for path in sorted(folder.glob("runs/*/*/report.json")):
        report = json.loads(path.read_text())
        tile_m2 = COLUMNS_PER_TILE * report["matrix"]["cell_size_m"] ** 2
        runs.append({
            "input": path.parts[-3],
            "config": path.parts[-2],
            "scans_per_s": report["scans_per_s"],
            "stages_ms": report["stages_ms"],
            "peak_memory_mb": report["peak_memory_mb"],
            "bytes_per_m2": report["matrix"]["memory_mb"] * 2**20
            / (report["matrix"]["tiles"] * tile_m2),
            "points_per_scan": report["points"] / report["scans"],
        })
    return runs


def print_runs(runs):
    names = list(dict.fromkeys(stage for run in runs for stage in run["stages_ms"]))
    rows = [
        ["points a scan"] + [f"{run['points_per_scan']:.0f}" for run in runs],
        ["scans/s"] + [f"{run['scans_per_s']:.1f}" for run in runs],
        ["peak memory [MB]"] + [f"{run['peak_memory_mb']:.0f}" for run in runs],
        ["matrix [bytes/m2]"] + [f"{run['bytes_per_m2']:.0f}" for run in runs],
    ]
    for name in names:
        times = [run["stages_ms"].get(name) for run in runs]
        rows.append([name + " [ms]"] + ["" if ms is None else f"{ms:.2f}" for ms in times])
    print("Whole runs; the stages' milliseconds a scan add up to more than the run, as threads "
          "share them\n")
    print_table(["replay"] + [f"{run['input']}, {run['config']}" for run in runs], rows)


def main():
    folder = pathlib.Path(sys.argv[1])
    stages, others = stage_times(folder / "stages.json")
    runs = whole_runs(folder)
    print()
    print_stages(stages)
    print("A scan seen first on new ground; a whole scan in maps of 1, 10 and 100 areas; and along a "
          "road\n")
    print_table(["", "ms", "map [MB]"], [
        [name.replace(", iterations:1", ""), f"{other['ms']:.3f}",
         "" if other["map_mb"] is None else f"{other['map_mb']:.0f}"]
        for name, other in others.items()])
    print_runs(runs)
    results = {
        "stages": [
            {"stage": name, "beams": key[0], "res_g_m": key[1] / 100, **time}
            for name, times in stages.items() for key, time in times.items()
        ],
        "maps": others,
        "runs": runs,
    }
    (folder / "results.json").write_text(json.dumps(results, indent=1) + "\n")


main()
