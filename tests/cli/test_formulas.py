"""The README's table of formulas is true: it names every formula of the headers, in the file that has it, and tests that exist."""
import glob
import os
import re
import sys

SOURCE = os.environ["BYSSUS_SOURCE"]
MODULES = ("sph", "tled", "proxy")
HEADING = "## Where each formula lives"
FORMULA = re.compile(r"^BY_HD\s+[^;{}()]*?(\w+)\s*\(", re.M)


def formulas_of_headers():
    """{'sph/sph_kernel.h': {'SPHKernelW', ...}} of all headers with formulas; and marks that no name could be read from"""
    found, unread = {}, []
    for module in MODULES:
        for path in sorted(glob.glob(os.path.join(SOURCE, "src", module, "*.h"))):
            with open(path, encoding="utf-8") as file:
                text = file.read()
            name = f"{module}/{os.path.basename(path)}"
            names = FORMULA.findall(text)
            if names:
                found[name] = set(names)
            if len(names) != len(re.findall(r"\bBY_HD\b", text)):
                unread.append(f"src/{name}: BY_HD stands where it begins no function")
    return found, unread


def table_of_readme():
    """rows (line number, functions, file, test) of the table, and what is wrong with its form"""
    rows, errors = [], []
    with open(os.path.join(SOURCE, "README.md"), encoding="utf-8") as file:
        lines = file.read().splitlines()
    if HEADING not in lines:
        return rows, [f"README.md has no section '{HEADING}'"]
    for number, line in enumerate(lines[lines.index(HEADING) + 1:], lines.index(HEADING) + 2):
        if line.startswith("## "):
            break
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("|") or cells[0] == "formula" or set(cells[0]) <= set("-: "):
            continue
        where = re.fullmatch(r"((?:`\w+` )*`\w+`), (\S+)", cells[1]) if len(cells) == 4 else None
        if where is None or not all(cells):
            errors.append(f"README.md:{number}: expected | formula | `Function` `Function`, file | source | test |")
            continue
        rows.append((number, re.findall(r"`(\w+)`", where.group(1)), where.group(2), cells[3]))
    return rows, errors


def main():
    headers, errors = formulas_of_headers()
    rows, wrong = table_of_readme()
    errors += wrong
    named = {}
    for number, functions, header, test in rows:
        if not any(os.path.exists(os.path.join(SOURCE, "tests", test + end)) for end in (".c", ".py")):
            errors.append(f"README.md:{number}: there is no test tests/{test}")
        for function in functions:
            if function not in headers.get(header, ()):
                errors.append(f"README.md:{number}: {function} is not a formula of src/{header}")
            if function in named:
                errors.append(f"README.md:{number}: {function} is in line {named[function]} already")
            named[function] = number
    for header, functions in headers.items():
        errors += [f"README.md does not name {function} of src/{header}" for function in sorted(functions - set(named))]
    if sum(map(len, headers.values())) < 10:
        errors.append("hardly any formulas were found")
    print("\n".join(errors) or f"{len(named)} formulas in {len(rows)} rows")
    return 1 if errors else 0


sys.exit(main())
