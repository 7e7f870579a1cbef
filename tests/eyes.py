"""Programs that look at what was written: they must be there in CI, which sets RUBGEN_TEST_EYES, else tests skip."""

import html
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
SOFTWARE_VULKAN = [*Path("/usr/share/vulkan/icd.d").glob("lvp_icd*.json")]


def need(found: object, what: str) -> None:
    """Skip where `what` is not installed; fail where it must be."""
    if not found:
        (pytest.fail if os.environ.get("RUBGEN_TEST_EYES") == "1" else pytest.skip)(f"needs {what}")


def narrow_page(page: Path, folder: Path, width: int) -> tuple[int, int, str]:
    """Widths of the page's content and of its frame of `width` pixels, and what the browser's console said.

    The page stands in a frame, for a browser's own window has a least width.
    """
    frame = folder / "frame.html"
    script = (
        "const f = document.querySelector('iframe');"
        "f.onload = () => { const d = f.contentDocument.documentElement;"
        " document.title = `${d.scrollWidth} ${d.clientWidth}`; };"
    )
    content = html.escape(page.read_text(encoding="utf-8"), quote=True)
    text = f'<title>none</title><iframe width="{width}" height="900" frameborder="0"></iframe><script>{script}</script>'
    frame.write_text(text.replace("<iframe ", f'<iframe data-x srcdoc="{content}" '), encoding="utf-8")
    done = _chromium(folder, "--dump-dom", "--virtual-time-budget=5000", frame.as_uri())
    found = re.search(r"<title>(\d+) (\d+)</title>", done.stdout)
    assert found, done.stdout[:300]
    console = "\n".join(line for line in done.stderr.splitlines() if "CONSOLE" in line)
    return int(found[1]), int(found[2]), console


def page_picture(page: Path, folder: Path, *options: str) -> Path:
    """A screenshot of the page."""
    picture = folder / "page.png"
    _chromium(folder, f"--screenshot={picture}", "--window-size=900,1600", *options, page.resolve().as_uri())
    return picture


def page_content(page: Path, folder: Path) -> str:
    """The page after its scripts have run, HTML, without a network."""
    rules = "--host-resolver-rules=MAP * ~NOTFOUND"
    return _chromium(folder, "--dump-dom", "--virtual-time-budget=30000", rules, page.resolve().as_uri()).stdout


def printed_page(page: Path, folder: Path) -> bytes:
    """The page as it would be printed, PDF."""
    _chromium(folder, f"--print-to-pdf={folder / 'page.pdf'}", page.resolve().as_uri())
    return (folder / "page.pdf").read_bytes()


def _chromium(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [
        str(CHROMIUM), "--headless=new", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader",
        "--hide-scrollbars", "--no-first-run",
        "--enable-logging=stderr", "--disable-dev-shm-usage", f"--user-data-dir={folder / 'profile'}", *arguments,
    ]  # fmt: skip
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
