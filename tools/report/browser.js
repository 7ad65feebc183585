// The browser of the tests.

export const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";

/** Longest wait for anything, ms. */
export const PATIENCE = 180_000;

/** Software rendering instead of a graphics card; none of the browser's own network traffic. */
export const FLAGS = [
  "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
  "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
];
