// The generator as WebAssembly, in a thread of its own.

const encoder = new TextEncoder();
const decoder = new TextDecoder();
let instance = null;
let asking = 0;

/** One question, one answer. */
async function answer(question) {
  const { room, ask, answer, memory } = (await instance).exports;
  const bytes = encoder.encode(question);
  // The memory may move while room is made, and while the answer is worked out.
  const place = room(bytes.length);
  new Uint8Array(memory.buffer, place, bytes.length).set(bytes);
  const length = ask();
  return decoder.decode(new Uint8Array(memory.buffer, answer(), length));
}

self.addEventListener("message", async ({ data: { module, asked, question } }) => {
  if (module) {
    const progress = (done) => self.postMessage({ asked: asking, progress: done });
    instance = WebAssembly.instantiate(module, { page: { progress } });
    return;
  }
  asking = asked;
  try {
    self.postMessage({ asked, answer: await answer(question) });
  } catch (error) {
    // Memory that there is not, or a defect of the generator: this worker is of no use any more.
    self.postMessage({ asked, failure: String(error) });
  }
});
