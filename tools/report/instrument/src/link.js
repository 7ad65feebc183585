// A spec in the address of the page: compressed, in the fragment, which browsers send to nobody.

/** Longest spec that a link may contain, as the compiler has it, bytes. */
export const MOST = 4 << 20;
const PREFIX = "#spec=";

const through = (bytes, transform) => new Blob([bytes]).stream().pipeThrough(transform);

/** The fragment for a text. */
export async function fragment(text) {
  const bytes = new Uint8Array(await new Response(through(text, new CompressionStream("deflate-raw"))).arrayBuffer());
  let letters = "";
  for (let at = 0; at < bytes.length; at += 0x8000) letters += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  return PREFIX + btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** The text of a fragment; `null` without one. A text that is too long is refused while it is unpacked. */
export async function text(hash) {
  if (!hash.startsWith(PREFIX)) return null;
  const letters = hash.slice(PREFIX.length).replaceAll("-", "+").replaceAll("_", "/");
  if (letters.length > MOST) throw new Error(`the link is longer than ${MOST >> 20} MB`);
  let bytes;
  try {
    bytes = Uint8Array.from(atob(letters), (letter) => letter.charCodeAt(0));
  } catch {
    throw new Error("the link is damaged: it is not complete");
  }
  const reader = through(bytes, new DecompressionStream("deflate-raw")).getReader();
  const decoder = new TextDecoder();
  let found = "";
  let size = 0;
  for (;;) {
    const { done, value } = await reader.read().catch(() => {
      throw new Error("the link is damaged: it cannot be unpacked");
    });
    if (done) return found + decoder.decode();
    size += value.length;
    if (size > MOST) {
      reader.cancel().catch(() => {});
      throw new Error(`the spec in the link is longer than ${MOST >> 20} MB`);
    }
    found += decoder.decode(value, { stream: true });
  }
}
