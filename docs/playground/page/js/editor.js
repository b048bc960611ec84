// The model file in an editor: mistakes at their places with quick fixes, completion, and what keys are.

import { autocompletion } from "@codemirror/autocomplete";
import { indentWithTab } from "@codemirror/commands";
import { yaml } from "@codemirror/lang-yaml";
import { HighlightStyle, syntaxHighlighting, syntaxTree } from "@codemirror/language";
import { lintGutter, setDiagnostics } from "@codemirror/lint";
import { EditorState, StateEffect, StateField } from "@codemirror/state";
import { Decoration, EditorView, hoverTooltip, keymap } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { basicSetup } from "codemirror";

import { element, prose } from "./dom.js";
import { range } from "./places.js";
import { about, choices, keys } from "./schema.js";

const FUNCTIONS =
  "sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp log sqrt abs sign min max sat pi".split(" ");

/** The keys above a place, outermost first; null stands for an item of a list. */
function path(state, place) {
  const found = [];
  for (let node = syntaxTree(state).resolveInner(place, -1); node; node = node.parent) {
    if (node.name === "Pair") {
      const key = node.getChild("Key");
      if (key && place > key.to) found.unshift(state.sliceDoc(key.from, key.to).trim());
    } else if (node.name === "Item") {
      found.unshift(null);
    }
  }
  return found;
}

/** The names that the model declares. */
function declared(state) {
  const text = state.doc.toString();
  const names = new Set();
  for (const [, list] of text.matchAll(/^(?:x|y|u|w):\s*\[([^\]]*)\]/gm)) {
    for (const name of list.split(",")) names.add(name.trim());
  }
  for (const [, map] of text.matchAll(/^(?:parameters|define):\s*\{([^}]*)\}/gm)) {
    for (const [, name] of map.matchAll(/([A-Za-z_]\w*)\s*:/g)) names.add(name);
  }
  return [...names].filter(Boolean);
}

/** The keys that are possible at the cursor. */
function completion(schema) {
  return (context) => {
    const word = context.matchBefore(/[\w-]*/);
    if (word.from === word.to && !context.explicit) return null;
    const line = context.state.doc.lineAt(context.pos);
    const before = context.state.sliceDoc(line.from, word.from);
    let above = path(context.state, word.from);
    const indent = before.match(/^\s*/)[0].length;
    // At the start of a line the tree says what the line would continue, not what it would begin.
    if (/^\s*$/.test(before)) above = indented(context.state, line.number, indent);
    const options = [];
    const value = /:\s+[^{[]*$/.test(before) || /[[(*+\-/^]\s*$/.test(before);
    if (!value) {
      for (const [key, node] of keys(schema, above)) {
        const detail = node.examples?.length ? JSON.stringify(node.examples[0]).slice(0, 40) : undefined;
        options.push({ label: key, type: "property", info: node.description, detail, apply: `${key}: ` });
      }
    }
    for (const choice of choices(schema, above)) options.push({ label: choice, type: "enum" });
    if (value || options.length === 0) {
      for (const name of declared(context.state)) options.push({ label: name, type: "variable" });
      for (const name of FUNCTIONS) options.push({ label: name, type: "function" });
    }
    return options.length ? { from: word.from, options, validFor: /^[\w-]*$/ } : null;
  };
}

/** The keys above a line that is indented so far, by the lines before it. */
function indented(state, number, indent) {
  const above = [];
  for (let depth = indent; number > 1 && depth > 0; ) {
    const text = state.doc.line(--number).text;
    const [, spaces, key] = text.match(/^(\s*)(?:- )?([\w-]+):/) ?? [];
    if (key && spaces.length < depth) {
      above.unshift(key);
      depth = spaces.length;
    }
  }
  return above;
}

/** The description of a key under the pointer. */
function hover(schema) {
  return hoverTooltip((view, place) => {
    for (let node = syntaxTree(view.state).resolveInner(place, 1); node; node = node.parent) {
      if (node.name !== "Key") continue;
      const key = view.state.sliceDoc(node.from, node.to).trim();
      const words = about(schema, [...path(view.state, node.from), key]);
      if (!words) return null;
      const create = () => ({ dom: element("div", { class: "tip" }, element("code", {}, key), ": ", words) });
      return { pos: node.from, end: node.to, above: true, create };
    }
    return null;
  });
}

const mark = StateEffect.define();

/** Lines that a claim is about. */
const marked = StateField.define({
  create: () => Decoration.none,
  update(lines, transaction) {
    for (const effect of transaction.effects) if (effect.is(mark)) return effect.value;
    return transaction.docChanged ? Decoration.none : lines;
  },
  provide: (field) => EditorView.decorations.from(field),
});

const colours = HighlightStyle.define([
  { tag: tags.comment, class: "tok-comment" },
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], class: "tok-key" },
  { tag: tags.string, class: "tok-string" },
]);

/** The story of a diagnostic, written when it is unfolded. */
export function story(code, explain) {
  const details = element("details", { class: "story" }, element("summary", {}, `What is ${code}?`));
  details.addEventListener(
    "toggle",
    () => {
      const told = explain(code);
      details.append(
        ...told.explanation.split("\n\n").map((part) => element("p", {}, prose(part))),
        element("p", {}, "An input that provokes it, with what to do instead:"),
        element("pre", { tabindex: "0" }, told.example),
      );
      if (told.paper) details.append(element("p", {}, `In Ortega et al. 2015: ${told.paper}.`));
    },
    { once: true },
  );
  return details;
}

/** The quick fix of a diagnostic; null if there is none that needs no thought. */
export function fix(diagnostic, text) {
  const insert = diagnostic.replacement;
  return insert ? { ...range(text, diagnostic.primary.span), insert, name: `Change to \`${insert}\`` } : null;
}

/** The editor. */
export class Editor {
  constructor({ parent, text, schema, changed, explain }) {
    this.explain = explain;
    this.view = new EditorView({
      parent,
      state: EditorState.create({
        doc: text,
        extensions: [
          basicSetup,
          keymap.of([indentWithTab]),
          yaml(),
          syntaxHighlighting(colours),
          autocompletion({ override: [completion(schema)] }),
          hover(schema),
          lintGutter(),
          marked,
          EditorView.lineWrapping,
          EditorView.contentAttributes.of({ "aria-label": "Model file", spellcheck: "false" }),
          EditorView.updateListener.of((update) => update.docChanged && changed()),
        ],
      }),
    });
  }

  get text() {
    return this.view.state.doc.toString();
  }

  set text(text) {
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text }, scrollIntoView: true });
    this.view.dispatch({ selection: { anchor: 0 } });
  }

  /** Underlines diagnostics about this text; none if it has changed since. */
  diagnose(text, diagnostics) {
    if (text !== this.text) return;
    const found = diagnostics.flatMap((diagnostic) => this.#underlined(text, diagnostic));
    this.view.dispatch(setDiagnostics(this.view.state, found.sort((a, b) => a.from - b.from)));
  }

  #underlined(text, diagnostic) {
    const { severity, message, primary, secondary, notes, help, code } = diagnostic;
    const place = range(text, primary.span);
    if (!place) return [];
    const renderMessage = () =>
      element(
        "div",
        { class: "tip" },
        element("p", {}, prose(message), primary.text ? [": ", prose(primary.text)] : null),
        notes.map((note) => element("p", { class: "note" }, "note: ", prose(note))),
        help ? element("p", { class: "help" }, "help: ", prose(help)) : null,
        story(code, this.explain),
      );
    const mend = fix(diagnostic, text);
    const actions = mend ? [{ name: mend.name.replaceAll("`", ""), apply: () => this.apply(mend) }] : [];
    const source = `pebo: ${code}`;
    const others = secondary.flatMap((label) => {
      const place = range(text, label.span);
      return place && label.text ? [{ ...widened(text, place), severity: "info", message: label.text }] : [];
    });
    const kind = severity === "note" ? "info" : severity;
    return [{ ...widened(text, place), severity: kind, source, message, renderMessage, actions }, ...others];
  }

  /** Makes a change that a diagnostic proposes. */
  apply({ from, to, insert }) {
    this.view.dispatch({ changes: { from, to, insert }, selection: { anchor: from + insert.length } });
    this.view.focus();
  }

  /** Goes to a place. */
  go(place) {
    this.view.dispatch({ selection: { anchor: place.from, head: place.to }, scrollIntoView: true });
    this.view.focus();
  }

  /** Marks the lines of these places of this text, and shows the first. */
  mark(text, spans) {
    if (text !== this.text) return;
    const places = spans.map((span) => range(text, span)).filter((place) => place && place.to > place.from);
    const marks = places.map((place) => Decoration.mark({ class: "marked" }).range(place.from, place.to));
    const effects = [mark.of(Decoration.set(marks, true))];
    if (places.length) effects.push(EditorView.scrollIntoView(places[0].from, { y: "center" }));
    this.view.dispatch({ effects });
  }
}

/** A point, as where something is missing, takes the letter before or behind it. */
function widened(text, { from, to }) {
  if (to > from) return { from, to };
  return from < text.length && text[from] !== "\n" ? { from, to: from + 1 } : { from: Math.max(0, from - 1), to: from };
}
