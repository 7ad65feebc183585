// A spec in the address of the page, with what the page shows of it: compressed, in the fragment, which browsers send to nobody.

/** Longest spec that a link may contain, as the compiler has it, bytes; and longest text of what is shown. */
export const MOST = 4 << 20;
const MOST_SHOWN = 1 << 16;
const PREFIX = "#spec=";
const SHOWN = "&shown=";

const through = (bytes, transform) => new Blob([bytes]).stream().pipeThrough(transform);

/** A text, compressed, in letters that an address may have. */
async function packed(text) {
  const bytes = new Uint8Array(await new Response(through(text, new CompressionStream("deflate-raw"))).arrayBuffer());
  let letters = "";
  for (let at = 0; at < bytes.length; at += 0x8000) letters += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  return btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** The text of such letters. One that is too long is refused while it is unpacked. */
async function unpacked(packed, most) {
  const letters = packed.replaceAll("-", "+").replaceAll("_", "/");
  const long = new Error(`the spec in the link is longer than ${MOST >> 20} MB`);
  if (letters.length > most) throw long;
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
    if (size > most) {
      reader.cancel().catch(() => {});
      throw long;
    }
    found += decoder.decode(value, { stream: true });
  }
}

/** The fragment for a spec, and for what is shown of it, if that is given. */
export async function fragment(text, shown = null) {
  return PREFIX + (await packed(text)) + (shown ? SHOWN + (await packed(JSON.stringify(shown))) : "");
}

/** The spec of a fragment; `null` without one. */
export async function text(hash) {
  return hash.startsWith(PREFIX) ? unpacked(hash.slice(PREFIX.length).split(SHOWN)[0], MOST) : null;
}

/** What a fragment says is shown: anything that its writer wanted, or `null`. */
export async function shown(hash) {
  const packed = hash.split(SHOWN)[1];
  if (!packed) return null;
  try {
    return Object(JSON.parse(await unpacked(packed, MOST_SHOWN)));
  } catch {
    return null;
  }
}
