// What to start from: a new crane, one of the examples, with their pictures, or a lesson.
import { element } from "../../src/element.js";

export class Gallery {
  /** `host` is a dialog; `choose(spec)` is called with `{name, text}`. */
  constructor(host, { lessons, examples, fresh }, choose) {
    this.host = host;
    const letter = (textContent) => element("b", { textContent, ariaHidden: "true" });
    const drawing = (picture) => element("img", { alt: "", src: `data:image/svg+xml,${encodeURIComponent(picture)}` });
    const all = [
      { one: fresh, sign: letter("+"), title: "New crane", words: "a boom on a pillar, to change" },
      ...examples.map((one) => ({ one, sign: drawing(one.picture), title: one.title, words: one.name.replace(".yaml", "") })),
      ...lessons.map((one) => ({ one, sign: letter(`${one.number}`), title: one.title, words: `lesson ${one.number} of the manual` })),
    ];
    this.cards = all.map(({ one, sign, title, words }) => {
      const card = element("button", { type: "button" }, sign, element("strong", { textContent: title }), element("span", { textContent: words }));
      card.addEventListener("click", () => {
        host.close();
        choose(one);
      });
      return { card, name: one.name };
    });
    host.querySelector(".cards").replaceChildren(...this.cards.map(({ card }) => card));
    host.querySelector(".close").addEventListener("click", () => host.close());
    // Beside the dialog.
    host.addEventListener("click", ({ target }) => target === host && host.close());
  }

  /** `open`: the name of the spec that is open. */
  show(open) {
    for (const { card, name } of this.cards) card.ariaCurrent = name === open ? "true" : null;
    this.host.showModal();
  }
}
