'use strict';
// Where everything is at any instant: phases of constant jerk along blocks, whose paths are pieces.

function decode(Type, text) { return new Type((Uint8Array.fromBase64?.(text) ?? bytesOf(atob(text))).buffer); }
// For browsers without `fromBase64`. `Uint8Array.from` takes twenty times as long as a loop.
function bytesOf(characters) {
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

// The index of the last value that is not above x, in values that do not fall; 0 where all are above.
function lastNotAbove(values, x, from = 0, to = values.length) {
  let low = from, high = to;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[middle] <= x) low = middle; else high = middle;
  }
  return low;
}

class Motion {
  constructor(plan, axes, limits) {
    this.name = plan.name;
    this.duration = plan.duration;
    this.length = plan.length;
    this.channels = plan.channels;
    this.axes = axes;
    this.limits = limits.map(x => x ?? Infinity);
    this.offsets = plan.offsets;
    this.deviations = {period: plan.deviation.period, vectors: decode(Float32Array, plan.deviation.vectors)};
    this.tolerance = plan.deviation.tolerance;
    this.take(plan);
    this.count = this.phase.time.length;
  }

  take(plan) {
    const f64 = name => decode(Float64Array, plan[name]);
    const u32 = name => decode(Uint32Array, plan[name]);
    const u8 = name => decode(Uint8Array, plan[name]);
    this.phase = {time: f64('time'), within: f64('within'), v: f64('velocity'), a: f64('acceleration'),
                  j: f64('jerk'), block: u32('block'), limitedBy: u8('limitedBy')};
    this.block = {start: f64('blockStart'), wanted: f64('blockWanted'), firstPiece: u32('blockFirstPiece'),
                  line: u32('blockLine'), kind: u8('blockKind'), offset: u32('blockOffset')};
    this.piece = {length: f64('pieceLength'), curved: u8('pieceCurved')};
    this.points = f64('points');
    this.placePieces();
  }

  // Where each piece begins in its block, and in the points.
  placePieces() {
    const n = this.piece.length.length;
    this.piece.from = new Float64Array(n);
    this.piece.at = new Uint32Array(n);
    let at = 0;
    for (let b = 0; b + 1 < this.block.firstPiece.length; ++b) {
      let from = 0;
      for (let i = this.block.firstPiece[b]; i < this.block.firstPiece[b + 1]; ++i) {
        this.piece.from[i] = from;
        this.piece.at[i] = at;
        from += this.piece.length[i];
        at += (this.piece.curved[i] ? 6 : 2) * this.channels;
      }
    }
  }

  // s that a phase takes.
  durationOf(i) {
    return (i + 1 < this.count ? this.phase.time[i + 1] : this.duration) - this.phase.time[i];
  }
  phaseAt(t) { return lastNotAbove(this.phase.time, t); }

  // X, Y and Z of places on the path, all ends of pieces among them.
  forPlaces(visit) {
    for (const at of this.piece.at) visit(this.points, at);
  }

  // Position and three derivatives by length, of every channel, at a place of a block; into `out`.
  path(block, within, out) {
    const first = this.block.firstPiece[block], end = this.block.firstPiece[block + 1];
    const i = lastNotAbove(this.piece.from, within, first, end);
    const n = this.channels, p = this.points, at = this.piece.at[i], length = this.piece.length[i];
    const x = length > 0 ? Math.min(Math.max((within - this.piece.from[i]) / length, 0), 1) : 0;
    for (let k = 0; k < n; ++k) {
      const q = at + k;
      if (!this.piece.curved[i]) {
        const d = p[q + n] - p[q];
        out.position[k] = p[q] + x * d;
        out.first[k] = length > 0 ? d / length : 0;
        out.second[k] = out.third[k] = 0;
        continue;
      }
      const d = p[q + 3 * n] - p[q], v0 = p[q + n] * length, v1 = p[q + 4 * n] * length;
      const a0 = p[q + 2 * n] * length * length, a1 = p[q + 5 * n] * length * length;
      const c3 = 10 * d - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
      const c4 = -15 * d + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
      const c5 = 6 * d - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
      out.position[k] = p[q] + x * (v0 + x * (a0 / 2 + x * (c3 + x * (c4 + x * c5))));
      out.first[k] = (v0 + x * (a0 + x * (3 * c3 + x * (4 * c4 + x * 5 * c5)))) / length;
      out.second[k] = (a0 + x * (6 * c3 + x * (12 * c4 + x * 20 * c5))) / length ** 2;
      out.third[k] = (6 * c3 + x * (24 * c4 + x * 60 * c5)) / length ** 3;
    }
  }

  // Room for what `inPhase` finds.
  room() {
    const vector = () => new Float64Array(this.channels);
    return {position: vector(), first: vector(), second: vector(), third: vector(),
            velocity: vector(), acceleration: vector(), jerk: vector()};
  }

  // The state at an instant of a phase: q' v, q'' v^2 + q' a, q''' v^3 + 3 q'' v a + q' j.
  inPhase(i, t, out) {
    const ph = this.phase, block = ph.block[i], j = ph.j[i];
    const tau = Math.min(Math.max(t - ph.time[i], 0), this.durationOf(i));
    const within = ph.within[i] + tau * (ph.v[i] + tau * (ph.a[i] / 2 + tau * j / 6));
    let v = ph.v[i] + tau * (ph.a[i] + tau * j / 2), a = ph.a[i] + tau * j, jerk = j;
    const ended = t >= this.duration;
    if (ended) v = a = jerk = 0;
    this.path(block, within, out);
    for (let k = 0; k < this.channels; ++k) {
      out.velocity[k] = out.first[k] * v;
      out.acceleration[k] = out.second[k] * v * v + out.first[k] * a;
      out.jerk[k] = out.third[k] * v * v * v + 3 * out.second[k] * v * a + out.first[k] * jerk;
    }
    out.time = t;
    out.phase = i;
    out.block = block;
    out.s = ended ? this.length : this.block.start[block] + this.counted(block, within);
    out.v = v;
    out.a = a;
    out.j = jerk;
    return out;
  }
  // The length of what only rotary axes do does not count.
  counted(block, within) {
    const next = block + 1 < this.block.start.length ? this.block.start[block + 1] : this.length;
    return Math.min(within, Math.max(next - this.block.start[block], 0));
  }

  at(t, out = this.room()) {
    const time = Math.min(Math.max(t, 0), this.duration);
    if (this.count > 0) return this.inPhase(this.phaseAt(time), time, out);
    Object.assign(out, {time, phase: 0, block: 0, s: 0, v: 0, a: 0, j: 0});
    if (this.block.line.length > 0) this.path(0, 0, out);
    return out;
  }

  // When the path is s mm long.
  timeAtLength(s) {
    if (this.count === 0) return 0;
    const room = this.room();
    this.phaseStart ??= this.phase.time.map((t, i) => this.inPhase(i, t, room).s);
    const i = lastNotAbove(this.phaseStart, s);
    let from = this.phase.time[i], to = from + this.durationOf(i);
    for (let k = 0; k < 50 && to > from; ++k) {
      const middle = (from + to) / 2;
      if (this.inPhase(i, middle, room).s < s) from = middle; else to = middle;
    }
    return to;
  }
  // Where a phase's speed turns, if it does: the instant of its highest or lowest speed.
  turning(i) {
    const tau = -this.phase.a[i] / this.phase.j[i];
    return tau > 0 && tau < this.durationOf(i) ? this.phase.time[i] + tau : undefined;
  }

  // From the programmed path to where it is; into `out`.
  deviationAt(t, out) {
    const {period, vectors} = this.deviations, last = vectors.length / 3 - 1;
    if (last < 1) return out.fill(0);
    const at = Math.min(Math.max(t / period, 0), last), i = Math.min(Math.floor(at), last - 1), part = at - i;
    for (let k = 0; k < 3; ++k) out[k] = vectors[3 * i + k] + part * (vectors[3 * i + 3 + k] - vectors[3 * i + k]);
    return out;
  }
  deviation(state) { return norm(this.deviationAt(state.time, this.gap ??= [0, 0, 0])); }
  get deviates() { return this.deviations.vectors.length > 0; }

  // Speed that the program asks for; NaN where it asks for none.
  wanted(state) {
    const speed = this.block.wanted[state.block];
    return isFinite(speed) ? speed : NaN;
  }
  lineOf(state) { return this.block.line[state.block] ?? 0; }
  kindOf(state) { return this.block.kind[state.block] ?? 0; }
  // In the program's coordinates.
  programmed(state) {
    const o = 3 * (this.block.offset[state.block] ?? 0);
    return [0, 1, 2].map(k => state.position[k] - (this.offsets[o + k] ?? 0));
  }
  // When a line's motion begins, or that of the first line behind it; undefined where there is none.
  startOfLine(line) {
    for (let i = 0; i < this.count; ++i)
      if (this.block.line[this.phase.block[i]] >= line) return this.phase.time[i];
    return undefined;
  }

  // The largest share that anything takes of its limit.
  share(state) {
    let most = Math.max(norm(state.velocity) / this.limits[0] || 0, norm(state.acceleration) / this.limits[1] || 0,
                        norm(state.jerk) / this.limits[2] || 0);
    for (const axis of this.axes) {
      const k = axis.channel;
      for (const [value, limit] of [[state.velocity[k], axis.limits[0]], [state.acceleration[k], axis.limits[1]],
                                    [state.jerk[k], axis.limits[2]]])
        if (limit) most = Math.max(most, Math.abs(value) / limit);
    }
    return most;
  }
}

// A motion that is known at instants only; between them values are approximate.
class SampledMotion extends Motion {
  take(plan) {
    const samples = plan.samples, f32 = name => decode(Float32Array, samples[name]);
    const line = decode(Uint32Array, samples.line), n = line.length;
    this.period = samples.period;
    this.gap = samples.gap;
    this.travelled = decode(Float64Array, samples.travelled);
    this.values = f32('axes');
    const v = f32('velocity'), a = f32('acceleration'), j = f32('jerk');
    this.phase = {time: new Float64Array(n).map((_, i) => i * this.period), v, a, j,
                  block: new Uint32Array(n).map((_, i) => i), limitedBy: decode(Uint8Array, samples.limitedBy)};
    this.phase.time[n - 1] = this.duration;
    this.block = {line, wanted: f32('wanted'), kind: decode(Uint8Array, samples.kind), offset: decode(Uint32Array, samples.offset)};
  }
  forPlaces(visit) {
    for (let i = 0; i < this.count; ++i) visit(this.values, 4 * this.channels * i);
  }
  turning() { return undefined; }
  durationOf(i) { return i + 1 < this.count ? this.phase.time[i + 1] - this.phase.time[i] : 0; }
  inPhase(i, t, out) {
    const n = this.channels, next = Math.min(i + 1, this.count - 1), seconds = this.durationOf(i);
    const part = seconds > 0 ? Math.min(Math.max((t - this.phase.time[i]) / seconds, 0), 1) : 0;
    const between = (values, from, to) => values[from] + part * (values[to] - values[from]);
    // the cubic with these values and slopes at both ends
    const cubic = (p0, v0, p1, v1) => {
      const d = p1 - p0, a = v0 * seconds, b = v1 * seconds;
      return p0 + part * (a + part * (3 * d - 2 * a - b + part * (a + b - 2 * d)));
    };
    const from = 4 * n * i, to = 4 * n * next, all = this.values;
    for (let k = 0; k < n; ++k) {
      out.position[k] = cubic(all[from + k], all[from + n + k], all[to + k], all[to + n + k]);
      out.velocity[k] = between(all, from + n + k, to + n + k);
      out.acceleration[k] = between(all, from + 2 * n + k, to + 2 * n + k);
      out.jerk[k] = between(all, from + 3 * n + k, to + 3 * n + k);
    }
    out.v = between(this.phase.v, i, next);
    out.a = between(this.phase.a, i, next);
    out.j = between(this.phase.j, i, next);
    out.s = cubic(this.travelled[i], this.phase.v[i], this.travelled[next], this.phase.v[next]);
    for (let k = 0; k < n; ++k) {
      out.first[k] = out.v > 0 ? out.velocity[k] / out.v : 0;
      out.second[k] = out.v > 0 ? (out.acceleration[k] - out.first[k] * out.a) / out.v ** 2 : 0;
    }
    return Object.assign(out, {time: t, phase: i, block: i});
  }
}

function motionOf(plan, axes, limits) {
  return plan.samples ? new SampledMotion(plan, axes, limits) : new Motion(plan, axes, limits);
}

// Of X, Y and Z.
function norm(v) { return Math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
