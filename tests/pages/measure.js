// Measures the pages in frames of two widths, light and dark, and writes what is wrong with them into the document.
"use strict";

const WIDTHS = [360, 1400];
const SCHEMES = ["light", "dark"];
// WCAG 2.2, 1.4.3: the least contrast of text with what is behind it.
const CONTRAST = 4.5;

// Of the letters in a figure but for indices, in pixels: below it, they have to be guessed on a telephone.
const SMALLEST = 11;

const PAPER = document.createElement("canvas").getContext("2d");

function channels(colour) {
  return colour.match(/[\d.]+/g).map(Number);
}

function luminance([red, green, blue]) {
  const linear = (value) => {
    const share = value / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  };
  return 0.2126 * linear(red) + 0.7152 * linear(green) + 0.0722 * linear(blue);
}

function contrast(one, other) {
  const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
  return (high + 0.05) / (low + 0.05);
}

// The nearest background that is there.
function behind(element, view) {
  for (let at = element; at; at = at.parentElement) {
    const colour = channels(view.getComputedStyle(at).backgroundColor);
    if (colour.length === 3 || colour[3] > 0) return colour;
  }
  return [255, 255, 255];
}

// A part of a name is hidden: of a name that is broken over lines, a browser shows the first line alone.
function isBroken(token, view) {
  const style = view.getComputedStyle(token);
  PAPER.font = `${style.fontStyle} ${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  const { left, right } = extent(token);
  // A letter is wider than two pixels; a single one may be set as another glyph.
  return [...token.textContent].length > 1 && right - left < PAPER.measureText(token.textContent).width - 2;
}

// From where to where what is in an element reaches, which may be more than the element.
function extent(element) {
  const range = element.ownerDocument.createRange();
  range.selectNodeContents(element);
  const boxes = [...range.getClientRects()].filter((box) => box.width > 0);
  return { left: Math.min(...boxes.map((box) => box.left)), right: Math.max(...boxes.map((box) => box.right)) };
}

function wrong(frame, scheme) {
  const [view, page] = [frame.contentWindow, frame.contentDocument];
  const found = [];
  page.querySelectorAll("details").forEach((folded) => (folded.open = true));
  if (!view.matchMedia(`(prefers-color-scheme: ${scheme})`).matches) found.push(`it is not shown ${scheme}`);
  const width = page.documentElement.scrollWidth;
  if (width > view.innerWidth) found.push(`it is ${width} wide`);
  for (const box of page.querySelectorAll(".wide, pre, p, table, h1, h2, h3, ul, figure")) {
    const scrolls = box.parentElement.closest(".wide, pre");
    const right = box.getBoundingClientRect().right;
    if (!scrolls && right > view.innerWidth) found.push(`${box.tagName} ends at ${right}: ${box.textContent.slice(0, 60)}`);
  }
  for (const math of page.querySelectorAll("math")) {
    const { width, height } = math.getBoundingClientRect();
    if (!(width > 0 && height > 0)) found.push(`a formula has no size: ${math.textContent.slice(0, 60)}`);
  }
  for (const token of page.querySelectorAll("mi, mn, mo, mtext")) {
    if (isBroken(token, view)) found.push(`a name is broken in a formula: ${token.textContent.slice(0, 60)}`);
  }
  for (const row of page.querySelectorAll("math mtr")) {
    const cells = [...row.children].map(extent).filter((cell) => cell.right > cell.left);
    cells.sort((one, other) => one.left - other.left);
    for (let i = 1; i < cells.length; i++) {
      // Half a pixel is rounding of the layout.
      if (cells[i].left < cells[i - 1].right - 0.5) found.push(`a formula overlaps: ${row.textContent.slice(0, 60)}`);
    }
  }
  for (const drawing of page.querySelectorAll("figure svg")) {
    const box = drawing.getBoundingClientRect();
    if (!drawing.closest(".wide") && box.right > width) found.push(`a figure ends at ${box.right}, and is cut`);
    const scale = box.width / drawing.viewBox.baseVal.width;
    for (const label of drawing.querySelectorAll("text")) {
      const size = parseFloat(view.getComputedStyle(label).fontSize) * scale;
      if (!(size >= SMALLEST)) found.push(`letters of ${size} pixels in a figure: ${label.textContent.slice(0, 60)}`);
    }
  }
  for (const fraction of page.querySelectorAll("mfrac")) {
    const [above, below] = [...fraction.children].map((part) => part.getBoundingClientRect());
    if (!(above.bottom <= below.top + 1)) found.push(`a fraction is no fraction: ${fraction.textContent.slice(0, 60)}`);
  }
  let level = 0;
  for (const heading of page.querySelectorAll("h1, h2, h3, h4, h5, h6")) {
    const next = Number(heading.tagName[1]);
    if (next > level + 1 || (next === 1 && level > 0)) found.push(`heading out of order: ${heading.textContent}`);
    level = next;
  }
  for (const link of page.querySelectorAll("a[href]")) {
    const target = link.getAttribute("href");
    if (!target.startsWith("#") || !page.getElementById(target.slice(1))) found.push(`a link leads nowhere: ${target}`);
  }
  for (const figure of page.querySelectorAll("svg, img")) {
    const name = figure.querySelector("title")?.textContent || figure.getAttribute("alt");
    if (!name || (figure.tagName === "svg" && figure.getAttribute("role") !== "img")) found.push("a figure has no name");
  }
  for (const table of page.querySelectorAll("table")) {
    if (!table.caption) found.push("a table has no caption");
  }
  if (page.querySelector("script, link, img, iframe, [onclick], [src]")) found.push("it has a script, or needs another file");
  if (!page.documentElement.lang || !page.title) found.push("it has no language, or no title");
  for (const element of page.body.querySelectorAll("*:not(svg, svg *)")) {
    const words = [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.data.trim());
    if (!words) continue;
    const colour = channels(view.getComputedStyle(element).color);
    const ratio = contrast(colour, behind(element, view));
    if (ratio < CONTRAST) found.push(`contrast ${ratio.toFixed(1)}: ${element.textContent.slice(0, 60)}`);
  }
  return found;
}

function shown(text, width, scheme) {
  return new Promise((resolve) => {
    const frame = document.createElement("iframe");
    frame.style.cssText = `width: ${width}px; height: 900px; border: 0; color-scheme: ${scheme}`;
    frame.onload = () => {
      const found = wrong(frame, scheme);
      frame.remove();
      resolve(found);
    };
    frame.srcdoc = text;
    document.body.append(frame);
  });
}

async function measure(pages) {
  const results = {};
  for (const [name, text] of Object.entries(pages)) {
    results[name] = {};
    for (const width of WIDTHS) {
      for (const scheme of SCHEMES) results[name][`${width} px, ${scheme}`] = await shown(text, width, scheme);
    }
  }
  const output = document.createElement("pre");
  output.id = "results";
  output.textContent = JSON.stringify(results);
  document.body.append(output);
}
