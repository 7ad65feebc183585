"""Options that the comparisons with generated code have in common."""

import argparse


def parser(documentation):
    """A parser with the options of every comparison."""
    options = argparse.ArgumentParser(description=documentation, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--evaluate", metavar="PROGRAM", help="the built program `evaluate`")
    options.add_argument(
        "--crane", metavar="NAME", action="append", help="compare this crane, or that of a YAML file (may be repeated)"
    )
    options.add_argument("--states", type=int, default=100, help="random states a crane, half near the guess, half far")
    options.add_argument("--seed", type=int, default=1, help="seed of the random states")
    options.add_argument("--self-test", metavar="SPEC", nargs="*", help="check the comparison, without Rust")
    return options


def run(options_parser, compare, self_test):
    """Runs the comparison or its self-test, as the arguments ask for, and returns the exit code."""
    options = options_parser.parse_args()
    if options.self_test is not None:
        return self_test(options)
    if not options.evaluate:
        options_parser.error("--evaluate or --self-test is needed")
    return compare(options)
