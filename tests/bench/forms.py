#!/usr/bin/env python3
"""Size of the text and times of one job in every form of output: forms.py PROGRAM JOB [narrow] [granted] [CONTROL ..].

The machine is xyzac_large.toml with each control, with accelerations, its teeth called or looped where the control can,
and written out. `narrow`: with the contour tolerance that nobody asks for. `granted`: Siemens with angles alone, whose
TRAORI takes the rotary offset. Prints a row a form, as in docs/dialects.md."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

FORMS = [("linuxcnc", "none"), ("linuxcnc", "angles"), ("fanuc", "none"), ("fanuc", "angles"),
         ("mitsubishi_m80", "none"), ("haas", "none"), ("siemens", "none"), ("siemens", "angles"),
         ("siemens", "vectors"), ("heidenhain", "none"), ("heidenhain", "angles"), ("heidenhain", "vectors")]
ROOT = pathlib.Path(__file__).resolve().parents[2]


def machine_text(control, tcp, loop):
    text = (ROOT / "machines/data/xyzac_large.toml").read_text()
    text = text.replace('dialect = "linuxcnc"', f'dialect = "{control}"').replace('tcp = "none"', f'tcp = "{tcp}"')
    if "max_acceleration" not in text:
        text = re.sub(r"(\[axes\.[A-Z]\]\n(?:[^\n]+\n)*?max_speed[^\n]*\n)", r"\1max_acceleration = 2000.0\n", text)
    text += f"\n[post]\nindex_loop = {'true' if loop else 'false'}\n"
    if control == "linuxcnc":
        text += "corner_tolerance = 0.0005\n"
    if control == "linuxcnc" and tcp != "none":
        text += 'tcp_on = ["M428"]\ntcp_off = ["M429"]\n' + ('index_offset = "G59.3"\n' if loop else "")
    if "granted" in sys.argv[3:]:
        text += "transformation_takes_rotary_offset = true\n"
    if control == "heidenhain":
        text += 'coolant_mist = ["M7", "M9"]\n'
    return text


def run(program, job, control, tcp, loop, narrow):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "machine.toml").write_text(machine_text(control, tcp, loop))
        text = re.sub(r'(\[machine\]\nfile = )"[^"]*"', r'\1"machine.toml"', job.read_text())
        if narrow and control in ("siemens", "heidenhain"):
            text += "\n[program]\ncontour_tolerance = 0.0003\n"
        (folder / "job.toml").write_text(text)
        done = subprocess.run([program, "run", folder / "job.toml", "--out", folder / "out", "--json", "--quiet"],
                              capture_output=True, text=True)
        if done.returncode != 0:
            return None, done.stderr.strip().split("\n")[0][:100]
        report = json.loads((folder / "out/report.json").read_text())
        return report, (folder / "out" / report["program"]["file"]).read_text()


def main():
    program, job, narrow = sys.argv[1], pathlib.Path(sys.argv[2]), "narrow" in sys.argv[3:]
    print("| form | kB | blocks | written out kB | blocks | minutes | proven um |\n|---|---|---|---|---|---|---|")
    wanted = [word for word in sys.argv[3:] if word not in ("narrow", "granted")]
    forms = [("siemens", "angles")] if "granted" in sys.argv[3:] else FORMS
    for control, tcp in forms:
        if wanted and control not in wanted:
            continue
        cells = []
        for loop in (True, False):
            report, text = run(program, job, control, tcp, loop, narrow)
            if report is None:
                print(f"| {control} {tcp} | refused: {text} |")
                break
            cells += [f"{len(text) / 1000:.0f}", str(report["program"]["blocks"])]
            if loop:
                last = [f"{report['total_minutes']:.1f}", f"{report['gouge_um']['bound']:.2f}"]
        else:
            print(f"| {control} {tcp} | " + " | ".join(cells + last) + " |", flush=True)


main()
