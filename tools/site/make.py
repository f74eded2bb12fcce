#!/usr/bin/python3
"""The documentation as a site, with a gallery of all samples made from runs. Called by tools/site.sh, which installs what it needs.

    make.py --program TOOTHPATH [--out FOLDER] [--runs FOLDER] [--module FOLDER]

1. runs every sample into --runs (default build/site_runs); one that is newer than job and program stays;
2. takes a picture of what each run wrote (tools/page_screenshot.mjs);
3. runs the commands of the tutorials;
4. puts the pages that can be reached from README.md and docs/ where they lie in the repository, with the gallery, and lets mkdocs make the site;
5. asks every link of the site, and for every sample in the gallery.
What fails ends it with exit code 1.
"""
import argparse
import html
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib

import links

HERE = os.path.dirname(os.path.abspath(__file__))
REPOSITORY = os.path.dirname(os.path.dirname(HERE))
TUTORIALS = ("machinist", "gear_engineer", "developer")


def fail(text):
    sys.exit(f"site: {text}")


def samples():
    """{name: job} of samples/*.toml, by name."""
    folder = os.path.join(REPOSITORY, "samples")
    return {name[:-5]: tomllib.load(open(os.path.join(folder, name), "rb")) for name in sorted(os.listdir(folder)) if name.endswith(".toml")}


def ideas():
    """{name: what samples/README.md says of it}."""
    out = {}
    for line in open(os.path.join(REPOSITORY, "samples/README.md"), encoding="utf-8"):
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("|") and len(cells) == 2:
            for name in re.findall(r"`(\w+)\.toml`", cells[0]):
                out[name] = cells[1]
    return out


def command_of(job):
    """A job without operations is one for a gear shaper."""
    return "run" if "operation" in job else "shaper"


def run_sample(program, name, job, folder):
    """Runs it where program or job are newer than its results."""
    path = os.path.join(REPOSITORY, "samples", name + ".toml")
    report = os.path.join(folder, "report.json")
    if os.path.isfile(report) and os.path.getmtime(report) > max(os.path.getmtime(p) for p in (path, program)):
        return
    print(f"{command_of(job)} {name}", flush=True)
    run = subprocess.run([program, command_of(job), path, "--out", folder, "--quiet"], text=True, stderr=subprocess.PIPE)
    if run.returncode:
        fail(f"{name} ends with {run.returncode}: {run.stderr}")


def take_picture(name, job, folder):
    """picture.png of the 3D view, of a shaper's page the first chart."""
    page, what = ("report.html", "#space .viewer canvas") if command_of(job) == "run" else ("shaper.html", "svg")
    picture, page = os.path.join(folder, "picture.png"), os.path.join(folder, page)
    if os.path.isfile(picture) and os.path.getmtime(picture) > os.path.getmtime(page):
        return
    print(f"picture of {name}", flush=True)
    run = subprocess.run(["node", os.path.join(REPOSITORY, "tools/page_screenshot.mjs"), page, picture, "--select", what, "--width", "900"], text=True, stderr=subprocess.PIPE)
    if run.returncode:
        fail(f"picture of {name}: {run.stderr}")


def hours(minutes):
    return f"{minutes:.0f} min" if minutes < 100 else f"{minutes / 60:.1f} h"


def numbers_of(folder, job):
    """[(word, number)] of a run, from its files."""
    report = json.load(open(os.path.join(folder, "report.json"), encoding="utf-8"))
    out = [("machine", report["machine"]["name"])]
    if command_of(job) == "shaper":
        sheet = json.load(open(os.path.join(folder, "shaper.json"), encoding="utf-8"))
        return out + [("on the machine", hours(sheet["time"]["total"]))]
    if not report["verified"]:
        fail(f"{folder}: not verified")
    left, gouge = report["excess_um"]["finished"], report["gouge_um"]
    return out + [
        ("on the machine", hours(report["total_minutes"])),
        ("worst left", f"{left['max']:.1f} um"),
        ("left, proven below", f"{left['bound']:.1f} um"),
        ("rms", f"{left['rms']:.2f} um"),
        ("gouge, proven below", f"{gouge['bound']:.2f} of {gouge['tolerance']:g} um"),
    ]


def gallery(jobs, runs, version):
    """The page, as Markdown: one article a sample, with its picture, numbers and links to its job and report."""
    said = ideas()
    out = ["---", "hide: [navigation, toc]", "---", "", "# Gallery", "", f"Every sample, run by {version}: what stands here was read from the files of these runs. A click opens the report with the gear on its machine.",
           "", '<div class="gallery" markdown="0">']
    for name in jobs:
        if name not in said:
            fail(f"samples/README.md lacks {name}.toml")
    for name in sorted(jobs, key=list(said).index):
        job = jobs[name]
        folder = os.path.join(runs, name)
        page = "report.html" if command_of(job) == "run" else "shaper.html"
        rows = "".join(f"<dt>{html.escape(word)}</dt><dd>{html.escape(number)}</dd>" for word, number in numbers_of(folder, job))
        text = re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(said[name]))
        out.append(f'<article id="{name}"><a href="gallery/{name}/{page}"><img src="gallery/{name}/picture.png" alt="{html.escape(job["name"])} as its run shows it" loading="lazy"></a>'
                   f'<div class="words"><h2>{name}</h2><p>{text}</p><dl>{rows}</dl><a href="samples/{name}.toml">{name}.toml</a></div></article>')
    return "\n".join(out + ["</div>", ""])


def missing_in_gallery(page, jobs):
    return [name for name in jobs if f'<article id="{name}">' not in page]


def navigation():
    """Home, tutorials, gallery, the map, and a part a reader as docs/README.md has them."""
    tutorials = [f"docs/tutorial_{name}.md" for name in TUTORIALS]
    parts, part, seen = {}, None, set(tutorials)
    page = os.path.join(REPOSITORY, "docs/README.md")
    for _, line, _, _ in links.lines_of_text(page):
        if line.startswith("## "):
            part = parts.setdefault(line[3:], [])
        elif part is not None:
            for match in links.LINK.finditer(line):
                target = os.path.normpath(os.path.join("docs", match.group(1).partition("#")[0]))
                if target.endswith(".md") and target not in seen:
                    seen.add(target)
                    part.append(target)
    return [{"Home": "README.md"}, {"Tutorials": tutorials}, {"Gallery": "gallery.md"}, {"Map": "docs/README.md"}] + [{t: p} for t, p in parts.items()]


def stage(folder, runs, jobs, version):
    """What mkdocs reads: the pages as they lie in the repository, what they link to, the gallery with its reports."""
    pages, files, faults = links.pages_and_files(REPOSITORY)
    if faults:
        fail("links of the pages:\n" + "\n".join(faults))
    shutil.rmtree(folder, ignore_errors=True)
    for path in pages + files + [f"samples/{name}.toml" for name in jobs]:
        target = os.path.join(folder, path)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        shutil.copyfile(os.path.join(REPOSITORY, path), target)
    for name, job in jobs.items():
        os.makedirs(os.path.join(folder, "gallery", name))
        for file in ("picture.png", "report.html" if command_of(job) == "run" else "shaper.html"):
            shutil.copyfile(os.path.join(runs, name, file), os.path.join(folder, "gallery", name, file))
    open(os.path.join(folder, "gallery.md"), "w", encoding="utf-8").write(gallery(jobs, runs, version))
    shutil.copyfile(os.path.join(HERE, "site.css"), os.path.join(folder, "site.css"))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--out", default=os.path.join(REPOSITORY, "build/site"))
    parser.add_argument("--runs", default=os.path.join(REPOSITORY, "build/site_runs"))
    parser.add_argument("--module", default="")
    asked = parser.parse_args()
    program, out, runs = map(os.path.abspath, (asked.program, asked.out, asked.runs))
    jobs = samples()
    for name, job in jobs.items():
        run_sample(program, name, job, os.path.join(runs, name))
        take_picture(name, job, os.path.join(runs, name))
    for name in TUTORIALS:
        if name == "developer" and not asked.module:
            print("the tutorial for developers was not run: --module says where the Python module lies")
            continue
        page = os.path.join(REPOSITORY, f"docs/tutorial_{name}.md")
        if subprocess.run([os.path.join(HERE, "run_tutorial.py"), page, "--program", program] + (["--module", asked.module] if asked.module else [])).returncode:
            fail(f"{page} shows what is not so")
    version = subprocess.run([program, "--version"], text=True, stdout=subprocess.PIPE, check=True).stdout.strip()
    staged = out + "_pages"
    stage(staged, runs, jobs, version)
    settings = open(os.path.join(HERE, "mkdocs.yml"), encoding="utf-8").read()
    path = out + ".yml"
    with open(path, "w", encoding="utf-8") as file:
        file.write(settings + f"docs_dir: {json.dumps(staged)}\nsite_dir: {json.dumps(out)}\nnav: {json.dumps(navigation())}\n")
    if subprocess.run(["mkdocs", "build", "--quiet", "--clean", "--config-file", path]).returncode:
        fail("mkdocs")
    count, faults = links.html_faults(out)
    if faults:
        fail("links of the site:\n" + "\n".join(faults))
    missing = missing_in_gallery(open(os.path.join(out, "gallery.html"), encoding="utf-8").read(), jobs)
    if missing:
        fail(f"the gallery lacks {', '.join(missing)}")
    print(f"{out}/index.html: {count} pages, every link leads somewhere; {len(jobs)} samples in the gallery")


if __name__ == "__main__":
    main()
