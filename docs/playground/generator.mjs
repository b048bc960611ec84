// The generator as WebAssembly in Node: what the page's worker does, without a page.
import { readFileSync } from "node:fs";

/** A function from a question to the text of its answer. */
export function generator(path) {
  const module = new WebAssembly.Module(readFileSync(path));
  const { exports } = new WebAssembly.Instance(module, { page: { progress: () => {} } });
  const encoder = new TextEncoder();
  const decoder = new TextDecoder();
  const respond = (question) => {
    const bytes = encoder.encode(JSON.stringify(question));
    const place = exports.room(bytes.length);
    new Uint8Array(exports.memory.buffer, place, bytes.length).set(bytes);
    const length = exports.ask();
    return decoder.decode(new Uint8Array(exports.memory.buffer, exports.answer(), length));
  };
  respond.memory = () => exports.memory.buffer.byteLength;
  return respond;
}
