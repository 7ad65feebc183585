// Builds the page into one file, which the command includes: `node build.js`; with `--check`, only reports whether that file
// is current.
import { readFile, writeFile } from "node:fs/promises";
import { build } from "esbuild";
import { assemble, output } from "./page.js";

const TARGET = new URL("../page/src/report.html", import.meta.url);

const built = await build({
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
const script = output(built, ".js");
const template = await readFile(new URL("src/page.html", import.meta.url), "utf8");
const page = await assemble({ template, script, style: output(built, ".css"), packages: ["three", "uplot"] });

if (process.argv.includes("--check")) {
  if ((await readFile(TARGET, "utf8")) !== page) {
    console.error("the page of the command is not what apps/report makes: run `npm ci && npm run build` there");
    process.exit(1);
  }
  console.log("the page of the command is current");
} else {
  await writeFile(TARGET, page);
  console.log(`page ${(page.length / 1000).toFixed(0)} kB, script ${(script.length / 1000).toFixed(0)} kB`);
}
