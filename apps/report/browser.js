// The browser of the tests: the one that CHROMIUM names, else an installed one, else that of the pinned package @sparticuz/chromium. This
// package contains the browser itself with its libraries: `npm ci` installs it, with no other download and no system package.
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, renameSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliDecompressSync } from "node:zlib";
import { chromium } from "playwright-core";

const INSTALLED = "/usr/bin/chromium";
const FOLDER = dirname(fileURLToPath(import.meta.url));
const ARCHIVES = join(FOLDER, "node_modules/@sparticuz/chromium/bin");
/** Removed by `npm ci` together with the package it comes from. */
const UNPACKED = join(FOLDER, "node_modules/.chromium");

/** Longest wait for anything, ms. */
export const PATIENCE = 180_000;

/** None of the browser's own network traffic. */
const FLAGS = [
  "--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
];
/** Software rendering instead of a graphics card. */
const DRAWING = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

/** Unpacks the browser of the package. It gets its name when it is whole: an interrupted attempt leaves none. */
function unpack() {
  const folder = mkdtempSync(`${UNPACKED}-`);
  const archive = (name) => brotliDecompressSync(readFileSync(join(ARCHIVES, name)));
  for (const name of ["al2023", "swiftshader"]) {
    execFileSync("tar", ["--extract", "--no-same-owner", "--directory", folder], { input: archive(`${name}.tar.br`) });
  }
  writeFileSync(join(folder, "chromium"), archive("chromium.br"), { mode: 0o755 });
  renameSync(folder, UNPACKED);
}

/** The browser's file and its environment. */
function find() {
  if (process.env.CHROMIUM) return { executablePath: process.env.CHROMIUM };
  if (existsSync(INSTALLED)) return { executablePath: INSTALLED };
  if (process.platform !== "linux" || process.arch !== "x64") {
    throw new Error(`${INSTALLED} is missing, and the package has a browser for Linux on x86-64 only: set CHROMIUM to one`);
  }
  if (!existsSync(UNPACKED)) unpack();
  const env = {
    ...process.env,
    LD_LIBRARY_PATH: [join(UNPACKED, "lib"), process.env.LD_LIBRARY_PATH].filter(Boolean).join(":"),
    FONTCONFIG_FILE: join(FOLDER, "fonts.conf"),
    // In the C locale, pages would get the language "en-US@posix", which Intl refuses. The locale need not be installed.
    LC_ALL: "en_US.UTF-8",
  };
  return { executablePath: join(UNPACKED, "chromium"), env };
}

/** Starts the browser, with or without 3-D; `swift`: the page around the 3-D is put together without the slow detour over its software rendering. */
export function launch({ flat = false, swift = false } = {}) {
  return chromium.launch({ ...find(), args: [...FLAGS, ...(flat ? ["--disable-3d-apis"] : DRAWING), ...(swift ? ["--disable-gpu-compositing"] : [])] });
}
