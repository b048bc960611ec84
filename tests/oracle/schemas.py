"""The answers for programs are what their schemas say, by a validator that is not ours: `schemas.py PEBO-GEN MODEL..` runs
`check` and `solve` of each model with `--format json`, and holds each object against what `pebo-gen schema` prints.

Each field is then taken out of an object, and one put in, which the schema must refuse. Exit status 0 if all of it holds,
else 1.
"""

import json
import subprocess
import sys

from jsonschema import Draft202012Validator

# Malformed, refuted, and refused at more than one place; `-` reads the model from the standard input.
REFUSED = (
    "model: [",
    "model: m\nx: [a]\ny: [b, b]\nf_x: {a: c}\nphi: [a]\n",
    "model: m\nx: [a]\ny: [b]\nf_x: {a: a^2}\nf_y: {b: a}\nphi: [a]\n",
)


def printed(*command, text=None):
    """What a command writes to its standard output; refused models have an exit status other than 0."""
    return subprocess.run(command, input=text, capture_output=True, text=True).stdout


def main(pebo_gen, models):
    failures = count = 0
    for command, more in (("check", []), ("solve", ["--limit", "2"])):
        schema = json.loads(printed(pebo_gen, "schema", command))
        Draft202012Validator.check_schema(schema)
        validator = Draft202012Validator(schema)
        for model, text in [*((model, None) for model in models), *(("-", text) for text in REFUSED)]:
            lines = printed(pebo_gen, command, model, "--format", "json", *more, text=text).splitlines()
            found = [f"{len(lines)} objects"] if len(lines) != 1 else []
            for value in map(json.loads, lines):
                found += [f"{error.json_path}: {error.message}" for error in validator.iter_errors(value)]
                for changed in [{**value, "another": 1}, *({k: value[k] for k in value if k != name} for name in value)]:
                    found += ["a field too many or too few is not found"] if validator.is_valid(changed) else []
            for line in found:
                print(f"{command} {text or model}: {line}")
            failures += len(found)
            count += 1
    print(f"{count} answers are what their schemas say" if failures == 0 else f"{failures} failures")
    return failures != 0 or count == 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
