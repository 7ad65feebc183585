// Colours: those of the figures (M. Okabe, K. Ito, 2008), and a scale for forces that colour-blind readers can follow.

/** Curves in order, for paper and for dark screens. */
export const CURVES = {
  light: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b37a00", "#3c9ccf", "#5b4ba0", "#3f4750"],
  dark: ["#5db4ea", "#f08a4b", "#35c79a", "#e2a0c6", "#eabb47", "#9ad6f5", "#a99be8", "#c4ccd4"],
};

/** Whether the page is dark now. */
export const isDark = () => document.documentElement.dataset.theme === "dark";

/** Colour of the n-th curve on the page as it is now. */
export const curve = (n) => CURVES[isDark() ? "dark" : "light"][n % 8];

/** A colour of the style sheet. */
export const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** viridis (S. van der Walt, N. Smith, 2015), sampled. */
const VIRIDIS = ["#440154", "#482878", "#3e4a89", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"];
/** Colour of a foot that pulls. */
export const PULLS = "#e0559b";

/** Colour of a fraction from 0 to 1; below 0, that of a support that pulls. */
export function scale(share) {
  if (share < 0) return PULLS;
  return VIRIDIS[Math.min(Math.round(share * (VIRIDIS.length - 1)), VIRIDIS.length - 1)];
}

/** Colour of a limit that is exceeded. */
export const BEYOND = "#d62728";

/** Continuous colour of a fraction from 0 to 1, as `[r, g, b]` from 0 to 1 in linear light; red above 1. */
export function smooth(share) {
  const parts = (colour) => [1, 3, 5].map((at) => (parseInt(colour.slice(at, at + 2), 16) / 255) ** 2.2);
  if (!(share <= 1)) return parts(BEYOND);
  const place = Math.max(share, 0) * (VIRIDIS.length - 1);
  const below = Math.min(Math.floor(place), VIRIDIS.length - 2);
  const [from, to] = [parts(VIRIDIS[below]), parts(VIRIDIS[below + 1])];
  return from.map((value, i) => value + (place - below) * (to[i] - value));
}

/** The scale as a CSS gradient. */
export const gradient = `linear-gradient(90deg, ${VIRIDIS.join(", ")})`;
