// Places: the generator counts bytes of UTF-8, browsers count units of UTF-16.

/** A function from bytes of this text to its units. */
export function units(text) {
  // Of a text without other letters they are the same.
  if (/^[\x00-\x7f]*$/.test(text)) return (byte) => Math.min(byte, text.length);
  const starts = [];
  let byte = 0;
  for (let unit = 0; unit < text.length; unit++) {
    const point = text.codePointAt(unit);
    const bytes = point < 0x80 ? 1 : point < 0x800 ? 2 : point < 0x10000 ? 3 : 4;
    for (let i = 0; i < bytes; i++) starts[byte++] = unit;
    if (point > 0xffff) unit++;
  }
  return (byte) => (byte < starts.length ? starts[byte] : text.length);
}

/** The units of a place of this text; null where the place is nowhere in it. */
export function range(text, span) {
  if (!span) return null;
  const at = units(text);
  return { from: at(span.start), to: Math.max(at(span.start), at(span.end)) };
}
