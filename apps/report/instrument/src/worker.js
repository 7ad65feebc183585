// Runs the engine in a thread of its own: requests in, answers out, both JSON.

const read = new TextDecoder();
const written = new TextEncoder();
let engine = null;

/** Asks the engine: `room` makes room for the request, `ask` answers it. */
function ask(request) {
  const bytes = written.encode(request);
  const at = engine.room(bytes.length);
  new Uint8Array(engine.memory.buffer, at, bytes.length).set(bytes);
  const length = engine.ask();
  return read.decode(new Uint8Array(engine.memory.buffer, engine.answer(), length));
}

let ready = null;
onmessage = async ({ data: { module, id, request } }) => {
  if (module) {
    ready = WebAssembly.instantiate(module, {}).then(({ exports }) => (engine = exports));
    return;
  }
  try {
    await ready;
    const begin = performance.now();
    postMessage({ id, answer: ask(request), took: performance.now() - begin });
  } catch (error) {
    // The module is not usable after this.
    // Where memory ends, the engine stops at an instruction that cannot be reached.
    const lacks = error instanceof RangeError || /memory|stack|unreachable/.test(error.message);
    postMessage({ id, failed: lacks ? "it needs more memory than there is, or is nested too deeply" : `it failed (${error.message})` });
  }
};
