// The emitted Rust, to copy or to save, with what its crate needs.

import { copier, element, save, show } from "./dom.js";

/** As the manual has it: where this repository is. */
const CARGO = `[dependencies]
pebo-runtime = { path = "../pebo/pebo-runtime" }
`;

/** Shows the module; `choose` asks for the other type of numbers. */
export function code(name, emitted, scalar, choose) {
  const other = (wanted, words) =>
    element(
      "label",
      {},
      element("input", { type: "radio", name: "scalar", value: wanted, checked: wanted === scalar, onchange: () => choose(wanted) }),
      ` ${words}`,
    );
  const chosen = document.activeElement?.name === "scalar";
  const lines = emitted.text.split("\n").length;
  show(
    "code",
    element("h2", {}, "Code"),
    element(
      "fieldset",
      { class: "row" },
      element("legend", {}, "Numbers"),
      other("f64", "f64"),
      other("f32", "f32"),
      copier("Copy the module", () => emitted.text),
      element("button", { type: "button", id: "download", onclick: () => save(`${name}.rs`, emitted.text, "text/rust") }, "Download"),
    ),
    element(
      "p",
      {},
      "A module for ",
      element("code", {}, `src/${name}.rs`),
      ", without the standard library, without allocation, without a panic. It was read back and proved equal to the formulas above. ",
      "Its crate needs these lines of ",
      element("code", {}, "Cargo.toml"),
      ":",
    ),
    element("pre", { tabindex: "0" }, CARGO),
    element("p", {}, copier("Copy these lines", () => CARGO)),
    element(
      "details",
      { id: "module" },
      element("summary", {}, `The module, ${lines} lines`),
      element("pre", { tabindex: "0" }, element("code", {}, emitted.text)),
    ),
  );
  // The choice that was made is made anew, and keeps the keyboard.
  if (chosen) document.querySelector(`#code input[value="${scalar}"]`).focus();
}
