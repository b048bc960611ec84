// The page: each text is checked, and what follows from it is shown in the order in which it is known.

import * as answers from "./answer.js";
import { code } from "./code.js";
import { element, save } from "./dom.js";
import { Editor } from "./editor.js";
import { Engine, Stopped } from "./engine.js";
import { carried, fragment } from "./link.js";
import { Loop } from "./loop.js";
import { droppable, recording, replayed } from "./recording.js";

/** A pause in typing, in milliseconds: shorter ones are no pauses. */
const PAUSE = 120;

const status = document.getElementById("status");
const progress = document.getElementById("progress");
const examples = document.getElementById("examples");

let engine, editor, loop;
/** The story of each diagnostic by its code. */
let stories = {};
let scalar = "f64";
/** The last answer, and its text. */
let last = { text: null, accepted: false, name: "model" };
let table = null;
let later = 0;
/** The number of the text that is being worked on: what belongs to another is dropped. */
let turn = 0;

function say(text) {
  if (status.textContent !== text) status.textContent = text;
}

function fail(error) {
  if (error instanceof Stopped) return;
  progress.hidden = true;
  const memory = /memory|unreachable|allocation/i.test(error.message);
  say(
    memory
      ? "The prover ran out of memory: write shorter formulas, or use pebo-gen on a machine."
      : `The prover stopped: ${error.message}. This is a defect of pebo: please report it with the model.`,
  );
}

/** Asks, and tells of the progress of what takes time. */
async function ask(question, words) {
  const started = performance.now();
  const answer = await engine.ask(question, (done) => {
    progress.hidden = performance.now() - started < 300;
    progress.value = done;
    if (words && !progress.hidden) say(words);
  });
  progress.hidden = true;
  return answer;
}

/** Checks the text, then writes the code, then runs the loop. */
async function check() {
  const text = editor.text;
  const mine = ++turn;
  const current = () => mine === turn;
  say("Checking.");
  try {
    const answer = await ask({ what: "check", text });
    if (!current()) return;
    const name = answer.report.model;
    answer.diagnostics.forEach((diagnostic, index) => (diagnostic.replacement = answer.replacements[index]));
    last = { text, accepted: answer.standing === "accepted", name };
    answers.verdict(answer);
    answers.diagnostics(answer, text, editor);
    editor.diagnose(text, answer.diagnostics);
    answers.claims(answer, text, editor);
    document.body.dataset.standing = answer.standing;
    say(`${name || "The model"}: ${answer.standing === "malformed" ? "not a model yet" : answer.report.verdict}.`);
    performance.mark("verdict");
    if (!last.accepted) {
      for (const id of ["code", "recording", "transforms"]) document.getElementById(id).replaceChildren();
      loop.prepare(null);
      if (answer.standing === "refused" && answer.report.phi) await search(mine);
      return;
    }
    await write(mine);
    loop.prepare(answer.knobs);
    recording(replay, ownSignals);
    document.getElementById("own").hidden = !answer.knobs;
    if (answer.knobs) await run(mine);
    else document.getElementById("loop").replaceChildren(
      element("h2", {}, "Closed loop"),
      element("p", {}, "A section ", element("code", {}, "simulation"), " in the model describes one; every example has it."),
    );
    if (answer.report.phi?.origin === "found") await search(mine);
    else answers.offerTransforms(() => search(turn).catch(fail));
  } catch (error) {
    fail(error);
  }
}

async function write(mine) {
  const answer = await ask({ what: "emit", text: last.text, scalar });
  if (mine !== turn) return;
  if (answer.emitted) {
    code(last.name, answer.emitted, scalar, (wanted) => {
      scalar = wanted;
      write(turn).catch(fail);
    });
  } else {
    answers.diagnostics(answer, last.text, editor);
    document.getElementById("code").replaceChildren();
  }
}

/** The largest absolute value of each output. */
function sizes(csv, names) {
  const [head, ...rows] = csv.trim().split("\n").map((line) => line.split(","));
  return Object.fromEntries(
    names.map(([name]) => {
      const column = head.indexOf(name);
      return [name, rows.reduce((size, row) => Math.max(size, Math.abs(Number(row[column])) || 0), 0) || 1];
    }),
  );
}

async function run(mine) {
  const answer = await ask({ what: "simulate", text: last.text, ...loop.call, csv: true }, "Running the closed loop.");
  if (mine !== turn) return;
  if (answer.csv) {
    table = answer.csv;
    // Of the file's own loop: noise is measured by it.
    loop.sizes ??= sizes(table, loop.outputs);
  }
  loop.show(answer, () => save(`${last.name}.csv`, table, "text/csv"));
  performance.mark("figure");
  say(`${last.name}: ${answer.run ? "the closed loop was run." : "the closed loop could not be run."}`);
}

async function search(mine) {
  say("Searching for transforms.");
  const solution = await ask({ what: "solve", text: last.text ?? editor.text });
  if (mine !== turn) return;
  answers.transforms(solution, editor);
  say(`${last.name}: the search for transforms ended.`);
}

async function replay(name, csv) {
  if (!last.accepted) return say("Recorded data need a model that is accepted.");
  try {
    const mine = turn;
    say("Replaying.");
    const answer = await ask({ what: "replay", text: last.text, name, csv });
    if (mine !== turn) return;
    replayed(name, answer);
    say(answer.replay ? `${answer.replay.rows} rows were replayed.` : "The recording could not be replayed.");
    document.getElementById("recording").scrollIntoView({ block: "start" });
  } catch (error) {
    fail(error);
  }
}

const ownSignals = () => table && replay("closed-loop.csv", table);

function changed() {
  clearTimeout(later);
  // The answer in progress is about an older text.
  turn++;
  engine.stop();
  history.replaceState(null, "", location.pathname + location.search);
  later = setTimeout(check, PAUSE);
}

async function start() {
  const here = (name) => new URL(name, import.meta.url);
  const [loaded, known] = await Promise.all([
    Engine.load(here("./pebo.wasm")),
    fetch(here("./site.json")).then((response) => response.json()),
  ]);
  engine = loaded;
  stories = known.stories;
  document.getElementById("manual").hidden = !known.manual;
  for (const { name, title } of known.examples) examples.append(element("option", { value: name }, title));
  const of = (name) => known.examples.find((example) => example.name === name)?.text;
  loop = new Loop(() => run(turn).catch(fail));
  const asked = new URLSearchParams(location.search).get("model");
  const text = (await carried(location.hash)) ?? of(asked) ?? of(known.first);
  examples.value = known.examples.find((example) => example.text === text)?.name ?? "";
  editor = new Editor({ parent: document.getElementById("editor"), text, schema: known.schema, changed, explain: (code) => stories[code] });
  examples.addEventListener("change", () => of(examples.value) && (editor.text = of(examples.value)));
  window.addEventListener("hashchange", async () => {
    const text = await carried(location.hash);
    if (text !== null) editor.text = text;
  });
  const link = document.getElementById("link");
  link.addEventListener("click", async () => {
    history.replaceState(null, "", await fragment(editor.text));
    try {
      await navigator.clipboard.writeText(location.href);
      link.textContent = "Link copied";
    } catch {
      link.textContent = "Link is in the address";
    }
    setTimeout(() => (link.textContent = "Copy link"), 2000);
  });
  droppable(replay);
  await check();
}

start().catch((error) => say(`The page could not be loaded: ${error.message}.`));
