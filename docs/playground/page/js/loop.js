// The closed loop: its figure, and sliders that run it again without proving anything again.

import { element, markup, prose, save, short, show } from "./dom.js";

const SEED = 1;

/** The settings of a loop, as sliders; `run` is called with what differs from the file. */
export class Loop {
  #knobs = null;
  #values = {};
  /** The sizes of the outputs in the file's own loop. */
  sizes = null;
  #run;
  #later = 0;

  constructor(run) {
    this.#run = run;
  }

  /** The request for the loop beside the file: settings as of `--set`, and options of the run. */
  get call() {
    const values = this.#values;
    const [set, how] = [[], {}];
    if (values.noise) for (const [name] of this.#knobs.noise) set.push(`simulation.noise.${name}=${values.noise * (this.sizes?.[name] ?? 1)}`);
    if (values.mismatch && values.parameter) set.push(`simulation.plant.${values.parameter}=${1 + values.mismatch}*${values.parameter}`);
    if (values.step) set.push(`simulation.step=${this.#knobs.step * 2 ** values.step}`);
    if (values.initial !== undefined && values.initial !== 1) how.initial_error = values.initial;
    if (values.estimator && values.estimator !== this.#knobs.estimator) how.estimator = values.estimator;
    if (values.seed && values.seed !== SEED) how.seed = values.seed;
    return { set, how };
  }

  /** The outputs, each with the noise of the file. */
  get outputs() {
    return this.#knobs?.noise ?? [];
  }

  /** Shows the settings of another model; those that were moved are as in the file again, unless it is the same loop. */
  prepare(knobs) {
    const same = JSON.stringify(knobs) === JSON.stringify(this.#knobs);
    this.#knobs = knobs;
    if (same && document.getElementById("figure")) return;
    this.#values = {};
    this.sizes = null;
    if (!knobs) {
      show("loop");
      return;
    }
    const parameters = knobs.parameters.map((name) => element("option", { value: name }, name));
    const estimators = knobs.estimators.map((name) => element("option", { value: name, selected: name === knobs.estimator }, name));
    this.#values.parameter = knobs.parameters[0];
    const choose = (key) => (event) => this.#change({ [key]: event.target.value });
    show(
      "loop",
      element("h2", {}, "Closed loop"),
      element("p", { class: "hint" }, "The sliders set what the file does not say, or says otherwise; the proof stays."),
      element(
        "div",
        { class: "knobs" },
        this.#slider("noise", "Sensor noise", { min: 0, max: 12, value: 0 }, (at) => (at ? 1e-4 * 10 ** (at / 4) : 0), (value) =>
          value ? `${short(100 * value)} % of each output's largest value` : "as in the file",
        ),
        this.#slider("initial", "Error at the start", { min: 0, max: 40, value: 10 }, (at) => at / 10, (value) =>
          value === 1 ? "as in the file" : value === 0 ? "none: the state is known" : `${value} times that of the file`,
        ),
        knobs.parameters.length
          ? element(
              "div",
              { class: "pair" },
              element("label", {}, "True value of ", element("select", { id: "parameter", onchange: choose("parameter") }, parameters)),
              this.#slider("mismatch", "Mismatch", { min: -10, max: 10, value: 0 }, (at) => at / 20, (value) =>
                value ? `${value > 0 ? "+" : "−"}${Math.round(100 * Math.abs(value))} % of what the model says` : "as the model says",
              ),
            )
          : null,
        knobs.step
          ? this.#slider("step", "Step", { min: -2, max: 6, value: 0 }, (at) => at, (value) => `${short(knobs.step * 2 ** value)} s`)
          : null,
        element("label", {}, "Estimator ", element("select", { id: "estimator", onchange: choose("estimator") }, estimators)),
        element(
          "div",
          { class: "row" },
          element("button", { type: "button", id: "reset", onclick: () => this.#reset() }, "As in the file"),
          element("button", { type: "button", id: "dice", onclick: () => this.#change({ seed: (this.#values.seed ?? SEED) + 1 }) }, "Other noise"),
        ),
      ),
      element("div", { id: "figure" }),
    );
  }

  #slider(key, name, { min, max, value }, scale, words) {
    const told = element("output", { for: `knob-${key}` }, words(scale(value)));
    const input = element("input", { type: "range", id: `knob-${key}`, min, max, value, "aria-valuetext": words(scale(value)) });
    input.addEventListener("input", () => {
      const chosen = scale(Number(input.value));
      told.textContent = words(chosen);
      input.setAttribute("aria-valuetext", words(chosen));
      this.#change({ [key]: chosen });
    });
    return element("div", { class: "knob" }, element("label", { for: `knob-${key}` }, name), input, told);
  }

  #reset() {
    const knobs = this.#knobs;
    this.#knobs = null;
    document.getElementById("figure").remove();
    this.prepare(knobs);
    document.getElementById("reset").focus();
    this.#run();
  }

  #change(values) {
    Object.assign(this.#values, values);
    // As many as a hand moves past are one.
    clearTimeout(this.#later);
    this.#later = setTimeout(() => this.#run(), 80);
  }

  /** Shows a run. */
  show(answer, download) {
    const place = document.getElementById("figure");
    if (!place) return;
    const run = answer.run;
    if (!run) {
      const told = answer.diagnostics.filter(({ severity }) => severity === "error");
      const line = ({ message, help }) => element("p", {}, prose(message), help ? ["; ", prose(help)] : null);
      place.replaceChildren(element("div", { class: "refused" }, told.map(line)));
      return;
    }
    const row = ({ baseline, state, unit, first, last, settled }) =>
      element(
        "tr",
        {},
        element("th", { scope: "row" }, baseline ? `${baseline}.${state}` : state, unit ? ` in ${unit}` : ""),
        [short(first), short(last), settled == null ? "no" : `${short(settled)} s`].map((cell) => element("td", {}, cell)),
      );
    const told = answer.diagnostics.filter(({ code }) => code === "not-converged");
    const advice = ({ message, notes, help }) =>
      element("p", { class: "advice" }, prose([message, ...notes, help].filter(Boolean).join("; ")));
    place.replaceChildren(
      element("figure", {}, element("div", { class: "wide paper", tabindex: "0", role: "region", "aria-label": "Figure of the closed loop" }, markup(run.figure))),
      element("p", {}, "Estimator: ", element("code", { id: "used" }, run.estimator)),
      element(
        "div",
        { class: "wide" },
        element(
          "table",
          {},
          element("caption", {}, `Errors of the estimates, over ${short(run.end)} s`),
          element("thead", {}, element("tr", {}, ["error of", "at the start", "at the end", "settled to 1 %"].map((name) => element("th", { scope: "col" }, name)))),
          element("tbody", { id: "errors" }, run.summary.estimates.map(row)),
        ),
      ),
      ...told.map(advice),
      element("p", { class: "row" },
        element("button", { type: "button", onclick: () => save("figure.svg", run.figure, "image/svg+xml") }, "Save the figure"),
        element("button", { type: "button", onclick: download }, "Save the signals as CSV"),
      ),
    );
  }
}
