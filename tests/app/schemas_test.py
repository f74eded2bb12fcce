"""The schemas in docs/schema against every file that stands in the repository, by Debian's jsonschema.

Asked: they are schemas of draft 7; every sample, job and machine file passes; each of these files with one key
misspelt is flagged; the first line of each names its schema, and so does that of a job that `new` writes; and
docs/schema/README.md says how many of tests/bad_jobs the schema alone flags.
"""

import copy
import glob
import json
import os
import re
import subprocess
import sys
import tempfile
import urllib.parse
import urllib.request

import jsonschema
import tomli

root, program = sys.argv[1:3]
faults = []


def validator(name):
    with open(f"{root}/docs/schema/{name}.schema.json", encoding="utf-8") as file:
        schema = json.load(file)
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def read(path):
    with open(path, "rb") as file:
        return tomli.load(file)


def files(*folders):
    return sorted(path for folder in folders for path in glob.glob(f"{root}/{folder}/*.toml"))


def tables(value):
    """Every table of a document."""
    if isinstance(value, dict):
        yield value
        for inner in value.values():
            yield from tables(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from tables(inner)


def misspelt(document):
    """The document with one key misspelt, once for every key."""
    for at, table in enumerate(tables(document)):
        for key in table:
            changed = copy.deepcopy(document)
            wrong = list(tables(changed))[at]
            wrong[key + "x"] = wrong.pop(key)
            yield key, changed


def judge(schema, paths):
    flagged = count = 0
    for path in paths:
        document = read(path)
        for error in schema.iter_errors(document):
            faults.append(f"{path}: {'.'.join(map(str, error.absolute_path))}: {error.message}")
        for key, changed in misspelt(document):
            count += 1
            if schema.is_valid(changed):
                faults.append(f"{path}: {key} misspelt passes")
            else:
                flagged += 1
    return len(paths), flagged, count


def named_schema(path):
    """The file that the first line names, as the language servers of TOML find it: a URL, or a path from the file."""
    with open(path, encoding="utf-8") as file:
        first = file.readline().rstrip("\n")
    if not first.startswith("#:schema "):
        faults.append(f"{path}: the first line names no schema: {first}")
        return None
    url = urllib.parse.urljoin("file://" + urllib.parse.quote(os.path.abspath(path)), first.removeprefix("#:schema "))
    parts = urllib.parse.urlsplit(url)
    found = os.path.realpath(urllib.request.url2pathname(parts.path))
    if parts.scheme != "file" or not os.path.isfile(found):
        faults.append(f"{path}: {first}: there is no {url}")
        return None
    return found


def judge_named(name, paths):
    """Each of the files names the schema of this name, and passes it."""
    wanted = os.path.realpath(f"{root}/docs/schema/{name}.schema.json")
    for path in paths:
        found = named_schema(path)
        if found is None:
            continue
        if found != wanted:
            faults.append(f"{path}: names {found}")
        with open(found, encoding="utf-8") as file:
            schema = jsonschema.Draft7Validator(json.load(file))
        for error in schema.iter_errors(read(path)):
            faults.append(f"{path}: {error.message}")
    print(f"{len(paths)} files name {name}.schema.json in their first line")


def new_jobs(folder):
    """Jobs that the program writes: milled, with tools of a library, and shaped."""
    table = f"{folder}/shop.tbl"
    with open(table, "w", encoding="utf-8") as file:
        file.write("T12 P3 D1 Z80\n")
    said = "12: type = 'ball_end_mill', shank_diameter = 4, stick_out = 27, holder = [[11, 11, 30]], flute_length = 7"
    spur = ["--gear", "face", "--teeth", "60", "--module", "2"]
    for name, options in [
        ("milled job", ["--cut", "ball", "--machine", "xyzac_large"]),
        ("library", ["--cut", "ball", "--machine", "xyzac_large", "--tools", table, "--tool", said]),
        ("shaped", ["--cut", "shaped", "--machine", "y514"]),
    ]:
        path = f"{folder}/{name}.toml"
        made = subprocess.run([program, "new", *spur, *options, "-o", path], capture_output=True, text=True)
        if made.returncode != 0:
            faults.append(f"toothpath new: {name}: {made.stdout}{made.stderr}")
        else:
            yield path


job, machine = validator("job"), validator("machine")
print("| files | pass | keys misspelt | flagged |")
print("|---|---|---|---|")
for name, schema, paths in [
    ("samples, tests/jobs", job, files("samples", "tests/jobs")),
    ("machines/data", machine, files("machines/data")),
]:
    passed, flagged, count = judge(schema, paths)
    print(f"| {name} | {passed} | {count} | {flagged} |")
    if passed < 15:
        faults.append(f"{name}: only {passed} files were found")

judge_named("job", files("samples", "tests/jobs"))
judge_named("machine", files("machines/data"))
with tempfile.TemporaryDirectory() as folder:
    judge_named("job", list(new_jobs(folder)))

no_toml, flagged, left = [], [], []
for path in files("tests/bad_jobs"):
    try:
        document = read(path)
    except (tomli.TOMLDecodeError, UnicodeDecodeError):
        no_toml.append(path)
        continue
    (left if job.is_valid(document) else flagged).append(os.path.basename(path))
total = len(no_toml) + len(flagged) + len(left)
said = f"Of the {total} files of `tests/bad_jobs`, {len(no_toml)} are no TOML; the schema alone flags {len(flagged)}"
print(f"\n{said}, and leaves {len(left)} to the program: {', '.join(left)}")
with open(f"{root}/docs/schema/README.md", encoding="utf-8") as file:
    if said not in re.sub(r"\s+", " ", file.read()):
        faults.append(f'docs/schema/README.md does not say "{said}"')

for fault in faults:
    print(fault, file=sys.stderr)
sys.exit(1 if faults else 0)
