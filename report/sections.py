"""sections.py - a page of verification: its sections are run, kept one by one, and written together.

A report is a script report/NAME.py that calls `main` with its sections. Each section is a function without arguments that returns markdown; it is kept
in build/report/NAME/SECTION.md with its seconds and its claims beside it, so that -only runs some and takes the others from there. A note written by hand,
report/notes/NAME_SECTION.md, goes below its section. A section that was never run here stays as it stands on the page.
"""

import json
import os
import platform
import re
import sys
import time

from program import NAME, PROGRAM, ROOT, WORK, Failure, Missing, execute, program_options, say, table

PAGE = ROOT / "docs" / "verification" / (NAME + ".md")

claims = []  # of the section that runs


def claim(case, error, order="", bar="", met=None):
    """a row of the table at the page's head: finest error and observed order as text, the bar if there is one, and whether it is met"""
    claims.append([case, error, order, bar, "" if met is None else "yes" if met else "**no**"])


def machine():
    name = platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            name = next((line.split(":")[1].strip() for line in file if line.startswith("model name")), name)
    except OSError:
        pass
    return f"{os.cpu_count()} cores of an {name}" if name[0] in "AEIOU" else f"{os.cpu_count()} cores of a {name}"


def note(section):
    """what a reader should know of a section, written by hand"""
    path = ROOT / "report" / "notes" / f"{NAME}_{section}.md"
    return "\n" + path.read_text(encoding="utf-8") if path.exists() else ""


def make(name, section):
    """one section, kept in files"""
    start = time.time()
    print(f"== {name}", file=sys.stderr, flush=True)
    claims.clear()
    text = section()
    (WORK / (name + ".md")).write_text(text, encoding="utf-8")
    (WORK / (name + ".json")).write_text(json.dumps({"seconds": round(time.time() - start, 1), "claims": claims}), encoding="utf-8")


def make_if_possible(name, section, asked):
    """a section for which something is missing stays as it is, unless it was asked for"""
    try:
        make(name, section)
    except Missing as missing:
        if asked:
            raise
        say(f"left as it is: {missing}")


def kept(name, page):
    """text, seconds and claims of a section that was run here, else as they stand on the page; None without either"""
    if (WORK / (name + ".md")).exists() and (WORK / (name + ".json")).exists():
        data = json.loads((WORK / (name + ".json")).read_text(encoding="utf-8"))
        return (WORK / (name + ".md")).read_text(encoding="utf-8") + note(name), data["seconds"], data["claims"]
    found = re.search(rf"^`-only {name}`, (\d+) s\. (.*?)(?=^## |\Z)", page, re.MULTILINE | re.DOTALL)
    if not found:
        return None
    rows = [[cell.strip() for cell in line.split("|")[2:-1]] for line in page.splitlines() if line.startswith(f"| `{name}` |")]
    return found.group(2).rstrip("\n") + "\n", float(found.group(1)), rows


def write_page(sections, head):
    before = PAGE.read_text(encoding="utf-8") if PAGE.exists() else ""
    parts, rows, seconds, failures = [], [], 0.0, 0
    for name, title, _ in sections:
        found = kept(name, before)
        if not found:
            continue
        text, spent, said = found
        seconds += spent
        failures += text.count("**no**") + sum(row[-1] == "**no**" for row in said)
        rows += [[f"`{name}`", *row] for row in said]
        parts.append(f"\n## {title}\n`-only {name}`, {spent:.0f} s. {text}")
    summary = table(["section", "case", "error, finest", "order", "bar", "met"], rows) if rows else ""
    text = head.format(seconds=seconds, machine=machine(), failures=failures or "none", summary=summary) + "".join(parts)
    PAGE.parent.mkdir(parents=True, exist_ok=True)
    PAGE.write_text(text.rstrip("\n") + "\n", encoding="utf-8")
    say(f"{PAGE}: {failures} rows not within, {seconds:.0f} s")
    return failures


def main(arguments, sections, head):
    """-only SECTION ...: run these, the others as they are; -keep: runs whose scene is unchanged are not run again. The exit status"""
    arguments = program_options(arguments)
    only = arguments[1:] if arguments[:1] == ["-only"] else []
    known = [name for name, _, _ in sections]
    if (arguments and not only) or any(name not in known for name in only):
        print(f"usage: ./dev report {NAME} [-keep] [-only SECTION ...]; sections: {' '.join(known)}", file=sys.stderr)
        return 2
    WORK.mkdir(parents=True, exist_ok=True)
    try:
        execute([PROGRAM, "info"])
        for name, _, section in sections:
            if not only or name in only:
                make_if_possible(name, section, asked=name in only)
    except Failure as failure:
        print(failure, file=sys.stderr)
        return 1
    return 3 if write_page(sections, head) else 0
