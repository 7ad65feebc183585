// What to start from: a new crane, or one of the examples, with their pictures.
import { element } from "../../src/element.js";

export class Gallery {
  /** `host` is a dialog; `choose(spec)` is called with `{name, text}`. */
  constructor(host, { examples, fresh }, choose) {
    this.host = host;
    this.cards = [fresh, ...examples].map((one) => {
      const title = one === fresh ? "New crane" : one.title;
      const picture = one === fresh ? element("b", { textContent: "+", ariaHidden: "true" }) : element("img", { alt: "", src: `data:image/svg+xml,${encodeURIComponent(one.picture)}` });
      const words = one === fresh ? "a boom on a pillar, to change" : one.name.replace(".yaml", "");
      const card = element("button", { type: "button" }, picture, element("strong", { textContent: title }), element("span", { textContent: words }));
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
