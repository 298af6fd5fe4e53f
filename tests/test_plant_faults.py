"""The faults that tests/plant_faults.py plants stand where they should, one for each package; it is not run here."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SCRIPT = ROOT / "tests" / "plant_faults.py"


def load_script():
    spec = importlib.util.spec_from_file_location("plant_faults", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    sys.modules["plant_faults"] = module
    spec.loader.exec_module(module)
    return module


FAULTS = load_script()


@pytest.mark.parametrize("number", range(1, len(FAULTS.FAULTS) + 1))
def test_a_fault_stands_once_in_its_file_and_changes_it_to_something_that_python_takes(number):
    fault = FAULTS.FAULTS[number - 1]
    path, text = FAULTS.checked_text(ROOT, fault)
    assert fault.new != fault.old
    compile(text.replace(fault.old, fault.new), str(path), "exec")
    assert FAULTS.test_files(ROOT, fault)
    assert all((ROOT / "tests" / name).exists() for name in fault.tests)


def test_every_package_has_a_fault():
    core = ROOT / "core" / "toolaxis"
    packages = {path.name for path in core.iterdir() if (path / "__init__.py").is_file()}
    assert packages == {fault.file.split("/")[2] for fault in FAULTS.FAULTS if fault.file.startswith("core/")}
    assert any(fault.file.startswith("workbench/") for fault in FAULTS.FAULTS)
    assert len(FAULTS.FAULTS) == 34


def test_a_text_that_is_gone_is_an_error_that_names_its_file(tmp_path):
    done = subprocess.run([sys.executable, str(SCRIPT), "--only", "1", "--folder", str(tmp_path)], capture_output=True,
                          text=True, check=False)
    assert done.returncode == 2 and FAULTS.FAULTS[0].file in done.stderr
    skipped = subprocess.run([sys.executable, str(SCRIPT), "--only", "1", "--folder", str(tmp_path), "--skip-missing"],
                             capture_output=True, text=True, check=False)
    assert skipped.returncode == 0 and "0 of 0 found" in skipped.stdout


def test_a_planted_fault_is_gone_afterwards(tmp_path):
    fault = FAULTS.FAULTS[0]
    path = tmp_path / fault.file
    path.parent.mkdir(parents=True)
    path.write_text(f"x = 1  # {fault.old}\n")
    before = path.stat().st_mtime_ns
    with pytest.raises(KeyboardInterrupt), FAULTS.planted(tmp_path, fault):
        assert fault.new in path.read_text() and fault.old not in path.read_text()
        raise KeyboardInterrupt
    assert path.read_text() == f"x = 1  # {fault.old}\n" and path.stat().st_mtime_ns == before


@pytest.mark.parametrize(("answer", "said", "verdict"), [
    (1, "FAILED tests/numeric/test_x.py::test_y - assert 1\n", "found by numeric/test_x.py::test_y"),
    (2, "ERROR tests/numeric/test_x.py\n", "found by numeric/test_x.py"), (None, "", "NOT FOUND within"),
    (0, "....  [100%]\n", "NOT FOUND"), (0, "ssss  [100%]\n4 skipped\n", "not run: its tests were skipped")])
def test_what_pytest_says_is_read(answer, said, verdict):
    assert FAULTS.verdict_of(answer, said).startswith(verdict)
