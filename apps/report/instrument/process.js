// The engine in a process of Node.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";

/** The engine of a file: a function that answers its requests. */
export async function start(wasm) {
  const { instance } = await WebAssembly.instantiate(await readFile(wasm), {});
  const { memory, room, ask, answer } = instance.exports;
  return (request) => {
    const bytes = new TextEncoder().encode(JSON.stringify(request));
    // Each call may move the memory.
    const place = room(bytes.length);
    new Uint8Array(memory.buffer, place, bytes.length).set(bytes);
    const length = ask();
    const said = JSON.parse(new TextDecoder().decode(new Uint8Array(memory.buffer, answer(), length)));
    assert(!said.error, said.error);
    return said;
  };
}
