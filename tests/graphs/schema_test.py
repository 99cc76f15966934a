"""What `sherd nodes --schema` prints, held against graphs by a validator of JSON Schema.

    python3 schema_test.py PROGRAM GRAPHS

All graphs below GRAPHS are valid, and each of the wrong ones below is refused by the validator and by `sherd check`.
"""

import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema

GONE = object()

BASE = {
    "format": 1,
    "fps": 24,
    "vars": {
        "mesh": "${ASSETS}/vase.obj",
        "height": 1.5,
        "count": 500,
        "turn": [25, 0, 15],
        "yes": True,
        "where": "floor",
    },
    "targets": {"all": ["hit"]},
    "nodes": {
        "mesh": {"type": "LoadMesh@1", "params": {"file": "${mesh}"}},
        "tets": {"type": "Tetrahedralize@1", "in": {"mesh": "mesh"}, "params": {"tets": "${count}"}},
        "hit": {
            "type": "Simulate@1",
            "in": {"body": "tets"},
            "params": {"scene": "floor", "drop_height": 2, "orientation": [25, 0, 15]},
        },
    },
}

FILL = {
    "help": "Fills a surface.",
    "vars": {"count": 300},
    "inputs": {"mesh": {"type": "Mesh", "optional": False, "help": "a surface"}},
    "outputs": {"tets": {"from": "cage.tets", "type": "TetMesh", "help": "its inside"}},
    "nodes": {"cage": {"type": "Tetrahedralize@1", "in": {"mesh": "in.mesh"}, "params": {"tets": "${count}"}}},
}


def with_fill(**parts):
    """BASE with a node that stands for the subgraph FILL, some parts of which are changed."""
    fill = {key: value for key, value in {**FILL, **parts}.items() if value is not GONE}
    return {"subgraphs": {"fill": fill}, "nodes.tets": {"type": "fill", "in": {"mesh": "mesh"}}}


# Changes of BASE: where, and what stands there then. Where not a list: a path with dots.
RIGHT = {
    "as it is": {},
    "a variable for a number": {"nodes.hit.params.drop_height": "${height}"},
    "a variable for a list": {"nodes.hit.params.orientation": "${turn}"},
    "a variable within a list": {"nodes.hit.params.orientation": ["${height}", 0, 1]},
    "a variable for a boolean": {"nodes.hit.params.standing": "${yes}"},
    "a variable for a word": {"nodes.hit.params.scene": "${where}"},
    "a whole number with a point": {"nodes.tets.params.tets": 500.0},
    "a wired parameter": {
        "nodes.hit.in.threshold": "other.work",
        "nodes.other": {"type": "Simulate@1", "in": {"body": "tets"}},
    },
    "a required parameter that is wired": {
        "nodes.mesh": {"type": "LoadMesh@1", "in": {"file": "picture"}},
        "nodes.picture": {"type": "Preview@1", "in": {"pieces": "pieces"}, "params": {"file": "out/a.obj"}},
        "nodes.pieces": {"type": "Tessellate@1", "in": {"cells": "cells"}},
        "nodes.cells": {"type": "CVD@1", "in": {"weights": "weights", "embedding": "embed"}},
        "nodes.weights": {"type": "Weights@1", "in": {"energy": "drop.energy"}},
        "nodes.drop": {"type": "Simulate@1", "in": {"body": "cage"}},
        "nodes.embed": {"type": "Embed@1", "in": {"tets": "cage"}},
        "nodes.cage": {"type": "Tetrahedralize@1", "in": {"mesh": "first"}},
        "nodes.first": {"type": "LoadMesh@1", "params": {"file": "${mesh}"}},
    },
    "a target that is one node": {"targets.one": "hit"},
    "no fps": {"fps": GONE},
    "a name with a space and letters of another alphabet": {"targets.Größe 2": ["hit"]},
    "frames": {"frames": "1001-1040"},
    "every second frame": {"frames": "1001-1100x2"},
    "one frame": {"frames": 1001},
    "frames one by one": {"frames": "1,5,8-10"},
    "a wedge": {"wedge": {"height": [1, 1.5, 2]}},
    "a list of objects": {
        "nodes.paint": {
            "type": "PaintBeta@1",
            "params": {"strokes": [{"points": [[0, 0, 0], [1, 0, "${height}"]], "radius": 0.1, "value": "${height}"}]},
        }
    },
    "a variable for a list of objects": {
        "vars.strokes": [], "nodes.paint": {"type": "PaintBeta@1", "params": {"strokes": "${strokes}"}},
    },
    "a subgraph": with_fill(),
    "a subgraph in few words": with_fill(
        help=GONE, vars=GONE, inputs={"mesh": "Mesh"}, outputs={"tets": "cage"},
        nodes={"cage": {"type": "Tetrahedralize@1", "in": {"mesh": "in.mesh"}}},
    ),
    "a subgraph with a value for its variable": {**with_fill(), "nodes.tets.params": {"count": 400}},
}

# As RIGHT, with a part of what `check` says of it.
WRONG = {
    "a misspelt parameter": ({"nodes.hit.params.drop_hight": 1}, 'did you mean "drop_height"'),
    "a number below its range": ({"nodes.hit.params.drop_height": -1}, "at least 0 m"),
    "a number above its range": ({"nodes.hit.params.restitution": 1.5}, "at most 1"),
    "a number on an open limit": ({"nodes.hit.params.poisson": 0.5}, "below 0.5"),
    "an integer below its range": ({"nodes.tets.params.tets": 3}, "at least 20"),
    "a fraction for an integer": ({"nodes.tets.params.tets": 100.5}, "an integer"),
    "a word for a number": ({"nodes.hit.params.drop_height": "high"}, "a number"),
    "a boolean for a number": ({"nodes.hit.params.drop_height": True}, "a number"),
    "a number for a boolean": ({"nodes.hit.params.standing": 1}, "true or false"),
    "a number for a file": ({"nodes.mesh.params.file": 7}, "a string"),
    "a word that is none of the choices": ({"nodes.hit.params.scene": "flor"}, 'did you mean "floor"'),
    "a list that is too short": ({"nodes.hit.params.orientation": [25, 0]}, "three numbers"),
    "a list of words": ({"nodes.hit.params.orientation": ["x", "y", "z"]}, "three numbers"),
    "a number for a list": ({"nodes.hit.params.orientation": 25}, "three numbers"),
    "a number for a list of objects": ({"nodes.paint": {"type": "PaintBeta@1", "params": {"strokes": 3}}}, "a list"),
    "a parameter that is null": ({"nodes.hit.params.drop_height": None}, "leave the parameter out"),
    "an empty file name": ({"nodes.mesh.params.file": ""}, "this is empty"),
    "a variable that isn't closed": ({"nodes.hit.params.drop_height": "${height"}, "${"),
    "a variable with more behind it for a number": ({"nodes.hit.params.drop_height": "${height}0"}, "a number"),
    "a required parameter that is missing": ({"nodes.mesh.params": {}}, "the parameter is missing"),
    "a required parameter without params": ({"nodes.mesh.params": GONE}, "the parameter is missing"),
    "a required input that is missing": ({"nodes.tets.in": {}}, "not connected"),
    "a required input without in": ({"nodes.hit.in": GONE}, "not connected"),
    "an unknown input": ({"nodes.tets.in.mehs": "mesh"}, 'did you mean "mesh"'),
    "a link that is a number": ({"nodes.tets.in.mesh": 3}, "a string"),
    "a link without a node": ({"nodes.tets.in.mesh": ".mesh"}, "no link"),
    "a link without a port": ({"nodes.tets.in.mesh": "mesh."}, "no link"),
    "a list that is wired": ({"nodes.hit.in.orientation": "mesh"}, "can't be wired"),
    "an unknown type": ({"nodes.mesh.type": "LodMesh@1"}, 'did you mean "LoadMesh"'),
    "a version that there isn't": ({"nodes.hit.type": "Simulate@99"}, "newer"),
    "a type without its version": ({"nodes.hit.type": "Simulate"}, "Simulate@1"),
    "a type that is empty": ({"nodes.hit.type": ""}, "no node type"),
    "a node without a type": ({"nodes.mesh.type": GONE}, '"type" is missing'),
    "an unknown key of a node": ({"nodes.hit.parms": {}}, 'did you mean "params"'),
    "an unknown key of the graph": ({"node": {}}, 'did you mean "nodes"'),
    "params that are a list": ({"nodes.hit.params": []}, "an object"),
    "a node that is a word": ({"nodes.hit": "Simulate@1"}, "an object"),
    "a node with a stroke in its name": ({"nodes.a/b": {"type": "LoadMesh@1", "params": {"file": "a"}}}, "no name"),
    "no nodes": ({"nodes": GONE}, '"nodes" is missing'),
    "nodes that are empty": ({"nodes": {}, "targets": GONE}, "there are none"),
    "no format": ({"format": GONE}, '"format" is missing'),
    "another format": ({"format": 2}, "reads format 1"),
    "a format in quotes": ({"format": "1"}, '"format": 1'),
    "fps of zero": ({"fps": 0}, "above 0"),
    "fps in quotes": ({"fps": "24"}, "above 0"),
    "frames that are a boolean": ({"frames": True}, "frames"),
    "frames in words": ({"frames": "first to last"}, "no range of frames"),
    "frames with a step of nothing": ({"frames": "1-10x"}, "no range of frames"),
    "a wedge of one value": ({"wedge": {"height": 2}}, "a list of the values"),
    "a wedge of no values": ({"wedge": {"height": []}}, "a list of the values"),
    "a wedge of lists": ({"wedge": {"turn": [[1, 2, 3]]}}, "a number, a text or a boolean"),
    "a wedge with a value twice": ({"wedge": {"height": [1, 1]}}, "in the list already"),
    "a wedge that is a list": ({"wedge": [7, 8]}, "wedge"),
    "a variable that is null": ({"vars.height": None}, "a variable is"),
    "a variable that the program sets": ({"vars.frame": 3}, "set by the program"),
    "a target that is a number": ({"targets.all": 1}, "targets.all"),
    "a misspelt key of a subgraph": (with_fill(output={}), 'did you mean "outputs"'),
    "a subgraph without nodes": (with_fill(nodes=GONE), '"nodes" is missing'),
    "a subgraph that is a number": ({"subgraphs": {"fill": 3}}, "a subgraph"),
    "a subgraph in a file without a name": ({"subgraphs": {"fill": ""}}, "name of the file is empty"),
    "a subgraph in a file that a variable names": ({"subgraphs": {"fill": "${mesh}"}}, "can't be named by variables"),
    "an input of a subgraph without a type": (with_fill(inputs={"mesh": {"help": "a"}}), '"type" is missing'),
    "an output of a subgraph from nowhere": (with_fill(outputs={"tets": {"help": "a"}}), '"from" is missing'),
    "a misspelt parameter in a subgraph": (
        with_fill(nodes={"cage": {"type": "Tetrahedralize@1", "in": {"mesh": "in.mesh"}, "params": {"tet": 300}}}),
        'did you mean "tets"',
    ),
}


def changed(changes):
    graph = copy.deepcopy(BASE)
    for path, value in changes.items():
        *above, key = path.split(".")
        part = graph
        for name in above:
            part = part[name]
        if value is GONE:
            del part[key]
        else:
            part[key] = value
    return graph


def plain(text):
    """The text without comments and without commas before a closing bracket."""
    string = r'("(?:\\.|[^"\\])*")'
    text = re.sub(string + r"|//[^\n]*|/\*.*?\*/", lambda m: m[1] or " ", text, flags=re.S)
    return re.sub(string + r"|,(?=\s*[}\]])", lambda m: m[1] or "", text)


class Checks:
    def __init__(self, program, schema):
        self.program, self.failures = str(pathlib.Path(program).resolve()), 0
        self.validator = jsonschema.Draft7Validator(schema)

    def expect(self, holds, what):
        if not holds:
            print("FAILED:", what)
            self.failures += 1

    def is_valid(self, name, graph):
        for error in self.validator.iter_errors(graph):
            self.expect(False, f"{name}: {'/'.join(map(str, error.absolute_path))}: {error.message[:300]}")

    def said_by_check(self, graphs):
        """What `sherd check` says of each of the graphs, by name, and its exit code."""
        with tempfile.TemporaryDirectory() as folder:
            paths = {name: pathlib.Path(folder, f"case_{i:03}.json") for i, name in enumerate(graphs)}
            for name, path in paths.items():
                path.write_text(json.dumps(graphs[name]))
            command = [self.program, "check", *map(str, paths.values())]
            run = subprocess.run(command, capture_output=True, text=True, cwd=folder, timeout=120)
            lines = (run.stdout + run.stderr).splitlines()
            of = {name: [line for line in lines if f"{path.name}:" in line.split(" ")[0]] for name, path in paths.items()}
            return {name: "\n".join(said) for name, said in of.items()}, run.returncode


def pasted_snippets(program):
    """A graph of the nodes that the reference offers to paste."""
    reference = subprocess.run([program, "nodes", "--markdown"], capture_output=True, text=True, check=True).stdout
    nodes = re.findall(r"```json\n(.*?)\n```", reference, flags=re.S)
    return json.loads('{"format": 1, "nodes": {' + ",\n".join(nodes) + "}}"), len(nodes)


def main(program, graphs):
    printed = subprocess.run([program, "nodes", "--schema"], capture_output=True, text=True, check=True)
    schema = json.loads(printed.stdout)
    jsonschema.Draft7Validator.check_schema(schema)
    checks = Checks(program, schema)

    # What the graphs wrote lies below them, in out/.
    shipped = sorted(p for p in pathlib.Path(graphs).rglob("*.json") if "out" not in p.relative_to(graphs).parts)
    checks.expect(len(shipped) >= 4, f"only {len(shipped)} graphs below {graphs}")
    for path in shipped:
        checks.is_valid(path, json.loads(plain(path.read_text(encoding="utf-8"))))

    right = {name: changed(changes) for name, changes in RIGHT.items()}
    said, code = checks.said_by_check(right)
    checks.expect(code == 0, f"`check` ends with {code} on right graphs")
    for name, graph in right.items():
        checks.is_valid(name, graph)
        checks.expect("no errors" in said[name], f"{name}: `check` says: {said[name]}")

    checks.is_valid("a subgraph in a file of its own", {"format": 1, **FILL})
    checks.expect(not checks.validator.is_valid(FILL), "a subgraph in a file without a format: the schema lets it pass")

    pasted, count = pasted_snippets(program)
    checks.expect(len(pasted["nodes"]) == count >= 10, f"{count} snippets with {len(pasted['nodes'])} names")
    checks.is_valid("snippets", pasted)
    said, _ = checks.said_by_check({"snippets": pasted})
    for line in said["snippets"].splitlines():
        placeholder = "FILE" in line or "DIRECTORY" in line or "writes to the same path" in line
        checks.expect(placeholder, f"snippets: {line}")

    wrong = {name: changed(changes) for name, (changes, _) in WRONG.items()}
    said, code = checks.said_by_check(wrong)
    checks.expect(code == 2, f"`check` ends with {code} on wrong graphs")
    for name, (_, words) in WRONG.items():
        checks.expect(not checks.validator.is_valid(wrong[name]), f"{name}: the schema lets it pass")
        checks.expect(words in said[name], f"{name}: `check` doesn't say {words!r} but: {said[name]}")

    print(f"{len(shipped)} graphs, {len(right)} right and {len(wrong)} wrong ones: {checks.failures} failures")
    return 1 if checks.failures else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
