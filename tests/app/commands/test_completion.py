"""Scripts that shells really complete with."""

import shutil
import subprocess

import pytest

from toongeo.app.cli import main


@pytest.fixture
def script(capsys):
    """``script(shell)`` -> what the command prints."""

    def script(shell):
        assert main(["completion", shell]) == 0
        return capsys.readouterr().out

    return script


def run(shell, text):
    if shutil.which(shell) is None:
        pytest.skip(f"needs {shell}")
    done = subprocess.run([shell, "-c", text], capture_output=True, text=True, check=True, timeout=60)
    assert done.stderr == ""
    return done.stdout.split()


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["ma"], ["make"]),
        (["comp"], ["completion"]),
        (["make", "--sh"], ["--sheet"]),
        (["make", "a.png", "--same"], ["--same-person"]),
        (["make", "--crop", ""], ["head", "bust", "face"]),
        (["make", "--crop", "b"], ["bust"]),
        (["edit", "--wink-l"], ["--wink-left"]),
        (["bench", "tab"], ["table1", "table2", "table4"]),
        (["bench", "table1", "--eo"], ["--eos"]),
        (["completion", "f"], ["fish"]),
        (["make", "-o", ""], []),  # a file name, which the shell knows
        (["--ver"], ["--version"]),
    ],
)
def test_bash_completes(script, words, expected):
    line = " ".join(["toongeo", *(f"'{word}'" for word in words)])
    ask = f"COMP_WORDS=({line}); COMP_CWORD={len(words)}; _toongeo; echo ${{COMPREPLY[@]}}"
    assert run("bash", f"{script('bash')}\n{ask}") == expected


def test_zsh_takes_the_script(script):
    assert "_toongeo" in run("zsh", f"{script('zsh')}\nprint ${{(k)_comps}} $_comps[toongeo]")


def test_fish_completes(script):
    text = script("fish")
    for line, expected in (
        ("toongeo ma", ["make"]),
        ("toongeo make --cro", ["--crop"]),
        ("toongeo make --crop ", ["bust", "face", "head"]),
        ("toongeo bench tab", ["table1", "table2", "table4"]),
        ("toongeo completion z", ["zsh"]),
    ):
        found = run("fish", f"{text}\ncomplete -C '{line}' | cut -f 1")
        assert sorted(found) == expected, line
