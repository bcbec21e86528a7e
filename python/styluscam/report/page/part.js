// The part, plain or in the colours of a heat map.

class PartView {
  static async of(stage, part) {
    const [points, borders, [at], normals, triangles] = await Promise.all(
      [part.points, part.borders, part.at, part.normals, part.triangles].map(unpacked),
    );
    const lines = borderLines(stage, points, borders);
    return new PartView(stage, part.maps, points, at, normals, triangles, lines);
  }

  constructor(stage, maps, points, at, normals, triangles, lines) {
    this.stage = stage;
    this.lines = lines;
    this.maps = maps;
    const count = at.length;
    const position = new Float32Array(3 * count);
    const normal = new Float32Array(3 * count);
    for (let i = 0; i < count; i++) {
      for (let k = 0; k < 3; k++) {
        position[3 * i + k] = points[k][at[i]] - stage.origin[k];
        normal[3 * i + k] = normals[k][i];
      }
    }
    const index = new Uint32Array(3 * triangles[0].length);
    for (let t = 0; t < triangles[0].length; t++) {
      for (let k = 0; k < 3; k++) index[3 * t + k] = triangles[k][t];
    }
    const geometry = new THREE.BufferGeometry();
    this.colours = new THREE.BufferAttribute(new Uint8Array(3 * count), 3, true);
    geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(normal, 3));
    geometry.setAttribute("color", this.colours);
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    const looks = { vertexColors: true, side: THREE.DoubleSide, shininess: 18, specular: 0x222222 };
    // behind the lines of a path that lie on it
    const material = new THREE.MeshPhongMaterial({ ...looks, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2 });
    material.onBeforeCompile = litFromTheEye;
    this.mesh = new THREE.Mesh(geometry, material);
    stage.scene.add(this.mesh, lines);
  }

  /** Whether it is drawn. */
  seen(on) {
    this.mesh.visible = this.lines.visible = on;
    this.stage.redraw();
  }

  /** Shows the map with this key; none for plain. */
  async show(key) {
    const map = this.maps.find((one) => one.key === key);
    const values = map ? (await unpacked(map.values))[0] : null;
    const colour = colourOf(map);
    const array = this.colours.array;
    for (let i = 0; i < this.colours.count; i++) {
      const rgb = values ? colour(values[i]) : PLAIN;
      array[3 * i] = rgb[0];
      array[3 * i + 1] = rgb[1];
      array[3 * i + 2] = rgb[2];
    }
    linear(array);
    this.colours.needsUpdate = true;
    showLegend("map", map && scaleLegend("map", { ...map, colours: given.colours.map }));
    document.getElementById("map-note").textContent = map ? map.note : "";
    this.stage.redraw();
  }
}

/** Turns normals to the eye by themselves, not by the sense of their triangle: slivers have lost theirs to rounding. */
function litFromTheEye(shader) {
  const begin = "#include <normal_fragment_begin>";
  const turn = "if (dot(normal, vViewPosition) < 0.0) normal = -normal;";
  shader.fragmentShader = shader.fragmentShader.replace(begin, `${begin}\n${turn}`);
}

function borderLines(stage, points, borders) {
  const position = new Float32Array(6 * borders[0].length);
  for (let i = 0; i < borders[0].length; i++) {
    for (let end = 0; end < 2; end++) {
      for (let k = 0; k < 3; k++) position[6 * i + 3 * end + k] = points[k][borders[end][i]] - stage.origin[k];
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0x3b4754, transparent: true, opacity: 0.7 }));
}

function colourOf(map) {
  if (!map) return () => PLAIN;
  const table = Array.from({ length: 1025 }, (_, i) => shade(given.colours.map, i / 1024));
  const span = map.high - map.low || 1;
  return (value) => {
    if (value < -1.5) return UNFORMED;
    if (value < 0) return NOTHING;
    if (map.limit !== null && value > map.limit) return OVER;
    return table[Math.round(1024 * Math.min(1, Math.max(0, (value - map.low) / span)))];
  };
}

/** From the colours of a screen to those in which light is added up, in place. */
const LINEAR = Uint8Array.from({ length: 256 }, (_, i) => Math.round(255 * new THREE.Color().setRGB(i / 255, 0, 0, THREE.SRGBColorSpace).r));
function linear(array) {
  for (let i = 0; i < array.length; i++) array[i] = LINEAR[array[i]];
}
