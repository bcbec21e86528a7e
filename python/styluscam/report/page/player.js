// Time: the slider, play and pause, the readout, the cursors in the plots.

const SPEEDS = [1, 3, 10, 30, 100, 300, 1000, 3000, 10000];
const PLAY_SECONDS = 40;

class Player {
  constructor(path) {
    this.path = path;
    this.time = path.duration;
    /** Called with the move under way and the tip's place. */
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
    if (!this.path.count) return;
    this.time = Math.min(Math.max(time, 0), this.path.duration);
    this.tell(this.path.at(this.time));
  }

  /** To the end of a move; several may end at the same time. */
  seekMove(move) {
    this.time = this.path.times[move];
    this.tell({ move, tip: this.path.end(move) });
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
    if (!this.path.count) return;
    const { move } = this.now;
    const ended = this.time >= this.path.times[move];
    const to = by > 0 ? (ended ? move + 1 : move) : move - 1;
    this.seekMove(Math.min(Math.max(to, 0), this.path.count - 1));
  }

  read({ move, tip }) {
    const { path } = this;
    const operation = given.operations[path.operations[move]];
    const said = {
      time: clock(this.time),
      line: path.lines[move] || "–",
      x: tip[0].toFixed(4),
      y: tip[1].toFixed(4),
      z: tip[2].toFixed(4),
      feed: path.kinds[move] === 0 ? "rapid" : `${Number(path.feeds[move].toFixed(3))} mm/min`,
      tool: given.tools[this.toolAt(move)]?.name ?? "–",
      operation: operation?.[0] || "–",
      move: `${move + 1} of ${path.count}`,
    };
    for (const place of document.querySelectorAll("#readout dd")) {
      place.textContent = place.title = String(said[place.dataset.key]);
    }
  }

  toolAt(move) {
    return given.operations[this.path.operations[move]]?.[1];
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
