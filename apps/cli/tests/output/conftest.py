"""What the tests share: the command, and the schemas of what it prints."""

import json
import subprocess

import jsonschema
import pytest


def pytest_addoption(parser):
    parser.addoption("--command", required=True, help="the program `crane`")


@pytest.fixture(scope="session")
def crane(request):
    """Runs the command: its exit code and what it prints."""
    program = request.config.getoption("--command")

    def run(*arguments, text=None):
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, input=text)
        return done.returncode, done.stdout, done.stderr

    return run


@pytest.fixture(scope="session")
def output(crane):
    """What a command prints as JSON, after a check against the schema that `crane schema` prints."""

    def of(kind, *arguments, code=0, text=None):
        returned, out, err = crane(*arguments, "--format", "json", text=text)
        assert returned == code, err
        found = json.loads(out)
        schema = json.loads(crane("schema", kind)[1])
        jsonschema.Draft202012Validator.check_schema(schema)
        jsonschema.validate(found, schema, cls=jsonschema.Draft202012Validator)
        return found

    return of
