// Numbers as `columns.py` packs them, unpacked; and what the page was given.

const given = JSON.parse(document.getElementById("data").textContent);

function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

async function inflated(text) {
  const stream = new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The columns of an array, each a Float64Array. */
async function unpacked({ count, columns, scale, data }) {
  const planes = await inflated(data);
  const all = scale ? wholeNumbers(planes, count, columns, scale) : doubles(planes);
  return Array.from({ length: columns }, (_, k) => all.subarray(k * count, (k + 1) * count));
}

function wholeNumbers(planes, count, columns, scale) {
  const n = count * columns;
  const all = new Float64Array(n);
  for (let k = 0; k < columns; k++) {
    let sum = 0;
    for (let i = k * count; i < (k + 1) * count; i++) {
      const folded = (planes[i] | (planes[n + i] << 8) | (planes[2 * n + i] << 16) | (planes[3 * n + i] << 24)) >>> 0;
      sum += folded & 1 ? -(folded + 1) / 2 : folded / 2;
      all[i] = sum / scale;
    }
  }
  return all;
}

function doubles(planes) {
  const n = planes.length / 8;
  const bytes = new Uint8Array(planes.length);
  for (let plane = 0; plane < 8; plane++) {
    for (let i = 0; i < n; i++) bytes[8 * i + plane] = planes[plane * n + i];
  }
  return new Float64Array(bytes.buffer);
}

/** The first index whose value is not below `value`, in an array that rises. */
function firstFrom(rising, value) {
  let low = 0;
  let high = rising.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (rising[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}
