"""Programs and seeds of the tests."""

import subprocess

import pytest


def pytest_addoption(parser):
    parser.addoption("--command", required=True, help="the program `crane`")
    parser.addoption("--combinations", required=True, help="the program `combinations`")
    parser.addoption("--from", type=int, default=0, help="the first seed")
    parser.addoption("--count", type=int, default=4, help="how many random cranes")


def pytest_generate_tests(metafunc):
    if "seed" in metafunc.fixturenames:
        first = metafunc.config.getoption("--from")
        metafunc.parametrize("seed", range(first, first + metafunc.config.getoption("--count")))


@pytest.fixture(scope="session")
def specs(request, tmp_path_factory):
    """Files of random cranes by their seeds, each written once."""
    program, files = request.config.getoption("--combinations"), {}
    folder = tmp_path_factory.mktemp("specs")

    def spec(seed):
        if seed not in files:
            text = subprocess.run([program, "--from", str(seed), "--print"], capture_output=True, text=True, check=True).stdout
            files[seed] = folder / f"random_{seed}.yaml"
            files[seed].write_text(text)
        return files[seed]

    return spec


@pytest.fixture(scope="session")
def command(request):
    """Runs the command and returns what it prints."""
    program = request.config.getoption("--command")

    def run(*arguments):
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run
