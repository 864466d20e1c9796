"""brick.Controller.replay (docs/python.md), and from where names of files count."""

import pathlib
import shutil

import brick
import pytest


def test_a_replay_does_the_same_with_a_waveform(tmp_path):
    with brick.Controller(plant="dac8", setup="dac8", seed=5) as c:
        c.command("#1J:100")
        with pytest.raises(brick.CommandRefused):
            c.command("frob")
        c.run(ms=5)
        c.replay(str(tmp_path / "replay.vcd"))
    assert (tmp_path / "replay.vcd").stat().st_size > 10_000


def test_a_replay_that_goes_another_way_says_so(tmp_path):
    wave, included = tmp_path / "replay.vcd", tmp_path / "included.pmc"
    with brick.Controller() as c:
        included.write_text("P1=3\n")
        c.load(str(included))
        with pytest.raises(ValueError, match="no signal"):
            c.signal("frob")
        c.replay(str(wave))
        included.unlink()
        c.run(ms=1)
        with pytest.raises(brick.BrickError, match=r"call 1 \(script\) ended with ValueError: .*; expected a result"):
            c.replay(str(wave))
        with pytest.raises(ValueError, match="cannot be read"):
            c.load(str(included))
        included.write_text("P1=3\n")
        with pytest.raises(brick.BrickError, match=r"call 4 \(script\) ended with a result; expected ValueError: "):
            c.replay(str(wave))
    assert wave.stat().st_size > 1000


@pytest.mark.parametrize(("options", "file"), [(["--profile", "profile"], "profile"),
                                               (["--record=r.csv", "--record-of=host.breq"], "r.csv")])
def test_a_replay_leaves_the_files_of_the_first_run(tmp_path, monkeypatch, options, file):
    monkeypatch.chdir(tmp_path)
    with brick.Controller(options=options) as c:
        c.run(ms=1)
    pathlib.Path(file).write_text("mine")
    c.replay("replay.vcd")
    assert pathlib.Path(file).read_text() == "mine" and pathlib.Path("replay.vcd").stat().st_size > 1000


def test_names_of_files_count_from_where_the_caller_stands(tmp_path, monkeypatch):
    first, then = tmp_path / "first", tmp_path / "then"
    for folder in (first, then):
        folder.mkdir()
        (folder / "line.pmc").write_text(f"P1={len(folder.name)}\n")
    shutil.copy(pathlib.Path(__file__).resolve().parents[3] / "boards/geobrick-lv-4.toml", first / "board.toml")
    monkeypatch.chdir(first)
    with brick.Controller(board="board.toml", options=["--load=line.pmc", "--profile=profile"]) as c:
        assert c["P1"] == len("first")
        with c.record("host.breq", file="record.csv") as record:
            monkeypatch.chdir(then)
            c.run(ms=1)
        assert len(record) in (2, 3) and (first / "record.csv").exists()
        c.start_wave(pathlib.Path("wave.vcd"))
        c.stop_wave()
        for again in (lambda: c.load("line.pmc"), lambda: c.script('#include "line.pmc"\n')):
            c["P1"] = 0
            again()
            assert c["P1"] == len("then")
        c.replay("replay.vcd")
        monkeypatch.chdir(first)
        c.script('#include "line.pmc"\n')
        assert c["P1"] == len("first")
    assert {file.name for file in then.iterdir()} == {"line.pmc", "wave.vcd", "replay.vcd"}
    assert {file.name for file in first.iterdir()} == {"line.pmc", "board.toml", "record.csv", "profile"}


def test_a_replay_ends_where_a_call_was_cut_off(tmp_path):
    with brick.Controller(realtime=True, options=["--wave", str(tmp_path / "own.vcd")]) as c:
        c["P1"] = 3
        with pytest.raises(brick.WallTimeout):
            c.run(s=3600, wall_limit=0.2)
        c["P1"] = 4
        own = (tmp_path / "own.vcd").stat().st_ino
        with pytest.raises(brick.WallTimeout, match=r"call 2 \(run\) was cut off: .*replay.vcd ends before"):
            c.replay(str(tmp_path / "replay.vcd"))
        assert (tmp_path / "own.vcd").stat().st_ino == own
    assert (tmp_path / "replay.vcd").stat().st_size > 1000


def test_a_replay_has_the_flash_of_the_start_and_leaves_the_file(tmp_path):
    flash, wave = tmp_path / "flash", tmp_path / "wave.vcd"
    for option in (["--flash", str(flash)], [f"--flash={flash}"]):
        c = brick.Controller(options=option)
        c.command(f"I5={len(option)}")
        c.command("SAVE")
        c.close()
        saved = flash.read_bytes()
        flash.write_bytes(b"")  # a replay that reads or writes this one shows
        c.replay(str(wave))
        assert flash.read_bytes() == b"" and wave.stat().st_size > 1000
        flash.write_bytes(saved)
