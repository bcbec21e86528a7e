// What is shown: the formed sheet stands for the part, but for a map, which is drawn on the part.

class Layers {
  constructor(part, { shapes, tool, opposite }) {
    this.part = part;
    this.views = { shapes, tool, opposite };
    this.boxes = [...document.querySelectorAll("[data-layer]")];
    this.map = document.getElementById("map");
    for (const box of this.boxes) box.addEventListener("change", () => this.apply());
    this.map?.addEventListener("change", () => this.apply());
    this.apply();
  }

  apply() {
    const { shapes, tool, opposite } = this.views;
    for (const { dataset, checked } of this.boxes) {
      if (dataset.layer === "tool") tool.show(checked);
      else if (dataset.layer === "opposite") opposite.show(checked);
      else shapes.show(dataset.layer, checked && !(dataset.layer === "formed-sheet" && this.map?.value));
    }
    const sheet = shapes.layers["formed-sheet"];
    this.part?.seen(!sheet?.visible);
  }
}
