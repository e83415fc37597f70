"""A headless Chromium driven over a pipe (Chrome DevTools Protocol), with nothing but Python's own library.

No network: the browser gets no address but those given to open(), and requests for anything but file: are recorded.
"""
import base64
import json
import os
import select
import shutil
import struct
import subprocess
import tempfile
import time
import unittest
import zlib

FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync", "--disable-extensions", "--mute-audio", "--remote-debugging-pipe",
         "--enable-unsafe-swiftshader"]  # WebGL without graphics hardware


def program():
    """Path of the browser, or None."""
    return os.environ.get("KREPL_BROWSER") or shutil.which("chromium") or shutil.which("chromium-browser")


def first_pixel(png):
    """(r, g, b) of the first pixel of a PNG of 8 bits a channel; no filter changes that one."""
    packed, at = b"", 8
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at:at + 8])
        if kind == b"IHDR":
            assert struct.unpack(">BB", png[at + 16:at + 18]) in ((8, 2), (8, 6))
        elif kind == b"IDAT":
            packed += png[at + 8:at + 8 + size]
        at += 12 + size
    return tuple(zlib.decompress(packed)[1:4])


class Browser:
    """`with Browser(1200, 800) as b: b.open(path); b.evaluate("1 + 1")`"""

    def __init__(self, width=1200, height=800, dark=False, timeout=60):
        self.timeout, self.size, self.dark = timeout, (width, height), dark
        self.problems, self.requests = [], []  # console errors and exceptions; addresses asked for
        self._id, self._buffer, self._answers = 0, b"", {}

    def __enter__(self):
        self._profile = tempfile.mkdtemp(prefix="krepl-browser-")
        to_browser, self._write = os.pipe()
        self._read, from_browser = os.pipe()

        def place_pipes():  # the protocol's fixed numbers: 3 in, 4 out; moved away first so that none overwrites another
            a, b = os.dup(to_browser), os.dup(from_browser)
            os.dup2(a, 3)
            os.dup2(b, 4)

        self._process = subprocess.Popen([program(), *FLAGS, f"--user-data-dir={self._profile}", "about:blank"],
                                         preexec_fn=place_pipes, close_fds=False, stdin=subprocess.DEVNULL,
                                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        target = next(t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self._session = None
        self._session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Runtime", "Page", "Network", "Log"):
            self.call(domain + ".enable")
        self.call("Emulation.setDeviceMetricsOverride", width=self.size[0], height=self.size[1], deviceScaleFactor=1,
                  mobile=False)
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if self.dark else "light"}])
        return self

    def __exit__(self, *_):
        try:
            self._send("Browser.close")
            self._process.wait(10)
        except (OSError, subprocess.TimeoutExpired):
            self._process.kill()
            self._process.wait()
        os.close(self._write)
        os.close(self._read)
        shutil.rmtree(self._profile, ignore_errors=True)

    def _send(self, method, **parameters):
        self._id += 1
        message = {"id": self._id, "method": method, "params": parameters}
        if getattr(self, "_session", None):
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        return self._id

    def _receive(self, until):
        """One message, or None when time is up."""
        while b"\0" not in self._buffer:
            ready, _, _ = select.select([self._read], [], [], max(0, until - time.monotonic()))
            if not ready:
                return None
            chunk = os.read(self._read, 1 << 20)
            if not chunk:
                raise RuntimeError("the browser has gone")
            self._buffer += chunk
        message, self._buffer = self._buffer.split(b"\0", 1)
        return json.loads(message)

    def _note(self, message):
        method, parameters = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.problems.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
            self.problems.append(" ".join(str(a.get("value", a.get("description"))) for a in parameters["args"]))
        elif method == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
            # The driver of software WebGL complains about the browser's own reading of pixels, not about the page.
            if "GPU stall due to ReadPixels" not in parameters["entry"]["text"]:
                self.problems.append(parameters["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self.requests.append(parameters["request"]["url"][:200])

    def call(self, method, **parameters):
        wanted, until = self._send(method, **parameters), time.monotonic() + self.timeout
        while True:
            message = self._receive(until)
            if message is None:
                raise TimeoutError(f"{method} took more than {self.timeout} s")
            if message.get("id") == wanted:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']['message']}")
                return message["result"]
            self._note(message)

    def open(self, path, fragment=""):
        """Loads a file and waits until its script has run."""
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", url="file://" + os.path.abspath(path) + ("#" + fragment if fragment else ""))
        self.wait("document.readyState === 'complete' && Boolean(window.kreplView)")
        self.settle()

    def evaluate(self, expression):
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"].get("exception", {}).get("description", expression))
        return answer["result"].get("value")

    def wait(self, expression):
        until = time.monotonic() + self.timeout
        while not self.evaluate(expression):
            if time.monotonic() > until:
                raise TimeoutError(f"still not so: {expression}")
            time.sleep(0.03)

    def settle(self):
        """Waits until the picture is complete."""
        self.wait("kreplView.frame().count > 0 && !kreplView.frame().stale")
        self.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def key(self, key):
        text = {"text": key} if len(key) == 1 else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def screenshot(self, path):
        with open(path, "wb") as out:
            out.write(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))


class BrowserCase(unittest.TestCase):
    """Tests of pages in one browser, `cls.browser` of the size `cls.size`: no message in its console, and no request but for files."""

    size = (1200, 800)

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser(*cls.size)
        cls.browser.__enter__()

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()

    def setUp(self):
        self.browser.problems.clear()
        self.browser.requests.clear()

    def tearDown(self):
        self.assertEqual(self.browser.problems, [], "console")
        outside = [r for r in self.browser.requests if not r.startswith(("file:", "about:"))]
        self.assertEqual(outside, [], "requests")
