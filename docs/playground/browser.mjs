// The page in real browsers, as a visitor uses it: types a mistake, mends it by its quick fix, sees the model accepted,
// moves a slider, saves the code, replays, follows a link.
//
//   node browser.mjs SITE [--screenshots FOLDER] [chrome] [firefox]
import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import puppeteer from "puppeteer-core";

import { serve } from "./serve.mjs";

const [site, ...rest] = process.argv.slice(2);
const pictures = rest[0] === "--screenshots" ? rest.splice(0, 2)[1] : null;
const browsers = rest.length ? rest : ["chrome", "firefox"];
const PROGRAMS = { chrome: "/usr/bin/chromium", firefox: "/usr/bin/firefox-esr" };
/** The time that a loaded machine may take for a proof or a run. */
const PATIENCE = 60_000;

const server = await serve(site);
const playground = `${server.address}playground/`;

function launch(browser, downloads) {
  return puppeteer.launch({
    browser,
    executablePath: PROGRAMS[browser],
    // Without a display, and as root.
    headless: true,
    args: browser === "chrome" ? ["--no-sandbox", "--disable-gpu"] : [],
    extraPrefsFirefox: {
      "browser.download.dir": downloads,
      "browser.download.folderList": 2,
      "browser.helperApps.neverAsk.saveToDisk": "text/rust,text/plain,text/csv,image/svg+xml",
      "browser.download.alwaysOpenPanel": false,
    },
  });
}

const standing = (page, wanted) =>
  page.waitForFunction((wanted) => document.body.dataset.standing === wanted, { timeout: PATIENCE }, wanted);
const text = (page, selector) => page.$eval(selector, (found) => found.textContent);
const appears = (page, selector) => page.waitForSelector(selector, { timeout: PATIENCE });
/** Waits for the words of an element: much of an answer arrives after the rest. */
const shows = (page, selector, words) =>
  page.waitForFunction(
    (selector, words) => new RegExp(words).test(document.querySelector(selector)?.textContent ?? ""),
    { timeout: PATIENCE },
    selector,
    words.source,
  );
/** The text of the status line. */
const said = (page, words) =>
  page.waitForFunction(
    (words) => document.getElementById("status").textContent.includes(words),
    { timeout: PATIENCE },
    words,
  );

/** Opens an address, and notes what goes wrong there, and what is asked of whom. */
async function open(browser, address) {
  const page = await browser.newPage();
  page.wrong = [];
  page.on("pageerror", (error) => page.wrong.push(`error: ${error.message}`));
  page.on("console", (message) => message.type() === "error" && page.wrong.push(`console: ${message.text()}`));
  page.on("request", (request) => {
    const url = request.url();
    if (/^(blob|data):/.test(url)) return;
    if (!url.startsWith(server.address) || request.method() !== "GET") page.wrong.push(`sends: ${url}`);
  });
  await page.setViewport({ width: 1366, height: 900 });
  await page.goto(address);
  return page;
}

async function type(page, keys, words) {
  await page.focus(".cm-content");
  await page.keyboard.down("Control");
  await page.keyboard.press(keys);
  await page.keyboard.up("Control");
  await page.keyboard.type(words);
  // Nothing of what is proposed while typing is wanted.
  await page.keyboard.press("Escape");
}

const chapters = {
  async "a mistake is underlined, mended by its quick fix, and the model is accepted"(browser) {
    const page = await open(browser, `${playground}?model=nothing`);
    await standing(page, "accepted");
    await type(page, "Home", "# naïve 😀\nreferense: me");
    await page.keyboard.press("Enter");
    await standing(page, "malformed");
    await appears(page, ".cm-lintRange-error");
    // Bytes are not units: a comment with other letters stands before it.
    await shows(page, ".cm-lintRange-error", /^referense$/);
    await shows(page, "#diagnostics", /did you mean reference\?/);
    await page.click(".diagnostics .story summary");
    await shows(page, ".diagnostics .story", /what to do instead/);
    await page.click("button.fix");
    await standing(page, "accepted");
    assert.match(await page.$eval(".cm-content", (editor) => editor.innerText), /^reference: me$/m);
    await page.waitForFunction(() => !document.querySelector(".cm-lintRange-error"), { timeout: PATIENCE });
    return page;
  },

  async "a transform is found, listed, and can be chosen"(browser) {
    const page = await open(browser, `${playground}?model=nothing`);
    await standing(page, "accepted");
    await shows(page, "#verdict", /found by a search/);
    await appears(page, ".candidates tbody tr");
    await page.click(".candidates button");
    await page.waitForFunction(() => /^phi: \[/m.test(document.querySelector(".cm-content").innerText), { timeout: PATIENCE });
    await standing(page, "accepted");
    await page.waitForFunction(() => !/found by a search/.test(document.getElementById("verdict").textContent), {
      timeout: PATIENCE,
    });
    return page;
  },

  async "a claim unfolds to mathematics and marks its lines"(browser) {
    const page = await open(browser, `${playground}?model=cuk`);
    await standing(page, "accepted");
    await page.click('[data-id="cascade"] summary');
    await appears(page, '[data-id="cascade"] math');
    await appears(page, ".marked");
    await page.waitForFunction(() => document.querySelectorAll(".marked").length >= 3, { timeout: PATIENCE });
    const size = await page.$eval('[data-id="cascade"] math mfrac', (fraction) => fraction.getBoundingClientRect().height);
    assert.ok(size > 10, `a fraction is ${size} pixels high`);
    return page;
  },

  async "a refuted claim shows its witness and what would mend it"(browser) {
    const page = await open(browser, `${playground}?model=boost`);
    await standing(page, "accepted");
    await page.focus(".cm-content");
    const model = "model: m\nx: [p]\ny: [q]\nf_x: {p: -p^3}\nf_y: {q: p}\nphi: [p]\n";
    await page.keyboard.down("Control");
    await page.keyboard.press("a");
    await page.keyboard.up("Control");
    // As from the clipboard: typed letters would be completed and indented.
    await page.evaluate((words) => document.execCommand("insertText", false, words), model);
    await standing(page, "refused");
    await page.click('[data-id="cascade"] summary');
    await appears(page, ".witness table");
    await appears(page, "#transforms table, #transforms p");
    return page;
  },

  async "sliders run the loop again, and the code can be saved"(browser, downloads) {
    const page = await open(browser, `${playground}?model=boost`);
    await appears(page, "#figure svg");
    const before = await text(page, "#errors");
    await page.focus("#knob-noise");
    for (let step = 0; step < 8; step++) await page.keyboard.press("ArrowRight");
    const moved = (before) =>
      page.waitForFunction((before) => document.getElementById("errors")?.textContent !== before, { timeout: PATIENCE }, before);
    await moved(before);
    const noisy = await text(page, "#errors");
    await page.select("#estimator", "least-squares");
    await moved(noisy);
    await shows(page, "#used", /^least-squares, covariance/);
    await page.click("#reset");
    await page.waitForFunction((before) => document.getElementById("errors")?.textContent === before, { timeout: PATIENCE }, before);
    const double = await text(page, "#module pre");
    await page.click('input[value="f32"]');
    const other = (double) => document.querySelector("#module pre").textContent !== double;
    await page.waitForFunction(other, { timeout: PATIENCE }, double);
    assert.equal(await page.evaluate(() => document.activeElement.value), "f32");
    await page.click("#download");
    const path = join(downloads, "boost.rs");
    for (const end = Date.now() + PATIENCE; Date.now() < end; await new Promise((wait) => setTimeout(wait, 50))) {
      if (readdirSync(downloads).includes("boost.rs") && readFileSync(path, "utf8")) break;
    }
    assert.equal(readFileSync(path, "utf8"), await text(page, "#module pre"));
    return page;
  },

  async "recorded data are replayed"(browser) {
    const page = await open(browser, `${playground}?model=boost`);
    await appears(page, "#figure svg");
    await page.click("#own");
    await appears(page, "#replayed svg");
    await shows(page, "#replayed", /1001 rows/);
    // A file that is dropped, and is no recording.
    await page.evaluate(() => {
      const data = new DataTransfer();
      data.items.add(new File(["t,w\n0,1\n"], "log.csv", { type: "text/csv" }));
      document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
    });
    await appears(page, "#replayed .refused");
    await shows(page, "#replayed", /log\.csv/);
    return page;
  },

  async "a link carries the model"(browser) {
    const page = await open(browser, `${playground}?model=boost`);
    await standing(page, "accepted");
    await type(page, "Home", "# mine: ÄÖ 😀");
    await page.keyboard.press("Enter");
    await page.click("#link");
    await page.waitForFunction(() => location.hash.length > 10, { timeout: PATIENCE });
    const other = await open(browser, page.url());
    await standing(other, "accepted");
    assert.match(await page.$eval(".cm-content", (editor) => editor.innerText), /^# mine: ÄÖ 😀/);
    await page.close();
    return other;
  },

  async "a long run is stopped by a newer text, and the page is never frozen"(browser) {
    const page = await open(browser, `${playground}?model=levitated_ball`);
    await said(page, "Running");
    // Frames go on while it runs.
    const gap = await page.evaluate(
      () =>
        new Promise((done) => {
          let last = performance.now();
          let longest = 0;
          const end = last + 500;
          const frame = (now) => {
            longest = Math.max(longest, now - last);
            last = now;
            now < end ? requestAnimationFrame(frame) : done(longest);
          };
          requestAnimationFrame(frame);
        }),
    );
    console.log(`    longest gap between frames during a run: ${gap.toFixed(0)} ms`);
    await page.select("#examples", "boost");
    await page.waitForFunction(() => /^boost/.test(document.getElementById("status").textContent), { timeout: PATIENCE });
    await appears(page, "#figure svg");
    return page;
  },

  async "everything has a name, is reached by keys, and fits"(browser) {
    const page = await open(browser, `${playground}?model=cuk`);
    await appears(page, "#figure svg");
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.className), "skip");
    const nameless = await page.$$eval("button, input, select, a[href], [role=region], [role=textbox]", (all) =>
      all
        .filter((one) => !one.closest(".cm-panels"))
        .filter(
          (one) =>
            !(one.textContent.trim() || one.ariaLabel || one.getAttribute("aria-label") || one.labels?.[0]?.textContent.trim()),
        )
        .map((one) => one.outerHTML.slice(0, 80)),
    );
    assert.deepEqual(nameless, []);
    await page.$$eval("details", (all) => all.forEach((one) => (one.open = true)));
    for (const width of [360, 768, 1366, 1920]) {
      await page.setViewport({ width, height: 900 });
      const [wide, room] = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
      assert.ok(wide <= room, `${wide} pixels in ${room}`);
      const beyond = await page.$$eval("#answer *", (all) =>
        all
          .filter((one) => !one.closest(".wide > *, pre > *, svg, math") && one.getBoundingClientRect().width > 0)
          .filter((one) => one.getBoundingClientRect().right > window.innerWidth + 1)
          .map((one) => one.outerHTML.slice(0, 80)),
      );
      assert.deepEqual(beyond, [], `at ${width} pixels`);
    }
    return page;
  },

  async "the pages of the site lead to one another"(browser) {
    const page = await open(browser, server.address);
    const links = await page.$$eval("a[href]", (all) => all.map((one) => one.href));
    assert.ok(links.length > 20);
    for (const link of links) assert.equal((await fetch(link)).status, 200, link);
    return page;
  },
};

/** Pictures of what a visitor sees, to be looked at. */
async function screenshots(browser, folder) {
  mkdirSync(folder, { recursive: true });
  const scenes = {
    found: async (page) => appears(page, ".candidates"),
    mistake: async (page) => {
      await standing(page, "accepted");
      await type(page, "Home", "referense: me");
      await page.keyboard.press("Enter");
      await standing(page, "malformed");
      await appears(page, ".cm-lintRange-error");
      await page.hover(".cm-lintRange-error");
      await appears(page, ".cm-tooltip");
    },
    figure: async (page) => {
      await appears(page, "#figure svg");
      await page.$eval("#loop", (loop) => loop.scrollIntoView());
    },
    claim: async (page) => {
      await standing(page, "accepted");
      await appears(page, "#figure svg");
      await page.click('[data-id="cascade"] summary');
      await appears(page, ".marked");
    },
  };
  for (const [scene, prepare] of Object.entries(scenes)) {
    for (const width of [360, 1366]) {
      for (const scheme of ["light", "dark"]) {
        const page = await browser.newPage();
        await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
        await page.setViewport({ width, height: width < 500 ? 1600 : 900 });
        await page.goto(`${playground}?model=${["found", "mistake"].includes(scene) ? "nothing" : "cuk"}`);
        await prepare(page);
        await page.screenshot({ path: join(folder, `${scene}-${width}-${scheme}.png`) });
        await page.close();
      }
    }
  }
}

let failed = 0;
for (const name of browsers) {
  const downloads = mkdtempSync(join(tmpdir(), "pebo-downloads-"));
  const browser = await launch(name, downloads);
  try {
    console.log(await browser.version());
    if (name === "chrome") {
      const session = await browser.target().createCDPSession();
      await session.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: downloads });
    }
    if (pictures) await screenshots(browser, join(pictures, name));
    else
      for (const [chapter, act] of Object.entries(chapters)) {
        const started = Date.now();
        try {
          const page = await act(browser, downloads);
          assert.deepEqual(page.wrong, []);
          await page.close();
          console.log(`  ok: ${chapter} (${((Date.now() - started) / 1000).toFixed(1)} s)`);
        } catch (error) {
          failed++;
          console.error(`  FAILED: ${chapter}\n${error.stack}`);
        }
      }
  } finally {
    await browser.close();
    rmSync(downloads, { recursive: true });
  }
}
server.close();
process.exit(failed ? 1 : 0);
