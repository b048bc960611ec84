// Waiting times of a visitor, beside the native program: medians of ten.
//
//   node measure.mjs SITE NATIVE [MODEL ..]
//
// NATIVE is the example `playground` of the package `tests`, built for release.
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import puppeteer from "puppeteer-core";

import { generator } from "./generator.mjs";
import { serve } from "./serve.mjs";

const [site, native, ...asked] = process.argv.slice(2);
const models = asked.length ? asked : ["boost", "cuk", "motor_flux"];
const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const TIMES = 10;
const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];
const server = await serve(site);
const browser = await puppeteer.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
const mark = (page, name) =>
  page.waitForFunction((name) => performance.getEntriesByName(name).length, { timeout: 120_000 }, name);
const at = (page, name) => page.evaluate((name) => performance.getEntriesByName(name).at(-1).startTime, name);

/** Seconds that the native program takes for questions. */
function natively(questions) {
  const input = questions.map((question) => JSON.stringify(question)).join("\n");
  const started = performance.now();
  const { status, error, stderr } = spawnSync(native, { input, maxBuffer: 2 ** 30 });
  const took = performance.now() - started;
  if (status !== 0) throw error ?? new Error(`${native} is not the native side of the page: ${stderr}`);
  return took;
}

console.log("milliseconds     first verdict   on reload   figure   edit   native: check   emit and run   memory");
for (const model of models) {
  const text = readFileSync(join(root, `models/${model}.yaml`), "utf8");
  const found = { first: [], again: [], figure: [], edit: [], check: [], run: [] };
  for (let time = 0; time < TIMES; time++) {
    const context = await browser.createBrowserContext();
    const page = await context.newPage();
    const open = async () => {
      await page.goto(`${server.address}playground/?model=${model}`);
      await mark(page, "verdict");
    };
    await open();
    found.first.push(await at(page, "verdict"));
    await mark(page, "figure");
    found.figure.push(await at(page, "figure"));
    // A letter in a comment: everything is proved again. The pause that ends typing is not counted.
    await page.focus(".cm-content");
    await page.evaluate(() => performance.clearMarks());
    await page.keyboard.type("#");
    const typed = await page.evaluate(() => performance.now());
    await mark(page, "verdict");
    found.edit.push((await at(page, "verdict")) - typed - 120);
    await open();
    found.again.push(await at(page, "verdict"));
    await context.close();
    const check = { what: "check", text };
    const [one, both] = [natively([check]), natively([check, { what: "emit", text, scalar: "f64" }, { what: "simulate", text }])];
    found.check.push(one);
    found.run.push(both - one);
  }
  const ask = generator(join(site, "playground/pebo.wasm"));
  for (const question of [{ what: "check" }, { what: "emit", scalar: "f64" }, { what: "simulate" }, { what: "solve" }]) {
    ask({ ...question, text });
  }
  const ms = (values) => median(values).toFixed(0);
  console.log(
    `${model.padEnd(16)} ${ms(found.first).padStart(13)} ${ms(found.again).padStart(11)} ${ms(found.figure).padStart(8)} ` +
      `${ms(found.edit).padStart(6)} ${ms(found.check).padStart(15)} ${ms(found.run).padStart(14)} ` +
      `${(ask.memory() / 1e6).toFixed(0).padStart(5)} MB`,
  );
}
await browser.close();
server.close();
