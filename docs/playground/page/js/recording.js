// Recorded data: a file of CSV that is dropped onto the page, or chosen.

import { element, markup, prose, save, short, show } from "./dom.js";

/** Shows where recorded data go; `take` is called with the name and the text of a file. */
export function recording(take, sample) {
  if (document.getElementById("log")) return;
  const read = async (files) => files[0] && take(files[0].name, await files[0].text());
  show(
    "recording",
    element("h2", {}, "Recorded data"),
    element(
      "p",
      { class: "drop" },
      "Drop a CSV onto the page, or choose one: its rows go through the observer. Columns are found by the names of outputs, inputs and ",
      element("code", {}, "t"),
      ", or by the section ",
      element("code", {}, "recording"),
      " of the model. The file stays on your machine. ",
      element("label", {}, "File ", element("input", { type: "file", id: "log", accept: ".csv,text/csv", onchange: (event) => read(event.target.files) })),
      " ",
      element("button", { type: "button", id: "own", onclick: sample }, "Use the signals of the closed loop"),
    ),
    element("div", { id: "replayed" }),
  );
}

/** Lets files be dropped anywhere. */
export function droppable(take) {
  const over = (event) => {
    if (![...event.dataTransfer.types].includes("Files")) return;
    event.preventDefault();
    document.body.classList.toggle("dropping", event.type === "dragover");
  };
  for (const type of ["dragover", "dragleave"]) document.addEventListener(type, over);
  document.addEventListener(
    "drop",
    async (event) => {
      const file = event.dataTransfer.files[0];
      document.body.classList.remove("dropping");
      if (!file) return;
      event.preventDefault();
      event.stopPropagation();
      take(file.name, await file.text());
    },
    true,
  );
}

/** Shows a replay, or why there is none. */
export function replayed(name, answer) {
  const place = document.getElementById("replayed");
  if (!place) return;
  const { replay } = answer;
  if (!replay) {
    const told = answer.diagnostics.filter(({ severity }) => severity === "error");
    const line = ({ message, notes, help }) => [
      element("p", {}, `${name}: `, prose(message)),
      notes.map((note) => element("p", {}, prose(note))),
      help ? element("p", {}, "Help: ", prose(help)) : null,
    ];
    place.replaceChildren(element("div", { class: "refused", role: "alert" }, told.flatMap(line).flat().filter(Boolean)));
    return;
  }
  const residual = ({ output, unit, score }) =>
    element(
      "tr",
      {},
      element("th", { scope: "row" }, output, unit ? ` in ${unit}` : ""),
      [short(score.rms), short(score.worst)].map((cell) => element("td", {}, cell)),
    );
  place.replaceChildren(
    element("p", {}, `${name}: ${replay.rows} rows from t = ${short(replay.start)} s to ${short(replay.summary.end)} s.`),
    element("figure", {}, element("div", { class: "wide paper", tabindex: "0", role: "region", "aria-label": "Figure of the recording" }, markup(answer.figure))),
    element(
      "div",
      { class: "wide" },
      element(
        "table",
        {},
        element("caption", {}, "What model and estimates do not explain of the outputs, in the last tenth"),
        element("thead", {}, element("tr", {}, ["output", "root mean square", "largest"].map((title) => element("th", { scope: "col" }, title)))),
        element("tbody", {}, replay.residuals.map(residual)),
      ),
    ),
    element("p", {}, element("button", { type: "button", onclick: () => save("estimates.csv", answer.csv, "text/csv") }, "Save the estimates as CSV")),
  );
}
