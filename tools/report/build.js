// Builds the page into one file, which the command includes: `node build.js`; with `--check`, only reports whether that file
// is current.
import { createHash } from "node:crypto";
import { readFile, writeFile } from "node:fs/promises";
import { build } from "esbuild";

const TARGET = new URL("../page/src/report.html", import.meta.url);

const { outputFiles } = await build({
  absWorkingDir: new URL(".", import.meta.url).pathname,
  entryPoints: ["src/page.js"],
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "none",
  charset: "utf8",
  write: false,
  outdir: "out",
});
const output = (ending) => outputFiles.find(({ path }) => path.endsWith(ending)).text.trim();
// The text of an element ends at the first closing tag, even within a string.
const script = output(".js").replaceAll("</script", "<\\/script");
const style = output(".css");
const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const file = (path) => readFile(new URL(path, import.meta.url), "utf8");
const escape = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");

const licences = await Promise.all(["three", "uplot"].map(async (name) => {
  const { version } = JSON.parse(await file(`node_modules/${name}/package.json`));
  return `${name} ${version}\n\n${(await file(`node_modules/${name}/LICENSE`)).trim()}`;
}));
const parts = {
  // No external resources: only this script, this style and what they draw.
  policy: `default-src 'none'; script-src ${hash(script)}; style-src ${hash(style)}; img-src data: blob:; base-uri 'none'; form-action 'none'`,
  style,
  script,
  licences: escape(licences.join("\n\n\n")),
};
const page = (await file("src/page.html")).replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]);

if (process.argv.includes("--check")) {
  if ((await readFile(TARGET, "utf8")) !== page) {
    console.error("the page of the command is not what tools/report makes: run `npm ci && npm run build` there");
    process.exit(1);
  }
  console.log("the page of the command is current");
} else {
  await writeFile(TARGET, page);
  console.log(`page ${(page.length / 1000).toFixed(0)} kB, script ${(script.length / 1000).toFixed(0)} kB`);
}
