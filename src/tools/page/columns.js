// The columns of a plan, as report::PhaseColumns and report::PathColumns have written them.

function decode(Type, text) { return new Type((Uint8Array.fromBase64?.(text) ?? bytesOf(atob(text))).buffer); }
// For browsers without `fromBase64`. `Uint8Array.from` takes twenty times as long as a loop.
function bytesOf(characters) {
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

// The whole numbers of a column: see report::pack.
function unpack(text) {
  const bytes = decode(Uint8Array, text), groupSize = 64, mostOnes = 24, wholeBits = 54;
  let at = 0;  // in bits
  const next24 = () => {  // and one more, or some
    const i = at >>> 3;
    return (bytes[i] | bytes[i + 1] << 8 | bytes[i + 2] << 16 | bytes[i + 3] << 24) >>> (at & 7);
  };
  const number = count => {
    let value = 0, factor = 1;
    for (; count > 24; count -= 24, factor *= 2 ** 24) {
      value += factor * (next24() & 0xffffff);
      at += 24;
    }
    value += factor * (next24() & ((1 << count) - 1));
    at += count;
    return value;
  };
  const values = new Float64Array(number(32));
  for (let first = 0; first < values.length; first += groupSize) {
    const k = number(6) - 1, end = Math.min(first + groupSize, values.length), factor = 2 ** k;
    for (let i = first; k >= 0 && i < end; ++i) {
      const zeros = ~next24() | 1 << mostOnes, ones = 31 - Math.clz32(zeros & -zeros);
      at += ones < mostOnes ? ones + 1 : mostOnes;
      const u = ones < mostOnes ? ones * factor + number(k) : number(wholeBits), half = Math.floor(u / 2);
      values[i] = u === 2 * half ? half : -half - 1;
    }
  }
  return values;
}
function sums(values) {
  for (let i = 1; i < values.length; ++i) values[i] += values[i - 1];
  return values;
}

// Phases: when each begins, and position in the block, speed and acceleration there.
function readPhases(plan) {
  const form = unpack(plan.columns.form), durations = unpack(plan.columns.duration), starts = decode(Float64Array, plan.phaseStarts), n = form.length;
  const [time, within, v, a] = [0, 1, 2, 3].map(() => new Float64Array(n)), j = unpack(plan.columns.jerk).map(x => x / plan.grid.jerk);
  const block = new Uint32Array(sums(unpack(plan.columns.block))), ownStart = 1, sameDuration = 2;
  let now = 0, duration = 0, d = 0, s = 0, speed = 0, rise = 0;  // `now` and `duration` as whole numbers
  for (let i = 0, own = 0, told = 0; i < n; ++i) {
    if (i > 0 && block[i] !== block[i - 1]) s = 0;
    if (form[i] & ownStart) {
      [s, speed, rise] = starts.subarray(own, own + 3);
      own += 3;
    }
    time[i] = now / plan.grid.time;
    within[i] = s;
    v[i] = speed;
    a[i] = rise;
    if (!(form[i] & sameDuration)) {
      duration = durations[told++];
      d = duration / plan.grid.time;
    }
    now += duration;
    s += d * (speed + d * (rise / 2 + d * (j[i] / 6)));
    speed += d * (rise + d * (j[i] / 2));
    rise += d * j[i];
  }
  return {time, within, v, a, j, block, limitedBy: new Uint8Array(sums(unpack(plan.columns.limitedBy)))};
}

// The path: pieces, each with its degree, its length, where it begins in its block, and where the factors of its powers of
// the length begin: a vector of the channels for each power from 0 to the degree.
function readPieces(plan, firstPiece) {
  const {grid, channels: n, columns} = plan, ownStart = 8;
  const degree = new Uint8Array(sums(unpack(columns.degree))), length = sums(unpack(columns.length)).map(x => x / grid.length);
  const all = (name, count) => Array.from({length: count}, (_, k) => unpack(columns[name + k]));
  const ends = all('end', n).map(sums), seconds = all('second', n).map(sums), shapes = all('shape', 3 * n);
  const from = new Float64Array(degree.length), at = new Uint32Array(degree.length + 1);
  for (let i = 0; i < degree.length; ++i) at[i + 1] = at[i] + ((degree[i] & ~ownStart) + 1) * n;
  for (let b = 0; b + 1 < firstPiece.length; ++b)
    for (let i = firstPiece[b] + 1; i < firstPiece[b + 1]; ++i) from[i] = from[i - 1] + length[i - 1];

  const starts = decode(Float64Array, plan.pieceStarts), factors = new Float64Array(at[degree.length]);
  const here = new Float64Array(3 * n), read = [0, 0, 0, 0, 0, 0];  // where the last piece ends; how many there were of each degree
  for (let i = 0, own = 0; i < degree.length; ++i) {
    if (degree[i] & ownStart) {
      here.set(starts.subarray(own, own += 3 * n));
      degree[i] -= ownStart;
    }
    const h = length[i], d = degree[i], which = read[d]++;
    for (let k = 0; k < n; ++k) {
      const f = at[i] + k, p0 = here[k];
      let p1 = here[n + k], p2 = here[2 * n + k] / 2, p3 = 0, p4 = 0, p5 = 0;
      factors[f] = p0;
      if (d === 0) continue;
      if (d === 1) {
        p1 = (ends[k][which] / grid.length - p0) / h;
        p2 = 0;
      } else if (d === 3) {
        p3 = (seconds[k][which] / grid.second - 2 * p2) / (6 * h);
      } else {
        p3 = shapes[3 * k][which] / grid.shape / h ** 3;
        p4 = shapes[3 * k + 1][which] / grid.shape / h ** 4;
        p5 = shapes[3 * k + 2][which] / grid.shape / h ** 5;
      }
      factors[f + n] = p1;
      if (d > 1) {
        factors[f + 2 * n] = p2;
        factors[f + 3 * n] = p3;
      }
      if (d > 3) {
        factors[f + 4 * n] = p4;
        factors[f + 5 * n] = p5;
      }
      here[k] = p0 + h * (p1 + h * (p2 + h * (p3 + h * (p4 + h * p5))));
      here[n + k] = p1 + h * (2 * p2 + h * (3 * p3 + h * (4 * p4 + h * 5 * p5)));
      here[2 * n + k] = 2 * p2 + h * (6 * p3 + h * (12 * p4 + h * 20 * p5));
    }
  }
  return {degree, length, from, at, factors};
}

// Blocks: where each begins on the whole path, its first piece (and the end of the last), and its place in the text.
function readBlocks(plan) {
  const counts = sums(unpack(plan.columns.pieces)), firstPiece = new Uint32Array(counts.length + 1);
  for (let b = 0; b < counts.length; ++b) firstPiece[b + 1] = firstPiece[b] + counts[b];
  const pieces = readPieces(plan, firstPiece), counted = sums(unpack(plan.columns.counted)), start = new Float64Array(counts.length);
  for (let b = 0; b + 1 < start.length; ++b) {
    const last = firstPiece[b + 1] - 1;
    start[b + 1] = start[b] + (counted[b] ? pieces.from[last] + pieces.length[last] : 0);
  }
  const of = name => sums(unpack(plan.columns[name])), wanted = plan.wantedSpeeds.map(x => x ?? Infinity);
  return {pieces, block: {start, firstPiece, counted, line: new Uint32Array(of('line')), kind: new Uint8Array(of('kind')),
                          direct: new Uint8Array(of('direct')), offset: new Uint32Array(of('offset')), wanted: of('wanted').map(k => wanted[k])}};
}
