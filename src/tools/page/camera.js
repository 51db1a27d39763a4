// A parallel projection about a target that the pointer turns, moves and zooms. Z is up.

class Orbit {
  constructor(element, changed) {
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1e6, 1e6);
    this.camera.up.set(0, 0, 1);
    this.element = element;
    this.changed = changed;
    this.target = new THREE.Vector3();
    this.box = new THREE.Box3();
    this.height = this.diameter = 100;  // mm in the picture, and of the box
    this.clicked = () => {};
    this.look('isometric');
    this.listen();
  }

  look(view) {
    const views = {top: [-90, 90], front: [-90, 0], side: [0, 0], isometric: [-60, 35.264]};
    [this.azimuth, this.elevation] = views[view].map(d => d * Math.PI / 180);
    this.fit(this.box);
  }
  // Shows all of a box (THREE.Box3), as large as it goes in this direction.
  fit(box) {
    this.box = box;
    const half = box.isEmpty() ? new THREE.Vector3() : box.getSize(new THREE.Vector3()).multiplyScalar(0.5);
    if (!box.isEmpty()) box.getCenter(this.target);
    this.diameter = 2 * half.length() || 1;
    this.update();
    const e = this.camera.matrixWorld.elements, {clientWidth, clientHeight} = this.element;
    const [across, up] = [0, 4].map(k => Math.abs(e[k]) * half.x + Math.abs(e[k + 1]) * half.y + Math.abs(e[k + 2]) * half.z);
    this.height = 2.2 * Math.max(up, across * clientHeight / Math.max(clientWidth, 1)) || this.diameter;
    this.update();
  }
  update() {
    const aspect = this.element.clientWidth / Math.max(this.element.clientHeight, 1);
    const c = this.camera, h = this.height / 2;
    [c.left, c.right, c.top, c.bottom] = [-h * aspect, h * aspect, h, -h];
    const e = this.elevation, far = 10 * Math.max(this.diameter, this.height);
    const flat = Math.cos(e);
    c.up.set(flat > 1e-6 ? 0 : -Math.cos(this.azimuth), flat > 1e-6 ? 0 : -Math.sin(this.azimuth), flat > 1e-6 ? 1 : 0);
    c.position.set(flat * Math.cos(this.azimuth), flat * Math.sin(this.azimuth), Math.sin(e));
    c.position.multiplyScalar(far).add(this.target);
    [c.near, c.far] = [0, 2 * far];
    c.lookAt(this.target);
    c.updateProjectionMatrix();
    c.updateMatrixWorld();
    this.changed();
  }
  // A function that finds where a place p[k], p[k + 1], p[k + 2] is in the picture: px from its upper left corner.
  projection() {
    const m = new THREE.Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse).elements;
    const width = this.element.clientWidth, height = this.element.clientHeight;
    return (p, k) => [(1 + m[0] * p[k] + m[4] * p[k + 1] + m[8] * p[k + 2] + m[12]) * width / 2,
                      (1 - m[1] * p[k] - m[5] * p[k + 1] - m[9] * p[k + 2] - m[13]) * height / 2];
  }
  // mm in the picture's plane that pixels are.
  pan(dx, dy) {
    const scale = this.height / this.element.clientHeight, e = this.camera.matrixWorld.elements;
    for (const [axis, by] of [[0, -dx * scale], [4, dy * scale]])
      this.target.add(new THREE.Vector3(e[axis], e[axis + 1], e[axis + 2]).multiplyScalar(by));
    this.update();
  }
  listen() {
    let from = null, moved = 0;
    const el = this.element;
    el.addEventListener('pointerdown', event => {
      from = event;
      moved = 0;
      el.setPointerCapture(event.pointerId);
    });
    el.addEventListener('pointermove', event => {
      if (!from) return;
      const dx = event.clientX - from.clientX, dy = event.clientY - from.clientY;
      moved += Math.abs(dx) + Math.abs(dy);
      if (event.buttons & 1 && !event.shiftKey) {
        this.azimuth -= dx * 0.008;
        this.elevation = Math.min(Math.max(this.elevation + dy * 0.008, -Math.PI / 2), Math.PI / 2);
        this.update();
      } else {
        this.pan(dx, dy);
      }
      from = event;
    });
    el.addEventListener('pointerup', event => {
      from = null;
      if (moved < 4) this.clicked(event);
    });
    el.addEventListener('contextmenu', event => event.preventDefault());
    el.addEventListener('wheel', event => {
      event.preventDefault();
      const factor = Math.exp(event.deltaY * 0.001), box = el.getBoundingClientRect();
      const dx = event.clientX - box.left - box.width / 2, dy = event.clientY - box.top - box.height / 2;
      this.pan(-dx, -dy);
      this.height *= factor;
      this.pan(dx, dy);
    }, {passive: false});
  }
}
