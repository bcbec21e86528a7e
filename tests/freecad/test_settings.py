"""What a user prefers: the folder of machine files, the machine of new jobs, verification."""

from __future__ import annotations

import json
from typing import Any

import pytest
from freecad_host import INSIDE, FreeCad

pytestmark = [pytest.mark.world, pytest.mark.freecad]


@pytest.fixture(scope="module")
def seen(freecad: FreeCad, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = freecad.folder / "settings"
    folder.mkdir()
    done = freecad.run(INSIDE / "user_settings.py", "--", str(folder))
    lines = [line.removeprefix("RESULT ") for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    results = dict(json.loads(line) for line in lines)
    assert "broke" not in results and len(results) == 2, f"{results}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    return {**results, "folder": str(folder), "printed": done.stdout + done.stderr}


def test_a_folder_that_is_none_is_refused_in_a_sentence(seen: Any) -> None:
    folders = seen["folders"]
    end = ": choose one, or leave the line empty for the default"
    file = folders["file"]
    assert folders["refused"] == {
        "mine": f"SettingError: the folder of machine files mine must be stated from the root on{end}",
        file: f"SettingError: the folder of machine files {file} is not a folder{end}",
    }
    assert folders["gone"] == f"the folder of machine files {file} is not a folder{end}"
    assert f"StylusCAM: {folders['gone']}" in seen["printed"], "what is stored and gone is a warning at the start"


def test_the_chosen_folder_is_used_and_the_default_comes_back(seen: Any) -> None:
    assert seen["folders"]["chosen"] == seen["folder"]
    assert seen["folders"]["default"] and seen["folders"]["again"]


def test_programs_without_verification_state_it(seen: Any) -> None:
    posted = seen["posted"]
    note = "not verified: verification is switched off in StylusCAM's preferences"
    assert note in posted["without"]
    assert note not in posted["verified"] and "from this text" in posted["verified"]
    assert posted["by the job"] == posted["verified"], "--verify among the job's arguments comes first"

    def code(text: str) -> list[str]:
        return [line for line in text.splitlines() if not line.startswith("(")]

    assert code(posted["without"]) == code(posted["verified"]) and len(code(posted["verified"])) > 20


def test_a_new_job_begins_with_the_chosen_machine(seen: Any) -> None:
    ours, theirs = seen["posted"]["new"]
    assert ours == "styluscam_grbl" != theirs, "CAM's own default is back afterwards"
