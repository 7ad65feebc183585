// The browser of the tests.

export const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";

/** Longest wait for anything, ms. */
export const PATIENCE = 180_000;

/** Software for what no graphics card does here; nothing of the browser's own that talks to a network. */
export const FLAGS = [
  "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
  "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
];
