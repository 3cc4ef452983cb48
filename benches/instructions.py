#!/usr/bin/env python3
"""Instructions of whole processes under callgrind, which other work on the machine does not sway: prints a table in
Markdown, and holds it against the one in docs/benchmarks/counts.md.

    python benches/instructions.py [--gnomon PROGRAM] [--write]

It needs valgrind, and takes a minute on the dev build, which whoever changes the code has: it is no part of the tests. It fails where a count is off
the recorded one by more than 5 %; --write puts what it finds into the document in place of what is there. Another
compiler makes other code, so the counts are recorded with their compiler's name.
"""
import argparse, re, shutil, subprocess, sys, tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
RECORD = ROOT / "docs/benchmarks/counts.md"
TOLERANCE = 0.05
STUDY = "--engine cpu --size 512 --step 2h --resolution step --quiet --threads 1 --out {out}"
COMMANDS = {
    "load headquarters": "check sites/headquarters --threads 1",
    "ground, 3 instants": f"profile sites/tower --receivers ground --write json {STUDY}",
    "ground, in tiles": f"profile sites/tower --receivers ground --write json --memory 512KiB {STUDY}",
    "top, 3 instants": f"profile sites/tower --write json {STUDY}",
    "top, rays": f"profile sites/tower --technique ray-cast --write json {STUDY}",
    "ground, all files": f"profile sites/tower --receivers ground {STUDY}",
}
ROW = re.compile(r"^\| (.+?) \| ([\d,]+) \|$", re.M)


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("--gnomon", type=Path, default=ROOT / "target/debug/gnomon")
    ask.add_argument("--write", action="store_true")
    asked = ask.parse_args()
    if not shutil.which("valgrind"):
        sys.exit("valgrind is not there; install it")
    if not asked.gnomon.is_file():
        sys.exit(f"{asked.gnomon} is not there; build it with cargo build")
    text = RECORD.read_text()
    before, heading, rest = text.partition("## Instructions")
    recorded = {name: int(count.replace(",", "")) for name, count in ROW.findall(rest)}
    rows, off = [], []
    print("| process | instructions |\n|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, command in COMMANDS.items():
            count = instructions(asked.gnomon, command.format(out=folder), folder)
            rows.append(f"| {name} | {count:,} |")
            print(rows[-1], flush=True)
            was = recorded.get(name)
            if was is None or abs(count - was) > TOLERANCE * was:
                off.append(f"{name}: {count:,}, recorded {was}")
    if asked.write:
        compiler = subprocess.run(["rustc", "--version"], check=True, capture_output=True, text=True).stdout.strip()
        rest = re.sub(r"Compiled by .*", f"Compiled by {compiler}.", rest)
        rest = re.sub(r"(\|---\|---\|\n).*", lambda found: found[1] + "\n".join(rows) + "\n", rest, flags=re.S)
        RECORD.write_text(before + heading + rest)
    elif off:
        sys.exit("off by more than 5 %:\n" + "\n".join(off) + "\nwhere that is meant, run it with --write")


def instructions(gnomon, command, folder):
    valgrind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/callgrind.out"]
    told = subprocess.run([*valgrind, gnomon, *command.split()], cwd=ROOT, capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", told.stderr)
    if told.returncode != 0 or not found:
        sys.exit(f"{command} failed:\n{told.stderr}")
    return int(found[1])


main()
