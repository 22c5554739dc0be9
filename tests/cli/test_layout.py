"""The source tree keeps its promises: includes point one way, files stay small, the reference page is what the program prints."""
import os
import re
import subprocess
import sys

SOURCE = os.environ["BYSSUS_SOURCE"]
PROGRAM = os.environ["BYSSUS"]

# what each module may include besides itself; proxy sees the fluid through sph/sph.h only, never the solid
ALLOWED = {
    "base": set(),
    "sph": {"base"},
    "tled": {"base"},
    "proxy": {"base", "sph"},
    "coupler": {"base", "sph", "tled", "proxy"},
    "main": {"base", "coupler"},
}
LINES_MAX = 1000  # style: aim at 150-600, never 1000


def module_of(path):
    """'sph' of src/sph/sph.c, 'base' of src/keys.c"""
    relative = os.path.relpath(path, os.path.join(SOURCE, "src"))
    if relative == "main.c":
        return "main"
    return relative.split(os.sep)[0] if os.sep in relative else "base"


def sources():
    for folder, _, files in os.walk(os.path.join(SOURCE, "src")):
        for name in sorted(files):
            if name.endswith((".c", ".h", ".cu")):
                yield os.path.join(folder, name)


def check_includes(path, text, errors):
    module = module_of(path)
    for target in re.findall(r'^\s*#\s*include\s+"([^"]+)"', text, re.M):
        beside = os.path.normpath(os.path.join(os.path.dirname(path), target))
        other = module_of(beside if os.path.exists(beside) else os.path.join(SOURCE, "src", target))
        if other == module:
            continue
        if other not in ALLOWED[module]:
            errors.append(f"{path} includes {target}: {module} may not see {other}")
        if target.endswith("_impl.h"):
            errors.append(f"{path} includes {target}: private to {other}")


def check_reference(errors):
    page = os.path.join(SOURCE, "docs", "keys.md")
    printed = subprocess.run([PROGRAM, "info", "-keys"], capture_output=True, text=True, check=True).stdout
    with open(page) as file:
        if file.read() != printed:
            errors.append(f"{page} is not what the program prints: byssus info -keys > docs/keys.md")


def main():
    errors = []
    count = 0
    for path in sources():
        with open(path) as file:
            text = file.read()
        count += 1
        check_includes(path, text, errors)
        if text.count("\n") > LINES_MAX:
            errors.append(f"{path} has {text.count(chr(10))} lines, more than {LINES_MAX}")
    if count < 10:
        errors.append("hardly any sources were found")
    with open(os.path.join(SOURCE, "src", "main.c")) as file:
        if file.read().count("\n") >= 150:
            errors.append("src/main.c has 150 lines or more")
    check_reference(errors)
    print("\n".join(errors) or f"{count} files keep the rules")
    return 1 if errors else 0


sys.exit(main())
