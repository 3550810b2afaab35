"""What has changed, for the checks that look at changed files only."""
import subprocess

from compile_flags import TOP


def git(*words):
    result = subprocess.run(["git", *words], capture_output=True, text=True, cwd=TOP)
    return result.stdout.split("\0" if "-z" in words else None) if result.returncode == 0 else None


def base_commit():
    """None if there is no history."""
    head = git("rev-parse", "HEAD")
    left = git("merge-base", "HEAD", "origin/main")
    return (left if left and left != head else git("rev-parse", "HEAD~1") or [None])[0]


def is_commit(name):
    return git("rev-parse", "--verify", f"{name}^{{commit}}") is not None


def names_changed_since(commit):
    """Files that differ from the commit, and new ones, as paths from the top folder."""
    return {name for words in (("diff", "--name-only", "--diff-filter=d", "-z", commit),
                               ("ls-files", "--others", "--exclude-standard", "-z"))
            for name in git(*words) or [] if name}
