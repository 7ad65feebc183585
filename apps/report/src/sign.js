// A page to print and to sign: the summary that the command wrote.
import { element } from "./element.js";

/** Fills the page. */
export function sign({ summary }) {
  const rows = summary.map(({ name, texts, verdict }) =>
    element("tr", { className: verdict }, element("th", { textContent: name }), element("td", {}, ...texts.map((textContent) => element("p", { textContent })))),
  );
  document.querySelector("#sign .card").append(
    element("table", {}, element("tbody", {}, ...rows)),
    element("div", { className: "signatures" }, ...["computed by", "checked by", "place and date"].map((textContent) => element("p", { textContent }))),
  );
}
