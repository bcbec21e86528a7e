// The path: exact for the readout, thinned for the drawing.

class Path {
  static async of(given) {
    const names = ["ends", "times", "kinds", "feeds", "lines", "operations", "drawn"];
    const columns = await Promise.all(names.map((name) => unpacked(given[name])));
    const path = new Path();
    names.forEach((name, k) => (path[name] = name === "ends" ? columns[k] : columns[k][0]));
    path.drawnError = given.drawnError;
    path.unplaced = given.unplaced;
    return path;
  }

  get count() {
    return this.times.length;
  }

  get duration() {
    return this.count ? this.times[this.count - 1] : 0;
  }

  end(move) {
    return this.ends.map((column) => column[move]);
  }

  /** The move under way at a time, and where the tip is. */
  at(time) {
    const move = Math.min(firstFrom(this.times, time), this.count - 1);
    const before = Math.max(move - 1, 0);
    const begins = move > 0 ? this.times[before] : 0;
    const takes = this.times[move] - begins;
    const share = takes > 0 ? Math.min(1, (time - begins) / takes) : 1;
    const [from, to] = [this.end(before), this.end(move)];
    return { move, tip: share >= 1 ? to : from.map((x, k) => x + (to[k] - x) * share) };
  }
}

class PathView {
  constructor(stage, path) {
    this.stage = stage;
    this.path = path;
    const pieces = Math.max(path.drawn.length - 1, 0);
    const position = new Float32Array(6 * pieces);
    for (let s = 0; s < pieces; s++) {
      for (let end = 0; end < 2; end++) {
        const move = path.drawn[s + end];
        for (let k = 0; k < 3; k++) position[6 * s + 3 * end + k] = path.ends[k][move] - stage.origin[k];
      }
    }
    this.positions = new THREE.BufferAttribute(position, 3);
    this.colours = new THREE.BufferAttribute(new Uint8Array(6 * pieces), 3, true);
    this.past = this.lines(1);
    this.future = this.lines(0.22);
  }

  /** Lines over the same numbers as the others, with a range of their own. */
  lines(opacity) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.positions);
    geometry.setAttribute("color", this.colours);
    const material = new THREE.LineBasicMaterial({ vertexColors: true, transparent: opacity < 1, opacity, depthWrite: opacity === 1 });
    const lines = new THREE.LineSegments(geometry, material);
    lines.frustumCulled = false;
    this.stage.scene.add(lines);
    return lines;
  }

  /** Draws what is done by a move in full colour, and the rest faintly. */
  done(move) {
    const pieces = Math.min(Math.max(firstFrom(this.path.drawn, move + 1) - 1, 0), Math.max(this.path.drawn.length - 1, 0));
    this.past.geometry.setDrawRange(0, 2 * pieces);
    this.future.geometry.setDrawRange(2 * pieces, Infinity);
    this.stage.redraw();
  }

  /** Colours by "kind", "feed" or "height"; hidden for none. */
  show(by) {
    this.past.visible = this.future.visible = Boolean(by);
    if (by) this.colour(by);
    else showLegend("path", null);
    this.stage.redraw();
  }

  colour(by) {
    const { path, colours } = this;
    const heat = by === "kind" ? null : this.scale(by);
    const rapid = KINDS[0].rgb;
    for (let s = 0; s + 1 < path.drawn.length; s++) {
      const ends = [path.drawn[s], path.drawn[s + 1]];
      const kind = path.kinds[ends[1]];
      for (let end = 0; end < 2; end++) {
        const of = by === "feed" ? ends[1] : ends[end];
        const rgb = heat ? (kind === 0 ? rapid : shade(given.colours.path, heat.share(of))) : KINDS[kind].rgb;
        colours.array.set(rgb, 6 * s + 3 * end);
      }
    }
    linear(colours.array);
    colours.needsUpdate = true;
    showLegend("path", heat ? scaleLegend("path", heat) : kindLegend());
  }

  scale(by) {
    const values = by === "feed" ? this.path.feeds : this.path.ends[2];
    let [low, high] = [Infinity, -Infinity];
    for (let i = 0; i < values.length; i++) {
      if (this.path.kinds[i] === 0) continue;
      low = Math.min(low, values[i]);
      high = Math.max(high, values[i]);
    }
    if (low > high) [low, high] = [0, 1];
    const span = high - low || 1;
    const unit = by === "feed" ? "mm/min" : "mm";
    return { title: `path: ${by}`, unit, low, high, colours: given.colours.path, share: (i) => (values[i] - low) / span };
  }
}
