// Writes what the site knows of this repository: examples, schema, stories of diagnostics, and the page that leads to all.
//
//   node site.mjs SITE PEBO.wasm
import { existsSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { generator } from "./generator.mjs";

const [site, wasm] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const models = join(here, "../../models");
const ask = generator(wasm);
const read = (path) => readFileSync(path, "utf8");

const titled = (name, text) => ({ name, title: text.match(/^title: (.*)$/m)?.[1] ?? name, text });
const shipped = readdirSync(models)
  .filter((file) => file.endsWith(".yaml"))
  .map((file) => titled(file.slice(0, -5), read(join(models, file))))
  .sort((a, b) => a.title.localeCompare(b.title, "en"));
const recorded = titled("motor_bench", read(join(models, "recordings/motor_bench.yaml")));
const nothing = { ...titled("nothing", read(join(here, "page/nothing.yaml"))), title: "Start from nothing: without phi" };

const manual = existsSync(join(site, "manual/index.html"));
const known = {
  manual,
  first: "boost",
  examples: [nothing, ...shipped, recorded],
  schema: JSON.parse(ask({ what: "schema" })),
  stories: JSON.parse(ask({ what: "stories" })),
};
writeFileSync(join(site, "playground/site.json"), JSON.stringify(known));

const escaped = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
const report = ({ name, title }) =>
  `<li><a href="reports/${name}.html">${escaped(title)}</a> (<a href="playground/?model=${name}">try it</a>)</li>`;
writeFileSync(
  join(site, "index.html"),
  `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>pebo: proved state observers</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="playground/derivation.css">
</head>
<body>
<h1>pebo</h1>
<p>Version ${JSON.parse(ask({ what: "version" }))}. From the equations of a plant, an observer of its unmeasured states: proved, and written as Rust for firmware.</p>
<ul>
<li><a href="playground/">Try it in this browser</a>: nothing is installed, and nothing is sent</li>
${manual ? '<li><a href="manual/">The manual</a></li>' : ""}
</ul>
<h2>Proofs of the models that come with it</h2>
<ul>
${shipped.map(report).join("\n")}
</ul>
</body>
</html>
`,
);
