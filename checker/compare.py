#!/usr/bin/env python3
"""Gives both checkers the same mutated certificates: they must refuse at the same line, or both accept a claim that
still holds. python3 compare.py BIN_FOLDER COUNT [SEED] [CERTIFICATE ...]

BIN_FOLDER holds eeruf-check and examples/prove. Without certificates, tiny random problems are made and proven; their
mutated claims are judged by trying all schedules. Those of given certificates are judged by a fresh proof.
"""
import collections
import os
import random
import subprocess
import sys
import tempfile

import check_period


def tiny_problem(dice):
    """The head of a certificate without schedule: lines up to the gaps."""
    count, even = dice.randint(2, 4), dice.random() < 0.3

    def row(most):
        return [dice.randint(1, most)] * count if even else [dice.randint(1, most) for _ in range(count)]

    separation, window, together = row(3), row(5), []
    if count > 2 and dice.random() < 0.3:
        together = [sorted(dice.sample(range(count), 2))]
    lines = ["eeruf-certificate 1", "tick_us 1 1", f"sensors {count}"]
    lines += [text("separation", separation), text("window", window)]
    lines += [f"stale_echo {dice.randint(0, 1)}", "over_reals 0"] + [text("together", group) for group in together]
    interval = dice.randint(1, 4)
    for x in range(count):
        for y in range(x + 1, count):
            if [x, y] not in together and dice.random() < 0.8:
                is_shared = not even and dice.random() < 0.3
                gap = [window[x], window[y]] if is_shared else [interval if even else dice.randint(1, 4)] * 2
                lines.append(text("gap", [x, y] + gap))
    return lines


def text(word, numbers):
    return " ".join([word, *map(str, numbers)])


def schedule(problem, period):
    """A schedule with this period, if there is one, by trying all firing times."""
    every = range(problem.sensors)

    def fits(fire):
        x = len(fire) - 1
        d = [a - b for a, b in fire]
        if period - abs(d[x]) < problem.window[x] or problem.stale_echo and 2 * abs(d[x]) < problem.separation[x]:
            return False
        for y in range(x):
            if any(x in group and y in group for group in problem.together):
                if fire[x] != fire[y]:
                    return False
            elif abs(abs(d[x]) - abs(d[y])) < max(problem.separation[x], problem.separation[y]):
                return False
            for one, other in ((x, y), (y, x)):
                if gap := problem.gap[one][other]:
                    first, then = ([n * period + fire[s][n % 2] for n in range(5)] for s in (one, other))
                    if any(0 <= t - f < gap for f in first for t in then):
                        return False
        return True

    def extend(fire):
        if len(fire) == len(every):
            return fire
        for a in range(period):
            for b in range(period):
                if fits(fire + [(a, b)]) and (found := extend(fire + [(a, b)])):
                    return found
        return None

    return extend([])


def prove(binaries, head):
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
        file.write("\n".join(head) + "\n")
        file.flush()
        done = subprocess.run([os.path.join(binaries, "examples", "prove"), file.name], capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else None


def tiny_certificate(dice, binaries):
    while True:
        head = tiny_problem(dice)
        lines = check_period.Lines("\n".join(head + ["period 1"]))
        problem = object.__new__(check_period.Problem)
        try:
            problem.__init__(lines)
        except check_period.Refused:
            pass  # at the schedule, which is not there yet
        for period in range(1, 11 if problem.sensors == 4 else 14):
            if fire := schedule(problem, period):
                head += [f"period {period}", text("fire_a", [a for a, _ in fire]), text("fire_b", [b for _, b in fire])]
                bound = period if dice.random() < 0.8 else dice.randint(1, period)
                return prove(binaries, head + [f"no_period_below {bound}"])


def mutated(dice, certificate):
    lines = certificate.split("\n")
    for _ in range(dice.choice([1, 1, 1, 2, 3])):
        i, j = dice.randrange(len(lines)), dice.randrange(len(lines))
        kind = dice.choice(["delete", "double", "swap", "move", "cut", "number", "number", "number", "number"])
        if kind == "delete":
            del lines[i]
        elif kind == "double":
            lines.insert(i, lines[i])
        elif kind == "swap":
            lines[i], lines[j] = lines[j], lines[i]
        elif kind == "move":
            lines.insert(j, lines.pop(i))
        elif kind == "cut":
            # The rest of the text, or of one line.
            if dice.random() < 0.5:
                lines = lines[:i + 1]
            else:
                lines[i] = lines[i][:dice.randint(0, len(lines[i]))]
        else:
            parts = lines[i].split(" ")
            at = dice.randrange(len(parts))
            if parts[at].isdigit():
                parts[at] = str(max(0, int(parts[at]) + dice.choice([-2, -1, 1, 2, dice.randint(-30, 30)])))
                lines[i] = " ".join(parts)
        lines = lines or [""]
    return "\n".join(lines)


def verdicts(binaries, certificate):
    """Returns what the two checkers say: the words of acceptance, or the line of refusal."""
    try:
        here = check_period.check(certificate).claim()
    except check_period.Refused as error:
        here = str(error).split(":")[0]
    with tempfile.NamedTemporaryFile("w", suffix=".txt", newline="") as file:
        file.write(certificate)
        file.flush()
        done = subprocess.run([os.path.join(binaries, "eeruf-check"), file.name], capture_output=True, text=True)
    there = done.stdout.strip()
    return here, there if done.returncode == 0 else there.split(": ")[2]


def holds(binaries, certificate, is_tiny):
    """Returns true if the claim is true: the schedule was checked longhand already."""
    problem = check_period.Problem(check_period.Lines(certificate))
    if is_tiny and problem.bound < 16:
        return problem.bound == 1 or schedule(problem, problem.bound - 1) is None
    head = certificate.split("\n")
    end = next(i for i, line in enumerate(head) if line.startswith("no_period_below"))
    return prove(binaries, head[:end + 1]) is not None


def main(arguments):
    binaries, count, seed = arguments[0], int(arguments[1]), int(arguments[2]) if len(arguments) > 2 else 1
    dice, counts = random.Random(seed), collections.Counter()
    given = [open(name).read() for name in arguments[3:]]
    for number in range(count):
        if number % 25 == 0:
            original = given[number // 25 % len(given)] if given else tiny_certificate(dice, binaries)
            here, there = verdicts(binaries, original)
            if here != there or here.startswith("line"):
                sys.exit(f"unmutated: {here} / {there}\n{original}")
        certificate = original
        while certificate == original:
            certificate = mutated(dice, original)
        here, there = verdicts(binaries, certificate)
        if here != there:
            sys.exit(f"the checkers differ: {here} / {there}\n{certificate}")
        if here.startswith("line"):
            counts["refused"] += 1
            continue
        head = certificate.split("no_period_below")[0]
        if head == original.split("no_period_below")[0] and here == check_period.check(original).claim():
            counts["another proof of the same claim"] += 1
        elif holds(binaries, certificate, not given):
            counts["another claim, which holds"] += 1
        else:
            sys.exit(f"a false claim was accepted: {here}\n{certificate}")
    print(", ".join(f"{number} {what}" for what, number in counts.most_common()))


if __name__ == "__main__":
    main(sys.argv[1:])
