'use strict';
// Where everything is at any instant: phases of constant jerk along blocks, whose paths are pieces.

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
    this.linearChannels = axes.filter(axis => 'XYZ'.includes(axis.name)).map(axis => axis.channel);
    this.limits = limits.map(x => x ?? Infinity);
    this.offsets = plan.offsets;
    this.deviations = {period: plan.deviation.period, vectors: decode(Float32Array, plan.deviation.vectors)};
    this.tolerance = plan.deviation.tolerance;
    this.largestDeviation = plan.deviation.largest;
    this.take(plan);
    this.count = this.phase.time.length;
  }

  take(plan) {
    this.phase = readPhases(plan);
    Object.assign(this, readBlocks(plan));
    this.kept = `all ${this.phase.time.length} phases, the path to ${shortNumber(plan.pathError)} mm or °`;
  }

  // s that a phase takes.
  durationOf(i) {
    return (i + 1 < this.count ? this.phase.time[i + 1] : this.duration) - this.phase.time[i];
  }
  phaseAt(t) { return lastNotAbove(this.phase.time, t); }

  // X, Y and Z of places on the path, the starts of all pieces among them.
  forPlaces(visit) {
    for (let i = 0; i < this.pieces.degree.length; ++i) visit(this.pieces.factors, this.pieces.at[i]);
  }

  // Position and three derivatives by length, of every channel, at a place of a block; into `out`.
  path(block, within, out) {
    const {from, length, at, degree, factors} = this.pieces, {position, first, second, third} = out;
    const i = lastNotAbove(from, within, this.block.firstPiece[block], this.block.firstPiece[block + 1]), n = this.channels;
    const s = Math.min(Math.max(within - from[i], 0), length[i]), start = at[i], last = start + degree[i] * n;
    for (let k = 0; k < n; ++k) {  // by Horner's rule; of the second and third derivative the half and the sixth
      let value = 0, slope = 0, half = 0, sixth = 0;
      for (let f = last + k; f >= start; f -= n) {
        sixth = half + s * sixth;
        half = slope + s * half;
        slope = value + s * slope;
        value = factors[f] + s * value;
      }
      position[k] = value;
      first[k] = slope;
      second[k] = 2 * half;
      third[k] = 6 * sixth;
    }
  }

  // Room for what `inPhase` finds.
  room() {
    const vector = () => new Float64Array(this.channels);
    return {position: vector(), first: vector(), second: vector(), third: vector(),
            velocity: vector(), acceleration: vector(), jerk: vector(), time: 0, phase: 0, block: 0, within: 0, s: 0, v: 0, a: 0, j: 0};
  }

  // The motion along the path at an instant of a phase.
  along(i, t, out) {
    const ph = this.phase, block = ph.block[i], a = ph.a[i], j = ph.j[i], ended = t >= this.duration;
    const tau = Math.min(Math.max(t - ph.time[i], 0), this.durationOf(i));
    const within = ph.within[i] + tau * (ph.v[i] + tau * (a / 2 + tau * j / 6));
    out.time = t;
    out.phase = i;
    out.block = block;
    out.within = within;
    out.s = ended ? this.length : this.block.start[block] + this.counted(block, within);
    out.v = ended ? 0 : ph.v[i] + tau * (a + tau * j / 2);
    out.a = ended ? 0 : a + tau * j;
    out.j = ended ? 0 : j;
    return out;
  }
  // The state there: q' v, q'' v^2 + q' a, q''' v^3 + 3 q'' v a + q' j.
  inPhase(i, t, out) {
    const {block, within, v, a, j} = this.along(i, t, out);
    this.path(block, within, out);
    const n = this.channels, {first, second, third, velocity, acceleration, jerk} = out;
    for (let k = 0; k < n; ++k) {
      velocity[k] = first[k] * v;
      acceleration[k] = second[k] * v * v + first[k] * a;
      jerk[k] = third[k] * v * v * v + 3 * second[k] * v * a + first[k] * j;
    }
    return out;
  }
  // The length of what only rotary axes do does not count.
  counted(block, within) { return this.block.counted[block] ? within : 0; }

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
  deviation(state) { return norm(this.deviationAt(state.time, this.vector ??= [0, 0, 0])); }
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

  // The highest speeds along the path of what cuts and of rapids. These have a limit of their own, `rate`: Infinity where the
  // axes alone limit them.
  get speeds() {
    if (this.foundSpeeds) return this.foundSpeeds;
    const found = {cutting: 0, rapid: 0, rate: 0}, {phase} = this;
    for (let i = 0; i < this.count; ++i) {
      const v = phase.v[i], a = phase.a[i], j = phase.j[i], seconds = this.durationOf(i), rapid = this.block.kind[phase.block[i]] === 0;
      const top = this.turning(i) === undefined ? v : v - a * a / (2 * j), name = rapid ? 'rapid' : 'cutting';
      found[name] = Math.max(found[name], v, top, v + seconds * (a + seconds * j / 2));
      if (rapid) found.rate = Math.max(found.rate, this.rateOf(phase.block[i]));
    }
    return this.foundSpeeds = found;
  }
  rateOf(block) {
    const speed = this.block.wanted[block];
    return isFinite(speed) && speed !== null ? speed : Infinity;
  }
  // What the tool's velocity may be at most, rapids included.
  get velocityLimit() { return this.speeds.rapid > this.limits[0] ? this.speeds.rate : this.limits[0]; }

  // The size of a vector that the tool's limit holds for: the tip's, or that of the axes X, Y and Z where a machine behind a
  // map drives its axes directly.
  ofTool(state, vector) {
    if (!this.block.direct[state.block]) return norm(vector);
    return Math.hypot(...this.linearChannels.map(k => vector[k]));
  }
  // The largest share that anything takes of its limit.
  share(state) {
    const velocity = this.kindOf(state) === 0 ? this.rateOf(state.block) : this.limits[0];
    let most = Math.max(this.ofTool(state, state.velocity) / velocity || 0, this.ofTool(state, state.acceleration) / this.limits[1] || 0,
                        this.ofTool(state, state.jerk) / this.limits[2] || 0);
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
    this.kept = `instants ${shortNumber(this.period)} s apart`;
    this.block = {line, wanted: f32('wanted'), kind: decode(Uint8Array, samples.kind),
                  direct: decode(Uint8Array, samples.direct), offset: decode(Uint32Array, samples.offset)};
  }
  forPlaces(visit) {
    for (let i = 0; i < this.count; ++i) visit(this.values, 4 * this.channels * i);
  }
  turning() { return undefined; }
  along(i, t, out) { return this.inPhase(i, t, out); }
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
