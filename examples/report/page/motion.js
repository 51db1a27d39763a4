'use strict';
// Where everything is at any instant: phases of constant jerk along blocks, whose paths are pieces.

function decode(Type, text) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new Type(bytes.buffer);
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
    const f64 = name => decode(Float64Array, plan[name]);
    const u32 = name => decode(Uint32Array, plan[name]);
    const u8 = name => decode(Uint8Array, plan[name]);
    this.name = plan.name;
    this.duration = plan.duration;
    this.length = plan.length;
    this.channels = plan.channels;
    this.sampled = plan.sampled;
    this.axes = axes;
    this.limits = limits.map(x => x ?? Infinity);
    this.phase = {time: f64('time'), within: f64('within'), v: f64('velocity'), a: f64('acceleration'),
                  j: f64('jerk'), block: u32('block'), limitedBy: u8('limitedBy')};
    this.block = {start: f64('blockStart'), wanted: f64('blockWanted'), firstPiece: u32('blockFirstPiece'),
                  line: u32('blockLine'), kind: u8('blockKind'), offset: u32('blockOffset')};
    this.piece = {length: f64('pieceLength'), curved: u8('pieceCurved')};
    this.points = f64('points');
    this.offsets = plan.offsets;
    this.count = this.phase.time.length;
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

// Of X, Y and Z.
function norm(v) { return Math.hypot(v[0], v[1], v[2]); }
