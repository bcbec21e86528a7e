// Blank, formed sheet, what holds it and the die, each a layer that can be hidden.

const OUTLINE = 0.5; // of a shape's colour

class ShapesView {
  static async of(stage, shapes, standing) {
    const view = new ShapesView(stage);
    if (standing) {
      const names = ["at", "above", "clamp"];
      const [[at], above, [clamp]] = await Promise.all(names.map((name) => unpacked(standing[name])));
      view.standing = { at, above, clamp };
    }
    for (const shape of shapes) {
      const names = ["vertices", "normals", "triangles", "edges"];
      const [vertices, normals, triangles, edges] = await Promise.all(names.map((name) => unpacked(shape[name])));
      view.add(shape, vertices, normals, triangles, edges);
    }
    return view;
  }

  constructor(stage) {
    this.stage = stage;
    this.layers = {};
  }

  add({ key, colour, opacity }, vertices, normals, triangles, edges) {
    const geometry = new THREE.BufferGeometry();
    const position = new THREE.BufferAttribute(this.placed(vertices), 3);
    geometry.setAttribute("position", position);
    geometry.setAttribute("normal", new THREE.BufferAttribute(interleaved(normals), 3));
    geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(interleaved(triangles)), 1));
    const through = opacity < 1;
    // behind the lines of a path that lie on it; what one looks through is seen where it lies on something
    const offset = through ? { polygonOffsetFactor: -1, polygonOffsetUnits: -4 } : { polygonOffsetFactor: 1, polygonOffsetUnits: 2 };
    const looks = { side: THREE.DoubleSide, shininess: 18, specular: 0x222222, polygonOffset: true, ...offset };
    const material = new THREE.MeshPhongMaterial({ ...looks, color: hex(colour), transparent: through, opacity, depthWrite: !through });
    const lines = new THREE.BufferGeometry();
    lines.setAttribute("position", position);
    lines.setIndex(new THREE.BufferAttribute(Uint32Array.from(interleaved(edges)), 1));
    const outline = new THREE.LineBasicMaterial({ color: hex(colour.map((part) => OUTLINE * part)), transparent: true, opacity: 0.8 });
    const layer = new THREE.Group();
    layer.add(new THREE.Mesh(geometry, material), new THREE.LineSegments(lines, outline));
    for (const child of layer.children) child.frustumCulled = false;
    if (key === "formed-sheet") this.formed = vertices[2].map((z) => z - this.stage.origin[2]);
    this.stage.scene.add(layer);
    this.layers[key] = layer;
  }

  placed(columns) {
    const { origin } = this.stage;
    return interleaved(columns.map((column, k) => column.map((x) => x - origin[k])));
  }

  /** Lets the sheet stand as it does when the tool is on its way to a place of the path. */
  stand(index) {
    if (!this.standing) return;
    const { at, above, clamp } = this.standing;
    const next = Math.min(firstFrom(at, index), at.length - 1);
    const before = Math.max(next - 1, 0);
    const share = next > before ? Math.min(1, (index - at[before]) / (at[next] - at[before])) : 1;
    const between = (column) => column[before] + (column[next] - column[before]) * share;
    const { geometry } = this.layers["formed-sheet"].children[0];
    const { position } = geometry.attributes;
    for (let i = 0; i < above.length; i++) position.array[3 * i + 2] = this.formed[i] + between(above[i]);
    position.needsUpdate = true;
    geometry.computeVertexNormals();
    if (this.layers.clamp) this.layers.clamp.position.z = between(clamp);
    this.stage.redraw();
  }

  show(key, on) {
    this.layers[key].visible = on;
    this.stage.redraw();
  }
}

/** Columns of an array row by row. */
function interleaved(columns) {
  const all = new Float32Array(columns.length * columns[0].length);
  columns.forEach((column, k) => column.forEach((x, i) => (all[columns.length * i + k] = x)));
  return all;
}

function hex(rgb) {
  return rgb.reduce((sum, part) => 256 * sum + Math.round(part), 0);
}
