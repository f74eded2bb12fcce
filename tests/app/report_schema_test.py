"""docs/schema/report.schema.json against the program that writes the reports.

Asked: reports of runs of every kind pass; every key that the sources of the report write is in the schema, and every
property of the schema is written there; the sources of error of both are the same.
"""

import json
import os
import re
import subprocess
import sys
import tempfile

import jsonschema

root, program = sys.argv[1:3]
faults = []
with open(f"{root}/docs/schema/report.schema.json", encoding="utf-8") as file:
    schema = json.load(file)
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)


def properties(value):
    """The names of all properties of a schema."""
    if isinstance(value, dict):
        for name in value.get("properties", {}) if isinstance(value.get("properties"), dict) else {}:
            yield name
        for inner in value.values():
            yield from properties(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from properties(inner)


def written():
    """The keys that report_json.cpp and the findings write."""
    keys = set()
    with open(f"{root}/app/report/report_json.cpp", encoding="utf-8") as file:
        text = file.read()
    keys.update(re.findall(r'\{\s*"([a-z_0-9]+)",\s', text))
    keys.update(re.findall(r'\["([a-z_0-9]+)"\]', text))
    keys.update(*re.findall(r'const char\* key : \{([^}]*)\}', text) and
                [re.findall(r'"([a-z_]+)"', names) for names in re.findall(r'const char\* key : \{([^}]*)\}', text)])
    for name in ["milled/proof.cpp", "milled/unreached.cpp", "bevel/proof.cpp"]:
        with open(f"{root}/app/process/{name}", encoding="utf-8") as file:
            text = file.read()
        keys.update(re.findall(r'finding\.key = "([a-z_]+)"', text))
        keys.update(re.findall(r'detail\("([a-z_]+)"', text))
        for details in re.findall(r"details = \{(.*?)\};", text, re.S):
            keys.update(re.findall(r'\{"([a-z_]+)"', details))
    return keys


def sources(value):
    """The enumeration that begins with the first source of error."""
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else []
    if isinstance(value, list) and "flank solve" in value:
        return set(value)
    return set().union(*map(sources, inner))


with open(f"{root}/cam/proof/verification.h", encoding="utf-8") as file:
    told = set(re.findall(r'case ErrorSource::\w+: return "([^"]+)"', file.read()))
for source in sorted(told ^ sources(schema)):
    faults.append(f"the schema and verification.h do not both have the source of error {source}")

known, keys = set(properties(schema)), written()
# Told by words of other rooms: regions, the names of the scene, the data of commands (app/base/command_data.h); the units of what
# modifications come to.
elsewhere = {"flank", "fillet", "root", "fixture", "stock", "limits", "set_up", "um", "mrad", "radius_mm"}
for key in sorted(keys - known):
    faults.append(f"the schema lacks {key}")
for key in sorted(known - keys - elsewhere):
    faults.append(f"nothing writes {key}")
if len(keys) < 150:
    faults.append(f"only {len(keys)} keys were found in the sources")

with tempfile.TemporaryDirectory() as folder:
    strict = f"{folder}/strict.toml"
    with open(f"{root}/samples/spur_quick.toml", encoding="utf-8") as file:
        text = file.read().replace('file = "xyzac_large.toml"', 'file = "siemens_ac.toml"\naccept_assumed = true')
        text += "\n[program]\ncontour_tolerance = 0.01\n"
    with open(strict, "w", encoding="utf-8") as file:
        file.write(text)
    runs = [
        ("run", 0, ["samples/spur_quick.toml"]),
        ("check", 0, ["samples/spur_quick.toml", "PROGRAM", "--stock", "STL"]),
        ("run", 1, [strict]),
        ("run", 0, ["samples/spur_line.toml"]),
        ("run", 0, ["samples/bevel_pinion.toml"]),
        ("run", 0, ["samples/tool_axis.toml"]),
        ("run", 0, ["samples/dhfg_t600s.toml"]),
        ("surface", 0, ["samples/offset_milled.toml"]),
        ("surface", 0, ["samples/spur_modified.toml"]),
        ("surface", 0, ["samples/bevel_modified.toml"]),
        ("surface", 0, ["samples/bevel_wheel.toml"]),
        ("surface", 0, ["samples/spur_quick.toml", "--step"]),
        ("shaper", 0, ["samples/offset_shaped.toml"]),
    ]
    print("| command | job | exit | keys | faults |\n|---|---|---|---|---|")
    for at, (command, wanted, words) in enumerate(runs):
        out = f"{folder}/{at}"
        words = [{"PROGRAM": f"{folder}/0/program.ngc", "STL": f"{folder}/0/gear.stl"}.get(w, w) for w in words]
        done = subprocess.run([program, command, *words, "--out", out, "--quiet"], cwd=root, capture_output=True, text=True)
        if command != "check" and done.returncode != wanted:  # a stock that is the gear itself is not clear
            faults.append(f"{command} {words[0]} ends with {done.returncode}: {done.stderr}")
        if not os.path.exists(f"{out}/report.json"):
            faults.append(f"{command} {words[0]} leaves no report.json")
            continue
        with open(f"{out}/report.json", encoding="utf-8") as file:
            report = json.load(file)
        found = list(validator.iter_errors(report))
        for error in found:
            faults.append(f"{command} {words[0]}: {'.'.join(map(str, error.absolute_path))}: {error.message[:300]}")
        print(f"| {command} | {os.path.basename(words[0])} | {done.returncode} | {len(report)} | {len(found)} |")
        report["unheard_of"] = 1
        if validator.is_valid(report):
            faults.append("a key that is not there passes")

for fault in faults:
    print(fault, file=sys.stderr)
sys.exit(1 if faults else 0)
