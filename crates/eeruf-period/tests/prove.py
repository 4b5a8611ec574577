"""Proves claims with a checker's own rules, by branching on whatever is open: prove.py CHECKER FOLDER COUNT MOST

FOLDER has the heads of COUNT certificates, named by numbers; proofs get the ending .proof. Ends after MOST proofs.
"""
import importlib.util
import itertools
import os
import sys


def assumptions(checker, head, count):
    """The lines for the root that the checker accepts: all permutations, an exchange, a reversal."""
    def accepted(lines):
        reader = checker.Lines("\n".join([*head, *lines, "end", ""]))
        try:
            checker.root(reader, checker.Problem(reader))
        except checker.Refused:
            return False
        return reader.is_next("end")

    def text(word, numbers):
        return " ".join([word, *map(str, numbers)])

    images = [text("permutation", image) for image in itertools.permutations(range(count))][1:]
    images = [image for image in images if accepted([image, "greatest 0"])]
    reversals = [text("reverse", pair) for pair in itertools.combinations(range(count), 2)]
    reversals = [line for line in reversals if accepted([line])][:1]
    return (images and [*images, "greatest 0"]) + ["exchange 0"] + reversals


def tree(checker, problem, node):
    """The lines of a tree that refutes the node; None if nothing is open and it is not refuted."""
    every = range(problem.sensors)
    pairs = [f"{x} {y}" for x, y in itertools.combinations(every, 2)]
    lines = [f"{phase} {pair}" for pair in pairs for phase in "ab"] + [f"sign {x}" for x in every]
    lines += [f"rank {pair}" for pair in pairs] + [f"split {x} {v}" for x in every for v in range(problem.bound)]
    for line in lines:
        try:
            cases = checker.branching(checker.Lines(line), node)
        except checker.Refused:
            continue
        found = [line]
        for case in cases:
            if child := node.assuming(case):
                if (below := tree(checker, problem, child)) is None:
                    return None
                found += below
        return found
    return None


def main(path, folder, count, most):
    spec = importlib.util.spec_from_file_location("checker", path)
    checker = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(checker)
    for number in range(int(count)):
        with open(os.path.join(folder, str(number))) as file:
            head = file.read().split("\n")
        head = head[:next(i for i, line in enumerate(head) if line.startswith("no_period_below")) + 1]
        head += assumptions(checker, head, int(head[2].split(" ")[1]))
        reader = checker.Lines("\n".join([*head, "end", ""]))
        problem = checker.Problem(reader)
        node = checker.root(reader, problem)
        found = tree(checker, problem, node) if node else []
        if found is not None:
            with open(os.path.join(folder, f"{number}.proof"), "w") as file:
                file.write("\n".join([*head, *found, "end", ""]))
            most = int(most) - 1
            if most == 0:
                return


main(*sys.argv[1:])
