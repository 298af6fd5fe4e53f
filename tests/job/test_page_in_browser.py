"""The page in a real browser: it opens without fetching and without an error, turns, tells reasons, and prints."""

import base64
import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from toolaxis.job.files.plan_folder import read_plan, stage_folder, write_json, write_plan
from toolaxis.job.files.verdict_maps import write_views
from toolaxis.job.output.report import report
from toolaxis.job.output.verify import verdict_document, verify_plan
from toolaxis.numeric.equal_area import equal_area
from toolaxis.numeric.vectors import perpendicular
from toolaxis.plan.orientation import REASONS
from toolaxis.plan.plan import Plan

pytest.importorskip("plotly")
pytest.importorskip("jinja2")
webdriver = pytest.importorskip("selenium.webdriver", reason="the page is opened with selenium: pip install selenium")
CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
if CHROMIUM is None or DRIVER is None:
    pytest.skip("chromium is not installed: apt-get install chromium chromium-driver", allow_module_level=True)

_FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync",
          "--disable-background-networking", "--disable-component-update", "--disable-dev-shm-usage")
_TURNING = ("--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader")
Open = Callable[..., Any]


@pytest.fixture(scope="module")
def page(small_plan: Plan, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("browser") / "wavy"
    with stage_folder(folder) as stage:
        write_plan(small_plan, stage.folder)
        stage.publish()
    plan = read_plan(folder)
    verdict = verify_plan(plan)
    write_json(verdict_document(plan, verdict), folder / "verdict.json")
    write_views(plan, verdict, folder)
    return report(folder)


@pytest.fixture(scope="module")
def opened(page: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Open]:
    """A function that opens the page: width and height in pixels, a phone or not, further flags.

    A browser that was asked for alike is kept, and opens the page anew.
    """
    drivers: dict[tuple[Any, ...], Any] = {}

    def _open(width: int = 1280, height: int = 900, *, phone: bool = False, flags: tuple[str, ...] = _TURNING) -> Any:
        asked = width, height, phone, flags
        if asked in drivers:
            for log in ("browser", "performance"):
                drivers[asked].get_log(log)
            drivers[asked].get(page.as_uri())
            return drivers[asked]
        options = webdriver.ChromeOptions()
        options.binary_location = CHROMIUM
        profile = tmp_path_factory.mktemp("profile")
        for flag in (*_FLAGS, *flags, f"--window-size={width},{height}", f"--user-data-dir={profile}"):
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(DRIVER))
        driver.set_page_load_timeout(120)
        driver.set_script_timeout(120)
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "mobile": phone,
                                                                      "deviceScaleFactor": 1})
        driver.get(page.as_uri())
        drivers[asked] = driver
        return driver

    yield _open
    for driver in drivers.values():
        driver.quit()


def until(driver: Any, condition: str) -> Any:
    """Wait until a script's value is true; the value."""
    from selenium.webdriver.support.ui import WebDriverWait

    return WebDriverWait(driver, 120, 0.2).until(lambda one: one.execute_script(f"return {condition}"))


def show(driver: Any, chart: str) -> Any:
    """Bring a chart into the window and wait until it is drawn."""
    from selenium.webdriver.common.by import By

    into_view = f"document.querySelector('{chart}').scrollIntoView({{block: 'center'}})"
    driver.execute_script(into_view)
    until(driver, f"Boolean(document.querySelector('{chart}')._fullLayout && "
                  f"document.querySelector('{chart} .main-svg'))")
    driver.execute_script(into_view)  # what was drawn above it meanwhile moved it
    return driver.find_element(By.CSS_SELECTOR, chart)


def faults(driver: Any) -> list[str]:
    return [entry["message"] for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]


def asked_for(driver: Any) -> set[str]:
    """Addresses that the page asked for, what stands in itself apart; the browser's own empty tab is no page."""
    messages = [json.loads(entry["message"])["message"] for entry in driver.get_log("performance")]
    sent = [message["params"] for message in messages if message["method"] == "Network.requestWillBeSent"]
    found = {one["request"]["url"] for one in sent if not str(one.get("documentURL")).startswith("chrome:")}
    assert driver.current_url in found
    return {url for url in found - {driver.current_url} if not url.startswith(("data:", "blob:"))}


def painted(driver: Any, element: Any, tmp_path: Path) -> np.ndarray:
    """Pixels of an element, (rows, columns, 3)."""
    from matplotlib.image import imread

    file = tmp_path / "shot.png"
    file.write_bytes(element.screenshot_as_png)
    return np.asarray(imread(file))[..., :3]


def test_it_opens_without_fetching_and_without_an_error(opened: Open, tmp_path: Path) -> None:
    driver = opened()
    scene = show(driver, "[data-chart=scene]")
    until(driver, "Boolean(document.querySelector('[data-chart=scene] canvas'))")
    for chart in ("[data-own=hemisphere]", "[data-own=scallop]", "[data-own=gouge]", "[data-own=widths]",
                  "[data-chart=times]", "[data-chart=tool]"):
        show(driver, chart)
    assert asked_for(driver) == set() and faults(driver) == []
    assert driver.execute_script("return performance.getEntriesByType('resource').length") == 0
    names = driver.execute_script("return Array.from(document.querySelectorAll('.modebar-btn')).map(b => "
                                  "b.getAttribute('data-title') || b.title || b.dataset.title)")
    assert names and not [name for name in names if "hare" in name or "loud" in name]
    show(driver, "[data-chart=scene]")
    seen = painted(driver, scene, tmp_path)
    blue = (seen[..., 2] > seen[..., 0] + 0.15).mean()  # the machined face and its passes
    assert 0.01 < blue < 0.6


def test_the_part_turns(opened: Open) -> None:
    from selenium.webdriver.common.action_chains import ActionChains

    driver = opened()
    scene = show(driver, "[data-chart=scene]")
    camera = "JSON.stringify(document.querySelector('[data-chart=scene]')._fullLayout.scene._scene.getCamera().eye)"
    before = until(driver, camera)
    ActionChains(driver).move_to_element(scene).click_and_hold().move_by_offset(120, 30).release().perform()
    until(driver, f"{camera} !== '{before}'")
    assert faults(driver) == []


def test_the_pointer_reads_the_reason(opened: Open, small_plan: Plan) -> None:
    from selenium.webdriver.common.actions.action_builder import ActionBuilder

    (op,) = small_plan.operations
    found = op.orientation.map
    assert found is not None
    centre = op.face.normal(op.face.grid(24, 24)).sum(axis=0)
    centre /= np.linalg.norm(centre)
    spots = equal_area(found.axis, centre, perpendicular(centre)[0])
    apart = np.linalg.norm(spots[:, None] - spots[None] + 9 * np.eye(len(spots))[..., None], axis=2).min(axis=1)
    driver = opened()
    show(driver, "[data-own=hemisphere]")
    for code in sorted({int(code) for code in found.reason}):
        there = (found.reason == code) & (np.linalg.norm(spots, axis=1) < 0.95)
        if not there.any():
            continue
        k = int(np.argmax(np.where(there, apart, -1)))  # the one that is farthest from its neighbours
        x, y = driver.execute_script(
            "const p = document.querySelector('[data-own=hemisphere]'), l = p._fullLayout,"
            "r = p.getBoundingClientRect();"
            f"return [r.left + l.xaxis._offset + l.xaxis.d2p({spots[k, 0]}),"
            f" r.top + l.yaxis._offset + l.yaxis.d2p({spots[k, 1]})]")
        pointer = ActionBuilder(driver)
        pointer.pointer_action.move_to_location(round(x), round(y))
        pointer.perform()
        wanted = ", ".join(f"{value:+.4f}" for value in found.axis[k] + 0.0)
        told = until(driver, f"(t => t && t.textContent.includes('{wanted}') && t.textContent)"
                             "(document.querySelector('[data-own=hemisphere] .hovertext'))")
        assert (REASONS[code] if code else "strip width") in told
    assert faults(driver) == []


def test_it_is_read_on_a_phone(opened: Open) -> None:
    driver = opened(360, 740, phone=True)
    show(driver, "[data-chart=scene]")
    show(driver, "[data-own=scallop]")
    wide = driver.execute_script("return [document.documentElement.scrollWidth, window.innerWidth,"
                                 "Math.max(...Array.from(document.querySelectorAll('.chart'), c => c.scrollWidth))]")
    assert wide[0] <= 360 and wide[1] == 360 and wide[2] <= 360
    assert driver.execute_script("return parseFloat(getComputedStyle(document.body).fontSize)") >= 14
    assert faults(driver) == []


def test_it_prints_with_a_still_picture(opened: Open) -> None:
    driver = opened()
    show(driver, "[data-chart=scene]")
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    shown = driver.execute_script("return ['[data-chart=scene]', '#still', '#choose', '#orientations'].map("
                                  "s => document.querySelector(s).getBoundingClientRect().height > 0)")
    assert shown == [False, True, False, True]
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
    printed = base64.b64decode(driver.print_page())
    assert printed.startswith(b"%PDF") and len(printed) > 50_000
    assert faults(driver) == []


def test_without_webgl_there_is_the_still_picture(opened: Open) -> None:
    driver = opened(flags=("--disable-3d-apis",))
    until(driver, "document.body.classList.contains('flat')")
    shown = driver.execute_script("return ['[data-chart=scene]', '#still'].map("
                                  "s => document.querySelector(s).getBoundingClientRect().height > 0)")
    assert shown == [False, True]
    show(driver, "[data-own=hemisphere]")
    assert faults(driver) == []
