// The generator's answer on a model: verdict, diagnostics, claims with derivations, transforms to choose from.

import { element, markup, prose, show } from "./dom.js";
import { fix, story } from "./editor.js";
import { range } from "./places.js";

const MEANING = {
  accepted: "every claim is proved, and the code below follows",
  rejected: "a claim is false, and no code is written",
  undecided: "a claim is neither proved nor refuted, and no code is written",
};

const SIGN = { proved: "✓", refuted: "✗", undecided: "?", skipped: "–" };

const WORDS = {
  accepted: "proved",
  rejected: "refuted",
  undecided: "undecided",
};

/** The verdict on the model. */
export function verdict(answer) {
  if (answer.standing === "malformed") {
    show(
      "verdict",
      element("p", { class: "verdict", "data-verdict": "refuted" }, element("strong", {}, "not a model yet"), ": see below"),
    );
    return;
  }
  const word = answer.report.verdict;
  const phi = answer.report.phi;
  const found = phi?.origin === "found" ? `. The transform phi = (${phi.z.join(", ")}) was found by a search` : "";
  show(
    "verdict",
    element(
      "p",
      { class: "verdict", "data-verdict": WORDS[word] },
      element("strong", {}, word),
      `: ${MEANING[word]}${found}.`,
    ),
    answer.standing === "accepted" ? contents() : null,
  );
}

/** Consequences of a proof, further down. */
function contents() {
  const link = ([id, name]) => {
    const go = (event) => {
      // The fragment of the address is for models.
      event.preventDefault();
      document.getElementById(id).scrollIntoView({ block: "start" });
    };
    return element("li", {}, element("a", { href: `#${id}`, onclick: go }, name));
  };
  const parts = [["claims", "Claims"], ["transforms", "Transforms"], ["loop", "Closed loop"], ["code", "Code"], ["recording", "Recorded data"]];
  return element("nav", { "aria-label": "Contents", class: "contents" }, element("ul", {}, parts.map(link)));
}

/** The diagnostics as a list; each leads to its place. */
export function diagnostics(answer, text, editor) {
  if (answer.diagnostics.length === 0) return show("diagnostics");
  const item = (diagnostic) => {
    const { severity, code, message, primary, notes, help } = diagnostic;
    const place = range(text, primary.span);
    const mend = fix(diagnostic, text);
    const line = place ? text.slice(0, place.from).split("\n").length : null;
    return element(
      "li",
      { "data-severity": severity },
      element(
        "p",
        {},
        element("strong", {}, severity),
        " ",
        place ? element("button", { type: "button", class: "place", onclick: () => editor.go(place) }, `line ${line}`) : null,
        " ",
        prose(message),
        primary.text ? [" (", prose(primary.text), ")"] : null,
      ),
      notes.length ? element("ul", {}, notes.map((note) => element("li", {}, prose(note)))) : null,
      help ? element("p", { class: "help" }, "Help: ", prose(help)) : null,
      mend
        ? element("button", { type: "button", class: "fix", onclick: () => editor.apply(mend) }, prose(mend.name))
        : null,
      story(code, editor.explain),
    );
  };
  show("diagnostics", element("h2", {}, "Diagnostics"), element("ul", { class: "diagnostics" }, answer.diagnostics.map(item)));
}

const CLAIMS = {
  cascade: ["1 Cascade", "the rate of the transform holds known signals alone"],
  "left-inverse": ["2 Left inverse", "the states are read off the transform and the outputs"],
  regression: ["3 Regression", "the unknown constants stand in equations between known signals"],
  identifiability: ["4 Identifiability", "these equations determine the unknown constants"],
};

const OTHERS = {
  plant: ["Plant", "signals, parameters and equations as they were read"],
  transform: ["Transform", "z = phi(x, y)"],
  conditions: ["Conditions and remarks", "what the proofs rest on, and what to know in use"],
  code: ["Cost and accuracy", "of the emitted code"],
};

/** A witness against a claim: a point of the domain, with the values of what should vanish there. */
function witness(found) {
  if (!found) return null;
  const row = ([name, value]) =>
    element("tr", {}, element("th", { scope: "row" }, element("code", {}, name)), element("td", {}, element("code", {}, value)));
  const points = found.compared?.points ?? [found.point];
  const expression = found.compared?.expression ?? found.expression;
  const values = found.compared?.values ?? [found.bounds];
  return element(
    "div",
    { class: "witness" },
    element("p", {}, "Witness: at ", points.length > 1 ? "these points" : "this point", " of the domain the claim is false."),
    points.map((point, index) =>
      element(
        "div",
        { class: "wide" },
        element(
          "table",
          {},
          element("caption", {}, element("code", {}, expression), ` lies in [${values[index].join(", ")}]`),
          element("tbody", {}, Object.entries(point).map(row)),
        ),
      ),
    ),
  );
}

/** The sections of the derivation, those that were open stay open. */
export function claims(answer, text, editor) {
  const open = new Set([...document.querySelectorAll("#claims details[open]")].map((details) => details.dataset.id));
  const section = ({ id, verdict, html, places }) => {
    const [title, meaning] = CLAIMS[id] ?? OTHERS[id];
    const content = element("div", { class: "derivation" });
    const fill = () => {
      if (content.childNodes.length) return;
      const part = markup(html);
      // The summary is the heading.
      for (const heading of part.querySelectorAll("section:first-of-type > h2")) heading.remove();
      for (const own of part.querySelectorAll("[id]")) own.removeAttribute("id");
      content.append(witness(answer.report[id.replace("-", "_")]?.witness) ?? "", part);
    };
    const details = element(
      "details",
      { "data-id": id, "data-verdict": verdict, open: open.has(id) },
      element(
        "summary",
        {},
        verdict ? element("span", { class: "sign", "aria-hidden": "true" }, SIGN[verdict]) : null,
        element("strong", {}, title),
        verdict ? element("span", { class: "word" }, verdict) : null,
        element("span", { class: "meaning" }, meaning),
      ),
      content,
    );
    const marks = () => editor.mark(text, details.open ? places : []);
    if (open.has(id)) fill();
    details.querySelector("summary").addEventListener("click", () => setTimeout(marks));
    details.addEventListener("toggle", () => details.open && fill());
    return details;
  };
  const sections = answer.sections ?? [];
  const of = (names) => sections.filter(({ id }) => id in names).map(section);
  if (sections.length === 0) return show("claims");
  show(
    "claims",
    element("h2", {}, "Claims"),
    element("p", { class: "hint" }, "Unfold a claim for its derivation; its lines are marked in the model."),
    of(CLAIMS),
    element("h2", {}, "What they are about"),
    of(OTHERS),
  );
}

/** The transforms that a search found, to choose from. */
export function transforms(solution, editor) {
  const { candidates, bound, verdict, tried } = solution.report;
  const row = (candidate, index) => {
    const text = solution.texts[index];
    return element(
      "tr",
      {},
      element("th", { scope: "row" }, element("code", {}, `[${candidate.phi.join(", ")}]`)),
      element("td", {}, candidate.class === "gpebo" ? "generalised" : "plain"),
      element("td", { "data-verdict": WORDS[candidate.verdict] }, candidate.verdict),
      element("td", {}, candidate.identifiability ?? ""),
      element(
        "td",
        {},
        text && text !== editor.text
          ? element("button", { type: "button", onclick: () => (editor.text = text) }, "Use")
          : text
            ? "in use"
            : "",
      ),
    );
  };
  const head = ["phi", "cascade", "verdict", "identified", "choose"];
  show(
    "transforms",
    element("h2", {}, "Transforms"),
    candidates.length
      ? element(
          "div",
          { class: "wide" },
          element(
            "table",
            { class: "candidates" },
            element("caption", {}, "Found by the search, best first; each is proved like any other"),
            element("thead", {}, element("tr", {}, head.map((name) => element("th", { scope: "col" }, name)))),
            element("tbody", {}, candidates.map(row)),
          ),
        )
      : element("p", {}, verdict === "none" ? "There is none." : "None was found within the limit."),
    bound && verdict !== "found"
      ? element(
          "p",
          {},
          `Of the ${bound.states} states, transforms of the class ${bound.class} can hold at most ${bound.rank} independent `,
          `combinations${bound.proved ? ", which is proved" : ""}.`,
        )
      : null,
    tried.length && verdict !== "found"
      ? element("details", {}, element("summary", {}, "What was tried"), element("ul", {}, tried.map((line) => element("li", {}, line))))
      : null,
  );
}

/** A button that starts the search. */
export function offerTransforms(search) {
  show("transforms", element("p", {}, element("button", { type: "button", id: "search", onclick: search }, "Search for other transforms")));
}
