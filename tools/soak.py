"""Draw the random tests anew, round after round, and say how to draw again what failed.

`make test` draws the same cases in every run. Here each round has a seed of its own: for the property tests of the
model and of the interface, for wheels driven at random (`wheelrail torture`), for random calls of the Python package.

A round that fails is drawn again by its seed; what it found becomes a named test. The torture also finds the steps that
a contact may refuse by docs/limits.md.
"""

import argparse
import os
import random
import re
import subprocess
import sys
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
# Runs of the torture in a round, of each contact model: half a minute or so.
RUNS = {"line": 40, "patch": 8, "profiles": 8, "new-profiles": 8}
SEQUENCES = 200
# Cases of each contact and law of friction: the share of a few that lies at corners scatters by more than the test
# allows.
DERIVATIVE_CASES = "100"


def draws(seed, command):
    """Name and command of everything that a round draws."""
    cargo = [sys.executable, "tools/cargo.py", *command, "test", "--no-fail-fast"]
    yield "model", [*cargo, "--lib", "--test", "model"]
    yield "interface", [*cargo, "--test", "fmi", "sequences::"]
    for model, runs in RUNS.items():
        torture = ["target/release/wheelrail", "torture", "--model", model, "--runs", str(runs), "--seed", str(seed)]
        yield f"torture of the {model}", [*torture, "--slowest", "0"]
    calls = ["python_tests/test_random_calls.py", "--seeds", str(seed), str(seed + SEQUENCES)]
    yield "Python", [sys.executable, *calls]


def passes(name, line, environment):
    """Run one command; print what it says where it fails."""
    began = time.monotonic()
    done = subprocess.run(
        line, cwd=REPOSITORY, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    print(f"  {name}: {'passes' if done.returncode == 0 else 'FAILS'}, {time.monotonic() - began:.0f} s", flush=True)
    if done.returncode != 0:
        print(re.sub(r"(?m)^", "    ", done.stdout[-6000:]), flush=True)
    return done.returncode == 0


def passes_round(seed, command):
    """Draw a round; say how to draw it again if it fails."""
    print(f"seed {seed}", flush=True)
    environment = os.environ | {
        "PROPTEST_RNG_SEED": str(seed),
        "PROPTEST_DISABLE_FAILURE_PERSISTENCE": "true",
        "DERIVATIVE_CASES": DERIVATIVE_CASES,
    }
    failed = [name for name, line in draws(seed, command) if not passes(name, line, environment)]
    if failed:
        print(f"seed {seed} fails: {', '.join(failed)}. Again: make soak SEED={seed}", flush=True)
    return not failed


def main():
    """Draw rounds until the time is over, or the one that was asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=10.0, help="after which no other round begins")
    parser.add_argument("--seed", type=int, help="draw this round alone")
    parser.add_argument("command", nargs="*", help="options of tools/cargo.py")
    given = parser.parse_args()
    if given.seed is not None:
        sys.exit(0 if passes_round(given.seed, given.command) else 1)
    end, rounds, failed = time.monotonic() + 60.0 * given.minutes, 0, []
    while rounds == 0 or time.monotonic() < end:
        seed = random.SystemRandom().randrange(2**32)
        rounds += 1
        if not passes_round(seed, given.command):
            failed.append(seed)
    print(f"{rounds} rounds, {len(failed)} fail{': seeds ' if failed else ''}{', '.join(map(str, failed))}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
