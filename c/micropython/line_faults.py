"""Faults of one echo line from tests/data/line-faults.txt, and the table of tests/data/line-fault-outcomes.txt."""

FAULTY = 1  # in the file's ring


class Fault:
    """A row of the file. An edge is (us, level, is_lost); `says` and `samples` are words."""

    def __init__(self, columns):
        self.name, self.before, line, edges, says, samples = [column.strip() for column in columns]
        self.says, self.samples = says.split(), samples.split()
        words = line.split()
        self.partner = int(words[1]) if words[0] == "exchanged" else None
        self.forgotten = words[0] == "forgotten"
        self.words = edges.split()
        self.edges = [(int(word[1:].rstrip("*")), word[0] == "+", word.endswith("*")) for word in self.words]


def read(text):
    """The file: (period, firing times of each phase, faults)."""
    rows = [line.split("|") for line in text.strip().split("\n") if not line.startswith("#")]
    head = rows[0]
    if head[0].strip() != "schedule":
        raise ValueError("%r; expected a schedule" % head[0])
    times = [[int(us) for us in phase.split()] for phase in head[2:]]
    return int(head[1]), times, [Fault(row) for row in rows[1:]]


def cell(right, count, lies):
    """A cell of the table."""
    return "%d of %d, %d" % (right, count, lies)


def _cells(line):
    return [cell.strip() for cell in line.strip("|").split("|")]


def with_column(document, column, cells):
    """The document whose table has these cells, by name and surroundings, in this column."""
    lines, at, seen = document.split("\n"), None, set()
    for number, line in enumerate(lines):
        if not line.startswith("|"):
            continue
        row = _cells(line)
        if row[0] == "fault":
            at = row.index(column)
        elif at is not None and (row[0], row[1]) in cells:
            row[at] = cells[row[0], row[1]]
            lines[number] = "| " + " | ".join(row) + " |"
            seen.add((row[0], row[1]))
    missing = [key for key in cells if key not in seen]
    if missing:
        raise AssertionError("no row of %r in the table" % missing)
    return "\n".join(lines)
