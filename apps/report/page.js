// A page in one file: script, style and licences in a template, with a policy that lets nothing else in.
import { createHash } from "node:crypto";
import { readFile } from "node:fs/promises";

/** The file of a build with this ending. */
export const output = ({ outputFiles }, ending) => outputFiles.find(({ path }) => path.endsWith(ending)).text.trim();

const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const escape = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");

/** Fills a template; `policy`: what else each kind of resource may come from; `packages`: those whose licences it must show. */
export async function assemble({ template, script, style, packages, policy = {}, more = {} }) {
  // The text of an element ends at the first closing tag, even within a string.
  const code = script.replaceAll("</script", "<\\/script");
  const licences = await Promise.all(packages.map(async (name) => {
    const file = (path) => readFile(new URL(`node_modules/${name}/${path}`, import.meta.url), "utf8");
    const { version } = JSON.parse(await file("package.json"));
    return `${name} ${version}\n\n${(await file("LICENSE")).trim()}`;
  }));
  // No external resources: only this script, this style and what they draw.
  const sources = { "default-src": ["'none'"], "script-src": [hash(code)], "style-src": [hash(style)], "img-src": ["data:", "blob:"], "base-uri": ["'none'"], "form-action": ["'none'"] };
  for (const [kind, own] of Object.entries(policy)) sources[kind] = [...(sources[kind] ?? []), ...own];
  const rules = Object.entries(sources).map(([kind, from]) => `${kind} ${from.join(" ")}`);
  const parts = { policy: rules.join("; "), style, script: code, licences: escape(licences.join("\n\n\n")), ...more };
  return template.replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]);
}
