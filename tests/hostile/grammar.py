"""Command lines of skerry that nobody should type, as a grammar.

A rule is a list of (weight, expansion); an expansion is a list of symbols. `<name>` is a rule, `@name` an inhabitant of the
scratch folder (scratch.py), anything else a piece of text; pieces without a blank between them, as in ["--size=", "<size>"], are
one argument: a list in the list is joined. What draws is kept small by <small>, which stands last where it counts, so that a
command that is still at work after the time limit hangs.
"""

NOWHERE = ["", " ", ".", "..", "/", "//", "~", "-", "--", "\n", "a\nb", "\t", "\x7f", "\u202ename", "é日本", "\udcff\udcfe", "%s%n",
           "$(id)", "';--", "*", "x" * 255, "x" * 256, "y/" * 2100, "no/such/thing", "/proc/self/mem/x", "/dev/fd/99",
           "/proc/self/fd/1", "file\\name", "\u0301", "🏝️"]
NUMBERS = ["0", "-0", "1", "-1", "+1", "1e308", "1e309", "-1e309", "nan", "-nan", "inf", "-inf", "NaN", "1e-400", "0x10", "1_000", "1,5",
           "٣", "2147483648", "-2147483649", "4294967296", "9223372036854775808", "18446744073709551616", "9" * 400, "0." + "0" * 400 + "1",
           "1e", "e1", "--1", "1 ", " 1", "", "١", "½", "true", "null", "1\n", "0b1", "1f", ".", "+", "-"]
KEYS = ["world.offset", "world.islands", "sky.moon_phase", "lights.random", "lights.oracle", "lights.shadows", "shadow.enabled",
        "shadow.size", "clouds.coverage", "exposure", "renderer", "shading", "ao.strength", "bloom.intensity", "aa", "aa.samples",
        "water.layers", "display.peak", "jobs.threads", "debug.view", "upload.budget", "world.time", "reference.samples",
        "view.distance", "no.such.key", "", "=", "VIEW.DISTANCE", "view.distance.", "view..distance"]
JSONS = ["{", "[]", "3", "null", "{}", '{"seed": 1, "seed": 2}', '{"world": 3}', '{"world": null}', '{"world": ""}', '{"sead": 1}',
         '{"settings": {"view.distance": -1}}', '{"settings": {"view.distance": 1e999}}', '{"camera": [0, 1e300, 0, 0, 0]}',
         '{"camera": [[[[[]]]]]}', "[" * 100000, '{"a":' * 5000, '{"lights": [{"kind": "point"}]}', '{"clouds": 1}',
         '{"size": "-1x1"}', '{"fov": "nan"}', '{"time": "99:99"}', '{"\\u0000": 1}', '{"seed": "\\ud800"}', "\ufeff{}", "\0", '{"import": {}}',
         '{"world": "@fifo"}', '{"world": "missing.skerry"}', '{"clouds": [{"file": "missing.vdb"}]}', '{"masks": [[0, 0, 1e9, -1]]}']
PLANS = ["", "{", "[]", "null", "{}", '{"command": "stability"}', '{"command": 7, "arguments": [], "date": "", "notes": [], "tasks": []}',
         '{"command": "stability", "arguments": [], "date": "", "notes": [], "tasks": []}',
         '{"command": "stability", "arguments": [], "date": "", "notes": [], "tasks": [{"id": "../../keep.txt", "name": "time.clock"}]}',
         '{"command": "stability", "arguments": ["--help"], "date": "", "notes": [], "tasks": '
         '[{"id": "t000000000000000000000000", "name": "time.clock"}]}',
         '{"command": "test", "arguments": ["--dir", "x"], "date": "\\u0000", "notes": ["a\\nb"], "tasks": '
         '[{"id": "t000000000000000000000000", "name": "one\\ntwo"}, {"id": "t000000000000000000000000", "name": "one"}]}',
         '{"command": "test", "arguments": ["plan", "@fifo"], "date": "", "notes": [], "tasks": '
         '[{"id": "tffffffffffffffffffffffff", "name": "one"}]}', "[" * 100000, '{"tasks":' * 5000]


def any_of(values):
    return [(1, [value]) for value in values]


GRAMMAR = {
    "command": [(4, ["<shot>"]), (2, ["<vdb>"]), (2, ["<test>"]), (2, ["<farm>"]), (1, ["<report>"]), (1, ["<stability>"]), (1, ["<bench>"]),
                (1, ["<play>"]), (1, ["<devices>"]), (1, ["<confused>"])],

    # What is drawn.
    "shot": [(3, ["shot", "<source>", "<scene options>", "<outputs>", "<small>"]),
             (2, ["shot", "--seed", "1", "<outputs>", "<small>"]),
             (1, ["shot", "<outputs>", "<source>", "<flag>", "<scene options>", "<small>"])],
    "source": [(3, ["--seed", "<text>"]), (2, ["--world", "<world>"]), (3, ["--scene", "<scene>"]), (1, []),
               (1, ["--seed", "1", "--world", "<world>"]), (1, ["--scene", "@scene.json", "--seed", "<text>"])],
    "scene options": [(3, []), (4, ["<scene option>"]), (2, ["<scene option>", "<scene option>"]),
                      (1, ["<scene option>", "<scene options>"])],
    "scene option": [(2, ["--camera", "<camera>"]), (1, ["--fov", "<number>"]), (1, ["--time", "<time>"]), (1, ["--size", "<size>"]),
                     (1, ["--quality", "<text>"]), (3, ["--set", ["<key>", "=", "<number>"]]), (1, ["--set", "<text>"]),
                     (1, ["--renderer", "<text>"]), (1, ["--shading", "<text>"]), (1, ["--device", "<number>"]),
                     (1, ["--cloud", ["<cloud>", "<at>"]]), (1, ["--import", ["<import key>", "=", "<number>"]]), (1, ["<flag>"])],
    "small": [(5, ["--size", "16x9", "--set", "view.distance=48", "--set", "reference.samples=1", "--renderer", "reference"]),
              (1, ["--size", "16x9", "--set", "view.distance=48", "--quality", "low"])],
    "outputs": [(4, ["--out", "<output>"]), (3, ["--out", "<output>", "--stats", "<output>"]), (1, ["--stats", "<output>"]), (1, []),
                (1, [["--out=", "<output>"]]), (1, ["--out", "<output>", "--out", "<output>"]), (1, ["--out"])],

    # Values.
    "output": [(2, ["@new.png"]), (2, ["@keep.txt"]), (2, ["@keep.png"]), (6, ["<inhabitant>"]), (2, ["<nowhere>"])],
    "inhabitant": any_of(["@dir", "@dir/", "@dir/inside.txt", "@dir/new", "@keep.txt/below", "@link", "@link_to_link", "@dangling",
                          "@dangling_far", "@loop", "@link_to_dir", "@fifo", "@fifo_read", "@fifo_fed", "@socket", "@socket_deaf", "@full",
                          "@null", "@zero", "@disk", "@link_to_full", "@link_to_fifo", "@read_only.txt", "@report", "@world.skerry",
                          "@damaged.skerry", "@scene.json", "@hard_link", "@new\nline", "@ünïcödé", "/dev/stdout", "/dev/stderr"]),
    "nowhere": any_of(NOWHERE),
    "path": [(2, ["<inhabitant>"]), (1, ["<nowhere>"])],
    "world": [(2, ["@world.skerry"]), (1, ["@damaged.skerry"]), (1, ["@scene.json"]), (3, ["<path>"])],
    "scene": [(2, ["@scene.json"]), (4, ["@wild.json"]), (3, ["<path>"])],
    "cloud": [(1, ["@keep.txt"]), (1, ["@missing.vdb"]), (2, ["<path>"])],
    "at": [(2, []), (1, [["@@", "<number>", ",", "<number>", ",", "<number>"]]), (1, [["@@", "<camera>"]])],
    "number": any_of(NUMBERS),
    "text": [(2, ["<number>"]), (1, ["<nowhere>"]), (1, ["1"])],
    "key": any_of(KEYS),
    "import key": any_of(["grid", "scale", "size", "threshold", "up", "x", ""]),
    "time": any_of(["12:00", "24:00", "-1:00", "12:60", "12", ":", "12:00:00:00", "٣:٣٣", "nan:nan", "", "1e1:00", "12:00\n"]),
    "size": [(1, [["<number>", "x", "<number>"]]), (1, ["<number>"]), (1, ["65536x65536"]), (1, ["0x0"]), (1, ["16×9"])],
    "camera": [(2, [["<number>", ",", "<number>", ",", "<number>", ",", "<number>", ",", "<number>"]]), (1, ["<number>"]),
               (1, ["0,60,0,0,0"]), (1, [",,,,"]), (1, ["1099511627776,0,0,0,0"]), (1, ["1099511627777,0,0,0,0"])],
    "flag": any_of(["--validate", "--explain", "--json", "--help", "--version", "--", "-", "-x", "--out", "--set", "--partial", "--é",
                    "--validate=3", "--no-validate", "-h", "---", "--=", "--seed="]),
    "noise": [(6, []), (2, ["<flag>"]), (1, ["<nowhere>"]), (1, ["<number>"])],

    # The other commands.
    "vdb": [(1, ["vdb", "info", "<path>", "<noise>"]), (2, ["vdb", "import", "<path>", "--out", "<output>", "<noise>"]),
            (1, ["vdb", "import", "@islet.vdb", "--out", "<output>", "<vdb option>"]), (1, ["vdb", "info", "@islet.vdb", "<noise>"]),
            (4, ["vdb", "export", "--world", "@world.skerry", "--out", "<output>", "<noise>"]),
            (1, ["vdb", "export", "--world", "<world>", "--out", "<output>", "--partial"]),
            (1, ["vdb", "export", "--seed", "<text>", "--box", "<box>", "--out", "<output>"]), (1, ["vdb", "<noise>", "<noise>"])],
    "vdb option": [(1, []), (1, ["--scale", "<number>"]), (1, ["--size", "<number>"]), (1, ["--threshold", "<number>"]),
                   (1, ["--up", "<text>"]), (1, ["--grid", "<text>"])],
    "box": [(1, ["0,40,0,8,48,8"]), (1, ["0,0,0,0,0,0"]), (1, [["<camera>", ",", "<number>"]]), (1, ["<camera>"])],
    "test": [(2, ["test", "<scenes>", "<test outputs>", "<noise>"]), (1, ["test", "@scenes", "<test outputs>"]),
             (1, ["test", "@scenes", "<test option>"]), (1, ["test", "--merge", "<path>", "<test outputs>"]),
             (1, ["test", "--merge", "@rows.json", "<test outputs>"])],
    "scenes": [(1, ["@scenes"]), (1, ["@wild.json"]), (2, ["<path>"]), (1, [])],
    "test outputs": [(1, ["--html", "<output>"]), (1, ["--html", "@new_report"]), (1, ["--json", "<output>"]), (1, ["--junit", "<output>"]),
                     (1, ["--html", "<output>", "--json", "<output>", "--junit", "<output>"]), (1, [])],
    "test option": [(1, ["--shard", ["<number>", "/", "<number>"]]), (1, ["--jobs", "<number>"]), (1, ["--repeat", "-1"]),
                    (1, ["--device", "<number>"])],
    "report": [(3, ["report", "<noise>", "--out", "<output>", "--device", "99"]), (1, ["report", "<nowhere>", "--out", "<output>"]),
               (1, ["report", "water_layers", "<source>", "--device", "99", "--out", "@new_report"]), (1, ["report", "<noise>"])],
    "stability": [(2, ["stability", "--list", "<noise>"]), (2, ["stability", "time.clock", "--json", "<output>"]),
                  (1, ["stability", "<nowhere>", "--json", "<output>"]), (1, ["stability", "time.clock", "--device", "<number>"])],
    "bench": [(2, ["bench", "mesh", "--input", "<path>", "--json", "<output>"]), (1, ["bench", "<nowhere>", "<noise>"]),
              (1, ["bench", "frame", "<source>", "--device", "99", "--json", "<output>"]), (1, ["bench", "cull", "--device", "<bad device>"]),
              (1, ["bench", "fly", "--device", "99", "--seconds", "<number>", "--speed", "<number>"])],
    "bad device": any_of(["99", "-1", "x", "1e3", ""]),
    "play": [(2, ["play", "<source>", "<scene options>"]), (1, ["<flag>"]), (1, ["<source>"]), (1, ["play", "<noise>", "<noise>"])],

    # The same in parts. A folder of rows is written into, so that none of the places about the scratch folder may be one.
    "farm": [(2, ["stability", "plan", "<case>", "--dir", "<rows>", "<noise>"]), (3, ["stability", "run", "<task>", "--dir", "<rows>", "<noise>"]),
             (2, ["stability", "merge", "<folders>", "--dir", "<rows>", "--json", "<output>"]),
             (1, ["stability", "merge", "<folders>", "--dir", "<rows>", "<noise>"]),
             (2, ["test", "plan", "<scenes>", "--dir", "<rows>", "<test option>"]), (3, ["test", "run", "<task>", "--dir", "<rows>", "<farm option>"]),
             (2, ["test", "merge", "<folders>", "--dir", "<rows>", "<test outputs>"]),
             (1, ["report", "plan", "water_layers", "<noise>", "--size", "16x9", "--dir", "<rows>"]),
             (1, ["report", "run", "<task>", "--device", "99", "--dir", "<rows>"]),
             (1, ["report", "merge", "<folders>", "--dir", "<rows>", "--out", "<output>"]),
             (2, ["farm", "submit", "<rows>", "<submit option>", "--dry-run"]), (1, ["farm", "<noise>", "<rows>", "<noise>"]),
             (1, ["<command of farm>", "<verb>", "<noise>", "<noise>"]), (1, ["<command of farm>", "<noise>", "<verb>", "--dir", "<rows>"])],
    "submit option": [(2, ["--tasks-per-job", "<number>"]), (1, ["--cpus", "<number>"]), (1, ["--gres", "<path>"]), (1, ["--time", "<noise>"])],
    "command of farm": any_of(["stability", "test", "report"]),
    "verb": any_of(["plan", "run", "merge", "Plan", "plan run"]),
    "case": [(3, ["time.clock"]), (1, []), (1, ["<nowhere>"]), (1, ["time.clock", "time.clock"]), (1, ["<flag>"])],
    "task": [(4, []), (1, ["time.clock"]), (1, ["one"]), (1, ["<nowhere>"]), (2, [["<number>", "/", "<number>"]]), (1, ["1/1"]), (1, ["2/2"])],
    "farm option": [(2, []), (1, ["--jobs", "<number>"]), (1, ["--device", "<number>"]), (1, ["<flag>"])],
    "folders": [(3, []), (1, ["@planned"]), (1, ["@planned_test"]), (2, ["<path>"]), (1, ["<path>", "<path>"])],
    "rows": [(3, ["@planned"]), (3, ["@planned_test"]), (2, ["@planned_wild"]), (2, ["@new_rows"]), (1, ["@new/rows"]), (3, ["<inhabitant>"]),
             (2, ["<lost>"])],
    "lost": any_of(["", " ", ".", "--", "\n", "a\nb", "\t", "\u202ename", "\udcff\udcfe", "x" * 255, "x" * 256, "y/" * 2100, "no/such/thing",
                    "/proc/self/mem/x", "/dev/fd/99", "file\\name"]),
    "devices": [(1, ["devices"]), (1, ["devices", "--json"]), (1, ["devices", "<noise>", "<noise>"])],
    "confused": [(1, ["<nowhere>"]), (1, ["<number>"]), (1, ["<text>", "<noise>", "<noise>"]), (1, ["help"]), (1, ["shot", "shot"]),
                 (1, ["shot", "--help", "<noise>"]), (1, ["vdb", "shot"])],
}


def expand(symbol, random):
    """The arguments that a symbol stands for, and how they came about: pieces with their marks."""
    if isinstance(symbol, list):
        return ["".join(piece for part in symbol for piece in expand(part, random))]
    if not (symbol.startswith("<") and symbol.endswith(">")):
        return [symbol]
    rules = GRAMMAR[symbol[1:-1]]
    chosen = random.choices([expansion for _, expansion in rules], [weight for weight, _ in rules])[0]
    return [argument for part in chosen for argument in expand(part, random)]
