// The path: exact for the readout, thinned for the drawing.

class Path {
  static async of(given) {
    const names = ["places", "times", "kinds", "moves", "feeds", "lines", "operations", "drawn"];
    const columns = await Promise.all(names.map((name) => unpacked(given[name])));
    const path = new Path();
    names.forEach((name, k) => (path[name] = name === "places" ? columns[k] : columns[k][0]));
    path.axes = given.axes ? await unpacked(given.axes) : null;
    return Object.assign(path, { count: given.count, known: path.times.length });
  }

  get duration() {
    return this.known ? this.times[this.known - 1] : 0;
  }

  place(index) {
    return this.places.map((column) => column[index]);
  }

  /** The tool's axis at a share of the way to a place: up where no tool leans. */
  axis(index, share) {
    if (!this.axes) return [0, 0, 1];
    const before = Math.max(index - 1, 0);
    return this.axes.map((column) => column[before] + (column[index] - column[before]) * share);
  }

  /** The index of a move's end. */
  endOf(move) {
    return firstFrom(this.moves, move + 1) - 1;
  }

  /** Where the tip is at a time, and the index of the place to which it is going. */
  at(time) {
    const index = Math.min(firstFrom(this.times, time), this.known - 1);
    const before = Math.max(index - 1, 0);
    const begins = index > 0 ? this.times[before] : 0;
    const takes = this.times[index] - begins;
    const share = takes > 0 ? Math.min(1, (time - begins) / takes) : 1;
    const [from, to] = [this.place(before), this.place(index)];
    return { index, share, tip: share >= 1 ? to : from.map((x, k) => x + (to[k] - x) * share) };
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
        const index = path.drawn[s + end];
        for (let k = 0; k < 3; k++) position[6 * s + 3 * end + k] = path.places[k][index] - stage.origin[k];
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

  /** Draws what leads to a place in full colour, and the rest faintly. */
  done(index) {
    const pieces = Math.min(Math.max(firstFrom(this.path.drawn, index + 1) - 1, 0), Math.max(this.path.drawn.length - 1, 0));
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
    const values = by === "feed" ? this.path.feeds : this.path.places[2];
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
