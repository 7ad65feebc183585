// Load charts that the command was given.

/** Shows the pictures. */
export function chart({ chart }) {
  const host = document.querySelector("#chart .panels");
  for (const { name, svg } of chart ?? []) {
    const image = Object.assign(document.createElement("img"), { src: `data:image/svg+xml;base64,${svg}`, alt: name });
    const caption = Object.assign(document.createElement("figcaption"), { textContent: name });
    const figure = Object.assign(document.createElement("figure"), { className: "card picture" });
    figure.append(caption, image);
    host.append(figure);
  }
}
