#!/usr/bin/env python3
"""Lines of the checkout by folder, held against BUDGET: python3 xtask/budget.py [--write]

Code is every line but tests, comments, docstrings and blank lines; words are counted in Markdown; text is every line of
every file. Links are not followed. A folder may have at most the numbers in its row of BUDGET; without a row, nothing.
--write lowers rows to the present counts, rounded up to the next 50, and raises none: a number is raised by hand, in a
commit of its own that says what users gain and what was considered for removal. Every commit that raises one is checked.
"""
import ast
import collections
import pathlib
import re
import subprocess
import sys

BUDGET = pathlib.Path("BUDGET")
COLUMNS = ["rust", "c", "python", "web", "words", "text"]
STEP = 50
HEAD = """\
# Most lines of code by folder (text: of all files), and words of Markdown: `python3 xtask/budget.py` counts, and the
# quick lane of `cargo xtask test` holds them. --write lowers rows; one goes up only by hand, in a commit of its own.
"""


def git(*arguments):
    return subprocess.run(["git", *arguments], check=True, capture_output=True, text=True).stdout


def rust(text, in_tests):
    """Lines of code outside tests."""
    code, inside, lines = 0, in_tests, text.split("\n")
    for line, following in zip(lines, [*lines[1:], ""]):
        bare = line.strip()
        if not inside and bare.startswith("#[cfg(test)]") and re.match(r"(pub )?mod \w+ *\{", following.strip()):
            inside = True
        if inside:
            inside = in_tests or not line.startswith("}")
        elif bare and not bare.startswith("//"):
            code += 1
    return code


def c_like(text):
    text = re.sub(r"/\*.*?\*/", lambda comment: "\n" * comment.group().count("\n"), text, flags=re.S)
    return sum(bool(line.strip()) and not line.strip().startswith("//") for line in text.split("\n"))


def python(text):
    lines = {number for number, line in enumerate(text.split("\n"), 1) if line.strip() and line.strip()[0] != "#"}
    try:
        nodes = list(ast.walk(ast.parse(text)))
    except SyntaxError:  # templates, and syntax that is too new for this Python
        return len(lines)
    for node in nodes:
        body = getattr(node, "body", None)
        if isinstance(body, list) and body and isinstance(body[0], ast.Expr):
            value = getattr(body[0], "value", None)
            if isinstance(value, ast.Constant) and isinstance(value.value, str):
                lines -= set(range(body[0].lineno, body[0].end_lineno + 1))
    return len(lines)


def counted(name, text):
    """The column of a file, if it has one, and its count."""
    if name.endswith(".rs"):
        in_tests = re.search(r"(^|/)(tests|benches)/|tests\.rs$", name) is not None
        return "rust", rust(text, in_tests)
    if re.search(r"\.(c|h|cpp|ino)$", name):
        return "c", c_like(text)
    if re.search(r"\.pyi?$", name):
        return "python", python(text)
    if re.search(r"\.(js|ts|css|html)$", name):
        return "web", c_like(text)
    if name.endswith(".md"):
        return "words", len(text.split())
    return None, 0


def measured():
    """Count by folder and in total, including files that are about to be added."""
    rows = collections.defaultdict(collections.Counter)
    for name in git("ls-files", "--cached", "--others", "--exclude-standard").split("\n"):
        path = pathlib.Path(name)
        if not name or path.is_symlink() or not path.is_file():
            continue
        try:
            text = path.read_text(encoding="utf8")
        except UnicodeDecodeError:
            continue
        deep = path.parts[0] in ("crates", "docs") and len(path.parts) > 2
        folder = "/".join(path.parts[:2]) if deep else path.parts[0] if len(path.parts) > 1 else "."
        column, count = counted(name, text)
        for row in (rows[folder], rows["all"]):
            row[column] += count
        rows["all"]["text"] += text.count("\n")
    return rows


def parsed(text):
    """Rows of BUDGET."""
    lines = (line.split() for line in text.split("\n") if line and not line.startswith("#"))
    return {folder: dict(zip(COLUMNS, (0 if most == "-" else int(most) for most in row))) for folder, *row in lines}


def written(rows):
    """Format BUDGET with these rows, except empty ones."""
    folders = sorted((folder for folder in rows if folder != "all" and any(rows[folder].values()))) + ["all"]
    lines = [["folder", *COLUMNS]] + [[folder, *(str(rows[folder][c] or "-") for c in COLUMNS)] for folder in folders]
    lines[0][0] = "# " + lines[0][0]
    return HEAD + "".join(f"{line[0]:26}" + "".join(f"{field:>8}" for field in line[1:]) + "\n" for line in lines)


def raised(commit):
    """The rows that a commit raises or adds."""
    try:
        before = parsed(git("show", f"{commit}^:BUDGET"))
    except subprocess.CalledProcessError:  # the first, or the end of a shallow clone
        return []
    after = parsed(git("show", f"{commit}:BUDGET"))
    return [
        f"{folder} {column}"
        for folder, row in after.items()
        for column, most in row.items()
        if most > before.get(folder, {}).get(column, 0)
    ]


def main():
    rows, most = measured(), parsed(BUDGET.read_text(encoding="utf8")) if BUDGET.exists() else None
    if "--write" in sys.argv:
        rounded = {f: {c: -(-row[c] // STEP) * STEP for c in COLUMNS} for f, row in rows.items()}
        if most is not None:
            rounded = {f: {c: min(n, most.get(f, {}).get(c, 0)) for c, n in row.items()} for f, row in rounded.items()}
        BUDGET.write_text(written(rounded), encoding="utf8")
        return
    over = []
    for folder, row in rows.items():
        for column in COLUMNS:
            limit = (most or {}).get(folder, {}).get(column, 0)
            if row[column] > limit and (folder == "all" or column != "text"):
                over.append(f"{folder}: {row[column]} of {column}; BUDGET has {limit}")
    for commit in git("log", "-n", "50", "--format=%h", "--", "BUDGET").split():
        others = set(git("show", "--format=", "--name-only", commit).split()) - {"BUDGET"}
        if others and (rows_up := raised(commit)):
            over.append(f"{commit} raises {', '.join(rows_up)} and changes {len(others)} other files")
    print(written(rows).split("\n", 2)[2], end="")
    sys.exit("\n".join(over) if over else 0)


if __name__ == "__main__":
    main()
