"""What somebody with a notebook does: runs a job, plots its deviation map, looks at the exact flanks. Every number is compared with the files
that the run left, and with those of the program itself: notebook.py PROGRAM SAMPLES BAD_JOBS FOLDER, with PYTHONPATH at the module."""
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import threading
import tomllib

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import toothpath

program, samples, bad_jobs, folder = sys.argv[1], *map(pathlib.Path, sys.argv[2:5])
shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
quick = samples / "spur_quick.toml"


def same(a, b, tolerance=0.0):
    assert abs(a - b) <= tolerance, (a, b)


def inspection_csv(path):
    """zone, side -> points and normals, (rows, columns, 6)."""
    found = {}
    with open(path, newline="") as lines:
        for line in csv.DictReader(lines):
            key = int(line["zone"]), line["flank"]
            found.setdefault(key, {})[int(line["row"]), int(line["column"])] = [float(line[k]) for k in "xyzijk"]
    grids = {}
    for key, cells in found.items():
        rows, columns = (1 + max(cell[k] for cell in cells) for k in (0, 1))
        grids[key] = np.array([[cells[r, c] for c in range(columns)] for r in range(rows)])
    return grids


def compare_flanks(job, path):
    grids, flanks = inspection_csv(path), toothpath.Gear(job).flanks()
    assert len(flanks) == len(grids) > 0
    for flank in flanks:
        expected = grids[flank.zone, str(flank.side)]
        assert flank.points.shape == flank.normals.shape == expected.shape[:2] + (3,)
        np.testing.assert_allclose(np.dstack([flank.points, flank.normals]), expected, rtol=1e-12, atol=1e-13)


# A run, while another thread goes on: only a run that has not ended has hidden files.
seen = []
made = []
worker = threading.Thread(target=lambda: made.append(toothpath.run(quick, folder / "out", threads=2)))
worker.start()
while worker.is_alive():
    seen += [path for path in folder.glob("out/.*.ngc*")]
worker.join()
report = made[0]
assert seen, "the interpreter was held during the run"
print(report, report.summary, sep="\n")

# The report is that on the disk, the program that of the command line.
out = folder / "out"
on_disk = json.loads((out / "report.json").read_text())
assert report.json == on_disk and report.verified and on_disk["verified"] and report.verdict == "verified"
same(report.worst_gouge_um, on_disk["gouge_um"]["measured"], 1e-12)
same(report.worst_gouge_bound_um, on_disk["gouge_um"]["bound"], 1e-12)
same(report.worst_left_um, on_disk["excess_um"]["finished"]["max"], 1e-12)
same(report.worst_left_bound_um, on_disk["excess_um"]["finished"]["bound"], 1e-12)
same(report.cutting_minutes, on_disk["cutting_minutes"])
same(report.total_minutes, on_disk["total_minutes"])
assert report.worst_gouge_um < report.worst_gouge_bound_um <= 2.0
assert report.program == out / "program.ngc" and {*report.files} == {path.name for path in out.iterdir() if path.is_file()}
subprocess.run([program, "run", quick, "--out", folder / "by_program", "--quiet"], check=True)
for name in ("program.ngc", "cl.csv", "inspection.csv", "tooth.vtp"):
    assert (out / name).read_bytes() == (folder / "by_program" / name).read_bytes(), name

# The deviation map.
everywhere = np.concatenate([s.deviation_um.ravel() for s in report.surface])
reached = np.concatenate([s.deviation_um[s.reachable] for s in report.surface])
assert everywhere.size == on_disk["excess_um"]["finished"]["points"]
last = on_disk["excess_um"]["operations"][-1]
same(reached.max(), last["max"], 1e-4)
same(reached.min(), last["min"], 1e-4)
for surface in report.surface:
    assert surface.points.shape == surface.normals.shape == surface.deviation_um.shape + (3,)
    np.testing.assert_allclose(np.linalg.norm(surface.normals, axis=2), 1, atol=1e-12)
    assert len(surface.deviation_um_of_operations) == 2
    np.testing.assert_array_equal(surface.deviation_um_of_operations[-1], surface.deviation_um)
    assert surface.deviation_um_of_operations[0].min() > surface.deviation_um.max()  # roughing leaves more
assert [s.patch for s in report.surface].count("flank +1") == [s.patch for s in report.surface].count("flank -1") == 1

figure, axes = plt.subplots(1, len(report.surface), figsize=(14, 3.6), layout="constrained")
for axis, surface in zip(axes, report.surface):
    radius = np.hypot(surface.points[..., 0], surface.points[..., 1])
    height = surface.points[..., 2] if np.ptp(surface.points[..., 2]) > 0.2 else surface.points[..., 1]
    mesh = axis.pcolormesh(radius, height, surface.deviation_um, cmap="RdBu", vmin=-20, vmax=20, shading="gouraud")
    axis.set(title=f"{surface.patch}, zone {surface.zone}", xlabel="radius [mm]")
figure.colorbar(mesh, ax=axes, label="deviation [um]: > 0 left, < 0 too deep")
figure.savefig(folder / "deviation.png", dpi=80)
picture = plt.imread(folder / "deviation.png")
assert np.unique(picture.reshape(-1, picture.shape[2]), axis=0).shape[0] > 500, "the map has no colours"

# The exact flanks: those of inspection.csv, and denser; the normals stand on the surface.
compare_flanks(quick, out / "inspection.csv")
gear = toothpath.Gear(quick)
assert (gear.name, gear.type, gear.teeth) == ("spur-quick", "face_gear", 60)
assert gear.limits == json.loads((out / "limits.json").read_text())
for flank in gear.flanks(rows=60, columns=80, margin=0.0):
    assert flank.points.shape == (60, 80, 3)
    radius = np.hypot(flank.points[..., 0], flank.points[..., 1])
    same(radius.min(), 60, 1e-9)
    same(radius.max(), 65, 1e-9)
    along = np.gradient(flank.points, axis=1)[1:-1, 1:-1]
    across = np.gradient(flank.points, axis=0)[1:-1, 1:-1]
    cross = np.cross(across, along)
    cross /= np.linalg.norm(cross, axis=2, keepdims=True)
    assert np.abs((cross * flank.normals[1:-1, 1:-1]).sum(axis=2)).min() > 1 - 1e-6

# What an earlier call has read is no input of the next: it may be replaced.
try:
    toothpath.Gear(out / "limits.json")
except toothpath.RefusedError:
    pass
assert toothpath.run(quick, out).verified

# A bevel gear has other flanks.
bevel = samples / "bevel_pinion.toml"
subprocess.run([program, "surface", bevel, "--out", folder / "bevel", "--quiet"], check=True)
compare_flanks(bevel, folder / "bevel" / "inspection.csv")
# The same gear from a dict: a sweep without files. What is wrong is told with the same words.
numbers = tomllib.loads(quick.read_text())
from_dict = toothpath.Gear(numbers)
assert from_dict.name == toothpath.Gear(quick).name and from_dict.limits == toothpath.Gear(quick).limits
for a, b in zip(from_dict.flanks(), toothpath.Gear(quick).flanks(), strict=True):
    assert np.array_equal(a.points, b.points)
alone = {"gear": numbers["gear"]}
for teeth in np.arange(60, 62):
    alone["gear"]["teeth"] = teeth
    assert toothpath.Gear(alone).teeth == teeth
try:
    toothpath.Gear({"gear": {**numbers["gear"], "module": "two"}})
    raise AssertionError("a module of letters")
except toothpath.RefusedError as refused:
    assert "module must be a number, not a string" in str(refused), refused
try:
    toothpath.Gear({"gear": {1, 2}})
    raise AssertionError("a set")
except TypeError as refused:
    assert "not <class 'set'>" in str(refused), refused

assert {flank.side for flank in toothpath.Gear(bevel).flanks()} == {"L", "U"}

# A program that is not verified is a report without a program.
strict = folder / "strict.toml"
control = 'file = "siemens_ac.toml"\naccept_assumed = true'
strict.write_text(quick.read_text().replace('file = "xyzac_large.toml"', control) + "\n[program]\ncontour_tolerance = 0.01\n")
refused = toothpath.run(strict, folder / "strict")
assert not refused.verified and refused.program is None and refused.reasons and not list((folder / "strict").glob("program.*"))

# What is refused says so with its place, in the words of the program.
for name in ("key_unknown", "no_operation", "undercut_side_plus"):
    job = bad_jobs / f"{name}.toml"
    said = subprocess.run([program, "run", job, "--out", folder / "refused"], capture_output=True, text=True).stderr
    try:
        toothpath.run(job, folder / "refused")
    except toothpath.RefusedError as error:
        assert str(error) == said.rstrip("\n") and isinstance(error, toothpath.Error), (str(error), said)
        file, line, column, message = error.diagnostics[0]
        assert file == str(job) and line > 0 and column > 0 and message in str(error)
    else:
        raise AssertionError(f"{name} was not refused")
for call, kind in (
    (lambda: toothpath.Gear(folder / "none.toml"), toothpath.FileAccessError),
    (lambda: toothpath.run(quick, "/proc/none"), toothpath.FileAccessError),
    (lambda: toothpath.Gear(bad_jobs / "module_nan.toml"), toothpath.RefusedError),
    (lambda: gear.flanks(rows=3), toothpath.RefusedError),
    (lambda: toothpath.run(quick, out, threads=0), ValueError),
    (lambda: toothpath.run(quick), TypeError),
):
    try:
        call()
    except kind:
        continue
    raise AssertionError(f"no {kind}")
print("deviation map:", folder / "deviation.png")
