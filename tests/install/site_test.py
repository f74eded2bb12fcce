"""The parts of tools/site that need neither browser nor mkdocs: links of the pages lead somewhere, faults that are planted are found, every
sample is in the gallery with the numbers of its run: site_test.py PROGRAM"""
import json
import pathlib
import shutil
import sys
import tempfile

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tools/site"))
import links  # noqa: E402
import make  # noqa: E402
import run_tutorial  # noqa: E402

pages, files, faults = links.pages_and_files(REPOSITORY)
assert not faults, "\n".join(faults)
assert len(pages) > 45 and "docs/schema/README.md" in pages and "docs/images/report.png" in files, pages


def planted(text):
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "docs").mkdir()
        (pathlib.Path(folder) / "README.md").write_text("# A\n\n## Two words\n\n## Two words\n\n<a id=\"own\"></a>\n" + text)
        return links.pages_and_files(folder)[2]


for good in ("[a](#two-words) [b](#two-words-1) [c](#own) [d](README.md#a) [e](https://example.org/x)", "`[a](no.md)`", "\n    [a](no.md)", "```\n[a](no.md)\n```"):
    assert not planted(good), (good, planted(good))
for bad, why in (("[a](no.md)", "no such file"), ("![a](no.png)", "no such file"), ("[a](#three)", "no such heading"), ("[a](#two-words-2)", "no such heading"),
                 ("[a](docs)", "a folder"), ("[a](../x.md)", "outside"), ("text\n- item", "empty line")):
    assert len(planted(bad)) == 1 and why in planted(bad)[0], (bad, planted(bad))

with tempfile.TemporaryDirectory() as folder:
    site = pathlib.Path(folder)
    (site / "b.html").write_text('<h1 id="here">x</h1>')
    (site / "a.html").write_text('<a href="b.html#here">x</a><a href="b.html?q=1">x</a>')
    assert links.html_faults(site) == (2, [])
    for bad in ('<a href="b.html#gone">x</a>', '<img src="gone.png">'):
        (site / "a.html").write_text(bad)
        assert len(links.html_faults(site)[1]) == 1, bad

# Every page of docs/ stands in the navigation once.
listed = [page for entry in make.navigation() for pages in entry.values() for page in ([pages] if isinstance(pages, str) else pages)]
assert len(listed) == len(set(listed)), listed
missing = {page for page in pages if page.startswith("docs/") and page.count("/") == 1} - set(listed)
assert not missing, f"docs/README.md links to none of {missing}"

# The gallery: one run stands in for those of all samples but the shaped one.
jobs = make.samples()
with tempfile.TemporaryDirectory() as folder:
    runs = pathlib.Path(folder)
    for name in ("spur_quick", "offset_shaped"):
        make.run_sample(sys.argv[1], name, jobs[name], str(runs / name))
    for name, job in jobs.items():
        if make.command_of(job) == "run" and name != "spur_quick":
            shutil.copytree(runs / "spur_quick", runs / name)
    page = make.gallery(jobs, runs, "toothpath")
    assert not make.missing_in_gallery(page, jobs)
    assert make.missing_in_gallery(page.replace('id="spur_line"', ""), jobs) == ["spur_line"]
    report = json.loads((runs / "spur_quick/report.json").read_text())
    assert page.count(f"<dd>{report['excess_um']['finished']['max']:.1f} um</dd>") == len(jobs) - 1
    sheet = json.loads((runs / "offset_shaped/shaper.json").read_text())
    assert f"<dd>{sheet['time']['total']:.0f} min</dd>" in page
    with open(runs / "spur_line/report.json", "w", encoding="utf-8") as file:
        json.dump(dict(report, verified=False), file)
    for change, why in ((jobs, "not verified"), (dict(jobs, unknown=jobs["spur_quick"]), "lacks unknown.toml")):
        try:
            make.gallery(change, runs, "toothpath")
        except SystemExit as end:
            assert why in str(end), end
        else:
            raise AssertionError(why)

# What a tutorial shows is held against what is printed.
for shown, printed, miss in ((["a"], "a\n", None), (["a"], "b\n", 0), (["a", "..."], "a\nb\nc\n", None), (["...", "c"], "a\nb\nc\n", None), (["a", "c"], "a\nb\nc\n", 1),
                             (["a ... z"], "a b z\n", None), (["a"], "a\nb\n", 0), ([], "anything\n", None)):
    assert run_tutorial.first_miss(shown, printed) == miss, (shown, printed, run_tutorial.first_miss(shown, printed))
print(f"{len(pages)} pages, {len(jobs)} samples")
