"""Prove claims with a checker's own rules, by branching on whatever is open: prove.py CHECKER FOLDER COUNT MOST HOW

FOLDER has the heads of COUNT certificates, named by numbers; proofs get the ending .proof. Ends after MOST proofs. HOW
is `orders`, or `time` for counting and branchings along time.
"""
import importlib.util
import itertools
import os
import sys


def text(word, numbers):
    return " ".join([word, *map(str, numbers)])


def countings(checker, head, count):
    """Return the counting lines that the checker accepts, a list for each argument; cliques that contain all sensors
    come first."""
    def accepted(lines):
        try:
            checker.Problem(checker.Lines("\n".join([*head, *lines, "end", ""])))
        except checker.Refused:
            return False
        return True

    sets = [found for size in range(1, count + 1) for found in itertools.combinations(range(count), size)]
    cliques = [found for found in sets if accepted([text("clique", found)])]
    of_size = [[found for found in cliques if len(found) == size] for size in range(1, count + 1)]
    pairs = [list(pair) for pair in itertools.combinations(cliques, 2)]
    groups = [cliques, *of_size, *([one] for one in cliques), *pairs]
    groups = [[text("clique", found) for found in group] for group in groups if group]
    words = [[f"{word} {n}"] for word in ("line", "ring") for n in range(2, count + 1)]
    return [*groups, ["sequence"], *(lines for lines in words if accepted(lines))]


def assumptions(checker, head, count, greatest):
    """Return the root lines that the checker accepts: all permutations, an exchange, a reversal."""
    def accepted(lines):
        reader = checker.Lines("\n".join([*head, *lines, "end", ""]))
        try:
            checker.root(reader, checker.Problem(reader))
        except checker.Refused:
            return False
        return reader.is_next("end")

    images = [text("permutation", image) for image in itertools.permutations(range(count))][1:]
    images = [image for image in images if accepted([image, f"{greatest} 0"])]
    reversals = [text("reverse", pair) for pair in itertools.combinations(range(count), 2)]
    reversals = [line for line in reversals if accepted([line])][:1]
    families = images and [*images, f"{greatest} 0"]
    return families + ([] if greatest == "first" else ["exchange 0"] + reversals)


def tree(checker, problem, node):
    """Return the lines of a tree that refutes the node; None if it is not refuted and nothing is open."""
    every = range(problem.sensors)
    if problem.sets and node.left():
        found = ["next"]
        for case in checker.branching(checker.Lines("next"), node):
            if child := node.assuming(case):
                if (below := tree(checker, problem, child)) is None:
                    return None
                found += below
        return found
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


def main(path, folder, count, most, how):
    spec = importlib.util.spec_from_file_location("checker", path)
    checker = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(checker)
    for number in range(int(count)):
        with open(os.path.join(folder, str(number))) as file:
            head = file.read().split("\n")
        head = head[:next(i for i, line in enumerate(head) if line.startswith("no_period_below")) + 1]
        sensors, found = int(head[2].split(" ")[1]), None
        if how == "time":
            for lines in (counted := countings(checker, head, sensors)):
                if checker.Problem(checker.Lines("\n".join([*head, *lines, "end", ""]))).is_refuted:
                    head, found = head + lines, []
                    break
            else:
                head += counted[0]
        if found is None:
            head += assumptions(checker, head, sensors, "first" if how == "time" else "greatest")
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
