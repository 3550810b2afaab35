#!/usr/bin/python3
"""Checks that the sources of a target can be compiled in batches of any size (CMAKE_UNITY_BUILD_BATCH_SIZE). In a batch, two
constants, types or functions of one name in anonymous namespaces collide, and a local constant hides one of this name from an
earlier source, which is a warning. The compiler finds this too, but only in the batches of today.

Functions with different parameters are overloads. Two aliases or two using-declarations of one name are accepted: mostly they
are written differently for the same thing, and the compiler rejects others.

Run without arguments; exit code 1 if a name is not unique. The script also tests itself: it inserts faults into the sources in memory
and must report them.
"""
import collections
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ("core", "render", "server", "urdf")

NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-zA-Z])\'(?:\\.|[^\'\\\n])+\'', re.S)
BORDER = re.compile(r"^namespace (?:([\w:]+) )?\{$|^(\}) namespace", re.M)
CONSTANT = re.compile(r"^(?:constexpr|const|static|inline|thread_local)\b[^;({=]*?\bk[A-Z]\w*(?:\[\w*\])?\s*[=({;,]")
TYPE = re.compile(r"^(?:template <[^;{]*>\n)?(?:class|struct|union|enum(?: class| struct)?) (\w+)[^;(]*[{]", re.M)
ALIAS = re.compile(r"^(?:template <[^;{]*>\n)?using (\w+) =", re.M)
BORROWED = re.compile(r"^using [\w:]*?(\w+);", re.M)
FUNCTION = re.compile(r"^(?:template <[^;{]*>\n)?(?! |using\b|return\b|namespace\b|class\b|struct\b|enum\b)"
                      r"[\w:<>,&*\[\] ]+?[ &*](\w+)\(([^;{]*?)\)(?: const| noexcept| ->[^{;]*)*\s*\{", re.M)
DECLARATOR = re.compile(r"(?:^|,)[^,=({]*?\b(k[A-Z]\w*)")
LOCAL = re.compile(r"^ +(?:constexpr|const) [^;({=]*?\b(k[A-Z]\w*)(?:\[\w*\])? ?[=({]|^ +using (\w+) =", re.M)


def without_nested(text):
    """`text` with what is in brackets left out, so that commas separate declarators."""
    out, depth = [], 0
    for char in text:
        if char in "([{":
            depth += 1
        if depth == 0:
            out.append(char)
        if char in ")]}":
            depth -= 1
    return "".join(out)


def parameters(text):
    """The types of the parameters of a function."""
    flat = re.sub(r"\s+", " ", re.sub(r"=[^,]*", "", text)).strip()
    parts, depth, part = [], 0, ""
    for char in flat:
        depth += (char in "<(") - (char in ">)")
        if char == "," and depth == 0:
            parts.append(part)
            part = ""
        else:
            part += char
    parts.append(part)
    return tuple(re.sub(r"(?<=[ &*>])\w+$", "", part.strip()).strip() for part in parts)


def blocks(code):
    """What is between two borders of namespaces: (its named namespace, whether it is anonymous, its code)."""
    stack, at = [], 0
    for border in BORDER.finditer(code):
        yield "::".join(filter(None, stack)), None in stack, code[at:border.start()]
        at = border.end()
        if border[2]:
            stack.pop()
        else:
            stack.append(border[1])


def definitions(text, is_header=False):
    """Of one source: {(namespace, name): {what it is}}, and its local constants and aliases as {(namespace, name)}. Of a header: the
    constants and types of its namespaces, which sources that do not include it may not define either."""
    text = re.sub(r"^\}  // namespace", "} namespace", text, flags=re.M)
    code = NO_CODE.sub(lambda match: "" if match[0].startswith("/") else '""', text)
    found = collections.defaultdict(set)
    local = set()
    for namespace, is_anonymous, block in blocks(code):
        if not is_header:
            local.update((namespace, name or alias) for name, alias in LOCAL.findall(block))
        if is_anonymous == is_header:
            continue
        for statement in re.split(r"(?<=[;}])\s*\n(?=\S)", block):
            statement = statement.strip()
            if CONSTANT.match(statement) and not FUNCTION.match(statement):
                flat = without_nested(re.sub(r"<[^;{}=]*?>(?= )", "", statement))
                for name in DECLARATOR.findall(re.sub(r"=[^,;]*", "", flat)):
                    found[namespace, name].add(("constant",))
        for name in TYPE.findall(block):
            found[namespace, name].add(("type",))
        if is_header:
            continue
        for name in ALIAS.findall(block):
            found[namespace, name].add(("alias",))
        for name in BORROWED.findall(block):
            found[namespace, name].add(("using",))
        for name, arguments in FUNCTION.findall(block):
            found[namespace, name].add(("function", parameters(arguments)))
    return found, local


def targets(text):
    """The sources of each target of a CMakeLists.txt that is compiled in batches."""
    text = re.sub(r"#[^\n]*", "", text)
    single = set(re.findall(r"set_target_properties\((\w+) PROPERTIES UNITY_BUILD OFF\)", text))
    apart = set()
    for names in re.findall(r"set_source_files_properties\(([^)]*SKIP_UNITY_BUILD_INCLUSION[^)]*)\)", text):
        apart.update(names.split())
    for name, body in re.findall(r"^\s*(?!set_)\w+\(\s*(\w+)([^)]*)\)", text, re.M):
        files = [file for file in body.split() if re.fullmatch(r"[\w/]+\.(cc|h)", file) and file not in apart]
        files.sort(key=lambda file: file.endswith(".cc"))  # headers may come first in any batch
        if name not in single and len(files) > 1:
            yield name, files


def may_coexist(a, b):
    """Whether two sources may define what `a` and `b` are under one name."""
    if a[0] == b[0] == "function":
        return a != b
    return a[0] == b[0] in ("alias", "using")


def clashes(read):
    """`read`: (folder, CMakeLists.txt, {source: its definitions})."""
    for folder, cmake, defined in read:
        for target, sources in targets(cmake):
            first = {}  # by namespace and name, in the order of a batch
            for source in sources:
                names, local = defined[source]
                for namespace, name in local:
                    parts = namespace.split("::")
                    outer = ["::".join(parts[:i + 1]) for i in range(len(parts))]
                    for other, kind in (hit for each in outer for hit in first.get((each, name), [])):
                        yield f"{folder}/{source}: the local '{name}' hides the {kind[0]} of {other} in a batch of {target}"
                for key, kinds in names.items():
                    for kind in kinds:
                        for other, other_kind in first.get(key, []):
                            if not may_coexist(kind, other_kind):
                                yield f"{folder}/{source}: {kind[0]} '{key[1]}': {other} of {target} has a {other_kind[0]} of this name"
                for key, kinds in names.items():
                    first.setdefault(key, []).extend((source, kind) for kind in kinds)


def read_tree():
    for folder in FOLDERS:
        for cmake in sorted((TOP / folder).rglob("CMakeLists.txt")):
            text = cmake.read_text()
            files = {file for _, files in targets(text) for file in files}
            yield str(cmake.parent.relative_to(TOP)), text, {file: definitions((cmake.parent / file).read_text(), file.endswith(".h"))
                                                             for file in files}


def self_test():
    source = "namespace kinescope {{\nnamespace {{\n\n{}\n\n}}  // namespace\n}}  // namespace kinescope\n"
    header = "namespace kinescope {\n\nstruct Inertial {\n};\ninline constexpr int kMostJobs = 1;\n\n}  // namespace kinescope\n"

    def found(a, b):
        defined = {"a.cc": definitions(source.format(a)), "b.cc": definitions(source.format(b)), "b.h": definitions(header, True)}
        return list(clashes([("folder", "add_library(one STATIC a.cc b.cc b.h)\n", defined)]))

    faults = [
        ("constexpr double kA = 1, kB = 2;", "constexpr std::array<int, 2> kB = {1, 2};"),
        ("struct Place {\n  int x;\n};", "Json Place(const Vector3d& v) {\n  return {};\n}"),
        ("double Rounded(double value) {\n  return 1;\n}", "int Rounded(double other) {\n  return 2;\n}"),
        ("using Kind = a::Kind;", "void F() {\n  using Kind = b::Kind;\n}"),
        ("using rviz::Quoted;", "std::string Quoted(const std::string& s) {\n  return s;\n}"),
        ("constexpr int kMost = 1;", "void F() {\n  constexpr int kMost = 2;\n}"),
        ("std::string Inertial(int i) {\n  return {};\n}", ""),
        ("", "void F() {\n  constexpr int kMostJobs = 8;\n}"),
        ("constexpr int kA = 1, kB = 2;  // m\nconstexpr int kLeast = 24;  // px", "constexpr int kLeast = 2;"),
        ("enum class Look { kA };", "class Look {\n};"),
    ]
    fine = [
        ("using Clock = a::Clock;", "using Clock = b::Clock;"),  # the same type, or the compiler refuses
        ("struct A {\n  void List() {\n  }\n};", "struct B {\n  void List() {\n  }\n};"),
        ("void F() {\n  constexpr int kMost = 1;\n}", "constexpr int kMost = 2;"),
        ("double Of(int a) {\n  return 1;\n}", "double Of(double a) {\n  return 1;\n}"),
        ("constexpr int kMost = 1;  // kLeast", "constexpr int kLeast = 2;"),
        ("void F() {\n  constexpr int kMost = 2;\n}", "void G() {\n  constexpr int kMost = 2;\n}"),
    ]
    for a, b in faults:
        if not found(a, b):
            sys.exit(f"self-test: not reported:\n{a}\n{b}")
    for a, b in fine:
        if found(a, b):
            sys.exit(f"self-test: wrongly reported: {found(a, b)}")


def main():
    self_test()
    tree = list(read_tree())
    wrong = sorted(set(clashes(tree)))
    for line in wrong:
        print(line)
    count = sum(name.endswith(".cc") for _, _, sources in tree for name in sources)
    print(f"{count} sources in batches; {len(wrong)} names that are not unique")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
