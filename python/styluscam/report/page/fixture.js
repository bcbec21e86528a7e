// What holds the sheet: plates with an opening, drawn as far as a band around it.

const BAND = 0.08; // of the opening's larger side
const DEPTH = 0.25; // of the same, at most

class FixtureView {
  constructor(stage, plates) {
    this.stage = stage;
    this.group = new THREE.Group();
    const looks = { color: 0x6f8fae, side: THREE.DoubleSide, flatShading: true, transparent: true, opacity: 0.45, depthWrite: false };
    const material = new THREE.MeshPhongMaterial(looks);
    for (const plate of plates) this.group.add(new THREE.Mesh(banded(stage, plate), material));
    stage.scene.add(this.group);
  }

  show(on) {
    this.group.visible = on;
    this.stage.redraw();
  }
}

/** Middle of an opening, its sides, and the width of the band around it. */
function measured({ opening }) {
  const range = (k) => [Math.min(...opening.map((corner) => corner[k])), Math.max(...opening.map((corner) => corner[k]))];
  const ranges = [range(0), range(1)];
  const sides = ranges.map(([low, high]) => high - low);
  return { middle: ranges.map(([low, high]) => (low + high) / 2), sides, band: BAND * Math.max(...sides) };
}

/** The corners of what is drawn of a plate, mm. */
function outerCorners(plate) {
  const { middle, sides, band } = measured(plate);
  return plate.opening.map((corner) => corner.map((x, k) => middle[k] + (x - middle[k]) * (1 + (2 * band) / sides[k])));
}

/** Four rings of corners: down in the opening, at its rim, at the outer rim, down outside. */
function banded(stage, plate) {
  const [foot, top] = plate.heights;
  const low = Math.max(foot, top - DEPTH * Math.max(...measured(plate).sides));
  const outer = outerCorners(plate);
  const rings = [[plate.opening, low], [plate.opening, top], [outer, top], [outer, low]];
  const places = rings.map(([corners, z]) => corners.map(([x, y]) => stage.place([x, y, z])));
  const position = [];
  for (let ring = 0; ring + 1 < places.length; ring++) {
    const [inner, next] = [places[ring], places[ring + 1]];
    for (let i = 0; i < inner.length; i++) {
      const j = (i + 1) % inner.length;
      for (const point of [inner[i], next[i], next[j], inner[i], next[j], inner[j]]) position.push(point.x, point.y, point.z);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(position), 3));
  geometry.computeVertexNormals();
  return geometry;
}
