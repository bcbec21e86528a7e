// The tool: its meridian, turned about its axis.

const CORNER = Math.cos(0.35);
const SIDES = 96;
const UP = new THREE.Vector3(0, 0, 1);

class ToolView {
  constructor(stage, tools) {
    this.stage = stage;
    this.on = true;
    this.shapes = tools.map((tool) => (tool.profile.length ? revolved(tool.profile) : pointer(stage.size)));
    for (const shape of this.shapes) stage.scene.add(shape);
    this.pointer = pointer(stage.size);
    stage.scene.add(this.pointer);
  }

  /** Puts a tool's tip at a place, its axis along a direction; the pointer where none is loaded. */
  stand(tool, tip, axis) {
    const active = this.shapes[tool] ?? this.pointer;
    this.active = active;
    active.position.copy(this.stage.place(tip));
    active.quaternion.setFromUnitVectors(UP, new THREE.Vector3(...axis).normalize());
    this.show(this.on);
  }

  /** Whether it is drawn. */
  show(on) {
    this.on = on;
    for (const shape of [...this.shapes, this.pointer]) shape.visible = on && shape === this.active;
    this.stage.redraw();
  }
}

/** The tool on the other side of the sheet, upside down. */
class OppositeView {
  constructor(stage, { profile, colour }, tips) {
    this.stage = stage;
    this.tips = tips;
    this.on = true;
    this.shape = revolved(profile, hex(colour));
    this.shape.rotation.x = Math.PI;
    stage.scene.add(this.shape);
  }

  /** Puts its tip where it is on the way to a place of the path, a share of the way behind it. */
  stand(index, share) {
    const before = Math.max(index - 1, 0);
    this.tip = this.tips.map((column) => column[before] + (column[index] - column[before]) * share);
    this.known = this.tip.every(Number.isFinite);
    if (this.known) this.shape.position.copy(this.stage.place(this.tip));
    this.show(this.on);
  }

  show(on) {
    this.on = on;
    this.shape.visible = on && Boolean(this.known);
    this.stage.redraw();
  }
}

function revolved(profile, color = 0xd9a441) {
  const group = new THREE.Group();
  const material = new THREE.MeshPhongMaterial({ color, side: THREE.DoubleSide, shininess: 40, transparent: true, opacity: 0.82 });
  for (const piece of smoothPieces(profile)) {
    const lathe = new THREE.LatheGeometry(piece.map(([radius, height]) => new THREE.Vector2(radius, height)), SIDES);
    group.add(new THREE.Mesh(lathe.rotateX(Math.PI / 2), material));
  }
  return group;
}

/** The meridian, cut at its corners: shading is smooth on each piece. */
function smoothPieces(profile) {
  const pieces = [];
  let piece = [profile[0]];
  let last = null;
  for (let i = 1; i < profile.length; i++) {
    const [dr, dz] = [profile[i][0] - profile[i - 1][0], profile[i][1] - profile[i - 1][1]];
    const length = Math.hypot(dr, dz);
    if (!length) continue;
    const way = [dr / length, dz / length];
    if (last && last[0] * way[0] + last[1] * way[1] < CORNER) {
      pieces.push(piece);
      piece = [profile[i - 1]];
    }
    piece.push(profile[i]);
    last = way;
  }
  pieces.push(piece);
  return pieces.filter((one) => one.length > 1);
}

/** Stands for a tool of which nothing is known. */
function pointer(size) {
  return revolved([[0, 0], [0.012 * size, 0.06 * size], [0, 0.06 * size]]);
}
