// Colours of maps and paths, and the legends that state what they mean.

const PLAIN = [0xb9, 0xc2, 0xcc];
const NOTHING = [0xd3, 0xd8, 0xde];
const OVER = [0xcc, 0x4c, 0x9c];
const UNFORMED = [0xe8, 0xe2, 0xcf];
const KINDS = [
  { name: "rapid", rgb: [0x7f, 0x8a, 0x96] },
  { name: "down, up", rgb: [0xe0, 0x7b, 0x00] },
  { name: "cut", rgb: [0x00, 0x72, 0xb2] },
];

/** The colour of a share from 0 to 1, in a list of evenly spaced ones. */
function shade(colours, share) {
  const place = Math.min(Math.max(share, 0), 1) * (colours.length - 1);
  const below = Math.min(Math.floor(place), colours.length - 2);
  const part = place - below;
  return colours[below].map((low, k) => low + (colours[below + 1][k] - low) * part);
}

function css(rgb) {
  return `rgb(${rgb.map(Math.round).join(" ")})`;
}

function element(tag, className, text) {
  const made = document.createElement(tag);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
}

function legendCard(key, title) {
  const card = element("div", "legend");
  card.dataset.legend = key;
  card.append(element("b", "", title));
  return card;
}

/** `cut`: there are values above the scale's high end; `over`: what the colour beyond all of it means; `unformed`: what that
    of places that need no forming does. */
function scaleLegend(key, { title, unit, low, high, colours, cut, over, unformed }) {
  const card = legendCard(key, `${title}, ${unit}`);
  const bar = element("div", "bar");
  bar.style.background = `linear-gradient(to right, ${colours.map(css).join(",")})`;
  const ends = element("div", "ends");
  const marks = [short(low), short((low + high) / 2), `${cut ? "≥ " : ""}${short(high)}`];
  for (const mark of marks) ends.append(element("span", "", mark));
  card.append(bar, ends);
  if (over) card.append(swatch(OVER, over));
  if (unformed) card.append(swatch(UNFORMED, unformed));
  return card;
}

function kindLegend() {
  const card = legendCard("path", "path ");
  for (const kind of KINDS) card.append(swatch(kind.rgb, kind.name));
  return card;
}

function swatch(rgb, name) {
  const named = element("span", "kind");
  const patch = element("span", "swatch");
  patch.style.background = css(rgb);
  named.append(patch, name);
  return named;
}

/** A number with three digits that count. */
function short(value) {
  return String(Number(value.toPrecision(3)));
}

function showLegend(key, card) {
  const legends = document.getElementById("legends");
  legends.querySelector(`[data-legend="${key}"]`)?.remove();
  if (card) legends.append(card);
}
