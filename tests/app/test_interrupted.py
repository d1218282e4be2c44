"""How a command ends that was not let finish."""

import signal
import subprocess
import sys

import pytest

from tests.conftest import PORTRAITS, ROOT
from toongeo.app.cli import main

MAKE = ["make", str(PORTRAITS / "blue_girl.png"), "--landmarks", str(PORTRAITS / "blue_girl.pts"), "-o"]


def raising(error):
    def raise_it(*_, **__):
        raise error

    return raise_it


def test_an_interrupt_is_quiet(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("toongeo.app.make.make_avatar", raising(KeyboardInterrupt()))
    assert main([*MAKE, str(tmp_path / "a.glb")]) == 130
    assert "toongeo:" not in (said := capsys.readouterr().err) and "Traceback" not in said
    assert not list(tmp_path.iterdir())


def test_ctrl_c_in_a_real_shell_is_quiet(tmp_path):
    command = [sys.executable, "-m", "toongeo", *MAKE, str(tmp_path / "a.glb")]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stderr is not None
        seen = b""
        while b"fit" not in seen:
            seen += process.stderr.read(1)
        process.send_signal(signal.SIGINT)
        _, rest = process.communicate(timeout=120)
    assert process.returncode == 130
    assert b"Traceback" not in rest and b"toongeo:" not in rest
    assert not list(tmp_path.iterdir())


def test_servers_end_with_ctrl_c_as_they_should(avatar, tmp_path):
    pytest.importorskip("websockets")
    avatar.save(tmp_path / "a.glb")
    command = [sys.executable, "-m", "toongeo", "serve", str(tmp_path / "a.glb"), "--no-open"]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stdout.readline().startswith(b"page:")
        process.send_signal(signal.SIGINT)
        try:
            _, errors = process.communicate(timeout=120)
        finally:
            process.kill()
    assert process.returncode == 0 and errors == b""


@pytest.mark.parametrize(("error", "code"), [(ValueError("bad"), 2), (KeyError("odd"), 1), (OSError(28, "full"), 2)])
@pytest.mark.parametrize("debug", [False, True])
def test_tracebacks_are_for_debugging(tmp_path, capsys, monkeypatch, error, code, debug):
    monkeypatch.setattr("toongeo.app.make.make_avatar", raising(error))
    arguments = [*MAKE, str(tmp_path / "a.glb")]
    for given in [["--debug", *arguments], [*arguments, "--debug"]] if debug else [arguments]:
        assert main(given) == code
        said = capsys.readouterr().err
        assert ("Traceback" in said) == debug
        line = said.splitlines()[-1]
        assert line.startswith("toongeo: ") and str(error.args[-1]) in line
        assert "Errno" not in line and ("--debug shows where" in line) == (code == 1)
