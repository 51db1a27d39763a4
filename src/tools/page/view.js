// The path in space: each phase drawn as short lines, coloured by what it does there.

class View {
  constructor(element, drawings) {
    this.element = element;
    this.canvas = new Canvas(element);
    this.marker = new Marker(element);
    this.scene = new THREE.Scene();
    this.scene.fog = new THREE.Fog(theme.ground);
    this.orbit = new Orbit(element, () => this.turn());
    this.magnified = 1;
    this.orbit.clicked = event => this.pick(event);
    this.picked = () => {};
    for (const drawing of drawings) this.addDrawing(drawing);
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
  }

  addDrawing(drawing) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(decode(Float32Array, drawing.points), 3));
    this.scene.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color: 0xbbbbbb})));
  }
  // How many lines a phase is drawn as: by how much it turns, and how long it is. `state`: at its start.
  linesOf(motion, i, diagonal, state, room) {
    const seconds = motion.durationOf(i), start = motion.phase.time[i];
    const length = seconds * (motion.phase.v[i] + seconds * (motion.phase.a[i] / 2 + seconds * motion.phase.j[i] / 6));
    const bend = Math.max(norm(state.second), length > diagonal / 1000 ? norm(motion.inPhase(i, start + seconds / 2, room).second) : 0);
    return Math.max(1, Math.min(200, Math.ceil(Math.max(bend * length / 0.1, 60 * length / diagonal))));
  }

  // `other`: a motion to compare with, or nothing.
  show(motion, other = null) {
    this.motion = motion;
    const room = motion.room(), box = new THREE.Box3(), point = new THREE.Vector3();
    motion.forPlaces((values, at) => box.expandByPoint(point.fromArray(values, at)));
    const diagonal = Math.max(box.isEmpty() ? 0 : box.getSize(new THREE.Vector3()).length(), 1e-9);
    // Where each phase begins, and the end: X, Y, Z, length of the path. One phase ends where the next one begins.
    const starts = new Float64Array(4 * (motion.count + 1)), counts = new Uint8Array(motion.count), middle = motion.room();
    const keep = (i, state) => {
      for (let axis = 0; axis < 3; ++axis) starts[4 * i + axis] = state.position[axis];
      starts[4 * i + 3] = state.s;
    };
    let count = 0;
    for (let i = 0; i < motion.count; ++i) {
      keep(i, motion.inPhase(i, motion.phase.time[i], room));
      count += counts[i] = this.linesOf(motion, i, diagonal, room, middle);
    }
    keep(motion.count, motion.at(motion.duration, room));
    this.times = new Float64Array(2 * count);
    this.phases = new Uint32Array(count);
    const driven = new Float32Array(6 * count), distances = new Float32Array(2 * count);
    const solid = new Uint32Array(2 * count), dashed = new Uint32Array(2 * count);
    let next = 0, solids = 0, dashes = 0;
    const put = (i, t, x, y, z, s) => {
      driven[3 * next] = x;
      driven[3 * next + 1] = y;
      driven[3 * next + 2] = z;
      distances[next] = s;
      this.times[next] = t;
      this.phases[next >> 1] = i;
      if (motion.block.kind[motion.phase.block[i]] === 0) dashed[dashes++] = next; else solid[solids++] = next;
      ++next;
    };
    for (let i = 0; i < motion.count; ++i) {
      const from = motion.phase.time[i], seconds = motion.durationOf(i), at = 4 * i;
      put(i, from, starts[at], starts[at + 1], starts[at + 2], starts[at + 3]);
      for (let k = 1; k < counts[i]; ++k) {
        const {time, position, s} = motion.inPhase(i, from + seconds * k / counts[i], room);
        for (let end = 0; end < 2; ++end) put(i, time, position[0], position[1], position[2], s);
      }
      put(i, from + seconds, starts[at + 4], starts[at + 5], starts[at + 6], starts[at + 7]);
    }
    box.union(new THREE.Box3().setFromArray(driven));
    this.box = box;
    this.driven = driven;
    this.positions = driven.slice();
    const attribute = (values, n) => new THREE.BufferAttribute(values, n);
    this.colors = new THREE.BufferAttribute(new Uint8Array(8 * count), 4, true);  // the fourth byte is not used
    this.place = attribute(this.positions, 3);
    const distance = attribute(distances, 1);
    const lines = (position, indices, material) => {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', position);
      if (material.vertexColors) geometry.setAttribute('color', this.colors);
      if (material.isLineDashedMaterial) geometry.setAttribute('lineDistance', distance);
      geometry.setIndex(indices);
      return new THREE.LineSegments(geometry, material);
    };
    const drawn = attribute(solid.subarray(0, solids), 1);
    this.forget();
    this.path = new THREE.Group();
    const colored = {vertexColors: THREE.VertexColors}, dash = diagonal / 150;
    this.fine = [lines(this.place, drawn, new THREE.LineBasicMaterial(colored)),
                 lines(this.place, attribute(dashed.subarray(0, dashes), 1), new THREE.LineDashedMaterial({...colored, dashSize: dash, gapSize: dash}))];
    this.coarse = lines(this.place, attribute(this.fewer(2 * count), 1), new THREE.LineBasicMaterial(colored));
    this.path.add(...this.fine, this.coarse);
    if (motion.deviates) {
      const programmed = attribute(this.moved(-1), 3);
      const line = lines(programmed, drawn, new THREE.LineBasicMaterial({color: 0x999999, depthWrite: false}));
      line.renderOrder = -1;
      this.fine.push(line);
      this.path.add(line);
    }
    if (other) {
      const places = [];
      other.forPlaces((values, at) => places.push(values[at], values[at + 1], values[at + 2]));
      const line = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({color: 0xcc79a7, depthWrite: false}));
      line.renderOrder = -1;
      line.geometry.setAttribute('position', attribute(new Float32Array(places), 3));
      this.fine.push(line);
      this.path.add(line);
    }
    for (const part of this.path.children) part.frustumCulled = false;
    this.scene.add(this.path);
    this.magnify(this.magnified);
    this.refine(true);
    this.orbit.fit(box);
  }
  forget() {
    if (!this.path) return;
    this.scene.remove(this.path);
    for (const part of this.path.children) {
      part.geometry.dispose();
      part.material.dispose();
    }
  }

  // The places, so many deviations farther from the programmed path.
  moved(deviations) {
    const result = this.driven.slice(), gap = [0, 0, 0];
    for (let k = 0; k < this.times.length; ++k) {
      this.motion.deviationAt(this.times[k], gap);
      for (let axis = 0; axis < 3; ++axis) result[3 * k + axis] += deviations * gap[axis];
    }
    return result;
  }
  // Shows the deviation so many times as large as it is.
  magnify(factor) {
    this.magnified = factor;
    this.positions.set(factor === 1 ? this.driven : this.moved(factor - 1));
    this.place.needsUpdate = true;
    this.render();
  }

  // Indices of fewer lines, for while the view turns: each in place of some that follow each other.
  fewer(count) {
    const most = 4000, step = 2 * Math.ceil(count / 2 / most), indices = [];
    for (let k = 0; k < count; k += step) indices.push(k, Math.min(k + step, count) - 1);
    return new Uint32Array(indices);
  }
  // The view has been turned, moved or zoomed.
  turn() {
    if (this.times?.length > 2 * 1500) this.refine(false);
    this.render();
  }
  // All lines, as soon as it rests.
  rest() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => { this.refine(true); this.render(); }, 250);
  }
  refine(fine) {
    this.canvas.smooth = fine;
    this.canvas.wide = fine && this.times.length < 2 * 20000;
    for (const part of this.fine) part.visible = fine;
    this.coarse.visible = !fine;
  }

  // What is far away is paler, which shows the shape; by half at most.
  fade() {
    const {camera, target, diameter} = this.orbit, middle = camera.position.distanceTo(target);
    this.scene.fog.color.setHex(theme.ground);
    this.scene.fog.near = middle - diameter / 2;
    this.scene.fog.far = middle + 1.5 * diameter;
  }

  // Gives back what the legend tells.
  color(mode) {
    const motion = this.motion, room = motion.room(), n = this.times.length, colors = this.colors.array;
    const each = visit => {
      for (let k = 0; k < n; ++k) {
        const i = this.phases[k >> 1], t = this.times[k];
        visit(k, mode.along ? motion.along(i, t, room) : motion.inPhase(i, t, room));
      }
    };
    const put = (k, table, entry) => { for (let c = 0; c < 3; ++c) colors[4 * k + c] = table[3 * entry + c]; };
    let top = 0;
    if (mode.kind) {
      each((k, state) => put(k, distinctTable, mode.kind(state, motion) % distinct.length));
    } else {
      const values = new Float64Array(n);
      let most = 0;
      each((k, state) => {
        values[k] = mode.value(state, motion);
        most = Math.max(most, values[k]);
      });
      top = mode.top ? mode.top(motion) : Infinity;
      if (!isFinite(top)) top = most;
      for (let k = 0; k < n; ++k)
        put(k, scaleTable, top > 0 ? Math.round(scaleSteps * Math.min(Math.max(values[k] / top, 0), 1)) : 0);
    }
    this.colors.needsUpdate = true;
    this.render();
    return top;
  }

  // Puts the tool where it is, and marks the motion that it is in.
  put(state) {
    const line = this.motion.lineOf(state), of = k => this.motion.block.line[this.motion.phase.block[this.phases[k]]];
    let first = lastNotAbove(this.phases, state.phase), end = first + 1;
    const count = this.phases.length, most = 5000;
    for (let k = 0; first > 0 && k < most && of(first - 1) === line; ++k) --first;
    for (let k = 0; end < count && k < most && of(end) === line; ++k) ++end;
    this.marker.lines = this.positions.subarray(6 * first, count > 0 ? 6 * end : 0);
    this.putTool(state.position);
  }
  putTool(position) {
    this.marker.tool = Array.from(position.slice(0, 3));
    this.request();
  }

  // The instant whose place is nearest to the pointer, if it is near.
  pick(event) {
    const box = this.element.getBoundingClientRect(), place = this.orbit.projection();
    const x = event.clientX - box.left - this.element.clientLeft, y = event.clientY - box.top - this.element.clientTop;
    let nearest = 10, time;
    for (let k = 0; k < this.times.length; k += 2) {
      const [x0, y0] = place(this.positions, 3 * k), [x1, y1] = place(this.positions, 3 * k + 3);
      const dx = x1 - x0, dy = y1 - y0, square = dx * dx + dy * dy;
      const part = square > 0 ? Math.min(Math.max(((x - x0) * dx + (y - y0) * dy) / square, 0), 1) : 0;
      const distance = Math.hypot(x0 + part * dx - x, y0 + part * dy - y);
      if (distance >= nearest) continue;
      nearest = distance;
      time = this.times[k] + part * (this.times[k + 1] - this.times[k]);
    }
    if (time !== undefined) this.picked(time);
  }

  resize() {
    const width = this.element.clientWidth, height = this.element.clientHeight;
    this.canvas.resize(width, height);
    this.marker.resize(width, height);
    this.orbit.update();
  }
  // The path, with the next picture. Where only the marker moves, `request` is enough.
  render() {
    this.stale = true;
    this.request();
  }
  request() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      if (this.stale) this.draw();
      this.marker.draw(this.orbit);
      if (this.coarse?.visible) this.rest();
    });
  }
  draw() {
    this.stale = false;
    this.fade();
    this.canvas.draw(this.scene, this.orbit.camera);
  }
}
