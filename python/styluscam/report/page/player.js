// Time: the slider, play and pause, the readout, the cursors in the plots.

const SPEEDS = [1, 3, 10, 30, 100, 300, 1000, 3000, 10000];
const PLAY_SECONDS = 40;

class Player {
  constructor(path) {
    this.path = path;
    this.time = path.duration;
    /** Called with where the tip is, and the index of the place to which it is going. */
    this.show = () => {};
    this.slider = document.getElementById("time");
    this.slider.max = String(path.duration || 1);
    this.slider.addEventListener("input", () => this.seek(Number(this.slider.value)));
    this.playButton = document.getElementById("play");
    this.playButton.addEventListener("click", () => this.toggle());
    document.getElementById("back").addEventListener("click", () => this.step(-1));
    document.getElementById("forth").addEventListener("click", () => this.step(1));
    this.offerSpeeds();
    this.plots();
  }

  offerSpeeds() {
    this.speeds = document.getElementById("speed");
    for (const speed of SPEEDS) this.speeds.add(new Option(`×${speed}`, String(speed)));
    const quick = SPEEDS.find((speed) => this.path.duration / speed <= PLAY_SECONDS) ?? SPEEDS.at(-1);
    this.speeds.value = String(quick);
  }

  plots() {
    this.cursors = [];
    for (const figure of document.querySelectorAll(".over-time")) {
      const [left, width] = [Number(figure.dataset.left), Number(figure.dataset.width)];
      const plot = figure.querySelector(".plot");
      this.cursors.push({ line: figure.querySelector(".cursor"), left, width });
      plot.addEventListener("click", (event) => {
        const box = plot.getBoundingClientRect();
        this.seek(((event.clientX - box.left) / box.width - left) / width * this.path.duration);
      });
    }
  }

  seek(time) {
    if (!this.path.known) return;
    this.time = Math.min(Math.max(time, 0), this.path.duration);
    this.tell(this.path.at(this.time));
  }

  /** To a place; several may be reached at the same time. */
  seekPlace(index) {
    this.time = this.path.times[index];
    this.tell({ index, share: 1, tip: this.path.place(index) });
  }

  tell(now) {
    this.now = now;
    this.slider.value = String(this.time);
    this.slider.setAttribute("aria-valuetext", clock(this.time));
    for (const { line, left, width } of this.cursors) {
      line.style.left = `${100 * (left + width * (this.time / (this.path.duration || 1)))}%`;
    }
    this.read(now);
    this.show(now);
  }

  /** To the end of the move before or after. */
  step(by) {
    this.pause();
    const { path } = this;
    if (!path.known) return;
    const end = path.endOf(path.moves[this.now.index]);
    const ended = this.now.index === end && this.time >= path.times[end];
    const first = firstFrom(path.moves, path.moves[end]);
    const on = ended ? path.endOf(path.moves[Math.min(end + 1, path.known - 1)]) : end;
    this.seekPlace(by > 0 ? on : Math.max(first - 1, 0));
  }

  read({ index, tip }) {
    const { path } = this;
    const operation = given.operations[path.operations[index]];
    const said = {
      time: clock(this.time),
      line: path.lines[index] || "–",
      x: tip[0].toFixed(4),
      y: tip[1].toFixed(4),
      z: tip[2].toFixed(4),
      feed: path.kinds[index] === 0 ? "rapid" : `${Number(path.feeds[index].toFixed(3))} mm/min`,
      tool: given.tools[this.toolAt(index)]?.name ?? "–",
      operation: operation?.[0] || "–",
      move: `${path.moves[index] + 1} of ${path.count}`,
    };
    for (const place of document.querySelectorAll("#readout dd")) {
      place.textContent = place.title = String(said[place.dataset.key]);
    }
  }

  toolAt(index) {
    return given.operations[this.path.operations[index]]?.[1];
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (this.time >= this.path.duration) this.time = 0;
    this.playing = true;
    this.button("❚❚", "pause");
    let last = performance.now();
    const step = (now) => {
      if (!this.playing) return;
      this.seek(this.time + ((now - last) / 1000) * Number(this.speeds.value));
      last = now;
      if (this.time >= this.path.duration) this.pause();
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  pause() {
    this.playing = false;
    this.button("▶", "play");
  }

  button(sign, label) {
    this.playButton.textContent = sign;
    this.playButton.setAttribute("aria-label", label);
  }
}

function clock(seconds) {
  const [h, m, s] = [Math.floor(seconds / 3600), Math.floor(seconds / 60) % 60, seconds % 60];
  return `${h}:${String(m).padStart(2, "0")}:${s.toFixed(2).padStart(5, "0")}`;
}
