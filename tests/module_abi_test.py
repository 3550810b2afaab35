#!/usr/bin/python3
"""Checks the list of types that the program and its modules exchange. They exchange C++ values
(core/system/module_loader.h), so the table of functions that a module exports begins with the sizes of these types:
`ModuleAbi<...> abi`. A type that is missing in this list could change on one side without an error. This script
finds such types from the text of the sources: it starts at the functions of each table and follows every member
of every type. A member held by value changes the size of its owner. A type behind a container, a pointer or a
reference does not, so the list must contain it. Exit code 1 if a type is missing, or is listed but not exchanged.
"""
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
BEHIND = re.compile(r"\b(vector|map|set|deque|list|shared_ptr|unique_ptr|function)\s*<|[*&]")
TABLE = re.compile(r"struct\s+(\w+)\s*{\s*(?:render::)?ModuleAbi<([^;]*)>\s+abi\s*;")
NO_MEMBER = re.compile(r"\s*(using|typedef|friend|static|template|enum|explicit|public|private|protected)\b")


def without_comments(text):
    text = re.sub(r'"(?:\\.|[^"\\\n])*"', '""', text)
    return re.sub(r"//[^\n]*|/\*.*?\*/|^[ \t]*#[^\n]*$", " ", text, flags=re.DOTALL | re.MULTILINE)


def end_of_braces(text, begin):
    """The position after the } that closes the { at `begin`."""
    depth = 0
    for i in range(begin, len(text)):
        depth += {"{": 1, "}": -1}.get(text[i], 0)
        if depth == 0:
            return i + 1
    return len(text)


def read_types(texts):
    """(name of a struct or class -> its bases and body, alias -> aliased type)"""
    bodies, aliases = {}, {}
    for text in texts:
        for m in re.finditer(r"(?<!enum )\b(?:struct|class)\s+(?:\[\[\w+\]\]\s*)?(\w+)(?:\s+final)?\s*(:[^{;()]*)?{", text):
            end = end_of_braces(text, m.end() - 1)
            bodies[m.group(1)] = (m.group(2) or "") + ";" + text[m.end():end - 1]
        for m in re.finditer(r"\busing\s+(\w+)\s*=\s*([^;]+);", text):
            aliases[m.group(1)] = m.group(2)
    return bodies, aliases


def statements(body):
    """Declarations of a body, without the content of their braces."""
    depth, start = 0, 0
    flat = []
    for i, c in enumerate(body):
        if c == "{":
            if depth == 0:
                flat.append(body[start:i])
            depth += 1
        elif c == "}":
            depth -= 1
            if depth == 0:
                start = i + 1
                if not body[start:].lstrip().startswith((";", ",")):
                    flat.append(";")  # the end of a function or a type
    flat.append(body[start:])
    return re.sub(r"\b(public|private|protected)\s*:(?!:)", "", "".join(flat)).split(";")


def outside_angles(text):
    while (shorter := re.sub(r"<[^<>]*>", "", text)) != text:
        text = shorter
    return text


def is_member(statement):
    declared = statement.partition("=")[0]
    return bool(declared.strip()) and not NO_MEMBER.match(statement) and "(" not in outside_angles(declared)


def crossing(table, bodies, aliases):
    """The types whose size must be in the list of `table`, because its functions exchange them."""
    needed, seen, open_ends = set(), set(), []

    def names_in(text):
        names, left = set(), [text]
        while left:
            for word in re.findall(r"\w+", left.pop()):
                if word in aliases and word not in names:
                    left.append(aliases[word])
                names.add(word)
        return names & bodies.keys()

    def expanded(text):
        return text + " " + " ".join(aliases[w] for w in re.findall(r"\w+", text) if w in aliases)

    def follow(text, is_behind):
        for name in names_in(text):
            is_interface = "virtual" in bodies[name]
            if is_behind and not is_interface:
                needed.add(name)
            if name not in seen:
                seen.add(name)
                open_ends.append(name)

    for statement in statements(bodies[table]):
        if "ModuleAbi" not in statement:
            follow(statement, True)
    while open_ends:
        name = open_ends.pop()
        for statement in statements(bodies[name]):
            if "virtual" in statement:
                follow(statement, True)
            elif is_member(statement):
                follow(statement.partition("=")[0], bool(BEHIND.search(expanded(statement.partition("=")[0]))))
    return needed


def closure(name, texts):
    if name in texts or not (TOP / name).is_file():
        return
    text = (TOP / name).read_text()
    texts[name] = without_comments(text)
    for include in re.findall(r'^\s*#\s*include\s*"([^"]+)"', text, re.MULTILINE):
        closure(include, texts)


def problems_in(header, texts):
    bodies, aliases = read_types(texts.values())
    problems = []
    for table, listed in TABLE.findall(texts[header]):
        have = set(re.findall(r"(\w+)\s*(?:,|$)", listed.strip()))
        need = crossing(table, bodies, aliases)
        problems += [f"{header}: {table}::abi: {name} is missing" for name in sorted(need - have)]
        problems += [f"{header}: {table}::abi: {name} is listed but not exchanged" for name in sorted(have - need)]
    return problems


def faults_not_found(header, texts):
    """Self-test: a new type in a vector, behind a pointer of a nested member, and as an argument must be
    reported; a type held by value must not."""
    table = TABLE.search(texts[header]).group(1)
    expected = [f"{header}: {table}::abi: {name} is missing" for name in ("ByPointer", "InArgument", "InVector")]
    faulty = dict(texts)
    faulty["new.h"] = """
        struct InVector { double a = 0; };
        class ByPointer { public: int Get() const { return a_; } private: int a_ = {}; };
        using Pointer = std::shared_ptr<const ByPointer>;
        struct ByValue { Pointer pointer; std::vector<InVector> many = {}; enum class Kind { kA }; Kind kind; };
        struct InArgument { std::optional<ByValue> value; };"""
    faulty[header] = re.sub(r"(>\s+abi;)", r"\1 void (*added)(const InArgument& argument);", texts[header], count=1)
    found = [problem for problem in problems_in(header, faulty) if problem not in problems_in(header, texts)]
    return [] if found == expected else [f"self-test: reported {found}, expected {expected}"]


def main():
    headers = [path.relative_to(TOP).as_posix() for folder in ("render", "server")
               for path in sorted((TOP / folder).rglob("*.h")) if TABLE.search(path.read_text())]
    problems = []
    for header in headers:
        texts = {}
        closure(header, texts)
        problems += problems_in(header, texts) + faults_not_found(header, texts)
    print(f"{len(headers)} headers with module tables, {len(problems)} problems", *problems, sep="\n")
    return 1 if problems or not headers else 0


sys.exit(main())
