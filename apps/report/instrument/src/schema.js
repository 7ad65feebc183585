// Where a place in a spec is, and what the JSON Schema of the spec language says of it.

/** A key at the beginning of a text, its quotes, and what follows the colon. */
const KEY = /^("(?:[^"\\]|\\.)*"|'(?:[^']|'')*'|[^\s#:{}[\],&*!|>'"%@`-][^#:{}[\],]*?|-[^\s#:{}[\],][^#:{}[\],]*?)\s*:(?=\s|$)/;
const plain = (key) => key.replace(/^(["'])(.*)\1$/, "$2");

/**
 * The path to a place in a text of YAML, `{path, key}`: names and `[]` for entries of lists; `key` says whether a key is written
 * there, otherwise the value of the last name of the path. It reads on over mistakes: the text is being written.
 */
export function context(text, position) {
  const frames = [];
  let flow = null;
  let scalar = Infinity;
  const lines = text.slice(0, position).split("\n");
  for (const [number, line] of lines.entries()) {
    const indent = line.search(/\S/);
    // Only where something is being written does an empty line stand for anything.
    if (indent < 0 && number + 1 < lines.length) continue;
    if (flow) {
      flow = inFlow(line, flow);
      continue;
    }
    if (indent >= 0 && indent > scalar) continue;
    scalar = Infinity;
    const blank = indent < 0;
    if (!blank && line[indent] === "#") continue;
    let column = blank ? line.length : indent;
    let rest = line.slice(column);
    // An entry of a list may be as far left as the key of its list.
    const entry = /^-(\s|$)/.test(rest);
    while (frames.length && (frames.at(-1).column > column || (frames.at(-1).column === column && !(entry && frames.at(-1).key !== "[]")))) frames.pop();
    let marked;
    while ((marked = /^-(\s+|$)/.exec(rest))) {
      frames.push({ column, key: "[]" });
      column += marked[0].length;
      rest = rest.slice(marked[0].length);
    }
    const key = KEY.exec(rest);
    if (key) {
      frames.push({ column, key: plain(key[1]), value: true });
      rest = rest.slice(key[0].length);
      if (/^\s*[|>]/.test(rest)) scalar = column;
    } else {
      frames.push({ column, key: null });
    }
    if (/^\s*[[{]/.test(rest)) flow = inFlow(rest, []);
    else if (!key && frames.at(-1).key === null) frames.at(-1).word = rest;
  }
  const last = frames.at(-1);
  const path = frames.filter(({ key }) => key !== null).map(({ key }) => key);
  if (flow) {
    for (const { list, key } of flow) path.push(...(list ? ["[]"] : key ? [key] : []));
    const inner = flow.at(-1);
    return { path, key: !inner.list && !inner.key };
  }
  // Between keys a cursor in an empty line stands for a key; after a colon, for a value.
  return { path, key: !last?.value };
}

/** Brackets that a line of a flow leaves open: `{list, key}`; `null` once all are closed. */
function inFlow(line, open) {
  const stack = open.map((one) => ({ ...one }));
  let word = "";
  for (let at = 0; at < line.length; at += 1) {
    const letter = line[at];
    if (letter === '"' || letter === "'") {
      const end = line.indexOf(letter, at + 1);
      word += end < 0 ? line.slice(at) : line.slice(at, end + 1);
      at = end < 0 ? line.length : end;
    } else if (letter === "#" && /\s/.test(line[at - 1] ?? " ")) {
      break;
    } else if (letter === "{" || letter === "[") {
      stack.push({ list: letter === "[", key: null });
      word = "";
    } else if (letter === "}" || letter === "]") {
      stack.pop();
      word = "";
      if (!stack.length) return null;
    } else if (letter === ",") {
      if (stack.length) stack.at(-1).key = null;
      word = "";
    } else if (letter === ":" && /\s|$/.test(line[at + 1] ?? "") && stack.length && !stack.at(-1).list) {
      stack.at(-1).key = plain(word.trim());
      word = "";
    } else {
      word += letter;
    }
  }
  return stack;
}

/** The schema of a spec. */
export class Schema {
  constructor(root) {
    this.root = root;
  }

  /** A schema and all that it refers to or chooses from. */
  expand(node, seen = new Set()) {
    if (!node || typeof node !== "object" || seen.has(node)) return [];
    seen.add(node);
    const parts = [...(node.anyOf ?? []), ...(node.oneOf ?? []), ...(node.allOf ?? [])];
    if (node.$ref) parts.push(this.root.$defs[node.$ref.split("/").at(-1)]);
    return [node, ...parts.flatMap((part) => this.expand(part, seen))];
  }

  /** The schemas of what is at a path. */
  at(path) {
    let nodes = this.expand(this.root);
    for (const step of path) {
      const next = nodes.flatMap((node) => {
        if (step === "[]") return [node.items, ...(node.prefixItems ?? [])];
        return [node.properties?.[step] ?? (typeof node.additionalProperties === "object" ? node.additionalProperties : null)];
      });
      const seen = new Set();
      nodes = next.flatMap((node) => this.expand(node, seen));
    }
    return nodes;
  }

  /** Keys that a mapping at a path may have, with their descriptions. */
  keys(path) {
    const keys = new Map();
    for (const node of this.at(path)) {
      for (const name of Object.keys(node.properties ?? {})) if (!keys.has(name)) keys.set(name, this.words(node, name));
    }
    return keys;
  }

  /** Words that a value at a path may be. */
  values(path) {
    const values = new Map();
    const nodes = this.at(path);
    // A word that may also be the key of a choice is described there.
    const choices = new Map(nodes.filter(isChoice).map((node) => [Object.keys(node.properties)[0], node.description]));
    for (const node of nodes) {
      for (const value of [...(node.enum ?? []), ...("const" in node ? [node.const] : []), ...(node.type === "boolean" ? [true, false] : [])]) {
        const word = String(value);
        if (!values.get(word)) values.set(word, (node.const === value ? node.description : choices.get(word)) ?? "");
      }
    }
    return values;
  }

  /** What the value at a path is, in the words of the schema. */
  about(path) {
    const key = path.at(-1);
    return this.at(path.slice(0, -1)).map((node) => this.words(node, key)).find(Boolean) ?? "";
  }

  /** The description of a key of a mapping, of the choice that it makes, or of what it refers to. */
  words(node, key) {
    const property = node.properties?.[key] ?? node.additionalProperties;
    if (!property || typeof property !== "object") return "";
    const own = property.description ?? (isChoice(node) ? node.description : null);
    return own ?? this.expand(property).find(({ description }) => description)?.description ?? "";
  }
}

/** Whether a mapping is one of several choices, with a single key that names it. */
const isChoice = ({ properties, description }) => Boolean(description) && Object.keys(properties ?? {}).length === 1;
