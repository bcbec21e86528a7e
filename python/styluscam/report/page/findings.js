// Findings: a row brings its place to the middle of the view and its moment to the slider.

class Findings {
  constructor(stage, player, findings) {
    this.stage = stage;
    this.player = player;
    this.findings = findings;
    const look = new THREE.MeshBasicMaterial({ color: 0xd81b60, transparent: true, opacity: 0.75, depthTest: false });
    this.marker = new THREE.Mesh(new THREE.SphereGeometry(stage.size / 150, 20, 14), look);
    this.marker.renderOrder = 1;
    this.marker.visible = false;
    stage.scene.add(this.marker);
    for (const row of document.querySelectorAll(".finding")) {
      row.addEventListener("click", () => this.jump(row));
      row.addEventListener("keydown", (event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        this.jump(row);
      });
    }
    this.ticks();
  }

  ticks() {
    const rail = document.getElementById("ticks");
    for (const { time } of this.findings) {
      if (time === null) continue;
      const tick = element("i");
      tick.style.left = `${(100 * time) / (this.player.path.duration || 1)}%`;
      rail.append(tick);
    }
  }

  jump(row) {
    document.querySelector(".finding.chosen")?.classList.remove("chosen");
    row.classList.add("chosen");
    const { position, time } = this.findings[Number(row.dataset.finding)];
    this.player.pause();
    if (time !== null) this.player.seek(time);
    this.marker.visible = position !== null;
    if (position === null) return;
    this.marker.position.copy(this.stage.place(position));
    this.stage.flyTo(position);
    const box = this.stage.canvas.getBoundingClientRect();
    if (box.top < 0 || box.bottom > window.innerHeight) this.stage.canvas.scrollIntoView({ block: "center" });
  }
}
