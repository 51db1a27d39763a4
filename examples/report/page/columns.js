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

// The path: pieces, each with its length, where it begins in its block, its degree, and where the factors of its
// powers of the length begin: a vector of the channels for each power from 0 to the degree.
function readPieces(plan, firstPiece) {
  const degree = new Uint8Array(sums(unpack(plan.columns.degree))), length = sums(unpack(plan.columns.length)).map(x => x / plan.grid.length);
  const n = degree.length, channels = plan.channels, starts = decode(Float64Array, plan.pieceStarts), ownStart = 8;
  const columns = (name, count) => Array.from({length: count}, (_, k) => unpack(plan.columns[name + k]));
  const ends = columns('end', channels).map(sums), seconds = columns('second', channels).map(sums), shapes = columns('shape', 3 * channels);
  const from = new Float64Array(n), at = new Uint32Array(n);
  let size = 0, own = 0;
  for (let i = 0; i < n; ++i) {
    at[i] = size;
    size += ((degree[i] & 7) + 1) * channels;
  }
  const factors = new Float64Array(size), here = new Float64Array(3 * channels), read = [0, 0, 0, 0, 0, 0];
  for (let b = 0; b + 1 < firstPiece.length; ++b) {
    let travelled = 0;
    for (let i = firstPiece[b]; i < firstPiece[b + 1]; ++i) {
      from[i] = travelled;
      travelled += length[i];
    }
  }
  for (let i = 0; i < n; ++i) {
    if (degree[i] & ownStart) {
      here.set(starts.subarray(own, own += 3 * channels));
      degree[i] -= ownStart;
    }
    const h = length[i], d = degree[i], which = read[d]++;
    for (let k = 0; k < channels; ++k) {
      const f = at[i] + k, p = here[k], first = here[channels + k], second = here[2 * channels + k];
      factors[f] = p;
      if (d === 0) continue;
      if (d === 1) {
        const slope = factors[f + channels] = (ends[k][which] / plan.grid.length - p) / h;
        here[k] = p + h * slope;
        here[channels + k] = slope;
        here[2 * channels + k] = 0;
        continue;
      }
      factors[f + channels] = first;
      const p2 = factors[f + 2 * channels] = second / 2;
      let p3, p4 = 0, p5 = 0;
      if (d === 3) {
        p3 = (seconds[k][which] / plan.grid.second - second) / (6 * h);
      } else {
        const shape = power => shapes[3 * k + power][which] / plan.grid.shape;
        p3 = shape(0) / (h * h * h);
        p4 = factors[f + 4 * channels] = shape(1) / (h * h * h * h);
        p5 = factors[f + 5 * channels] = shape(2) / (h * h * h * h * h);
      }
      factors[f + 3 * channels] = p3;
      here[k] = p + h * (first + h * (p2 + h * (p3 + h * (p4 + h * p5))));
      here[channels + k] = first + h * (2 * p2 + h * (3 * p3 + h * (4 * p4 + h * 5 * p5)));
      here[2 * channels + k] = 2 * p2 + h * (6 * p3 + h * (12 * p4 + h * 20 * p5));
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
                          offset: new Uint32Array(of('offset')), wanted: of('wanted').map(k => wanted[k])}};
}
