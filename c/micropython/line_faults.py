"""Read an echo line's faults in tests/data/line-faults.txt; fill the table in tests/data/line-fault-outcomes.txt."""

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
    """Return the file's (period, firing times of each phase, faults)."""
    rows = [line.split("|") for line in text.strip().split("\n") if not line.startswith("#")]
    times = [[int(us) for us in phase.split()] for phase in rows[0][2:]]
    return int(rows[0][1]), times, [Fault(row) for row in rows[1:]]


def cell(right, count, lies):
    """Return a cell of the table."""
    return "%d of %d, %d" % (right, count, lies)


def with_column(document, column, cells):
    """Return the document with these cells, keyed by name and surroundings, in a column of its table."""
    rows, left = [line.split("|") for line in document.split("\n")], dict(cells)
    at = [[cell.strip() for cell in row].index(column) for row in rows if row[1:2] == [" fault "]][0]
    for row in rows:
        key = tuple([cell.strip() for cell in row[1:3]])
        if key in left:
            row[at] = " %s " % left.pop(key)
    if left:
        raise AssertionError("no row of %r in the table" % list(left))
    return "\n".join(["|".join(row) for row in rows])
