#!/usr/bin/env python3
"""Checks how src/radioslam is divided: into rooms, folders, headers, classes and functions.

  scripts/check_structure.py [SOURCE_FOLDER]      default: src/radioslam

Refuses, one line each:
  rooms that depend on each other in a circle (links of the room.cmake files and actual includes),
  includes of a room that is not linked, and headers that include each other in a circle,
  folders of more than 40 sources, a pipeline/ of more than 1500 lines,
  classes of more than 150 lines defined in a .cpp file (they have no header to be found or tested by),
  functions of more than 60 lines, field lists (visit_fields) excepted.
Exit status: 0 nothing refused, 1 something refused, 2 wrong call.
"""
import os
import re
import sys

MAX_SOURCES_OF_FOLDER = 40
MAX_LINES_OF_PIPELINE = 1500
MAX_LINES_OF_HIDDEN_CLASS = 150
MAX_LINES_OF_FUNCTION = 60

INCLUDE = re.compile(r'^\s*#\s*include\s+"radioslam/([^"]+)"', re.M)
NOT_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"([^(\s"]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\''
    r'|^[ \t]*#(?:\\\n|[^\n])*', re.S | re.M)
TEMPLATE = re.compile(r'^\s*template\s*<[^{}]*?>(?=\s*(?:class|struct|[A-Za-z_]))')
TYPE = re.compile(r'\b(class|struct|union)\s+(?:\[\[\w+\]\]\s*)?([A-Za-z_]\w*)')
SCOPE = re.compile(r'\b(?:namespace|enum)\b|^\s*extern\s*$')
FUNCTION_NAME = re.compile(r'(~?[A-Za-z_]\w*|operator\s*\S+?)\s*(?:<[^()]*>)?\s*\(')


# ---- code without comments, strings and preprocessor lines ----------------------------------------------------------

def blank(match):
    """Line breaks stay, so that line numbers do."""
    return "\n" * match.group().count("\n")


def without_angles(text):
    """Without template parameter lists, whose `class` declares no class."""
    while True:
        shorter = re.sub(r'\btemplate\s*<[^<>]*>|<[^<>;{}]*>', " ", text)
        if shorter == text:
            return text
        text = shorter


def blocks(code):
    """Yields (kind, name, first line, last line) of every class and outermost function body."""
    open_blocks = []
    begin = 0  # of the current statement
    for brace in re.finditer(r'[{};]', code):
        if brace.group() == "{":
            head = code[begin:brace.start()]
            first = begin + len(head) - len(TEMPLATE.sub("", head).lstrip())
            inside = bool(open_blocks) and open_blocks[-1][0] in ("function", "inside")
            open_blocks.append((*classify(head, inside), first))
        elif brace.group() == "}" and open_blocks:
            kind, name, first = open_blocks.pop()
            if kind in ("class", "function"):
                yield kind, name, code.count("\n", 0, first) + 1, code.count("\n", 0, brace.start()) + 1
        begin = brace.end()


def classify(head, inside):
    if inside:
        return "inside", ""
    head = without_angles(head)
    if SCOPE.search(head):
        return "scope", ""
    declared = TYPE.search(head)
    if declared and "(" not in head[:declared.start()]:
        return "class", declared.group(2)
    name = FUNCTION_NAME.search(head)
    if not name or ("=" in head[:name.start()] and "operator" not in head):
        return "inside", ""  # the initial value of a variable or member
    return "function", name.group(1)


def check_sizes(name, text, found):
    code = NOT_CODE.sub(blank, text)
    for kind, block, first, last in blocks(code):
        lines = last - first + 1
        if kind == "class" and name.endswith(".cpp") and lines > MAX_LINES_OF_HIDDEN_CLASS:
            found.append(f"{name}:{first}: class {block} has {lines} lines in a .cpp file, "
                         f"more than {MAX_LINES_OF_HIDDEN_CLASS}")
        if kind == "function" and block != "visit_fields" and lines > MAX_LINES_OF_FUNCTION:
            found.append(f"{name}:{first}: function {block} has {lines} lines, more than {MAX_LINES_OF_FUNCTION}")


# ---- folders and rooms ----------------------------------------------------------------------------------------------

def check_folders(sources, found):
    folders = {}
    for name in sources:
        folders.setdefault(name.rpartition("/")[0], []).append(name)
    for folder, names in sorted(folders.items()):
        if len(names) > MAX_SOURCES_OF_FOLDER:
            found.append(f"{folder}/: {len(names)} sources, more than {MAX_SOURCES_OF_FOLDER}")


def check_pipeline(sources, found):
    lines = sum(text.count("\n") for name, text in sources.items() if room_of(name) == "pipeline")
    if lines > MAX_LINES_OF_PIPELINE:
        found.append(f"pipeline/: {lines} lines, more than {MAX_LINES_OF_PIPELINE}; algorithms belong to other rooms")


def room_of(name):
    return name.split("/")[0]


def links_of_rooms(root):
    """Per room: the rooms that its room.cmake links."""
    links = {}
    for room in sorted(os.listdir(root)):
        path = os.path.join(root, room, "room.cmake")
        if not os.path.isfile(path):
            continue
        text = re.sub(r'#[^\n]*', "", read(path))
        words = re.search(r'\bROOMS\s+([a-z_\s]*)', text)
        links[room] = set(words.group(1).split() if words else
                                      re.findall(r'\bradioslam_([a-z_]+)', " ".join(
                                          re.findall(r'target_link_libraries\(([^)]*)\)', text))))
    for room, linked in links.items():
        linked &= set(links)
        linked.discard(room)
    return links


def reachable(graph, start):
    seen, todo = set(), [start]
    while todo:
        for following in sorted(graph.get(todo.pop(), ())):
            if following not in seen:
                seen.add(following)
                todo.append(following)
    return seen


def circles(graph):
    """Sets of nodes that reach each other, each as a sorted list."""
    reach = {node: reachable(graph, node) for node in graph}
    return sorted({tuple(sorted(other for other in reach[node] if node in reach.get(other, ())))
                   for node in graph if node in reach[node]})


def check_dependencies(root, sources, found):
    links = links_of_rooms(root)
    includes = {name: set(INCLUDE.findall(text)) for name, text in sources.items()}
    uses = {room: set(linked) for room, linked in links.items()}
    for name, included in sorted(includes.items()):
        allowed = reachable(links, room_of(name)) | {room_of(name)}
        for header in sorted(included):
            uses[room_of(name)].add(room_of(header))
            if room_of(header) not in allowed:
                found.append(f"{name}: includes {header}, but {room_of(name)}/room.cmake does not link that room")
    for room in uses:
        uses[room].discard(room)
    for circle in circles(uses):
        found.append("rooms in a circle: " + ", ".join(circle))
    headers = {name: {i for i in included if i.endswith(".hpp")}
               for name, included in includes.items() if name.endswith(".hpp")}
    for circle in circles(headers):
        found.append("headers in a circle: " + ", ".join(circle))


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def read_sources(root):
    """Texts of all .hpp and .cpp files by their path below `root`."""
    paths = [os.path.join(folder, name) for folder, _, names in os.walk(root) for name in names
             if name.endswith((".hpp", ".cpp"))]
    return {os.path.relpath(path, root): read(path) for path in sorted(paths)}


def main():
    if len(sys.argv) > 2:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    above = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
    root = sys.argv[1] if len(sys.argv) == 2 else os.path.join(above, "src", "radioslam")
    sources = read_sources(root)
    if not sources:
        print(f"{root}: no sources", file=sys.stderr)
        return 2
    found = []
    check_dependencies(root, sources, found)
    check_folders(sources, found)
    check_pipeline(sources, found)
    for name, text in sources.items():
        check_sizes(name, text, found)
    for line in found:
        print(line)
    return 1 if found else 0


sys.exit(main())
