// What the picture shows: how far deformations are exaggerated, forces, utilisation; and the picture as a file.
import { save } from "../../src/download.js";
import { exaggeration } from "../../src/viewer.js";

/** What the colours of beams mean. */
const words = (viewer) => (viewer.used.beams.length ? viewer.useInWords.join(": ") : "no beam whose stresses are known");

/** Wires the controls of a host to the view of a stage; what is shown stays so for the cranes that follow. */
export function looks(host, stage) {
  const [factor, text] = [host.querySelector("#factor"), host.querySelector("#factor_text")];
  factor.addEventListener("input", () => {
    const { factor: larger, words } = exaggeration(factor.value);
    text.textContent = words;
    stage.viewer?.set({ factor: larger });
  });
  for (const box of host.querySelectorAll("[data-look]")) {
    box.addEventListener("change", () => {
      const { viewer } = stage;
      if (!viewer) return;
      viewer.set({ [box.dataset.look]: box.checked });
      if (box.dataset.look === "use") host.querySelector("b").textContent = box.checked ? words(viewer) : "";
    });
  }
  host.querySelector("#picture").addEventListener("click", async () => {
    if (stage.viewer) save(`${stage.crane.name}.png`, await stage.viewer.picture(), "image/png");
  });
}
