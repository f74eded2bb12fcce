#!/usr/bin/python3
"""Runs the commands of a tutorial in an empty folder, and holds what they print against what the page shows.

    run_tutorial.py PAGE.md --program TOOTHPATH [--module FOLDER]

Commands are the lines "    $ .." of the page; "# exit code N" behind one says how it ends (default 0). What stands below is what it prints:
"..." as a line stands for any lines, within a line for any text. A fenced block behind "This is `NAME`:" is the file NAME. `samples` lies in the
folder. --module: where the Python module lies. The first difference is told with its line; exit code 1.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile

REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def steps_of(page):
    """[(line, command, exit code, [shown lines])] and {name: text of a file}."""
    steps, files, fence, name = [], {}, None, None
    for number, line in enumerate(open(page, encoding="utf-8").read().split("\n"), 1):
        if line.startswith("```"):
            fence = None if fence is not None else []
            if fence is not None and name:
                files[name] = fence
            continue
        if fence is not None:
            fence.append(line)
        elif line.startswith("    $ "):
            command, _, code = line[6:].partition("# exit code ")
            steps.append((number, command.strip(), int(code or 0), []))
        elif line.startswith("    ") and steps and steps[-1][0] + len(steps[-1][3]) + 1 == number:
            steps[-1][3].append(line[4:])
        if match := re.search(r"This is `([\w.]+)`:$", line):
            name = match.group(1)
        elif line and fence is None:
            name = None
    return steps, {name: "\n".join(lines) + "\n" for name, lines in files.items()}


def pattern(shown):
    parts = [r"(?:[^\n]*\n)*?" if line.strip() == "..." else ".*".join(map(re.escape, line.rstrip().split("..."))) + r" *\n" for line in shown]
    return "".join(parts)


def first_miss(shown, printed):
    """Index of the first shown line that the output lacks; None where it has all."""
    if not shown or re.fullmatch(pattern(shown), printed):
        return None
    return next(k for k in range(len(shown)) if k + 1 == len(shown) or not re.match(pattern(shown[: k + 1]), printed))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("page")
    parser.add_argument("--program", required=True)
    parser.add_argument("--module", default="")
    asked = parser.parse_args()
    steps, files = steps_of(asked.page)
    if not steps:
        print(f"{asked.page}: no commands")
        return 1
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            open(os.path.join(folder, name), "w", encoding="utf-8").write(text)
        shutil.copytree(os.path.join(REPOSITORY, "samples"), os.path.join(folder, "samples"))
        os.mkdir(os.path.join(folder, ".bin"))
        os.symlink(os.path.abspath(asked.program), os.path.join(folder, ".bin", "toothpath"))
        os.symlink("/usr/bin/python3", os.path.join(folder, ".bin", "python3"))
        environment = dict(os.environ, PATH=os.path.join(folder, ".bin") + ":" + os.environ["PATH"], PYTHONPATH=os.path.abspath(asked.module), LC_ALL="C.UTF-8")
        for number, command, code, shown in steps:
            run = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            if run.returncode != code:
                print(f"{asked.page}:{number}: exit code {run.returncode}, not {code}: {command}\n{run.stdout}")
                return 1
            miss = first_miss(shown, run.stdout)
            if miss is not None:
                print(f"{asked.page}:{number + 1 + miss}: not printed: {shown[miss]}\nprinted was:\n{run.stdout}")
                return 1
    print(f"{asked.page}: {len(steps)} commands do what the page shows")
    return 0


if __name__ == "__main__":
    sys.exit(main())
