// The same answers from a native program and from WebAssembly: every model that is shipped, and every input that provokes
// a diagnostic, through every question. It is the project's test on a machine of 32 bits.
//
//   node same.mjs NATIVE PEBO.wasm [MODEL.yaml ..]      of all models, or of these; with these, no recording is needed
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { generator } from "./generator.mjs";

const [native, wasm, ...few] = process.argv.slice(2);
const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const texts = (folder, end) =>
  readdirSync(join(root, folder))
    .filter((file) => file.endsWith(end))
    .map((file) => [file, readFileSync(join(root, folder, file), "utf8")]);

const all = [...texts("models", ".yaml"), ...texts("models/recordings", ".yaml"), ...texts("docs/playground/page", ".yaml")];
const models = all.filter(([file]) => few.length === 0 || few.includes(file));
assert.ok(models.length >= few.length, `not all of ${few} are there`);
const mistakes = texts("pebo-gen/design/src/source/examples", ".txt");
const recording = texts("models/recordings", ".csv")[0][1].split("\n").slice(0, 400).join("\n");

const questions = [{ what: "version" }, { what: "schema" }, { what: "stories" }, { what: "nonsense" }];
for (const [name, text] of models) {
  questions.push({ what: "check", text }, { what: "emit", text, scalar: "f64" }, { what: "emit", text, scalar: "f32" });
  questions.push({ what: "solve", text });
  // As many samples as a second or less takes: what a sample does, and not how many there are.
  const step = Number(text.match(/^ *step: (\S+)/m)?.[1] ?? 1);
  for (const how of [{}, { initial_error: 0.5, estimator: "least-squares" }]) {
    questions.push({ what: "simulate", text, set: [`simulation.duration=${500 * step}`], how, csv: true });
  }
  questions.push({ what: "replay", text, name: "bench.csv", csv: recording });
}
for (const [, text] of mistakes) questions.push({ what: "check", text });

const lines = questions.map((question) => JSON.stringify(question));
const told = spawnSync(native, { input: lines.join("\n"), encoding: "utf8", maxBuffer: 2 ** 30 });
assert.equal(told.status, 0, told.stderr);
const expected = told.stdout.trimEnd().split("\n");
assert.equal(expected.length, questions.length);

/** What a run may differ by, of the largest value of a column: the sine of the C library and that of compiler-builtins differ
 * in the last place, and the integrator's choice of steps, whose own tolerance is finer, makes no more of it. */
const SLACK = 1e-6;

/** Numbers that were measured in floating point are compared as such; all else is to be the same to the last letter. */
function same(question, answer, native) {
  if (answer === native) return "same";
  if (!["emit", "simulate", "replay"].includes(question.what)) return null;
  const parts = [JSON.parse(answer), JSON.parse(native)].map((answer) => {
    const { csv, figure, run, replay, emitted, ...rest } = answer;
    // Losses of accuracy are quotients of rounding errors; their powers of two are in the text, where they matter.
    const { accuracy, ...written } = emitted ?? {};
    const states = run?.errors.map(({ state }) => state);
    return { csv, rest: JSON.stringify([rest, written, accuracy?.places, states, replay?.rows]) };
  });
  if (parts[0].rest !== parts[1].rest) return null;
  const tables = parts.map(({ csv }) => (csv ?? "").split("\n").map((line) => line.split(",")));
  if (tables[0].length !== tables[1].length || tables[0][0].join() !== tables[1][0].join()) return null;
  const near = tables[0][0].every((_, column) => {
    const values = tables.map((rows) => rows.slice(1).filter((row) => row.length > 1).map((row) => Number(row[column])));
    const size = Math.max(...values[1].map(Math.abs));
    return values[0].every((value, row) => Math.abs(value - values[1][row]) <= SLACK * size);
  });
  return near ? "near" : null;
}

const ask = generator(wasm);
const count = { same: 0, near: 0, different: 0 };
const kinds = {};
questions.forEach((question, index) => {
  const answer = ask(question).replaceAll("\n", " ");
  const kind = `${question.what} ${answer.match(/^\{"standing":"(\w+)"/)?.[1] ?? ""}`.trim();
  kinds[kind] = (kinds[kind] ?? 0) + 1;
  assert.equal(answer.startsWith("{\"error\""), question.what === "nonsense", kind);
  const verdict = same(question, answer, expected[index]) ?? "different";
  count[verdict]++;
  if (verdict !== "different") return;
  const at = [...answer].findIndex((letter, place) => letter !== expected[index][place]);
  console.error(`${question.what} of ${question.text?.match(/^model: (\w+)/m)?.[1]} differs at ${at}:`);
  console.error(`  native ${expected[index].slice(Math.max(0, at - 60), at + 60)}`);
  console.error(`  wasm   ${answer.slice(Math.max(0, at - 60), at + 60)}`);
});
// A test in which nothing is accepted, or nothing is run, shows nothing.
assert.ok(kinds["check accepted"] >= models.length, JSON.stringify(kinds));
assert.ok(kinds["emit accepted"] >= 2 * models.length, JSON.stringify(kinds));
assert.ok(kinds["simulate accepted"] >= 1.9 * models.length, JSON.stringify(kinds));
assert.ok(few.length > 0 || kinds["replay accepted"] >= 1, JSON.stringify(kinds));
console.log(Object.entries(kinds).map(([kind, count]) => `${count} ${kind}`).join(", "));
console.log(
  `${questions.length} answers: ${count.same} the same to the last letter, ${count.near} but for rounding, ` +
    `${count.different} different; ${(ask.memory() / 1e6).toFixed(0)} MB`,
);
process.exit(count.different ? 1 : 0);
