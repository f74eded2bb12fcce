"""The schemas in docs/schema against every file that stands in the repository, by Debian's jsonschema.

Asked: they are schemas of draft 7; every sample, job and machine file passes; each of these files with one key
misspelt is flagged; and docs/schema/README.md says how many of tests/bad_jobs the schema alone flags.
"""

import copy
import glob
import json
import os
import re
import sys

import jsonschema
import tomli

root = sys.argv[1]
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
