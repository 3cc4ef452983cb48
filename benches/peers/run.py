#!/usr/bin/env python3
"""Gnomon beside what one could take instead, as whole processes, in one run: prints tables in Markdown.

    python benches/peers/run.py CITY.glb [--runs 7] [--tests T1,T2,T3,T4,F1,F2,minutes,low,probes,facades] [--raster PROGRAM]
                                         [--embree PROGRAM] [--embree-surfaces PROGRAM]
                                         [--peer 'NAME=COMMAND']...

The programs of others are for the reader to install. Two kinds have options of their own, as they take part in several tests:
--raster, a plain raster of projected triangles, and --embree, ray casting by Embree in packets; both are called as

    PROGRAM GLB SUNS N WEST SOUTH SIDE THREADS [PACKET] MODE OUT [robust]

with MODE mask, hours or top. --embree-surfaces is Embree's program for façades and roofs (F1, F2), called as

    PROGRAM GLB SUNS CELL THREADS OUT

with points CELL metres apart on every face. Any other program joins with --peer, where COMMAND may use {glb}, {suns} (a
line for each instant: the unit vector to the sun, x east, y north, z up), {n} (cells a side; F1, F2: a texel's side in
metres), {threads}, {test} (T1 to T4, F1, F2) and {out}.

Gnomon's hours are those of the instants alone, as the others' are (--resolution step); T2 and T4 have a further row with
hours to the minute, and T4 one of rays alone. Behind the letters come other tests: minutes, eight hours by the minute on
the highest surface; low, one instant there with the sun at 0.008°, beside one at noon; and, on the sample site
headquarters and by Gnomon alone, probes, points on façades and a year, one and 200 (--points FILE.csv for others), and
facades, January on surfaces with texels of a metre and a step of 15 minutes (--facade-days 365 for the whole year,
which takes most of an hour).

Programs take turns, so that ratios hold whatever else the machine does: each is the median of its turns' own ratios.
Seconds are medians; CPU is user and system time together; the peak is the largest resident size.
"""
import argparse, datetime, json, math, os, shutil, statistics, subprocess, sys, tempfile, time
from pathlib import Path

HERE = Path(__file__).resolve().parent
REGION = (-400, -400, 800)  # west, south, side, metres: the cells that every program judges
SITE = """[place]
latitude = 48.2
longitude = 16.37
time_zone = "UTC"
[[model]]
path = "{glb}"
[ground]
level = 0.0
[plan]
region = [-400, -400, 400, 400]
"""
T2 = "--date 2026-09-18 --from 07:00 --to 15:00 --step 1h"
YEAR = "--from-date 2026-01-01 --to-date 2026-12-31 --step 1h"
MINUTES = "--date 2026-09-18 --from 07:00 --to 15:00 --step 1min"
PROFILE = "profile {site} {study}"
HOURS = f"{PROFILE} --write tif,json"
SURFACES = "profile {site} {study} --patch-cell {n} --receivers surfaces --resolution step --write json --out {out}"
# test: cells a side (on façades the texels' side in metres), the study, what Gnomon is asked, the raster's program and Embree's
TESTS = {
    "T1": (2048, "--at 2026-09-18T13:00", "shadow {site} {study} --size 2048 --receivers ground --mask {out}.png", "mask"),
    "T2": (2048, T2, f"{PROFILE} --size 2048 --receivers ground --resolution step --out {{out}}", "mask"),
    "T2 tif,json": (2048, T2, f"{HOURS} --size 2048 --receivers ground --resolution step --out {{out}}", "mask"),
    "T3": (1024, YEAR, f"{HOURS} --size 1024 --receivers ground --resolution step --out {{out}}", "hours"),
    "T4": (2048, T2, f"{HOURS} --size 2048 --receivers top --resolution step --out {{out}}", "top"),
    "minutes": (2048, MINUTES, f"{HOURS} --size 2048 --receivers top --resolution step --out {{out}}", "top"),
    "low": (2048, "--at 2026-09-18T04:40:29", "shadow {site} {study} --size 2048 --receivers top --mask {out}.png", "top"),
    "low, noon": (
        2048,
        "--at 2026-09-18T10:50",
        "shadow {site} {study} --size 2048 --receivers top --mask {out}.png",
        "top",
    ),
    "F1": (0.5, T2, SURFACES, "surfaces"),
    "F2": (0.25, T2, SURFACES, "surfaces"),
}
# what else Gnomon is asked in the same table
FURTHER = {
    "T2 tif,json": {"Gnomon, hours to the minute": HOURS + " --size 2048 --receivers ground --resolution 1min --out {out}"},
    "T4": {
        "Gnomon, rays": HOURS + " --size 2048 --receivers top --technique ray-cast --resolution step --out {out}",
        "Gnomon, hours to the minute": HOURS + " --size 2048 --receivers top --resolution 1min --out {out}",
    },
}
HEADQUARTERS = HERE.parents[1] / "sites/headquarters"


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("model", type=Path, help="a city, z up as glTF has it, around the place")
    ask.add_argument("--gnomon", type=Path, default=HERE.parents[1] / "target/release/gnomon")
    ask.add_argument("--engine", default="cpu", help="Gnomon's (default: cpu)")
    ask.add_argument("--runs", type=int, default=7)
    ask.add_argument("--tests", default="T1,T2,T3,T4,minutes,low,probes,facades")
    ask.add_argument("--points", type=Path, help="the points of the test probes, as `gnomon probe --points` reads them")
    ask.add_argument("--facade-days", type=int, default=31)
    ask.add_argument("--threads", type=int, default=os.cpu_count())
    ask.add_argument("--raster", type=Path)
    ask.add_argument("--embree", type=Path)
    ask.add_argument("--embree-surfaces", type=Path)
    ask.add_argument("--peer", action="append", default=[], metavar="NAME=COMMAND")
    asked = ask.parse_args()
    glb = asked.model.resolve()
    if not glb.is_file():
        sys.exit(f"{glb} is not there; name a model")
    if not asked.gnomon.is_file():
        sys.exit(f"{asked.gnomon} is not there; build it with cargo build --release")
    with tempfile.TemporaryDirectory() as folder:
        compare(asked, glb, Path(folder))


def compare(asked, glb, folder):
    site = folder / "site.toml"
    site.write_text(SITE.format(glb=glb))
    gnomon = f"{asked.gnomon} {{command}} --engine {asked.engine} --threads {asked.threads} --no-refraction --quiet"
    wanted = [test for test in TESTS if test.replace(",", " ").split()[0] in asked.tests.split(",")]
    for test in wanted:
        cells, study, command, mode = TESTS[test]
        suns = write_suns(asked.gnomon, site, study, folder / "suns.txt")
        fill = dict(glb=glb, suns=suns, n=cells, threads=asked.threads, site=site, study=study, test=test.split()[0])
        ours = gnomon.format(command=command.format(out=folder / "gnomon", **fill))
        commands = {"Gnomon": ours}
        for name, further in FURTHER.get(test, {}).items():
            commands[name] = gnomon.format(command=further.format(out=folder / "further", **fill))
        raster = f"{fill['glb']} {suns} {cells} {REGION[0]} {REGION[1]} {REGION[2]} {asked.threads}"
        on_surfaces = mode == "surfaces"
        if asked.raster and mode in ("mask", "hours"):
            commands["plain raster"] = f"{asked.raster} {raster} {mode} {folder / 'raster.bin'}"
        if asked.embree_surfaces and on_surfaces:
            program = f"{asked.embree_surfaces} {glb} {suns} {cells} {asked.threads}"
            commands["Embree, packets of 16"] = f"{program} {folder / 'embree.bin'}"
        if asked.embree and not on_surfaces:
            commands["Embree, packets of 16"] = f"{asked.embree} {raster} 16 {mode} {folder / 'embree.bin'} robust"
        for peer in asked.peer:
            name, _, peer_command = peer.partition("=")
            commands[name] = peer_command.format(out=folder / "peer", **fill)
        judged = f"texels of {cells} m" if on_surfaces else f"{cells} × {cells} cells"
        title = f"{test}: {len(suns.read_text().splitlines())} instants, {judged}"
        table(title, commands, asked.runs if test not in ("T3", "minutes") else min(asked.runs, 2))
    if "probes" in asked.tests.split(","):
        probes(asked, folder)
    if "facades" in asked.tests.split(","):
        facades(asked, folder)


def probes(asked, folder):
    """One point and 200 on the façades of headquarters, all days of a year."""
    program = f"{asked.gnomon} probe {HEADQUARTERS} --threads {asked.threads} --quiet"
    year = "--from-date 2026-01-01 --to-date 2026-12-31"
    points = asked.points or facade_points(program, folder)
    head, *lines = points.read_text().splitlines()
    few = folder / "few.csv"
    few.write_text("\n".join([head, *lines[:200]]))
    commands = {
        "Gnomon": f"{program} --point 60,-60,1.2 {year} --totals {folder / 'one.csv'}",
        "Gnomon, one day": f"{program} --point 60,-60,1.2 --date 2026-06-21 --totals {folder / 'day.csv'}",
        f"Gnomon, {min(len(lines), 200)} points": f"{program} --points {few} {year} --totals {folder / 'few-totals.csv'}",
    }
    table("probes: one point and 365 days, headquarters", commands, min(asked.runs, 3))


def facade_points(program, folder):
    """Points on the walls around the headquarters, a metre and a half above the ground, spread over all of them."""
    command = f"{program} --json --date 2026-06-21 --on neighbours --spacing 2 --height 1.5"
    found = json.loads(subprocess.run(command.split(), check=True, capture_output=True).stdout)["probes"]
    every = max(len(found) // 1000, 1)
    lines = ["name,x,y,z,nx,ny,nz"]
    lines += [",".join(map(str, [f"p{at}", *it["point"], *it["normal"]])) for at, it in enumerate(found[::every])]
    points = folder / "points.csv"
    points.write_text("\n".join(lines))
    return points


def facades(asked, folder):
    """The first days of a year on all surfaces of headquarters."""
    last = datetime.date(2026, 1, 1) + datetime.timedelta(days=asked.facade_days - 1)
    command = (
        f"{asked.gnomon} profile {HEADQUARTERS} --receivers surfaces --patch-cell 1 --step 15min --write json"
        f" --from-date 2026-01-01 --to-date {last} --engine {asked.engine} --threads {asked.threads} --quiet"
    )
    hours = {"Gnomon": f"{command} --out {folder / 'hours'}"}
    hours["Gnomon, instants alone"] = f"{command} --resolution step --out {folder / 'instants'}"
    table(f"facades: {asked.facade_days} days every 15 minutes, headquarters, texels of 1 m", hours, 1)


def write_suns(gnomon, site, study, path):
    """The instants with a sun, as Gnomon has them without refraction."""
    command = [gnomon, "sun", site, *study.split(), "--no-refraction", "--json"]
    told = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    lines = []
    for instant in told["instants"]:
        if not instant["night"]:
            azimuth, altitude = (math.radians(instant[key]) for key in ("azimuth_deg", "altitude_deg"))
            east, north = math.sin(azimuth) * math.cos(altitude), math.cos(azimuth) * math.cos(altitude)
            lines.append(f"{east:.17g} {north:.17g} {math.sin(altitude):.17g}\n")
    path.write_text("".join(lines))
    return path


def table(title, commands, runs):
    turns = {name: [] for name in commands}
    for _ in range(runs):
        for name, command in commands.items():
            turns[name].append(run(name, command))
    print(f"\n## {title}, {runs} runs\n")
    print("| program | wall, s | CPU, s | peak, MiB | wall, times Gnomon's | CPU, times Gnomon's |\n|---|---|---|---|---|---|")
    ours = turns["Gnomon"]
    for name, taken in turns.items():
        wall, cpu, peak = (statistics.median(column) for column in zip(*taken))
        ratio = [statistics.median(its[at] / own[at] for its, own in zip(taken, ours)) for at in (0, 1)]
        print(f"| {name} | {wall:.3f} | {cpu:.3f} | {peak:.0f} | {ratio[0]:.2f} | {ratio[1]:.2f} |", flush=True)


def run(name, command):
    """Wall and CPU seconds and MiB of a whole process."""
    shutil.rmtree(command.split()[-1], ignore_errors=True)
    started = time.perf_counter()
    process = subprocess.Popen(command.split(), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    told = process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    wall = time.perf_counter() - started
    if status != 0:
        sys.exit(f"{name} failed: {command}\n{told.decode(errors='replace')}")
    return wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


main()
