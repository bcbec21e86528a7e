// Everything put together.

function boxOf(columns) {
  const [low, high] = [[], []];
  for (const column of columns) {
    let [least, most] = [Infinity, -Infinity];
    for (let i = 0; i < column.length; i++) {
      if (column[i] < least) least = column[i];
      if (column[i] > most) most = column[i];
    }
    low.push(least > most ? 0 : least);
    high.push(least > most ? 0 : most);
  }
  return [low, high];
}

function widen([low, high], place) {
  place.forEach((x, k) => {
    low[k] = Math.min(low[k], x);
    high[k] = Math.max(high[k], x);
  });
}

async function start() {
  const path = await Path.of(given.path);
  const box = given.part ? boxOf(await unpacked(given.part.points)) : boxOf(path.places);
  for (const shape of given.shapes) for (const corner of boxOf(await unpacked(shape.vertices))) widen(box, corner);
  const stage = new Stage(document.querySelector("#stage canvas"), box);
  const part = given.part && (await PartView.of(stage, given.part));
  const lines = new PathView(stage, path);
  const tool = new ToolView(stage, given.tools);
  const opposite = given.opposite && new OppositeView(stage, given.opposite, await unpacked(given.opposite.tips));
  const shapes = await ShapesView.of(stage, given.shapes, given.standing);
  const player = new Player(path);
  player.show = ({ index, tip, share }) => {
    lines.done(index);
    tool.stand(player.toolAt(index), tip, path.axis(index, share));
    opposite?.stand(index, share);
    shapes.stand(index);
  };
  player.seek(path.duration);
  new Findings(stage, player, given.findings);
  wire(stage, part, lines);
  new Layers(part, { shapes, tool, opposite });
  await part?.show("");
  lines.show("kind");
  note(path);
  return { stage, part, player, tool, shapes, opposite };
}

function wire(stage, part, lines) {
  const map = document.getElementById("map");
  const colour = document.getElementById("path-colour");
  colour.addEventListener("change", () => lines.show(colour.value));
  map?.addEventListener("change", () => {
    // a path over a map hides the map
    colour.value = map.value ? "" : "kind";
    lines.show(colour.value);
    part.show(map.value);
  });
  for (const button of document.querySelectorAll("[data-view]")) {
    button.addEventListener("click", () => stage.look(button.dataset.view));
  }
}

function note(path) {
  const { drawnError, sag, unknown, count } = given.path;
  const sentences = [`${count} moves`];
  if (sag) sentences.push(`arcs as chords, at most ${sag} mm off`);
  if (path.drawn.length < path.known) {
    sentences.push(`drawn through ${path.drawn.length} of ${path.known} points, at most ${short(drawnError)} mm off; the readout has them all`);
  }
  if (unknown) sentences.push(`${unknown} of them end at unknown positions`);
  if (given.part?.merged) sentences.push(`the part is drawn coarser: its points are merged in cells of ${short(given.part.merged)} mm`);
  document.getElementById("path-note").textContent = `${sentences.join("; ")}.`;
}

try {
  window.styluscam = await start();
} catch (error) {
  console.error(error);
  document.getElementById("stage").classList.add("flat");
  const trouble = document.getElementById("trouble");
  trouble.hidden = false;
  trouble.textContent = `The 3-D view cannot be shown in this browser: ${error.message}`;
}
document.documentElement.dataset.ready = "yes";
