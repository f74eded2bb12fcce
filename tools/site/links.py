#!/usr/bin/python3
"""Relative links of Markdown pages and of HTML pages: does each lead to a file and, behind '#', to a heading or a name?

    links.py REPOSITORY          every page of the repository that can be reached from README.md and docs/
    links.py --html FOLDER       every page of a site

One line a link that leads nowhere, 'page:line: link: why'; exit code 1 where there is one.
"""
import html.parser
import os
import re
import sys
import urllib.parse

LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)\)")


def lines_of_text(page):
    """(number, line) of what is no code: neither fenced, nor set off by four blanks, nor in backquotes."""
    fenced = list_item = False
    before = ""
    for number, line in enumerate(open(page, encoding="utf-8").read().split("\n"), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            if re.match(r"([-*]|\d+\.) ", line):
                list_item = True
            elif line and not line.startswith(" "):
                list_item = False
            if not (line.startswith("    ") and not list_item):
                yield number, re.sub(r"`[^`]*`", lambda m: "`" + "x" * (len(m.group()) - 2) + "`", line), line, before
            before = line


def slug(heading):
    """The name of a heading as GitHub and the site make it."""
    text = re.sub(r"[`*]|!?\[([^\]]*)\]\([^)]*\)", lambda m: m.group(1) or "", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def names_in(page):
    out = {}
    for _, _, line, _ in lines_of_text(page):
        for name in re.findall(r'<a id="([^"]+)">', line):
            out[name] = 0
        if match := re.match(r"#{1,6} (.*)", line):
            name = slug(match.group(1))
            out[name] = out.get(name, -1) + 1
    return set(out) | {f"{name}-{k}" for name, more in out.items() for k in range(1, more + 1)}


def links_of(page):
    """(line, link) of every relative link."""
    for number, line, _, _ in lines_of_text(page):
        for match in LINK.finditer(line):
            if not re.match(r"[a-z]+:", match.group(1)):
                yield number, match.group(1)


def pages_and_files(root):
    """Pages that can be reached from README.md and docs/, the files to which they link, and what leads nowhere."""
    pages, files, faults = [], set(), []
    todo = ["README.md"] + sorted(os.path.relpath(os.path.join(folder, name), root) for folder, _, names in os.walk(os.path.join(root, "docs"))
                                  for name in names if name.endswith(".md"))
    seen = set(todo)
    while todo:
        page = todo.pop(0)
        pages.append(page)
        full = os.path.join(root, page)
        for number, line, _, before in lines_of_text(full):
            if re.match(r"([-*]|\d+\.) ", line) and before and not re.match(r"[-*] |\d+\. | ", before):
                faults.append(f"{page}:{number}: a list needs an empty line before it")
        for number, link in links_of(full):
            path, _, name = link.partition("#")
            target = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
            where = f"{page}:{number}: {link}"
            if target.startswith(".."):
                faults.append(f"{where}: outside of the repository")
            elif not os.path.isfile(os.path.join(root, target)):
                faults.append(f"{where}: " + ("a folder; name its README.md" if os.path.isdir(os.path.join(root, target)) else "there is no such file"))
            elif not target.endswith(".md"):
                files.add(target)
            else:
                if name and name not in names_in(os.path.join(root, target)):
                    faults.append(f"{where}: no such heading")
                if target not in seen:
                    seen.add(target)
                    todo.append(target)
    return pages, sorted(files), faults


class Html(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.links, self.names = [], set()

    def handle_starttag(self, tag, attributes):
        for key, value in attributes:
            if key in ("id", "name"):
                self.names.add(value)
            elif key in ("href", "src") and value and not re.match(r"[a-z]+:|//", value):
                self.links.append((self.getpos()[0], value))


def html_faults(site):
    parsed = {}
    for folder, _, names in os.walk(site):
        for name in names:
            if name.endswith(".html"):
                path = os.path.join(folder, name)
                parsed[path] = Html()
                parsed[path].feed(open(path, encoding="utf-8").read())
    faults = []
    for page, content in sorted(parsed.items()):
        if os.path.basename(page) == "404.html":  # its links begin at the root of a server
            continue
        for number, link in content.links:
            path, _, name = urllib.parse.unquote(link).partition("#")
            target = os.path.normpath(os.path.join(os.path.dirname(page), path.partition("?")[0])) if path else page
            where = f"{os.path.relpath(page, site)}:{number}: {link}"
            if os.path.isdir(target):
                target = os.path.join(target, "index.html")
            if not os.path.isfile(target):
                faults.append(f"{where}: there is no such file")
            elif name and target in parsed and name not in parsed[target].names:
                faults.append(f"{where}: no such place in it")
    return len(parsed), faults


def main(arguments):
    if arguments[:1] == ["--html"]:
        count, faults = html_faults(arguments[1])
    else:
        pages, _, faults = pages_and_files(arguments[0])
        count = len(pages)
    for fault in faults:
        print(fault)
    print(f"{count} pages, {len(faults)} faults")
    return 1 if faults or not count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
