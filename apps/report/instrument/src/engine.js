// The engine in its worker: one question after another, each with a limit of time.
import worker from "worker-source";

/** Longest time for an answer, s. */
const PATIENCE = 10;

/** The compiled engine, from its compressed bytes in the page. */
export async function compile(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compileStreaming(new Response(stream, { headers: { "content-type": "application/wasm" } }));
}

/**
 * Reads what was typed into a field, in SI units: a number alone is in the unit beside the field, of which `factor` make one SI unit; any other text,
 * such as `1.5 t`, the engine reads, or refuses in its words.
 */
export async function typed(ask, text, { name, unit, factor = 1 }) {
  const number = Number(text);
  if (text.trim() && Number.isFinite(number)) return number / factor;
  return (await ask({ ask: "number", text, unit, of: name })).value;
}

export class Engine {
  constructor(module) {
    this.module = module;
    this.url = URL.createObjectURL(new Blob([worker], { type: "text/javascript" }));
    this.asked = new Map();
    this.count = 0;
    /** The last spec that was opened without mistakes: another worker opens it again. */
    this.spec = null;
    this.start();
  }

  start() {
    this.worker = new Worker(this.url);
    this.worker.onmessage = ({ data }) => this.hear(data);
    this.worker.postMessage({ module: this.module });
  }

  /** Asks, and waits for the answer at most some seconds. */
  ask(request, seconds = PATIENCE) {
    if (this.forgot && this.spec && request.ask !== "open") {
      this.forgot = false;
      this.ask(this.spec).catch(() => {});
    }
    const id = (this.count += 1);
    const answered = new Promise((resolve, reject) => {
      this.asked.set(id, { resolve, reject, seconds, ask: request.ask });
      this.worker.postMessage({ id, request: JSON.stringify(request) });
      this.watch();
    });
    if (request.ask !== "open") return answered;
    return answered.then((opened) => {
      Object.assign(this, { spec: opened.name ? request : null, forgot: false });
      return opened;
    });
  }

  /** Limits the time of the question that is being answered, not of those that wait behind it. */
  watch() {
    const [first] = this.asked.values();
    if (!first || first.patience || first.seconds === Infinity) return;
    first.patience = setTimeout(() => this.end(`ended: it took longer than ${first.seconds} s`), 1000 * first.seconds);
  }

  /** Ends what is being computed if it is one of these, which nobody waits for any more. */
  abandon(kinds, words) {
    if ([...this.asked.values()].some(({ ask }) => kinds.includes(ask))) this.end(words);
  }

  hear({ id, answer, failed, took }) {
    const { resolve, reject, patience } = this.asked.get(id) ?? {};
    if (!resolve) return;
    clearTimeout(patience);
    this.asked.delete(id);
    this.watch();
    if (failed) {
      reject(new Error(failed));
      this.end("ended: the engine was started again");
      return;
    }
    const said = JSON.parse(answer);
    if (said.error) reject(new Error(said.error));
    else resolve({ ...said, took });
  }

  /** Ends whatever is being computed; the next question finds a new worker, which opens the spec again. */
  end(words = "ended") {
    this.worker.terminate();
    const waiting = [...this.asked.values()];
    this.asked.clear();
    this.forgot = true;
    this.start();
    for (const { reject, patience } of waiting) {
      clearTimeout(patience);
      reject(new Error(words));
    }
  }
}
