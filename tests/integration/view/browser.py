#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# browser.py BIN_DIR EXAMPLES_DIR: the page of hrtc's report, that of spm_view and the example of its
# feed, while hrtc touches a model, in headless Chromium, operated through WebDriver. Exit code 77
# without Debian's chromium and chromium-driver. With VIEW_PICTURES it stores pictures of the pages
# in that folder.
#
# Every wait is for an event and names a missing one; all started programs are ended in any case,
# including browsers that have left their parents.
import base64
import ctypes
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

PATIENCE_S = 300  # Only a broken program waits this long.
LOAD_S = 60  # Time until a missing page is loaded again.
# No message bus, no network, no shared memory that a container may lack, and no watchdog that takes
# a busy machine for a broken graphics card.
FLAGS = ["--headless", "--no-sandbox", "--no-proxy-server", "--use-gl=angle",
         "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-watchdog",
         "--disable-dev-shm-usage", "--disable-background-networking", "--disable-sync",
         "--disable-component-update", "--disable-default-apps", "--disable-extensions",
         "--disable-breakpad", "--no-first-run", "--password-store=basic"]
PR_SET_PDEATHSIG = 1
PR_SET_CHILD_SUBREAPER = 36

began_s = time.monotonic()
system = ctypes.CDLL(None)
browsers = []
started = {}  # Processes by log.


def start(*command, log):
    quiet = {"DBUS_SESSION_BUS_ADDRESS": "disabled:", "DBUS_SYSTEM_BUS_ADDRESS": "disabled:",
             "HOME": os.getcwd(), "TMPDIR": os.getcwd()}
    with open(log, "wb") as file:
        process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT,
            env=os.environ | quiet,  # They end with this process, even if that is killed.
            preexec_fn=lambda: system.prctl(PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0))
    started[log] = process
    return process


def children_of(parent):
    """All present processes, and their children."""
    parents = {}
    for status in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = status.read_text(errors="replace").rpartition(")")[2].split()
            parents[int(status.parent.name)] = int(fields[1])
        except OSError:
            pass  # It has ended.
    found = {parent}
    while True:
        more = {child for child, of in parents.items() if of in found} - found
        if not more:
            return found - {parent}
        found |= more


def end_all():
    """All started programs and their children: orphans are this process's children."""
    end = time.monotonic() + PATIENCE_S
    while left := children_of(os.getpid()):
        for child in left:
            try:
                os.kill(child, signal.SIGKILL)
            except ProcessLookupError:
                pass
        try:
            while os.waitpid(-1, os.WNOHANG)[0] != 0:
                pass
        except ChildProcessError:
            pass
        if time.monotonic() > end:
            print("still there after SIGKILL:", sorted(left), flush=True)
            return
        time.sleep(0.02)


def fail(what):
    looked = browsers.pop() if browsers else None  # Once, since the request may also fail.
    if looked:
        print("--- the page:", looked.run(
            "return [document.readyState, document.body.innerText, performance.getEntries()"
            ".map((entry) => `${entry.name} ${entry.duration} ${entry.responseStatus}`)]"))
        print("--- its complaints:", looked.complaints(), flush=True)
    for log, process in started.items():
        lines = pathlib.Path(log).read_text(errors="replace").splitlines()
        code = process.poll()
        state = "runs" if code is None else f"has ended with {code}"
        print(f"--- {log}, whose program {state}; its last lines", *lines[-12:], sep="\n")
    sys.exit(f"FAULT after {time.monotonic() - began_s:.0f} s: {what}")


def line_in(log, pattern):
    """Group of the pattern in a line of the file, once there is one."""
    return eventually(lambda: re.search(pattern, pathlib.Path(log).read_text(errors="replace")),
                      f"'{pattern}' in {log}").group(1)


def eventually(ask, what):
    print(f"{time.monotonic() - began_s:5.1f} s: waits for {what}", flush=True)
    end = time.monotonic() + PATIENCE_S
    while True:
        answer = ask()
        if answer:
            return answer
        if time.monotonic() > end:
            fail(f"never came: {what}")
        time.sleep(0.1)


class Browser:
    def __init__(self, driver):
        port = line_in(driver, r"successfully on port (\d+)")
        self.root = f"http://127.0.0.1:{port}/session"
        folder = f"--user-data-dir={os.getcwd()}/profile"
        limits = {"pageLoad": PATIENCE_S * 900, "script": PATIENCE_S * 900}  # Time limits in ms.
        # This program waits for the page: the driver's wait may never end on a busy machine.
        wanted = {"alwaysMatch": {"pageLoadStrategy": "none", "goog:chromeOptions": {"args": [*FLAGS, folder]},
                                  "goog:loggingPrefs": {"browser": "ALL"}, "timeouts": limits}}
        self.root += "/" + self.call("POST", "", {"capabilities": wanted})["sessionId"]
        browsers.append(self)

    def ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.root + path, data, method=method)
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        return json.load(opener.open(request, timeout=PATIENCE_S))["value"]

    def call(self, method, path, body=None):
        try:
            return self.ask(method, path, body)
        except urllib.error.HTTPError as error:
            fail(f"{method} {path}: {error.read().decode()[:400]}")
        except (OSError, ValueError) as error:
            fail(f"chromedriver's answer to {method} {path or 'a new session'} never came: {error}")

    def open(self, url, is_there, what):
        """Repeats the load if the page does not arrive: browsers sometimes lose a connection."""
        begun_s = [0.0]

        def try_it():
            if time.monotonic() - begun_s[0] > LOAD_S:
                begun_s[0] = time.monotonic()
                self.call("POST", "/url", {"url": url})
            return is_there()
        eventually(try_it, what)

    def run(self, script):
        return self.call("POST", "/execute/sync", {"script": script, "args": []})

    def text(self, name):
        return self.run(f"const found = document.getElementById('{name}');"
                        "return found ? found.textContent : '';")

    def element(self, name):
        found = self.call("POST", "/element", {"using": "css selector", "value": f"#{name}"})
        return "/element/" + next(iter(found.values()))

    def click(self, name):
        self.call("POST", self.element(name) + "/click", {})

    def drag(self, selector, sideways):
        """Presses the button in the middle of the first such element, moves by this distance,
        releases."""
        found = self.call("POST", "/element", {"using": "css selector", "value": selector})
        moves = [{"type": "pointerMove", "origin": found, "x": 0, "y": 0},
                 {"type": "pointerDown", "button": 0},
                 {"type": "pointerMove", "origin": found, "x": sideways, "y": 0, "duration": 100},
                 {"type": "pointerUp", "button": 0}]
        self.call("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse",
                                                    "actions": moves}]})

    def press(self, name, pressed):
        """Clicks until the condition holds: a click while the page moves may miss."""
        def is_so():
            return self.run(f"return document.getElementById('{name}').ariaPressed") == pressed

        def try_it():
            if not is_so():
                self.click(name)
            return is_so()
        eventually(try_it, f"'{name}' pressed: {pressed}")

    def resize(self, width, height):
        self.call("POST", "/goog/cdp/execute", {  # A window cannot be as narrow as a telephone.
            "cmd": "Emulation.setDeviceMetricsOverride",
            "params": {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}})
        eventually(lambda: self.run("return innerWidth") == width, f"a page {width} px wide")

    def picture(self, name):
        folder = os.environ.get("VIEW_PICTURES")
        if folder:
            try:
                data = base64.b64decode(self.ask("GET", "/screenshot"))
                pathlib.Path(folder, name + ".png").write_bytes(data)
            except OSError as error:  # A busy machine draws none in the driver's 10 s.
                print(f"no picture {name}: {error}", flush=True)

    def complaints(self):
        """Faults except those of outdated states, from a controller that was silent."""
        entries = self.call("POST", "/se/log", {"type": "browser"})
        return {entry["message"] for entry in entries if entry["level"] == "SEVERE" and
                not re.search(r"/(front|boxes|loaded|requested)\?.* 4\d\d ", entry["message"])}


def expect(is_so, what):
    if not is_so:
        fail(what)


def fits(browser, what):
    """Charts follow the window after its event."""
    eventually(lambda: browser.run("return document.documentElement.scrollWidth <= innerWidth"),
               what)


# Elements wider than their box, or beyond the page's edge, cannot be read completely.
CUT_OFF = """return [...document.querySelectorAll(
    "button, dt, dd, td, th, h2, label, p, .names, .marks, #words, #waits, #film-notes")]
  .filter((one) => one.offsetParent !== null && (one.scrollWidth > one.clientWidth + 1 &&
    getComputedStyle(one).display !== "inline" && one.clientWidth > 0 ||
    one.getBoundingClientRect().right > innerWidth + 1))
  .map((one) => `${one.tagName} '${one.textContent.slice(0, 40)}'`)"""


def nothing_cut_off(browser, what):
    cut = browser.run(CUT_OFF)
    expect(not cut, f"{what}: cut off are {cut[:4]}")


def drawn(browser):
    """Waits for two more pictures of the surface, since the first may have been begun before."""
    pictures = "return Number(document.getElementById('canvas').dataset.pictures)"
    seen = browser.run(pictures)
    eventually(lambda: browser.run(pictures) >= seen + 2, "pictures of the surface")


def look(browser, url, serve):
    browser.resize(1440, 900)
    browser.open(f"{url}?theme=light",
                 lambda: "waiting for a controller on DDS domain" in browser.text("waits"),
                 "what the page waits for")
    hand = serve()
    eventually(lambda: browser.text("faces").endswith("faces"), "the controller's faces")
    eventually(lambda: browser.text("words").startswith("force "), "the force in words")
    expect(browser.text("waits") == "", "it still waits: " + browser.text("waits"))
    eventually(lambda: browser.run("return document.querySelector('.names').textContent")
               .startswith("T_L "), "stage times")
    eventually(lambda: re.match(r"force (?!0\.00)", browser.text("words")), "a touch")
    browser.click("fit")  # Towards the tool.
    for theme in ("light", "dark"):
        drawn(browser)
        browser.picture(theme)
        before = browser.run("return getComputedStyle(document.body).backgroundColor")
        browser.click("theme")
        after = browser.run("return getComputedStyle(document.body).backgroundColor")
        expect(before != after, "the theme stays")
    boxes(browser)
    frozen_page(browser)
    browser.press("freeze", "true")  # A machine without a graphics card draws slowly.
    for width in (400, 900, 2560):
        browser.resize(width, 1000)
        fits(browser, f"the page within {width} pixels")
        nothing_cut_off(browser, f"the page {width} pixels wide")
        browser.picture(f"wide-{width}")
        browser.click("theme")
        browser.picture(f"dark-{width}")
        browser.click("theme")
    browser.resize(900, 700)
    browser.press("freeze", "false")
    hand.terminate()
    eventually(lambda: hand.poll() is not None, "hrtc's end")
    eventually(lambda: "waiting for" in browser.text("waits"), "that the controller has gone")
    expect(not browser.complaints(), f"the browser complains: {sorted(browser.complaints())[:3]}")


# Greatest distance of a picture element's colour from the background, and the name that is shown.
FEED = """const gl = renderer.getContext();
renderer.render(scene, camera);
const seen = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, seen);
return {drawn: Math.max(...[0, 1, 2].map((part) => seen.reduce((most, value, i) =>
          i % 4 === part ? Math.max(most, Math.abs(value - seen[part])) : most, 0))),
        words: words.textContent, keys: [...shown.keys()].sort()}"""


def feed_page(browser, url, serve):
    """The example for three.js: tool, force and object of a controller, and the wait for one."""
    browser.resize(900, 700)
    browser.open(f"{url}pages/feed_three.html",
                 lambda: browser.text("words") == "waiting for a controller",
                 "what the feed's page waits for")
    expect(browser.run(FEED)["drawn"] == 0, "something is drawn without a controller")
    hand = serve()
    eventually(lambda: browser.text("words").startswith("hrtc-"), "the controller of the feed")
    eventually(lambda: re.match("force 0,object 0 [0-9a-f]+,tool 0 0\\.00",
                                ",".join(browser.run(FEED)["keys"])), "the parts of a feed")
    expect(browser.run(FEED)["drawn"] > 50, "nothing is drawn")
    browser.resize(1200, 800)
    fits(browser, "the feed's page in a wider window")
    browser.picture("feed")
    hand.terminate()
    eventually(lambda: browser.text("words") == "waiting for a controller", "an end of the feed")
    expect(not browser.complaints(), f"the browser complains: {sorted(browser.complaints())[:3]}")


# State of each chart: whether it is drawn, and its zoom.
CHARTS = """return charts.map((graph) => ({
  is_drawn: [...graph.graphDiv.querySelectorAll("canvas")].some((canvas) => canvas.getContext("2d")
    .getImageData(0, 0, canvas.width, canvas.height).data.some((value) => value !== 0)),
  range: graph.isZoomed("x") ? graph.xAxisRange() : null,
  marks: graph.graphDiv.closest("figure").querySelector(".marks").textContent}))"""


def reported(browser):
    """One file: charts, those over the run with a common zoom."""
    browser.resize(1440, 1000)
    browser.open(pathlib.Path("run.html").absolute().as_uri(),
                 lambda: browser.run("return document.querySelectorAll('.chart canvas').length")
                 >= 12, "the charts of a report")
    eventually(lambda: all(chart["is_drawn"] for chart in browser.run(CHARTS)),
               "something in each chart")
    expect("period" in browser.run(CHARTS)[3]["marks"], "the period isn't marked")
    browser.picture("report")
    browser.run("document.querySelector('.charts').scrollIntoView()")
    browser.drag(".chart", 120)
    def ranges():
        return [chart["range"] for chart in browser.run(CHARTS)]
    eventually(lambda: ranges()[0] and ranges() == [ranges()[0]] * 3 + [None] * 3,
               "the time that was dragged over, in all charts over the run")
    expect(0 < ranges()[0][0] < ranges()[0][1], f"dragged over, charts show {ranges()}")
    browser.run("charts[1].resetZoom()")
    eventually(lambda: ranges() == [None] * 6, "an end of the zoom")
    for width in (2560, 900, 400):
        browser.resize(width, 1000)
        fits(browser, f"the report within {width} pixels")
        nothing_cut_off(browser, f"the report {width} pixels wide")
    browser.picture("report-narrow")
    expect(not browser.complaints(), f"the browser complains: {sorted(browser.complaints())[:3]}")


def choose(browser, name, value):
    browser.run(f"const by = document.getElementById('{name}'); by.value = '{value}';"
                "by.dispatchEvent(new Event('change'));")


def box_count(browser):
    found = re.search(r", ([\d,]+) box", browser.text("faces"))
    return int(found[1].replace(",", "")) if found else 0


def boxes(browser):
    """Boxes of the tree, level by level: one at the root, more at each level below."""
    counts = []
    for level in ("0", "2", "24"):
        choose(browser, "level", level)
        least = counts[-1] if counts else 0
        eventually(lambda: box_count(browser) > least, f"boxes of level {level}, after {counts}")
        counts.append(box_count(browser))
    expect(counts[0] == 1, f"{counts[0]} boxes at the root")
    choose(browser, "level", "")
    browser.click("regions")
    eventually(lambda: "box" in browser.text("faces"), "boxes of what is loaded")
    for name, least in (("loaded", 1), ("requested", 0), ("present", 1), ("predicted", 1)):
        eventually(lambda: browser.text(f"regions-{name}") != "" and
                   int(browser.text(f"regions-{name}")) >= least, f"regions that are {name}")
    drawn(browser)
    browser.picture("regions")
    browser.click("regions")
    eventually(lambda: browser.run("return document.getElementById('regions-legend').hidden"),
               "an end of the regions' legend")


def played(browser, url):
    """Two recordings, of which the second one ends early and lifts its tool before."""
    def frame():
        found = re.search(r"frame ([\d,]+) of 0 to 499", browser.text("place"))
        return int(found[1].replace(",", "")) if found else -1
    browser.resize(1440, 900)
    browser.open(url, lambda: "the length" in browser.text("film-notes"), "what differs")
    first = re.search(r"frame (\d+): the device poses, in \d+ of 300 frames", browser.text("film-notes"))
    expect(first is not None, "it doesn't say where hands differ: " + browser.text("film-notes"))
    eventually(lambda: browser.text("faces").endswith("faces"), "a recording's faces")
    browser.click("play")
    eventually(lambda: frame() > 10, "that it plays")
    browser.press("play", "false")
    seen = frame()
    browser.click("step-back")
    eventually(lambda: frame() == seen - 1, f"frame {seen - 1}")
    browser.run("document.querySelector('#film-notes button').click()")
    eventually(lambda: frame() == int(first[1]), "the frame in which they differ")
    figure = "return document.querySelector('#figures dd').textContent"
    eventually(lambda: browser.run(figure) == str(int(first[1]) + 1), "what that frame shows")
    browser.picture("recordings")


def frozen_page(browser):
    frames = "return document.querySelector('#figures dd').textContent"
    browser.press("freeze", "true")
    seen = browser.run(frames)
    time.sleep(1.0)
    expect(browser.run(frames) == seen, "a frozen page goes on")
    browser.run("const back = document.getElementById('back'); back.value = '-30';"
                "back.dispatchEvent(new Event('input'));")
    earlier = browser.run("const first = document.querySelector('#figures dd');"
                          "return first ? first.textContent : '';")
    expect(earlier == "" or int(earlier.replace(",", "")) < int(seen.replace(",", "")),
           f"half a minute back is frame {earlier}, after {seen}")
    browser.press("freeze", "false")
    eventually(lambda: browser.run(frames) != seen, "newer frames")
    browser.click("near")
    browser.click("shells")
    choose(browser, "colour", "error")
    eventually(lambda: browser.text("most") == "exact", "colours of the error bound")
    drawn(browser)
    browser.picture("near")


def main():
    programs, examples = (pathlib.Path(folder).resolve() for folder in sys.argv[1:3])
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # No process is left running.
    for needed in ("chromium", "chromedriver"):
        if shutil.which(needed) is None:
            print(f"no {needed}: install chromium and chromium-driver")
            sys.exit(77)
    domain = os.environ.get("TACTUS_TEST_DOMAIN", str(os.getpid() % 231))
    os.environ.pop("CYCLONEDDS_URI", None)
    system.prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        os.chdir(folder)
        try:
            subprocess.run([programs / "spm_build", "--shape", "bumpy-sphere", "--faces", "20000",
                            "-o", "bumpy.spm"], check=True, timeout=PATIENCE_S,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            start("chromedriver", "--port=0", log="driver.log")
            start(programs / "spm_publish", "bumpy.spm", "--domain", domain, log="publish.log")
            start(programs / "spm_view", "--domain", domain, "--port", "0", "--pages", examples,
                  log="view.log")
            url = line_in("view.log", r"(http://\S+) shows")
            state = urllib.request.urlopen(url + "state", timeout=PATIENCE_S)
            there = json.load(state)["controllers"]
            expect(not there, f"DDS domain {domain} has controllers already: {there}")
            for name, seconds in (("one.rec", "0.5"), ("two.rec", "0.3")):
                subprocess.run([programs / "hrtc", "bumpy.spm", "--no-static", "--device", "sim",
                                "--virtual-time", "--allow-no-rt", "--duration", seconds,
                                "--record", name], check=True, timeout=PATIENCE_S,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            subprocess.run([programs / "hrtc", "bumpy.spm", "--no-static", "--device", "sim",
                            "--allow-no-rt", "--duration", "1", "--report", "run.html"],
                           check=True, timeout=PATIENCE_S, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
            start(programs / "spm_view", "--replay", "one.rec", "--replay", "two.rec", "--port",
                  "0", log="film.log")
            browser = Browser("driver.log")
            reported(browser)
            played(browser, line_in("film.log", r"(http://\S+) shows"))
            for page in (look, feed_page):
                page(browser, url, lambda: start(
                    programs / "hrtc", "--model", "bumpy", "--no-static", "--device", "sim",
                    "--allow-no-rt", "--domain", domain, "--duration", "600", log="hrtc.log"))
        finally:
            end_all()
            os.chdir("/")


main()
