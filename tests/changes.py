"""What has changed, for the checks that look at changed files only."""
import re
import subprocess

from compile_flags import TOP


def git_output(*words):
    result = subprocess.run(["git", *words], capture_output=True, text=True, cwd=TOP)
    return result.stdout if result.returncode == 0 else None


def git(*words):
    output = git_output(*words)
    return output if output is None else output.split("\0" if "-z" in words else None)


LANDED = "tests/gate/landed"  # a commit that has passed ./check as a whole, and what came before it


def base_commit():
    """The last commit that is known to have passed: where this branch left origin/main. In a clone whose origin/main is the change
    itself, as that of CI, the one that the tree names. None if neither is there: then nothing is known to have passed."""
    head, left = git("rev-parse", "HEAD"), git("merge-base", "HEAD", "origin/main")
    if left and left != head:
        return left[0]
    named = (TOP / LANDED).read_text().split()
    is_there = named and git("merge-base", "--is-ancestor", named[0], "HEAD") is not None
    return named[0] if is_there else None


def parse_options(parser):
    """Its options with --since and --all. `since` is a commit, or None if none is known to have passed."""
    parser.add_argument("--since", metavar="COMMIT", default=base_commit())
    parser.add_argument("--all", action="store_true")
    options = parser.parse_args()
    if not options.all and options.since is not None and git("rev-parse", "--verify", f"{options.since}^{{commit}}") is None:
        parser.error(f"--since={options.since}: unknown commit")
    return options


def names_changed_since(commit, with_removed=False):
    """Files that differ from the commit, and new ones, as paths from the top folder."""
    kinds = [] if with_removed else ["--diff-filter=d"]
    return {name for words in (("diff", "--name-only", *kinds, "-z", commit),
                               ("ls-files", "--others", "--exclude-standard", "-z"))
            for name in git(*words) or [] if name}


def has_lost_a_name(commit, name):
    """Whether a header that was there at the commit has a line less, or another one, that begins at the left: an include, or
    a declaration outside of classes. Who relied on that header for it finds nothing there."""
    removed = re.findall(r"^-(?!--)[A-Za-z#].*", git_output("diff", "-U0", "--no-renames", commit, "--", name) or "", re.MULTILINE)
    return any(not line.startswith("-#pragma") for line in removed)
