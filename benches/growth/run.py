#!/usr/bin/env python3
"""How Gnomon's time and memory grow with triangles and with cells, as whole processes: prints tables in Markdown.

    python benches/growth/run.py CITY.glb [--gnomon PROGRAM] [--triangles 1,10,100] [--cells 1,4,16] [--memory 256MiB]

The city is repeated side by side, as often as asked; its nodes are, so that the file stays small, but every copy is
loaded, welded and has its own edges. The plan covers all copies in 2048 × 2048 cells; with --cells it covers one city in
so many times as many. The instants are those of a day, one every four hours and one every half hour: what an instant costs is
the difference of both runs over that of their instants, so that it is free of loading and writing. Runs take turns, and
the median counts. CPU is user and system time together; the peak is the largest resident size.
"""
import argparse, json, math, os, shutil, statistics, struct, subprocess, sys, tempfile, time
from pathlib import Path

HERE = Path(__file__).resolve().parent
WINDOW = "--date 2026-09-18 --from 08:00 --to 16:00"
STEPS = (("4h", 3), ("30min", 17))
SITE = """[place]
latitude = 48.2
longitude = 16.37
time_zone = "UTC"
[[model]]
path = "city.glb"
[ground]
level = 0.0
[plan]
region = {region}
"""


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("model", type=Path, help="a city, as glTF has it, around the place")
    ask.add_argument("--gnomon", type=Path, default=HERE.parents[1] / "target/release/gnomon")
    ask.add_argument("--triangles", default="1,10,100", help="times those of the city")
    ask.add_argument("--cells", default="1,4,16", help="times 2048 × 2048")
    ask.add_argument("--receivers", default="ground,top")
    ask.add_argument("--memory", default="256MiB", help="the budget of the runs in tiles")
    ask.add_argument("--runs", type=int, default=3)
    ask.add_argument("--threads", type=int, default=os.cpu_count())
    asked = ask.parse_args()
    if not asked.gnomon.is_file():
        sys.exit(f"{asked.gnomon} is not there; build it with cargo build --release")
    numbers = lambda text: [int(number) for number in text.split(",") if number]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for receivers in asked.receivers.split(","):
            head(f"Triangles, receivers {receivers}: 2048 × 2048 cells over all of the city")
            first = None
            for copies in numbers(asked.triangles):
                triangles, region = city(asked.model, copies, folder)
                first = row(asked, folder, f"{triangles:,}", copies, 2048, receivers, region, [], first)
            head(f"Cells, receivers {receivers}: one city")
            first = None
            for cells in numbers(asked.cells):
                _, region = city(asked.model, 1, folder)
                size = round(2048 * math.sqrt(cells))
                first = row(asked, folder, f"{size} × {size}", cells, size, receivers, region, [], first)
            for cells in numbers(asked.cells):
                size = round(2048 * math.sqrt(cells))
                budget = ["--memory", asked.memory]
                row(asked, folder, f"{size} × {size}, {' '.join(budget)}", cells, size, receivers, region, budget, first)


def head(title):
    print(f"\n## {title}\n\n| | times | whole, wall s | whole, CPU s | an instant, CPU ms | times the first | peak, MiB |")
    print("|---|---|---|---|---|---|---|")


def city(model, copies, folder):
    """Writes the city repeated, and tells how many triangles that has and which region it covers."""
    data = model.read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    gltf, rest = json.loads(data[20:20 + length]), data[20 + length:]
    bounds = [gltf["accessors"][primitive["attributes"]["POSITION"]]
              for mesh in gltf["meshes"] for primitive in mesh["primitives"]]
    # glTF's x and z are east and south
    low = [min(each["min"][axis] for each in bounds) for axis in (0, 2)]
    high = [max(each["max"][axis] for each in bounds) for axis in (0, 2)]
    pitch = [math.ceil(high[axis] - low[axis]) + 8 for axis in (0, 1)]
    side = math.ceil(math.sqrt(copies))
    nodes, roots = [], []
    for copy in range(copies):
        first = len(nodes)
        for node in gltf["nodes"]:
            node = dict(node, name=f"{node.get('name', 'node')} {copy}")
            if "children" in node:
                node["children"] = [first + child for child in node["children"]]
            nodes.append(node)
        moved = [(copy % side) * pitch[0], 0, (copy // side) * pitch[1]]
        top = [first + root for root in gltf["scenes"][gltf.get("scene", 0)]["nodes"]]
        nodes.append({"name": f"copy {copy}", "translation": moved, "children": top})
        roots.append(len(nodes) - 1)
    gltf["nodes"], gltf["scenes"], gltf["scene"] = nodes, [{"nodes": roots}], 0
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    whole = struct.pack("<III", 0x46546C67, 2, 20 + len(text) + len(rest))
    (folder / "city.glb").write_bytes(whole + struct.pack("<II", len(text), 0x4E4F534A) + text + rest)
    of_one = sum(gltf["accessors"][primitive["indices"]]["count"] // 3
                 for mesh in gltf["meshes"] for primitive in mesh["primitives"])
    rows = math.ceil(copies / side)
    around = 100
    region = [low[0] - around, -(high[1] + (rows - 1) * pitch[1]) - around,
              high[0] + (side - 1) * pitch[0] + around, -low[1] + around]
    # a square
    length = max(region[2] - region[0], region[3] - region[1])
    region = [region[0], region[1], region[0] + length, region[1] + length]
    (folder / "site.toml").write_text(SITE.format(region=region))
    return of_one * copies, region


def row(asked, folder, name, times, size, receivers, region, budget, first):
    command = [asked.gnomon, "profile", folder, *WINDOW.split(), "--size", str(size), "--receivers", receivers]
    command += ["--resolution", "step", "--engine", "cpu", "--threads", str(asked.threads), "--write", "json", "--quiet"]
    command += ["--out", folder / "out", *budget]
    turns = [[run([*command, "--step", step], folder) for step, _ in STEPS] for _ in range(asked.runs)]
    few, many = [[statistics.median(turn[at][of] for turn in turns) for of in range(3)] for at in (0, 1)]
    an_instant = statistics.median(turn[1][1] - turn[0][1] for turn in turns) / (STEPS[1][1] - STEPS[0][1]) * 1e3
    peak = max(few[2], many[2])
    first = first or an_instant
    print(f"| {name} | {times} | {few[0]:.2f} | {few[1]:.2f} | {an_instant:.1f} | {an_instant / first:.2f} | {peak:.0f} |",
          flush=True)
    return first


def run(command, folder):
    """Wall and CPU seconds and MiB of a whole process."""
    shutil.rmtree(folder / "out", ignore_errors=True)
    started = time.perf_counter()
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    told = process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    wall = time.perf_counter() - started
    if status != 0:
        sys.exit(f"{' '.join(map(str, command))} failed\n{told.decode(errors='replace')}")
    return wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


main()
