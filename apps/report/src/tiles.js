// The figures to look at first, as the command judged them.
import { element } from "./element.js";

/** A figure with where and when. */
export const tile = ({ title, value, note, verdict }) =>
  element("div", { className: verdict }, ...[["span", title], ["strong", value], ["span", note]].map(([tag, textContent]) => element(tag, { textContent })));

/** Fills the tiles, and the sentence above them. */
export function tiles({ figures, verdict }, sentence = document.querySelector("#verdict"), host = document.querySelector("#tiles")) {
  if (verdict.verdict === "unlimited") sentence.remove();
  else Object.assign(sentence, { textContent: verdict.text, className: verdict.verdict });
  host.append(...figures.map(tile));
}
