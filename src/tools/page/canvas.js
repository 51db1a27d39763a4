// The pictures that the view is made of.

// A scene. Where it is `smooth`, each pixel is the mean of some: that takes most of the time where a processor draws, so
// it is for pictures that stay. WebGL's lines are one pixel wide; where they are `wide`, they are drawn at three places.
class Canvas {
  constructor(element) {
    const canvas = document.createElement('canvas');
    const context = canvas.getContext('webgl2', {alpha: false, antialias: false, preserveDrawingBuffer: true});
    if (!context) throw new Error('the browser has no WebGL 2');
    this.renderer = new THREE.WebGLRenderer({canvas, context});
    this.renderer.setPixelRatio(devicePixelRatio);
    this.renderer.autoClear = false;
    this.target = new THREE.WebGLMultisampleRenderTarget(1, 1, {depthBuffer: true, stencilBuffer: false});
    const picture = new THREE.MeshBasicMaterial({map: this.target.texture, depthTest: false, depthWrite: false});
    this.copy = new THREE.Scene();
    this.copy.add(new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), picture));
    this.whole = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
    this.smooth = this.wide = true;
    element.append(canvas);
  }
  resize(width, height) {
    this.renderer.setSize(width, height);
    const size = this.renderer.getDrawingBufferSize(new THREE.Vector2());
    this.target.setSize(size.x, size.y);
  }
  draw(scene, camera) {
    this.renderer.setClearColor(theme.ground);
    const {renderer} = this, {x, y} = renderer.getSize(new THREE.Vector2()), shifts = [[0, 0.5], [-0.43, -0.25], [0.43, -0.25]];
    for (const [k, shift] of (this.wide ? shifts : [[0, 0]]).entries()) {
      renderer.setRenderTarget(null);  // binds the target anew, which each picture leaves otherwise
      renderer.setRenderTarget(this.smooth ? this.target : null);
      if (k === 0) renderer.clear();
      camera.setViewOffset(x, y, ...shift, x, y);
      renderer.render(scene, camera);
    }
    camera.clearViewOffset();
    if (!this.smooth) return;
    renderer.setRenderTarget(null);
    renderer.render(this.copy, this.whole);
  }
}

// What is above the scene, and moves while that stays: the tool, the marked motion, and the scale.
class Marker {
  constructor(element) {
    this.canvas = element.appendChild(document.createElement('canvas'));
    this.canvas.className = 'marker';
    this.lines = new Float32Array();  // ends of lines, two by two
    this.tool = [0, 0, 0];
  }
  resize(width, height) {
    Object.assign(this, {width, height});
    Object.assign(this.canvas, {width: width * devicePixelRatio, height: height * devicePixelRatio});
    Object.assign(this.canvas.style, {width: `${width}px`, height: `${height}px`});
  }
  draw(orbit) {
    const context = this.canvas.getContext('2d'), place = orbit.projection();
    context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    context.clearRect(0, 0, this.width, this.height);
    context.lineWidth = 2;
    context.strokeStyle = theme.ink;
    context.beginPath();
    for (let k = 0; k < this.lines.length; k += 6) {
      context.moveTo(...place(this.lines, k));
      context.lineTo(...place(this.lines, k + 3));
    }
    context.stroke();
    context.beginPath();
    context.arc(...place(this.tool, 0), 5, 0, 2 * Math.PI);
    context.fillStyle = '#d55e00';
    context.strokeStyle = '#fff';
    context.fill();
    context.stroke();
    this.drawAxes(context, orbit);
    this.drawScale(context, orbit.height / this.height);
  }
  // Where X, Y and Z point.
  drawAxes(context, orbit) {
    const e = orbit.camera.matrixWorldInverse.elements, x = this.width - 50, y = this.height - 78, size = 30;
    context.strokeStyle = context.fillStyle = theme.faint;
    context.lineWidth = 1.5;
    context.font = '13px sans-serif';
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    ['X', 'Y', 'Z'].forEach((name, axis) => {
      const right = e[4 * axis], up = e[4 * axis + 1];
      if (Math.hypot(right, up) < 0.1) return;  // towards the eye
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(x + size * right, y - size * up);
      context.stroke();
      const far = size + 10 / Math.hypot(right, up);
      context.fillText(name, x + far * right, y - far * up);
    });
  }
  // A bar of a round length: 1, 2 or 5 times a power of ten, at most 100 px.
  drawScale(context, mmPerPixel) {
    const most = 100 * mmPerPixel, power = 10 ** Math.floor(Math.log10(most));
    const length = power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1), width = length / mmPerPixel;
    const right = this.width - 12.5, y = this.height - 10.5;
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(right - width, y - 4);
    context.lineTo(right - width, y);
    context.lineTo(right, y);
    context.lineTo(right, y - 4);
    context.stroke();
    context.textAlign = 'right';
    context.textBaseline = 'bottom';
    context.fillText(`${Number(length.toPrecision(1))} mm`, right, y - 4);
  }
}
