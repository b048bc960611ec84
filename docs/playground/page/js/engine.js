// The generator in a worker: one question at a time, and stopped when it is no longer wanted.

/** The reason that a question has no answer. */
export class Stopped extends Error {}

/** The generator, loaded once; a worker that is stopped is followed by another. */
export class Engine {
  #module;
  #worker = null;
  #waiting = null;
  #asked = 0;

  constructor(module) {
    this.#module = module;
    this.#start();
  }

  /** Loads the generator; `told` is called with the part that is here, 0 to 1. */
  static async load(url) {
    const response = await fetch(url);
    if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
    // Servers that do not know the type of the file are no reason to fail.
    const typed = response.headers.get("content-type")?.startsWith("application/wasm");
    const module = typed
      ? await WebAssembly.compileStreaming(response)
      : await WebAssembly.compile(await response.arrayBuffer());
    return new Engine(module);
  }

  #start() {
    this.#worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
    this.#worker.addEventListener("message", ({ data }) => this.#take(data));
    this.#worker.addEventListener("error", (event) => this.#fail(event.message ?? "the worker failed"));
    this.#worker.postMessage({ module: this.#module });
  }

  #take({ asked, progress, answer, failure }) {
    const waiting = this.#waiting;
    if (!waiting || waiting.asked !== asked) return;
    if (progress !== undefined) return waiting.progress?.(progress);
    if (failure !== undefined) return this.#fail(failure);
    this.#waiting = null;
    waiting.resolve(JSON.parse(answer));
  }

  /** A worker that failed, as one that ran out of memory, is followed by another. */
  #fail(message) {
    const waiting = this.#waiting;
    this.#waiting = null;
    this.#worker.terminate();
    this.#start();
    waiting?.reject(new Error(message));
  }

  get busy() {
    return this.#waiting !== null;
  }

  /** Answers a question; an earlier one without an answer is stopped. */
  ask(question, progress) {
    this.stop();
    const asked = ++this.#asked;
    return new Promise((resolve, reject) => {
      this.#waiting = { asked, resolve, reject, progress };
      this.#worker.postMessage({ asked, question: JSON.stringify(question) });
    });
  }

  /** Stops what is being worked on. */
  stop() {
    const waiting = this.#waiting;
    if (!waiting) return;
    this.#waiting = null;
    this.#worker.terminate();
    this.#start();
    waiting.reject(new Stopped());
  }
}
