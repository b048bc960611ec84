#!/usr/bin/env python3
"""Opens pages of `pebo-gen report` in headless Chromium, and says what is wrong with them.

    check.py PAGE.html ..                      exit status 1 if anything is
    check.py --screenshots FOLDER PAGE.html .. writes pictures of them instead

Each page is shown 360 and 1400 pixels wide, light and dark, with all that folds unfolded: nothing may leave the page but
inside a box that scrolls, figures are not cut and their letters have a size, formulas have a size, no name in them is broken over lines, their parts do
not overlap, fractions are fractions, headings are in order, links lead somewhere, figures have names, text has contrast
(measure.js). Before, it must be well-formed XML, and HTML without a parse error for html5lib, if that is installed.
"""

import argparse
import html
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

HERE = pathlib.Path(__file__).parent
WIDTHS = (360, 1400)
SCHEMES = ("light", "dark")


def chromium(*arguments):
    """Standard output of the browser."""
    command = ["chromium", "--no-sandbox", "--headless=new", "--disable-gpu", "--hide-scrollbars", *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=110).stdout


def malformed(page):
    """What parsers have against a page."""
    text = page.read_text(encoding="utf-8")
    try:
        xml.etree.ElementTree.fromstring(text)
    except xml.etree.ElementTree.ParseError as error:
        yield f"no XML: {error}"
    try:
        import html5lib
    except ImportError:
        return
    parser = html5lib.HTMLParser()
    parser.parse(text)
    for place, code, _ in parser.errors:
        yield f"no HTML: {code} at {place}"


def script(text):
    """A value as JavaScript inside an HTML element."""
    return json.dumps(text).replace("</", "<\\/").replace("<!--", "<\\!--")


def measured(pages):
    """What the browser has against pages: a map of names to maps of ways to show them to lists."""
    texts = {page.name: page.read_text(encoding="utf-8") for page in pages}
    measure = (HERE / "measure.js").read_text(encoding="utf-8")
    wrapper = f"<!DOCTYPE html><meta charset=utf-8><body><script>{measure}\nmeasure({script(texts)});</script>"
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "wrapper.html"
        path.write_text(wrapper, encoding="utf-8")
        # Virtual time ends when nothing is left to be done, and then the document is written.
        dom = chromium("--virtual-time-budget=600000", "--dump-dom", path.as_uri())
    result = re.search(r'<pre id="results">(.*?)</pre>', dom, re.DOTALL)
    if result is None:
        sys.exit("the browser did not come to the end of the pages")
    return json.loads(html.unescape(result.group(1)))


def screenshots(pages, folder):
    """Pictures of the top of each page in every way to show it."""
    folder.mkdir(parents=True, exist_ok=True)
    for page in pages:
        for width in WIDTHS:
            for scheme in SCHEMES:
                # A window of the browser is at least 500 wide: a frame is not.
                frame = (
                    f'<!DOCTYPE html><body style="margin: 0"><iframe style="border: 0; width: {width}px; height: 6000px; '
                    f'color-scheme: {scheme}" srcdoc="{html.escape(page.read_text(encoding="utf-8"))}"></iframe>'
                )
                with tempfile.TemporaryDirectory() as temporary:
                    path = pathlib.Path(temporary) / "frame.html"
                    path.write_text(frame, encoding="utf-8")
                    picture = folder / f"{page.stem}-{width}-{scheme}.png"
                    chromium(f"--window-size={max(width, 500)},6000", f"--screenshot={picture}", path.as_uri())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--screenshots", metavar="FOLDER", type=pathlib.Path)
    parser.add_argument("pages", metavar="PAGE.html", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    if arguments.screenshots:
        return screenshots(arguments.pages, arguments.screenshots)
    found = [f"{page.name}: {wrong}" for page in arguments.pages for wrong in malformed(page)]
    results = measured(arguments.pages)
    assert set(results) == {page.name for page in arguments.pages}
    for name, ways in results.items():
        assert set(ways) == {f"{width} px, {scheme}" for width in WIDTHS for scheme in SCHEMES}
        found += [f"{name}, {way}: {wrong}" for way, all_wrong in ways.items() for wrong in all_wrong]
    print("\n".join(found) or f"{len(results)} pages, each at {WIDTHS[0]} and {WIDTHS[1]} pixels, light and dark: in order")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
